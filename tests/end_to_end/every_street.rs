//! One street of every kind, with one driver each in turn: no fault, no broken rule, no standing without a reason, no passing of a queue.
//!
//! The number is not used elsewhere. `interplay sweep every-street` does the same with 1,200 other ones and all planners.

use interplay_scenarios::{Override, Street, load};
use interplay_simulation::report::Report;
use interplay_simulation::run::run;
use rayon::prelude::*;

const DRIVERS: [&str; 4] = ["human", "idm", "conservative", "negotiation"];

const NUMBER: u32 = 4711;

/// A driver may stand this long without a reason that the report knows: it starts again late \[s\].
const UNEXPLAINED_S: f64 = 5.0;

/// The streets that are wrong today: kind, and why.
const KNOWN_FAILURES: &[(&str, &str)] = &[];

/// All that is wrong with a run, of which the ego is judged.
fn faults(report: &Report) -> Vec<String> {
    let of_ego = |name: &str| report.vehicle("ego").and_then(|ego| ego.metrics.number(name)).unwrap_or_default();
    let limits = [
        ("contacts_at_fault", 0.0),
        ("rules_broken", 0.0),
        ("oncoming_past_queue_s", 0.0),
        ("off_road_m", 0.05),
        ("unexplained_standing_s", UNEXPLAINED_S),
    ];
    let exceeded = limits.into_iter().filter(|(name, most)| of_ego(name) > *most);
    exceeded.map(|(name, most)| format!("{name} is {}, more than {most}", of_ego(name))).collect()
}

#[test]
fn one_street_of_every_kind_is_driven_without_fault() {
    let kinds: Vec<&str> = Street::kinds().collect();
    assert!(kinds.len() >= 30);
    let wrong: Vec<String> = kinds
        .par_iter()
        .enumerate()
        .filter_map(|(index, kind)| {
            let (name, driver) = (format!("streets/{kind}/{NUMBER}"), DRIVERS[index % DRIVERS.len()]);
            let change = Override::Set(format!("vehicle.ego.driver={{ kind = \"{driver}\" }}"));
            let scenario = load(&name, &[change]).unwrap_or_else(|error| panic!("{name}: {:?}", error.faults()));
            let report = run(&name, &scenario, Vec::new()).unwrap_or_else(|error| panic!("{name}: {error}"));
            let faults = faults(&report);
            let is_known = KNOWN_FAILURES.iter().any(|(known, _)| known == kind);
            match (faults.is_empty(), is_known) {
                (true, true) => Some(format!("{name} with {driver} is right now: remove its line")),
                (false, false) => Some(format!("{name} with {driver}: {}", faults.join(", "))),
                _ => None,
            }
        })
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
