//! The day's optimum matches independent code, satisfies the optimality conditions, and no perturbation costs less.

mod common;

use common::numbers;
use interplay_building::comfort::{Setpoints, Targets};
use interplay_building::control::{BandPenalty, ControlError, Disturbance, optimum};
use interplay_building::discretise::{DENSE_NODES, Model};
use interplay_building::lifted::Lifted;
use interplay_building::network::{AMBIENT, Network, Wall, Zone};
use serde_json::Value;

const STEP_S: f64 = 1800.0;
const STEPS: usize = 48;

fn file(text: &str) -> Value {
    serde_json::from_str(text).expect("part of the repository")
}

fn floats(value: &Value) -> Vec<f64> {
    match value {
        Value::Array(items) => items.iter().flat_map(floats).collect(),
        number => vec![number.as_f64().expect("a number")],
    }
}

/// The testbed with the two walls of 10000 K·min/kJ that Table 2.1 lists and the preset leaves out.
fn testbed() -> Network {
    let zones: Vec<Zone> = ["1", "2", "3", "4"].map(Zone::named).to_vec();
    let mut walls: Vec<Wall> =
        [("1", "2"), ("1", "3"), ("2", "4"), ("3", "4")].map(|(a, b)| Wall::new(a, b, 62.5)).to_vec();
    walls.extend([("1", "4"), ("2", "3")].map(|(a, b)| Wall::new(a, b, 600_000.0)));
    walls.extend(["1", "2", "3", "4"].map(|zone| Wall::new(zone, AMBIENT, 31.25)));
    Network::new(&zones, &walls).expect("valid")
}

fn lifted(network: &Network) -> Lifted {
    Lifted::new(&Model::euler(network, STEP_S).expect("stable"), STEPS)
}

/// The forecast of a day of `days.json`.
fn forecast(day: usize) -> Disturbance {
    let days = file(include_str!("data/days.json"));
    Disturbance { ambient_c: floats(&days["T0_fc"][day]), gains_kw: floats(&days["w_fc"][day]) }
}

fn targets(setpoints: &Setpoints, zones: usize) -> Targets {
    setpoints.targets(zones, STEP_S, STEPS).expect("valid")
}

fn assert_close(got: f64, want: f64, relative: f64) {
    assert!((got - want).abs() <= relative * want.abs(), "{got} instead of {want}: {:e}", got / want - 1.0);
}

#[test]
fn optimal_costs_of_chapter_3_match_independent_code() {
    let optima = file(include_str!("data/optima.json"));
    let lifted = lifted(&testbed());
    for (name, other_weight) in [("ch3_night1", 1.0), ("ch3_night0", 0.0)] {
        let occupied_c = vec![24.0, 25.0, 26.0, 27.0];
        let setpoints = Setpoints { occupied_c, other_c: Some(30.0), other_weight, ..Setpoints::default() };
        let wanted = &optima[name];
        let initial_c = vec![wanted["T0"].as_f64().expect("a number"); 4];
        let found = optimum(&lifted, &initial_c, &targets(&setpoints, 4), &forecast(1), None).expect("solvable");
        assert_close(found.cost, wanted["J_nominal"].as_f64().expect("a number"), 1e-6);
        assert_eq!(found.cost, found.objective);
    }
}

#[test]
fn optimal_cost_of_chapter_4_matches_independent_code() {
    let optima = file(include_str!("data/optima.json"));
    let setpoints = Setpoints {
        occupied_c: vec![22.5, 22.0, 23.0, 23.5],
        from_h: 7.5,
        to_h: 18.0,
        occupied_weight: 2.0,
        ..Setpoints::default()
    };
    let penalty = Some(BandPenalty { linear: 50.0, quadratic: 50.0 });
    let found =
        optimum(&lifted(&testbed()), &[28.5; 4], &targets(&setpoints, 4), &forecast(1), penalty).expect("solvable");
    assert_close(found.objective, optima["ch4"]["J_nominal_with_slack"].as_f64().expect("a number"), 1e-6);
}

