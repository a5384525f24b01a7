//! What it costs to fall back for the sake of a bold signal.

mod common;

use common::starts::perturbed;
use common::world::{Run, families, run};
use interplay_planners::{Driver, bayesian};

/// Ticks of a run.
const TICKS: usize = 60;
/// Starts of a family.
const STARTS: u64 = 30;

/// The places of an ego when it is in its lane, added up over the starts of a family, and the mean time until then \[s\].
fn merged(family: &str, ahead_share: f64) -> (usize, f64) {
    let (_, pose) = families().into_iter().find(|(name, _)| name == family).expect("a family");
    let ego = || Driver::Bayesian(bayesian::Settings { ahead_share, ..bayesian::Settings::default() });
    let merged = |seed| Run::merged(&run(perturbed(pose(ego()), seed), TICKS)).expect("merges");
    let (places, times): (Vec<_>, Vec<_>) = (1..=STARTS).map(merged).unzip();
    (places.into_iter().sum(), times.into_iter().sum::<f64>() / STARTS as f64)
}

/// As printed the signal also draws back an ego that is ahead of the other: it takes longer to get into its lane, and no better place.
#[test]
fn an_ego_that_is_drawn_back_to_who_is_behind_merges_later() {
    let by_default = bayesian::Settings::default().ahead_share;
    for (family, sooner_s) in [("lane-change/nice-nice", 0.5), ("ramp-merge/tough-nice", 0.15)] {
        let [(place, time_s), (printed_place, printed_s)] = [by_default, 1.0].map(|share| merged(family, share));
        assert!(time_s < printed_s - sooner_s && place <= printed_place, "{family}: {time_s} and {printed_s} s");
    }
}
