//! Expected failures: a scenario shows what it shows because of its planner. Each one, driven by a planner that should not manage
//! it, must break the expectation named here. "scripted" is a driver without a script, which keeps its initial speed and ignores
//! all traffic.

use std::collections::BTreeSet;

use interplay_scenarios::{Override, embedded, load};
use interplay_simulation::run::run;
use rayon::prelude::*;

/// A scenario, who drives its ego instead, and the expectation that then breaks.
type Replacement = (&'static str, &'static str, &'static str);

const REPLACEMENTS: &[Replacement] = &[
    // A scripted vehicle does not stop for others.
    ("people/high-street", "scripted", "no_collision"),
    // Others do not yield to an ego that does not ask; an ego that asks goes first.
    ("intersection/nice", "conservative", "order"),
    ("intersection/bayesian-nice", "conservative", "order"),
    ("intersection/game-friendly", "conservative", "order"),
    ("intersection/game-nash", "conservative", "order"),
    ("intersection/nash-nice", "conservative", "order"),
    ("lane-change/nash-front-nice", "conservative", "order"),
    // A plan for the likeliest driver alone, or at the limit of what is possible, brakes harder.
    ("lane-keeping/contingency", "idm", "comfort.ego.braking_at_most_mps2"),
    ("ramp-merge/contingency", "negotiation", "comfort.ego.braking_at_most_mps2"),
    ("intersection/conservative-nice", "negotiation", "order"),
    ("intersection/negotiation-meets-game", "scripted", "order"),
    ("lane-change/front-nice", "conservative", "order"),
    ("lane-change/bayesian-front-nice", "conservative", "order"),
    ("lane-change/game-front-nice", "conservative", "order"),
    ("lane-change/game-nash", "conservative", "order"),
    ("lane-change/conservative-front-nice", "negotiation", "order"),
    ("lane-keeping/nice", "conservative", "order"),
    ("intersection/inferred-sensed", "conservative", "order"),
    ("intersection/game-inferred", "conservative", "order"),
    ("intersection/inferred-tough", "idm", "no_collision"),
    ("lane-keeping/conservative-nice", "negotiation", "order"),
    ("lane-keeping/two-negotiators", "conservative", "order"),
    ("ramp-merge/nice", "conservative", "order"),
    ("ramp-merge/game-nice", "conservative", "order"),
    ("ramp-merge/conservative-nice", "negotiation", "order"),
    // One cooperative driver alone does not cooperate: all wait for one another.
    ("intersection/cooperative", "conservative", "order"),
    ("lane-change/cooperative", "conservative", "completes.ego"),
    ("lane-keeping/cooperative", "conservative", "completes.merger"),
    // The intelligent driver model waits for a gap in which to merge; the exact value keeps away, the linear one does not.
    ("lane-change/among-idm", "idm", "completes.ego"),
    ("lane-change/front-tough", "idm", "order"),
    ("lane-change/bayesian-exact", "conservative", "order"),
    // The intelligent driver model sees no crossing traffic, and waits for a gap that no vehicle makes.
    ("intersection/tough", "idm", "no_collision"),
    ("intersection/bayesian-tough", "idm", "no_collision"),
    ("intersection/bayesian-inches", "idm", "order"),
    ("intersection/game-aggressive", "idm", "no_collision"),
    ("intersection/safety-filter", "idm", "no_collision"),
    ("lane-change/bayesian-front-tough", "idm", "order"),
    ("lane-change/game-friendly", "idm", "order"),
    ("lane-keeping/bayesian-tough", "idm", "min_gap_m"),
    ("ramp-merge/bayesian-front-tough", "idm", "order"),
    ("ramp-merge/front-tough", "idm", "order"),
    ("curve/lane-drop", "idm", "order"),
    ("full-size/bend", "idm", "completes.ego"),
    // A driver that keeps the right of way does not ask for it; one that ignores it goes out of turn.
    ("left-turn/nice", "human", "yields.oncoming.to.ego"),
    ("left-turn/tough", "scripted", "yields.ego.to.oncoming"),
    ("left-turn/game-nice", "human", "yields.oncoming.to.ego"),
    ("left-turn/game-tough", "scripted", "yields.ego.to.oncoming"),
    ("narrow-passage/nice", "conservative", "yields.oncoming.to.ego"),
    ("narrow-passage/tough", "scripted", "no_collision"),
    ("narrow-passage/two-negotiators", "scripted", "yields.ego.to.oncoming"),
    ("roundabout/nice", "human", "yields.ring.to.ego"),
    ("roundabout/tough", "negotiation", "yields.ego.to.ring"),
    ("left-turn/cooperative", "human", "completes.ego"),
    ("roundabout/bayesian-nice", "human", "yields.ring.to.ego"),
    ("roundabout/bayesian-tough", "negotiation", "yields.ego.to.ring"),
    ("narrow-passage/conservative-nice", "scripted", "gap_at_least_m"),
    ("t-junction/bayesian-nice", "human", "yields.main.to.ego"),
    ("t-junction/bayesian-tough", "scripted", "no_collision"),
    // A cooperative driver does not stop, and passes earlier than one that waits for its turn.
    ("t-junction/cooperative", "human", "speed.ego.min_above_mps"),
    ("roundabout/cooperative", "human", "yields.ego.to.ring"),
    ("narrow-passage/cooperative", "human", "completes.ego"),
    ("on-ramp/five", "idm", "yields.rear.to.ego"),
    ("all-way-stop/four", "scripted", "order"),
    ("overtaking/oncoming", "idm", "order"),
    ("curve/lane-drop-cars", "idm", "order"),
    // Among drivers who ignore it, the ego must find the way by itself.
    ("lane-change/both-tough", "scripted", "completes.ego"),
    ("lane-change/bayesian-both-tough", "scripted", "completes.ego"),
    ("lane-change/bayesian-gap-closed", "scripted", "completes.ego"),
    ("lane-change/game-aggressive", "scripted", "completes.ego"),
    ("lane-keeping/bayesian-nice", "scripted", "speed.ego.max_above_mps"),
    ("lane-keeping/tough", "scripted", "speed.ego.min_below_mps"),
    ("ramp-merge/tough", "scripted", "completes.ego"),
    ("ramp-merge/bayesian-tough", "scripted", "completes.ego"),
    ("ramp-merge/game-tough", "scripted", "completes.ego"),
];

/// The expectations that break when another planner drives the ego.
fn broken(name: &str, planner: &str) -> Vec<String> {
    let scenario = load(name, &[Override::Planner(planner.to_owned())]).expect("authored, with a known planner");
    let report = run(name, &scenario, Vec::new()).expect("the run can be finished");
    report.expectations.into_iter().filter(|one| !one.passed).map(|one| one.what).collect()
}

#[test]
fn unsuited_planners_fail_the_stated_expectations_of_scenarios() {
    let missed = |(name, planner, what): &(&str, &str, &str)| {
        let broken = broken(name, planner);
        let is_missed = !broken.iter().any(|one| one == what);
        is_missed.then(|| format!("{name} by {planner}: {what} not in {broken:?}"))
    };
    let wrong: Vec<String> = REPLACEMENTS.par_iter().filter_map(missed).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn every_figure_and_network_lists_a_planner_that_fails_it() {
    let listed: BTreeSet<&str> = REPLACEMENTS.iter().map(|(name, _, _)| *name).collect();
    for file in embedded() {
        let scenario = load(file.name, &[]).expect("authored");
        let has_figure = scenario.figure.is_some() && !scenario.vehicles.is_empty();
        let wants_line = has_figure || scenario.network.is_some();
        assert!(!wants_line || listed.contains(file.name), "{} needs a line in REPLACEMENTS", file.name);
    }
}