#[test]
fn optimal_costs_of_chapter_5_match_independent_code() {
    let optima = file(include_str!("data/optima.json"));
    for (name, network) in [("ch5_n4", testbed()), ("ch5_n9", Network::grid(3, 3)), ("ch5_n16", Network::grid(4, 4))] {
        let n = network.zone_count();
        let wanted = &optima[name];
        let setpoints =
            Setpoints { occupied_c: floats(&wanted["ref"]), occupied_weight: 2.0, band_k: 1.0, ..Setpoints::default() };
        let disturbance = match &wanted["D"] {
            Value::Null => forecast(1),
            // Lumped: all of it as gains, and 0 °C outdoors.
            lumped => Disturbance { ambient_c: vec![0.0; STEPS], gains_kw: floats(lumped) },
        };
        let penalty = Some(BandPenalty { linear: 0.0, quadratic: 50.0 });
        let found = optimum(&lifted(&network), &vec![27.0; n], &targets(&setpoints, n), &disturbance, penalty);
        assert_close(found.expect("solvable").objective, wanted["J"].as_f64().expect("a number"), 1e-6);
    }
}

/// A day with walls that store heat, exactly discretised.
fn storing_day() -> (Lifted, Vec<f64>, Targets, Disturbance) {
    let zones: Vec<Zone> = ["a", "b", "c"].map(|name| Zone { limit_kw: 0.8, ..Zone::named(name) }).to_vec();
    let walls = [
        Wall::new("a", "b", 40.0).with_capacity_kj_per_k(600.0),
        Wall::new("b", "c", 60.0),
        Wall::new("a", AMBIENT, 30.0).with_capacity_kj_per_k(1500.0),
        Wall::new("b", AMBIENT, 35.0),
        Wall::new("c", AMBIENT, 30.0),
    ];
    let network = Network::new(&zones, &walls).expect("valid");
    let lifted = Lifted::new(&Model::exact(&network, STEP_S).expect("valid"), STEPS);
    let setpoints = Setpoints { occupied_c: vec![23.0, 22.0, 24.0], ..Setpoints::default() };
    let gains_kw: Vec<f64> = numbers(3 * STEPS, 0.2).iter().map(|w| w + 0.25).collect();
    let ambient_c: Vec<f64> = numbers(STEPS, 3.0).iter().map(|t| t + 30.0).collect();
    (lifted, vec![28.0; network.node_count()], targets(&setpoints, 3), Disturbance { ambient_c, gains_kw })
}

#[test]
fn the_projected_gradient_vanishes_at_the_optimum() {
    let (lifted, initial_c, targets, disturbance) = storing_day();
    let found = optimum(&lifted, &initial_c, &targets, &disturbance, None).expect("solvable");
    // ∇J = 2 W_u u − 2 Gᵀ W_e (r − T), by the products of the lifted form, which the solver never saw.
    let weighted: Vec<f64> = (targets.error_weight.iter().zip(&targets.reference_c).zip(&found.temperatures_c))
        .map(|((weight, r), t)| weight * (r - t))
        .collect();
    let pull = lifted.transpose_product(&weighted);
    let mut at_limit = 0;
    for (u, pull) in found.heat_kw.iter().zip(&pull) {
        let gradient = 2.0 * u - 2.0 * pull;
        let stationary = u - (u - gradient).clamp(-0.8, 0.8);
        assert!(stationary.abs() < 1e-5, "{stationary:e}");
        at_limit += usize::from(u.abs() > 0.8 - 1e-6);
        assert!(u.abs() <= 0.8);
    }
    assert!(at_limit > 3, "the day is hot enough to need all the power");
    let simulated = lifted.response(&initial_c, &found.heat_kw, &disturbance.ambient_c, &disturbance.gains_kw);
    assert!(common::distance(&simulated, &found.temperatures_c) < 1e-9);
}

#[test]
fn no_perturbation_of_the_optimum_is_cheaper() {
    let (lifted, initial_c, targets, disturbance) = storing_day();
    let penalty = BandPenalty { linear: 5.0, quadratic: 5.0 };
    let found = optimum(&lifted, &initial_c, &targets, &disturbance, Some(penalty)).expect("solvable");
    for scale in [1e-3, 1e-2, 0.1, 1.0] {
        let noise = numbers(found.heat_kw.len(), scale);
        let heat_kw: Vec<f64> = found.heat_kw.iter().zip(&noise).map(|(u, du)| (u + du).clamp(-0.8, 0.8)).collect();
        let temperatures_c = lifted.response(&initial_c, &heat_kw, &disturbance.ambient_c, &disturbance.gains_kw);
        let objective = targets.cost(&temperatures_c, &heat_kw) + penalty.evaluate(&targets, &temperatures_c);
        assert!(objective > found.objective, "{objective} at {scale}");
    }
}

