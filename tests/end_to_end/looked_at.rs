//! Streets on which drivers were seen to do what people do not: to stop half-way into a lane, to overtake a bus that
//! pulls away, to swerve onto the other lane where they are close behind another car.

use interplay_scenarios::{Override, from_text, load};
use interplay_simulation::run::run;
use rayon::prelude::*;

/// From these starts, a driver that thought it could turn at the speed it wants stopped with its nose in the lane it joined, and a driver
/// that does not slow down touched it.
const STARTS_M: [f64; 3] = [4.0, 9.0, 14.0];

const DRIVERS: [&str; 3] = ["conservative", "bayesian", "negotiation"];

#[test]
fn no_driver_stops_half_way_into_the_lane_that_it_joins() {
    let cases: Vec<(f64, &str)> =
        STARTS_M.iter().flat_map(|start_m| DRIVERS.map(|driver| (*start_m, driver))).collect();
    cases.par_iter().for_each(|(start_m, driver)| {
        let changes = [
            "conduct=people".to_owned(),
            format!("vehicle.ego.driver={{ kind = \"{driver}\" }}"),
            format!("vehicle.main.start={{ lane = \"west-in\", along_m = {start_m}, speed_mps = 10.0 }}"),
            "vehicle.main.driver.style=tough".to_owned(),
        ];
        let scenario = load("t-junction/bayesian-nice", &changes.map(Override::Set)).expect("a scenario");
        let report = run("join", &scenario, Vec::new()).expect("a run");
        let number = |vehicle: &str, name: &str| {
            report.vehicle(vehicle).and_then(|vehicle| vehicle.metrics.number(name)).unwrap_or_default()
        };
        let case = format!("{driver} from {start_m} m");
        assert!(report.min_gap_m().expect("a gap") > 1.0, "{case}: {:?}", report.min_gap_m());
        assert!(number("ego", "unexplained_standing_s") < 1.0, "{case}");
        assert!(number("main", "peak_braking_mps2") < 3.0, "{case}: {}", number("main", "peak_braking_mps2"));
        assert!(report.vehicle("ego").expect("the ego").completed_s.is_some(), "{case}");
    });
}

/// Vehicles that had passed on the other lane counted as overtaking from behind, so that a driver stayed behind a slow one for good.
#[test]
fn a_driver_overtakes_a_slow_lorry_and_no_bus_that_leaves_its_stop() {
    for (street, last) in [("streets/truck/6219", "truck"), ("streets/bus/6220", "ego")] {
        let normal = Override::Set("vehicle.ego.driver={ kind = \"human\", style = \"normal\" }".to_owned());
        let scenario = load(street, &[normal]).expect("a street");
        let report = run("overtake", &scenario, Vec::new()).expect("a run");
        assert_eq!(report.order_of_driven().last(), Some(&last), "{street}");
    }
}

/// A car of which the driver finds itself close behind another that pulls away, as behind one that has cut in.
const CLOSE_BEHIND: &str = r#"
title = "Close behind"
shows = "A car close behind another that pulls away"
duration_s = 6.0
road = { kind = "two-way" }
defaults = { class = "car" }
[[vehicle]]
name = "ego"
start = { lane = "east", along_m = 20.0, speed_mps = 8.0 }
goal = { speed_mps = 8.0 }
[[vehicle]]
name = "ahead"
start = { lane = "east", along_m = 28.9, speed_mps = 8.0 }
goal = { speed_mps = 12.0 }
driver = { kind = "idm" }
"#;

/// A gap that is too short was to open faster than brakes can open it, so that humans gained it by swerving 0.6 m. Planners still do
/// (`docs/guide/people.md`).
#[test]
fn a_driver_close_behind_another_stays_in_its_lane() {
    for driver in ["human", "idm"] {
        let driven = Override::Set(format!("vehicle.ego.driver={{ kind = \"{driver}\" }}"));
        let scenario = from_text("close-behind", CLOSE_BEHIND, &[driven]).expect("a scenario");
        let report = run("close-behind", &scenario, Vec::new()).expect("a run");
        let ego = report.vehicle("ego").expect("the ego");
        let number = |name: &str| ego.metrics.number(name).unwrap_or_default();
        let [lateral_mps2, braking_mps2] = ["peak_lateral_acceleration_mps2", "peak_braking_mps2"].map(number);
        assert!(lateral_mps2 < 0.5 && braking_mps2 < 3.2, "{driver}: {lateral_mps2} and {braking_mps2} m/s²");
        assert!(number("astride_s") < 0.1 && report.collisions.is_empty(), "{driver}");
    }
}
