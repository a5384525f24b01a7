//! What it costs to ask for too long.

mod common;

use common::starts::perturbed;
use common::world::{families, run};
use interplay_planners::Driver;
use interplay_planners::drivers::{conservative, negotiation};

const TICKS: usize = 60;
/// Starts of a ramp merge with a tough front and a nice rear driver.
const STARTS: u64 = 30;

/// At how many starts the ego merges behind both.
fn last(ego: &Driver) -> usize {
    let (_, pose) = families().into_iter().find(|(name, _)| name == "ramp-merge/tough-nice").expect("a family");
    let place = |seed| run(perturbed(pose(ego.clone()), seed), TICKS).merged();
    (1..=STARTS).filter(|seed| place(*seed).is_none_or(|(place, _)| place == 2)).count()
}

/// A conservative ego merges between the two from each of these starts. One that asks the tough driver five times before it gives up
/// comes too late for that at one start in six or more, one that minds what its fallback costs at one in thirty at most.
#[test]
fn an_ego_that_asks_on_while_its_fallback_becomes_dearer_loses_its_place() {
    let minds = negotiation::Settings::default();
    let patient = negotiation::Settings { retreat_dearer_at_most: 1e6, ..minds };
    assert_eq!(last(&Driver::Conservative(conservative::Settings::default())), 0);
    let [lost, lost_by_patience] = [minds, patient].map(|settings| last(&Driver::Negotiation(settings)));
    assert!(lost <= 1 && lost_by_patience >= 5, "{lost} and {lost_by_patience} of {STARTS}");
}
