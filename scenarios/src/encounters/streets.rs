//! Encounters on streets.

use super::cast::{Cast, Stream};
use crate::streets::draft::{Draftee, Parked};
use crate::streets::queues::{STREET_M, street};

/// A queue comes through a passage that is as wide as one vehicle.
pub(super) fn narrow_queue(cast: &mut Cast) {
    let draft = &mut cast.draft;
    let priority = draft.one_of(&["", "priority_to = \"west\"\n", "priority_to = \"east\"\n"]);
    let (approach_m, limit_mps, passage_m) = (180.0, draft.between(8.3, 11.0), draft.between(25.0, 45.0));
    draft.road(&format!(
        "kind = \"narrow-passage\"\napproach_m = {approach_m:.1}\npassage_m = {passage_m:.1}\n\
         speed_limit_mps = {limit_mps:.1}\n{priority}"
    ));
    let (in_s, speed_mps) = (draft.between(5.0, 7.0), draft.between(0.7, 0.9) * limit_mps);
    let (headway_s, count) = ([1.6, draft.between(2.0, 3.0)], draft.count(3, 6));
    let (flow_mps, from_s) = (draft.between(0.7, 0.9) * limit_mps, in_s + draft.between(-4.0, -1.0));
    let place_m = approach_m - 5.0;
    cast.ego("east-in", "east-out", place_m, [speed_mps, 0.95 * limit_mps], in_s);
    cast.follower("east-in", "east-out", place_m - speed_mps * in_s, speed_mps);
    let (prefix, lane, to) = ("queue", "west-in", Some("west-out"));
    cast.stream(&Stream { prefix, lane, to, place_m, speed_mps: flow_mps, from_s, headway_s, count });
}

/// Vans stand in the ego's lane, and traffic comes the other way.
pub(super) fn double_parked(cast: &mut Cast) {
    let draft = &mut cast.draft;
    let limit_mps = draft.between(8.3, 11.0);
    street(draft, limit_mps);
    let (in_s, speed_mps) = (draft.between(4.0, 6.0), draft.between(0.7, 0.9) * limit_mps);
    let place_m = STREET_M - draft.between(35.0, 50.0);
    let vans = draft.count(1, 2);
    for (name, behind_m) in [("van-a", 5.0), ("van-b", 12.0)].into_iter().take(vans) {
        let aside_m = draft.between(-0.6, -0.2);
        draft.parked(Parked { name, kind: "parked-van", lane: "east-in", along_m: place_m + behind_m, aside_m });
    }
    let (headway_s, count) = ([2.0, draft.between(3.0, 6.0)], draft.count(3, 6));
    let (flow_mps, from_s) = (draft.between(0.7, 0.9) * limit_mps, in_s + draft.between(-1.0, 2.0));
    cast.ego("east-in", "east-out", place_m, [speed_mps, 0.95 * limit_mps], in_s);
    cast.follower("east-in", "east-out", place_m - speed_mps * in_s, speed_mps);
    // The vans stand on the part of the street that the others reach after its middle.
    let place_m = STREET_M + (STREET_M - place_m);
    let from_s = from_s.max((place_m - STREET_M + 5.0) / flow_mps);
    let (prefix, lane, to) = ("oncoming", "west-in", Some("west-out"));
    cast.stream(&Stream { prefix, lane, to, place_m, speed_mps: flow_mps, from_s, headway_s, count });
}

/// Length of the pavements from which pedestrians come \[m\].
const PAVEMENT_M: f64 = 25.0;

/// A stream of pedestrians from both sides uses a zebra crossing.
pub(super) fn zebra_stream(cast: &mut Cast) {
    let draft = &mut cast.draft;
    let limit_mps = draft.between(8.3, 13.9);
    street(draft, limit_mps);
    let (x_m, users) = (-20.0, "users = [\"pedestrian\"]\n");
    for (from, side) in [("north", 1.0), ("south", -1.0)] {
        // Two paths beside each other, one in each direction.
        let x_m = x_m - 1.3 * side;
        let y_m = |y_m: f64| [x_m, side * y_m];
        let next = |name: &str| format!("{users}successors = [\"{from}-{name}\"]\n");
        draft.lane(&format!("{from}-pavement"), [y_m(4.0 + PAVEMENT_M), y_m(4.0)], 2.5, &next("zebra"));
        let zebra = next("opposite") + "zebra = true\n";
        draft.lane(&format!("{from}-zebra"), [y_m(4.0), y_m(-4.0)], 2.5, &zebra);
        draft.lane(&format!("{from}-opposite"), [y_m(-4.0), y_m(-4.0 - PAVEMENT_M)], 2.5, users);
    }
    let (in_s, speed_mps) = (draft.between(4.0, 6.5), draft.between(0.7, 0.9) * limit_mps);
    let place_m = STREET_M + x_m - 3.0;
    let oncoming = draft.count(2, 4);
    cast.ego("east-in", "east-out", place_m, [speed_mps, 0.95 * limit_mps], in_s);
    cast.follower("east-in", "east-out", place_m - speed_mps * in_s, speed_mps);
    let (prefix, lane, to, from_s) = ("oncoming", "west-in", Some("west-out"), in_s);
    let (place_m, headway_s) = (STREET_M, [2.0, 4.0]);
    cast.stream(&Stream { prefix, lane, to, place_m, speed_mps, from_s, headway_s, count: oncoming });
    for from in ["north", "south"] {
        pedestrians(cast, from, in_s);
    }
}

/// Adds pedestrians from one side, the first of whom reaches the kerb about when the ego is there.
fn pedestrians(cast: &mut Cast, from: &str, in_s: f64) {
    let draft = &mut cast.draft;
    let (mut at_s, count) = (in_s + draft.between(-4.5, -1.0), draft.count(2, 5));
    let walk_mps = draft.between(1.1, 1.5);
    for number in 0..count {
        let along_m = (PAVEMENT_M - walk_mps * at_s).min(PAVEMENT_M - 0.1);
        if along_m < 0.5 {
            return;
        }
        let style = draft.one_of(&["careful", "normal", "bold"]);
        draft.vehicle(Draftee {
            name: &format!("{from}-{number}"),
            class: "pedestrian",
            lane: &format!("{from}-pavement"),
            along_m,
            speed_mps: walk_mps,
            to: Some(&format!("{from}-opposite")),
            wanted_mps: walk_mps,
            driver: Some(format!("{{ kind = \"walker\", style = \"{style}\" }}")),
        });
        at_s += draft.between(1.0, 3.5);
    }
}
