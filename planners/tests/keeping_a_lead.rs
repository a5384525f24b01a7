//! What an ego gives up that is ahead of the other, and acts as printed.

mod common;

use common::starts::perturbed;
use common::world::{Run, families, run};
use interplay_planners::Driver;
use interplay_planners::drivers::game::ExpressedBounds;
use interplay_planners::drivers::{bayesian, game};

const TICKS: usize = 60;
const STARTS: u64 = 30;

/// The places of an ego when it is in its lane, added up over the starts of a family, and the mean time until then \[s\].
fn merged(family: &str, ego: &Driver) -> (usize, f64) {
    let (_, pose) = families().into_iter().find(|(name, _)| name == family).expect("a family");
    let merged = |seed| Run::merged(&run(perturbed(pose(ego.clone()), seed), TICKS)).expect("merges");
    let (places, times): (Vec<_>, Vec<_>) = (1..=STARTS).map(merged).unzip();
    (places.into_iter().sum(), times.into_iter().sum::<f64>() / STARTS as f64)
}

/// Asserts that an ego merges later as printed, and gets no better place.
fn assert_later_as_printed(family: &str, ego: &Driver, printed: &Driver, later_s: f64) {
    let [(place, time_s), (printed_place, printed_s)] = [ego, printed].map(|ego| merged(family, ego));
    assert!(time_s < printed_s - later_s && place <= printed_place, "{family}: {time_s} and {printed_s} s");
}

/// As printed the signal also draws back an ego that is ahead of the other.
#[test]
fn an_ego_drawn_back_to_the_vehicle_behind_merges_later() {
    let with = |ahead_share| Driver::Bayesian(bayesian::Settings { ahead_share, ..bayesian::Settings::default() });
    let (ego, printed) = (Driver::Bayesian(bayesian::Settings::default()), with(1.0));
    for (family, later_s) in [("lane-change/nice-nice", 0.5), ("ramp-merge/tough-nice", 0.15)] {
        assert_later_as_printed(family, &ego, &printed, later_s);
    }
}

/// As printed an ego that seems surer to pass than it is slows down.
#[test]
fn an_ego_that_must_not_seem_too_sure_merges_later() {
    let with = |expressed_bounds| {
        Driver::Game(game::Settings { slack_weight: 1.5, expressed_bounds, ..game::Settings::default() })
    };
    let (ego, printed) = (with(ExpressedBounds::OneSided), with(ExpressedBounds::Interval));
    assert_later_as_printed("ramp-merge/nice-nice", &ego, &printed, 0.3);
}
