//! Every authored scenario meets its expectations.

use interplay_scenarios::{Override, embedded, load};
use rayon::prelude::*;
use serde_json::json;

use crate::command::{interplay, scratch};
use crate::film::film;

#[test]
fn every_authored_scenario_passes_without_collision_or_plan_failure() {
    let folder = scratch("authored");
    for file in embedded() {
        // The suite judges the counterfactuals.
        let alone = ["run", file.name, "--no-record", "--json", "--set", "counterfactual=[]"];
        let outcome = interplay(&folder, &alone);
        let report = outcome.json();
        assert_eq!(outcome.code, Some(0), "{}: {outcome:?}", file.name);
        assert_eq!(report["passed"], true, "{}", file.name);
        assert!(!report["expectations"].as_array().expect("a list").is_empty(), "{} expects nothing", file.name);
        if report.get("vehicles").is_none() {
            continue;
        }
        let on_purpose =
            report["expectations"].as_array().expect("a list").iter().any(|one| one["what"] == "collisions");
        assert!(on_purpose || report["collisions"] == json!([]), "{}", file.name);
        for vehicle in report["vehicles"].as_array().expect("a list") {
            assert_eq!(vehicle["plans"]["failed"], 0, "{}: {}", file.name, vehicle["name"]);
        }
    }
}

/// The planners are separated by what they do: who negotiates merges ahead, who does not merges between, no sooner.
#[test]
fn a_conservative_ego_merges_between_and_fails_the_expectation() {
    let folder = scratch("conservative");
    let arguments = ["run", "lane-change/front-nice", "--planner", "conservative", "--no-record", "--json"];
    let outcome = interplay(&folder, &arguments);
    let report = outcome.json();
    assert_eq!(outcome.code, Some(1), "{outcome:?}");
    assert_eq!(report["passed"], false);
    assert_eq!(report["order"], json!(["front", "ego", "rear"]));
    assert_eq!(report["collisions"], json!([]));
    let failed: Vec<_> =
        report["expectations"].as_array().expect("a list").iter().filter(|one| one["passed"] == false).collect();
    let what: Vec<_> = failed.iter().map(|one| &one["what"]).collect();
    assert_eq!(what, ["order", "completes.ego"], "another place, and later");
}

/// In every family the ego goes first in the nice scenario because it negotiates: the conservative planner has another order.
#[test]
fn other_vehicles_do_not_yield_to_an_ego_that_does_not_ask() {
    let folder = scratch("does-not-ask");
    for name in ["intersection/nice", "lane-keeping/nice", "ramp-merge/nice"] {
        let order = |planner: &str| {
            let report = interplay(&folder, &["run", name, "--planner", planner, "--no-record", "--json"]).json();
            assert_eq!(report["collisions"], json!([]), "{name}: {planner}");
            report["order"].clone()
        };
        let (asking, not_asking) = (order("negotiation"), order("conservative"));
        assert_eq!(asking[0], "ego", "{name}");
        assert_ne!(not_asking[0], "ego", "{name}");
    }
}

#[test]
fn without_a_command_the_first_scenario_runs() {
    let folder = scratch("default");
    let outcome = interplay(&folder, &[]);
    assert_eq!(outcome.code, Some(0), "{outcome:?}");
    let lines: Vec<&str> = outcome.stdout.lines().collect();
    assert_eq!(lines.first(), Some(&"People: crossing without priority  [people/intersection]"), "{outcome:?}");
    let next: Vec<&str> = outcome.stderr.lines().filter(|line| line.starts_with("next: ")).collect();
    assert_eq!(next.len(), 3, "{outcome:?}");
    for (line, command) in next.iter().zip(["why", "play", "new"]) {
        assert!(line.contains(&format!(" {command} ")), "{line}");
    }
    assert!(lines.len() + next.len() <= 15, "the first screen is short: {outcome:?}");
    assert!(!folder.join("recordings").exists(), "it writes no file");
}

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
