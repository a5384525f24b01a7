//! Drivers and plants that cannot manage a scenario break its expectations, which are strong enough to show it.

use interplay_scenarios::{Override, load};
use rayon::prelude::*;

use crate::film::film;

/// A scenario, a change of it, and the expectations that then fail.
const UNSUITED: &[(&str, &str, &[&str])] = &[
    ("full-size/lane-change", CONSERVATIVE, &["order"]),
    ("full-size/lane-keeping", CONSERVATIVE, &["order", "speed.ego.max_above_mps"]),
    ("full-size/ramp-merge", CONSERVATIVE, &["order"]),
    ("full-size/intersection", CONSERVATIVE, &["order", "completes.ego"]),
    ("intersection/slanted-nice", CONSERVATIVE, &["order", "completes.ego"]),
    ("intersection/slanted-tough", RECKLESS, &["order"]),
    ("intersection/four-way", CONSERVATIVE, &["order"]),
    ("intersection/stop-sign", RECKLESS, &["no_collision", "order"]),
    ("crash/side-impact", "plant.kind='kinematic'", &["speed.crossing.min_below_mps", "speed.follower.min_below_mps"]),
    ("crash/side-impact", "vehicle.ego.driver={ kind = 'conservative' }", &["collisions"]),
];

const CONSERVATIVE: &str = "vehicle.ego.driver={ kind = 'conservative' }";
const RECKLESS: &str = "vehicle.ego.driver={ kind = 'human', style = 'tough' }";

#[test]
fn unsuited_drivers_fail_the_stated_expectations() {
    UNSUITED.par_iter().for_each(|(name, change, expected): &(&str, &str, &[&str])| {
        let scenario = load(name, &[Override::Set((*change).to_owned())]).expect("a sound change");
        let report = film(name, scenario).report;
        let failed = report.expectations.iter().filter(|one| !one.passed).map(|one| one.what.as_str());
        let failed: Vec<&str> = failed.collect();
        assert!(expected.iter().all(|what| failed.contains(what)), "{name} with {change}: {failed:?} fail");
        assert!(!report.passed);
    });
}
