//! Who joins a road ahead of a vehicle with priority counts the time for its turn, and so does not stop half-way.

use interplay_scenarios::{Override, load};
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
