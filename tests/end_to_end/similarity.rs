//! Froude's law: a scenario and its twin of another size have the same motion, scaled.
//!
//! Both state starts and goals only. Lengths are multiplied by `λ`, times and speeds by `√λ`; settings are defaults, which the
//! loader scales.

use interplay_planners::{Driver, Input};
use interplay_scenarios::{Scenario, from_text};
use interplay_simulation::frame::VehicleFrame;
use rayon::prelude::*;

use crate::film::{Film, film};

/// The ego's drivers and the families in which they are compared.
const DRIVERS: [&str; 12] = [
    "kind = 'human'",
    "kind = 'conservative'",
    "kind = 'negotiation'",
    "kind = 'negotiation', acceptance = 'as-printed'",
    "kind = 'bayesian'",
    "kind = 'game'",
    "kind = 'game', expressed_bounds = 'interval'",
    "kind = 'game', expressed_speed = 'along-road'",
    "kind = 'cooperative'",
    "kind = 'nash'",
    "kind = 'contingency'",
    "kind = 'idm'",
];

/// Twins that are not compared: before a crossing this ego weaves, to be fast and come no nearer. Its first descent ends at its limit of
/// work, and one bound on its mean speed leaves the twins more than one way from there. With two bounds, and along the road, they move alike.
const NOT_COMPARED: (&str, &str) = ("intersection", "kind = 'game'");

/// A lane change ahead of two humans, or a crossing with one, or a ramp, of a size.
fn twin(family: &str, driver: &str, scale: f64) -> Scenario {
    let (m, mps) = (scale, scale.sqrt());
    let vehicle = |name: &str, [x, y, v, wanted]: [f64; 4], more: &str| {
        format!(
            "[[vehicle]]\nname = '{name}'\nstart = {{ x_m = {:?}, y_m = {:?}, speed_mps = {:?}{} }}\n\
             goal.speed_mps = {:?}\n{more}\n",
            x * m,
            y * m,
            v * mps,
            if more.contains("cross") { ", heading_deg = 90" } else { "" },
            wanted * mps
        )
    };
    let drivers = format!("driver = {{ {driver} }}");
    let vehicles = match family {
        "intersection" => [
            vehicle("ego", [-2.5, 0.185, 0.7, 1.2], &drivers),
            vehicle("crossing", [0.0, -1.815, 0.8, 0.8], "road = 'cross'\ndriver = { kind = 'human' }"),
        ]
        .concat(),
        _ => [
            vehicle("ego", [0.0, 0.185, 1.0, 1.0], &format!("goal.lane = 1\n{drivers}")),
            vehicle("front", [-0.4, 0.555, 1.2, 1.2], "driver = { kind = 'human' }"),
            vehicle("rear", [-1.9, 0.555, 1.2, 1.2], "driver = { kind = 'human', style = 'normal' }"),
        ]
        .concat(),
    };
    let text = format!(
        "title = 'Twin'\nshows = 'Similarity'\nscale = {scale:?}\nduration_s = {:?}\n[road]\nkind = '{family}'\n{vehicles}",
        8.0 * mps
    );
    from_text("twin.toml", &text, &[]).unwrap_or_else(|error| panic!("{error:?}"))
}

/// The largest difference of the states of twins at a tick, in the units of the small one.
fn apart([small, large]: [&Film; 2], tick: usize, scale: f64) -> f64 {
    let pairs = small.frames[tick].vehicles.iter().zip(&large.frames[tick].vehicles);
    let differences = pairs.flat_map(|(one, other)| {
        let [x, y, heading, speed] = other.state.to_array();
        let scaled = [x / scale, y / scale, heading, speed / scale.sqrt()];
        one.state.to_array().into_iter().zip(scaled).map(|(a, b)| (a - b).abs())
    });
    differences.fold(0.0, f64::max)
}

/// The largest relative difference of what one motion costs in the problems that the twins solve. Accelerations and steering
/// angles are the same at any size.
fn priced_apart([small, large]: [&Film; 2], tick: usize) -> f64 {
    let pairs = small.frames[tick].vehicles.iter().zip(&large.frames[tick].vehicles);
    let costs = pairs.filter_map(|(one, other)| {
        let inputs = problem_inputs(one)?;
        let [cost, scaled] =
            [one, other].map(|seen| seen.plan.problem.as_ref().map(|problem| problem.cost_of(&inputs)));
        cost.zip(scaled).map(|(cost, scaled)| (cost - scaled).abs() / (1.0 + cost.abs()))
    });
    costs.fold(0.0, f64::max)
}

