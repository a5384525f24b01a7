//! Encounters at junctions.

use super::cast::{Cast, Stream};
use crate::streets::junctions::equal_roads;

/// How far lanes end before the middle of a junction, roughly \[m\].
const MIDDLE_M: f64 = 8.0;

/// The ego turns left across oncoming traffic, with a vehicle behind it that drives straight on.
pub(super) fn left_turn(cast: &mut Cast) {
    let draft = &mut cast.draft;
    let (arm_m, limit_mps) = (240.0, draft.between(10.0, 13.9));
    draft.road(&format!("kind = \"crossing\"\narm_length_m = {arm_m:.1}\nspeed_limit_mps = {limit_mps:.1}"));
    let speed_mps = draft.between(0.7, 0.9) * limit_mps;
    let (in_s, flow_mps) = (draft.between(5.0, 7.0), draft.between(0.75, 0.9) * limit_mps);
    let (headway_s, count) = ([1.8, draft.between(2.6, 4.0)], draft.count(3, 6));
    let from_s = in_s + draft.between(-1.0, 1.5);
    let place_m = arm_m - MIDDLE_M;
    cast.ego("west-in", "north-out", place_m, [speed_mps, 0.9 * limit_mps], in_s);
    cast.follower("west-in", "east-out", place_m - speed_mps * in_s, speed_mps);
    let (prefix, lane, to) = ("oncoming", "east-in", Some("west-out"));
    cast.stream(&Stream { prefix, lane, to, place_m, speed_mps: flow_mps, from_s, headway_s, count });
}

/// The ego crosses a main road with traffic in both directions.
pub(super) fn crossing_priority(cast: &mut Cast) {
    let draft = &mut cast.draft;
    let (arm_m, limit_mps, sign) = (260.0, draft.between(11.0, 13.9), draft.one_of(&["yield", "stop"]));
    draft.road(&format!(
        "kind = \"crossing\"\narm_length_m = {arm_m:.1}\nspeed_limit_mps = {limit_mps:.1}\nminor = \"{sign}\""
    ));
    main_and_minor(cast, arm_m, limit_mps, ["south-in", "north-out"], [2.0, 3.2, 5.0]);
}

/// The ego turns onto a fast road.
pub(super) fn t_fast(cast: &mut Cast) {
    let draft = &mut cast.draft;
    let (arm_m, limit_mps) = (400.0, draft.between(19.0, 25.0));
    draft.road(&format!(
        "kind = \"t-junction\"\nturning_lanes = false\nright_of_way = \"yield\"\narm_length_m = {arm_m:.1}\n\
         speed_limit_mps = {limit_mps:.1}"
    ));
    let to = draft.one_of(&["east-out", "west-out"]);
    main_and_minor(cast, arm_m, limit_mps, ["south-in", to], [2.2, 3.5, 6.0]);
}

/// Adds the ego on a minor road and a stream from each side on the main one.
fn main_and_minor(cast: &mut Cast, arm_m: f64, limit_mps: f64, ego: [&str; 2], [low, from, to]: [f64; 3]) {
    let draft = &mut cast.draft;
    let (place_m, in_s, speed_mps) = (arm_m - MIDDLE_M, draft.between(5.0, 7.0), draft.between(8.0, 10.0));
    cast.ego(ego[0], ego[1], place_m, [speed_mps, 0.9 * limit_mps], in_s);
    cast.follower(ego[0], ego[1], place_m - speed_mps * in_s, speed_mps);
    for (prefix, lane, to_lane) in [("west", "west-in", "east-out"), ("east", "east-in", "west-out")] {
        let draft = &mut cast.draft;
        let (headway_s, count) = ([low, draft.between(from, to)], draft.count(3, 5));
        let (flow_mps, from_s) = (draft.between(0.75, 0.9) * limit_mps, in_s + draft.between(-1.0, 2.0));
        let to = Some(to_lane);
        cast.stream(&Stream { prefix, lane, to, place_m, speed_mps: flow_mps, from_s, headway_s, count });
    }
}

/// Roads meet without signs: those from the right go first, and those from the left have to let the ego go.
pub(super) fn crossing_equal(cast: &mut Cast) {
    let draft = &mut cast.draft;
    let (arm_m, limit_mps) = (170.0, draft.between(8.3, 11.0));
    draft.road(&equal_roads(limit_mps, arm_m));
    let (place_m, in_s) = (arm_m - 10.0, draft.between(4.0, 6.0));
    let speed_mps = draft.between(0.7, 0.9) * limit_mps;
    cast.ego("south-in", "south-out", place_m, [speed_mps, 0.9 * limit_mps], in_s);
    for (prefix, lane, to, most) in [("right", "east-in", "east-out", 4), ("left", "west-in", "west-out", 3)] {
        let draft = &mut cast.draft;
        let (headway_s, count) = ([2.0, draft.between(2.6, 4.0)], draft.count(1, most));
        let (flow_mps, from_s) = (draft.between(0.7, 0.9) * limit_mps, in_s + draft.between(-2.0, 1.0));
        let to = Some(to);
        cast.stream(&Stream { prefix, lane, to, place_m, speed_mps: flow_mps, from_s, headway_s, count });
    }
}

/// The ego enters a roundabout on which vehicles pass its entry.
pub(super) fn roundabout(cast: &mut Cast) {
    let draft = &mut cast.draft;
    let (arm_m, radius_m) = (160.0, draft.between(15.0, 22.0));
    draft.road(&format!("kind = \"roundabout\"\nlane_count = 1\nradius_m = {radius_m:.1}\narm_length_m = {arm_m:.1}"));
    let (place_m, in_s) = (arm_m - radius_m - 5.0, draft.between(6.0, 8.0));
    let speed_mps = draft.between(8.0, 10.0);
    cast.ego("south-in", "north-out", place_m, [speed_mps, 11.0], in_s);
    cast.follower("south-in", "east-out", place_m - speed_mps * in_s, speed_mps);
    // A quarter of the ring takes this long at the speed that its curve permits.
    let quarter_s = 1.57 * radius_m / (2.0 * radius_m).sqrt();
    for (prefix, lane, to, quarters) in [("west", "west-in", "east-out", 1.0), ("north", "north-in", "east-out", 2.0)] {
        let draft = &mut cast.draft;
        let (headway_s, count) = ([2.0, draft.between(2.5, 3.5)], draft.count(3, 5));
        // Before the ring they lose about 1.5 s by slowing down.
        let from_s = (in_s - quarters * quarter_s - 1.5 + draft.between(-1.5, 0.5)).max(0.5);
        let to = Some(to);
        // They slow down from this speed before the ring, unless they do not react at all.
        let speed_mps = if cast.is_of_keepers() { 0.95 * (2.0 * radius_m).sqrt() } else { 8.5 };
        cast.stream(&Stream { prefix, lane, to, place_m, speed_mps, from_s, headway_s, count });
    }
}