#[test]
fn days_without_a_feasible_problem_are_refused() {
    let (lifted, initial_c, targets, disturbance) = storing_day();
    let short = Disturbance { ambient_c: vec![30.0; 3], ..disturbance.clone() };
    let error = optimum(&lifted, &initial_c, &targets, &short, None).expect_err("too short");
    assert!(matches!(error, ControlError::Shape { found: 3, wanted: STEPS, .. }), "{error}");
    let error = optimum(&lifted, &initial_c[1..], &targets, &disturbance, None).expect_err("too short");
    assert!(matches!(error, ControlError::Shape { .. }), "{error}");

    let network = Network::grid(1, DENSE_NODES + 1);
    let large = Lifted::new(&Model::exact(&network, STEP_S).expect("valid"), 1);
    let targets = Setpoints { occupied_c: vec![22.0], ..Setpoints::default() };
    let targets = targets.targets(network.zone_count(), STEP_S, 1).expect("valid");
    let day = Disturbance { ambient_c: vec![30.0], gains_kw: vec![0.0; network.zone_count()] };
    let error = optimum(&large, &vec![25.0; network.node_count()], &targets, &day, None).expect_err("too large");
    assert!(matches!(error, ControlError::TooLarge { .. }), "{error}");
}

/// Sun on a wall does what some heat of the zones would do, G⁻¹ of the temperatures that it makes; designs that know either are
/// one and the same.
#[test]
fn the_optimum_accounts_for_sun_on_a_wall() {
    let zones = ["a", "b"].map(Zone::named).to_vec();
    let network = |solar_aperture_m2: f64| {
        let floor = Wall::new("a", AMBIENT, 30.0).with_capacity_kj_per_k(1500.0);
        let inner = Wall::new("a", "b", 40.0);
        let walls = [inner, Wall { solar_aperture_m2, ..floor }, Wall::new("b", AMBIENT, 35.0)];
        Network::new(&zones, &walls).expect("valid")
    };
    let (sunny, dark) = (network(3.0), network(0.0));
    let sunny_lifted = Lifted::new(&Model::exact(&sunny, STEP_S).expect("a step"), STEPS);
    let dark_lifted = Lifted::new(&Model::exact(&dark, STEP_S).expect("a step"), STEPS);
    let sun = |t: usize| if (16..34).contains(&t) { 500.0 } else { 0.0 };
    let ambient_c = vec![5.0; STEPS];
    let day = Disturbance {
        ambient_c: ambient_c.clone(),
        gains_kw: (0..STEPS).flat_map(|t| sunny.solar_gains_kw(sun(t))).collect(),
    };
    let initial_c = [18.0, 17.0, 12.0];
    let dark_c = dark_lifted.free_response(&initial_c, &ambient_c, &vec![0.0; 2 * STEPS]);
    let sunny_c = sunny_lifted.free_response(&initial_c, &ambient_c, &day.gains_kw);
    let warmer_k: Vec<f64> = sunny_c.iter().zip(&dark_c).map(|(sunny, dark)| sunny - dark).collect();
    assert!(warmer_k[2 * 34] > 1.0, "the sun warms: {}", warmer_k[2 * 34]);
    assert_eq!(warmer_k[..2 * 16], [0.0; 2 * 16]);
    let equivalent = Disturbance { ambient_c, gains_kw: dark_lifted.solve(&warmer_k) };
    let setpoints = Setpoints { occupied_c: vec![21.0], ..Setpoints::default() };
    let targets = targets(&setpoints, 2);
    let penalty = Some(BandPenalty { linear: 50.0, quadratic: 50.0 });
    let one = optimum(&sunny_lifted, &initial_c, &targets, &day, penalty).expect("solvable");
    let other = optimum(&dark_lifted, &initial_c, &targets, &equivalent, penalty).expect("solvable");
    assert_close(one.cost, other.cost, 1e-7);
    assert!(one.heat_kw.iter().zip(&other.heat_kw).all(|(one, other)| (one - other).abs() < 1e-4));
    // A day without gains of the wall does not fit this building.
    assert!(optimum(&sunny_lifted, &initial_c, &targets, &equivalent, penalty).is_err());
}