/// Inputs for every participant of the problem behind a plan: those of the plan, and of the others nothing.
fn problem_inputs(seen: &VehicleFrame) -> Option<Vec<Vec<Input>>> {
    let problem = seen.plan.problem.as_ref()?;
    let mut inputs = vec![vec![Input::default(); problem.horizon]; problem.participants.len()];
    inputs[0].clone_from(&seen.plan.trajectory.inputs);
    Some(inputs)
}

/// Whether every plan of a film met the tolerance of the optimiser.
fn is_converged(film: &Film) -> bool {
    let seen = film.frames.iter().flat_map(|frame| &frame.vehicles);
    seen.map(|vehicle| vehicle.plan.statistics.residual).fold(0.0, f64::max) <= CONVERGED_RESIDUAL
}

/// What a descent that has ended at an optimum leaves of the optimality conditions.
const CONVERGED_RESIDUAL: f64 = 1e-6;
/// Number of ticks at which the problems of twins are compared: the first, and the second, in which negotiation persuades. Later the
/// plans of others that are in them differ by what an optimiser leaves, at a price of 10³.
const ALIKE_TICKS: usize = 2;
/// States that differ by less are the same.
const SAME_STATES: f64 = 1e-6;
/// Most by which the cost of the same motion differs in both problems. A constant that is not scaled changes costs by much more.
const SAME_COST: f64 = 1e-3;
/// Most by which twins drift apart \[m, rad, m/s of the small one\]; measured are 10⁻⁷ to 10⁻⁴.
///
/// The optimiser stops by numbers that are not scaled. A row on the verge of being active has a slack of about the root of the
/// tolerance of QP subproblems, 3·10⁻⁵, and a descent ends where a step promises less than 10⁻⁹ of the cost. Without these two,
/// the law would hold to rounding, as it does for the model without an optimiser ([`MAX_DRIFT_OF_RULES`]).
const MAX_DRIFT: f64 = 1e-3;
/// The same for a driver without an optimiser among others without one.
const MAX_DRIFT_OF_RULES: f64 = 1e-10;
/// The same where a descent ended at its limit of work: the twins are then at different places on their way to one optimum.
const MAX_UNFINISHED_DRIFT: f64 = 1e-2;

#[test]
fn scaled_copies_of_a_scenario_move_alike() {
    let families = ["lanes", "intersection", "ramp-merge"];
    let takes = families.iter().flat_map(|family| DRIVERS.iter().map(move |driver| (*family, *driver)));
    let takes: Vec<(&str, &str)> = takes.filter(|take| *take != NOT_COMPARED).collect();
    takes.into_par_iter().for_each(|(family, driver)| {
        let small = film(family, twin(family, driver, 1.0));
        for scale in [10.0, 16.0] {
            let (large, about) = (film(family, twin(family, driver, scale)), format!("{family}, {driver}, {scale}"));
            assert_eq!(small.frames.len(), large.frames.len(), "{about}: as many steps");
            let most = if [&small, &large].into_iter().all(is_converged) { MAX_DRIFT } else { MAX_UNFINISHED_DRIFT };
            for tick in 0..small.frames.len() {
                let drift = apart([&small, &large], tick, scale);
                assert!(drift < most, "{about}: {drift} at tick {tick}");
                if tick < ALIKE_TICKS && drift < SAME_STATES {
                    let dearer = priced_apart([&small, &large], tick);
                    assert!(dearer < SAME_COST, "{about}: costs differ by {dearer} at tick {tick}");
                }
            }
        }
    });
}

/// Drivers that follow rules have no tolerances: to rounding, they move alike.
#[test]
fn scaled_copies_without_an_optimiser_move_alike_up_to_rounding() {
    for family in ["lanes", "ramp-merge"] {
        let of_size = |scale: f64| {
            let mut scenario = twin(family, "kind = 'idm'", scale);
            let driver = scenario.vehicles[0].driver.clone();
            scenario.vehicles.iter_mut().for_each(|vehicle| vehicle.driver = driver.clone());
            film(family, scenario)
        };
        let [small, large] = [1.0, 10.0].map(of_size);
        for tick in 0..small.frames.len() {
            let drift = apart([&small, &large], tick, 10.0);
            assert!(drift < MAX_DRIFT_OF_RULES, "{family}: {drift} at tick {tick}");
        }
    }
}

#[test]
fn stated_settings_are_not_scaled() {
    let mut scenario = twin("lanes", "kind = 'bayesian', beta_0_m = 0.02", 10.0);
    let Driver::Bayesian(settings) = &mut scenario.vehicles[0].driver else { panic!("another driver") };
    assert_eq!((settings.beta_0_m, settings.clear_lead_m), (0.02, 2.0));
}
