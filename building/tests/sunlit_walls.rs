//! Sun on walls that store heat: every controller runs with it, and designs that are told the sun plan with it.

use interplay_building::comfort::Setpoints;
use interplay_building::control::{Controller, Disturbance};
use interplay_building::day::run_day;
use interplay_building::discretise::Model;
use interplay_building::network::{AMBIENT, Network, Wall, Zone};

const STEP_S: f64 = 1800.0;
const STEPS: usize = 48;

/// Two rooms; the sun falls on the floor of the first and warms the air of the second.
fn building() -> Model {
    let zones = [Zone::named("a"), Zone { solar_aperture_m2: 1.0, ..Zone::named("b") }];
    let walls = [
        Wall::new("a", "b", 40.0),
        Wall { solar_aperture_m2: 3.0, ..Wall::new("a", AMBIENT, 30.0).with_capacity_kj_per_k(2500.0) },
        Wall::new("b", AMBIENT, 35.0),
    ];
    Model::euler(&Network::new(&zones, &walls).expect("valid"), STEP_S).expect("stable")
}

#[test]
fn with_an_exact_forecast_sunlit_walls_reach_the_planned_temperatures() {
    let model = building();
    let network = model.network();
    let sun = |t: usize| if (16..36).contains(&t) { 500.0 } else { 0.0 };
    let day = Disturbance {
        ambient_c: (0..STEPS).map(|t| 24.0 + if t < 20 { 0.0 } else { 6.0 }).collect(),
        gains_kw: (0..STEPS).flat_map(|t| network.solar_gains_kw(sun(t))).collect(),
    };
    let setpoints = Setpoints { occupied_c: vec![22.0], ..Setpoints::default() };
    let targets = setpoints.targets(2, STEP_S, STEPS).expect("valid");
    let mut planning = 0;
    for kind in [
        "thermostat",
        "pid",
        "iterative-learning",
        "model-predictive",
        "clairvoyant",
        "iterative",
        "concurrent",
        "distributed",
        "centralised",
    ] {
        let controller: Controller = toml::from_str(&format!("kind = '{kind}'")).expect("a kind");
        let mut sunlit = controller.controller(&model, STEPS).expect("valid");
        let mut nodes_c = vec![26.0; network.node_count()];
        for number in 0..3 {
            let record = run_day(&model, &mut nodes_c, &mut *sunlit, &targets, &day, &day).expect("runs");
            assert_eq!(record.design.fallback, None, "{kind}");
            if number == 2 && controller.plans() {
                planning += 1;
                let planned_c = &record.design.planned_c;
                assert_eq!(planned_c.len(), 2 * STEPS, "{kind}");
                let errors_k = planned_c.iter().zip(&record.temperatures_c).map(|(plan, real)| (plan - real).abs());
                let largest_k = errors_k.fold(0.0_f64, f64::max);
                assert!(largest_k < 1e-6, "{kind}: {largest_k} K");
            }
        }
    }
    assert!(planning >= 4, "{planning} designs plan");
}
