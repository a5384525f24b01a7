//! Encounters in which the ego needs a gap of another lane.

use super::cast::{Cast, Stream};

/// The ego comes from a ramp to a motorway whose right lane is dense.
pub(super) fn merge_dense(cast: &mut Cast) {
    let draft = &mut cast.draft;
    draft.road("kind = \"on-ramp\"\nbefore_m = 320.0\nafter_m = 600.0\nacceleration_lane_m = 160.0");
    let (flow_mps, in_s) = (draft.between(16.0, 21.0), draft.between(5.0, 7.0));
    let (headway_s, count) = ([1.1, draft.between(1.4, 1.9)], draft.count(7, 10));
    let (ego_mps, ahead_s) = (draft.between(15.0, 18.0), draft.between(3.0, 5.5));
    // 60 m along the acceleration lane, which begins where the ramp of 100 m and its curve of 42 m end.
    cast.ego("ramp", "main-0", 100.0 + 42.0 + 60.0, [ego_mps, 1.1 * flow_mps], in_s + 3.5);
    let from_s = in_s + 3.5 - ahead_s;
    let (prefix, lane, place_m) = ("right", "main-0", 380.0);
    cast.stream(&Stream { prefix, lane, to: None, place_m, speed_mps: flow_mps, from_s, headway_s, count });
    let speed_mps = flow_mps + 2.0;
    let (prefix, lane, headway_s) = ("left", "main-1", [2.0, 3.5]);
    cast.stream(&Stream { prefix, lane, to: None, place_m, speed_mps, from_s, headway_s, count: 4 });
}

/// Two lanes, of which the right one ends. A vehicle on `ending-in` can change lanes from `open_m` on, where `ending` begins.
fn ending_lane(cast: &mut Cast, [open_m, end_m]: [f64; 2], limit_mps: f64) {
    let draft = &mut cast.draft;
    let limit = format!("speed_limit_mps = {limit_mps:.1}\n");
    draft.road("kind = \"network\"");
    draft.lane("ending-in", [[0.0, 0.0], [open_m, 0.0]], 3.5, &format!("{limit}successors = [\"ending\"]"));
    draft.lane("ending", [[open_m, 0.0], [end_m, 0.0]], 3.5, &format!("{limit}left = {{ lane = \"through\" }}"));
    let beside = format!("{limit}right = {{ lane = \"ending\" }}");
    draft.lane("through", [[0.0, 3.5], [end_m + 500.0, 3.5]], 3.5, &beside);
}

/// The ego's lane ends beside a dense stream.
pub(super) fn lane_end(cast: &mut Cast) {
    let draft = &mut cast.draft;
    let (limit_mps, in_s) = (draft.between(13.9, 18.0), draft.between(4.0, 6.0));
    let (flow_mps, end_m) = (draft.between(0.75, 0.9) * limit_mps, draft.between(260.0, 300.0));
    let (place_m, count) = (end_m - draft.between(50.0, 80.0), draft.count(6, 9));
    let (headway_s, ahead_s) = ([1.1, draft.between(1.4, 2.0)], draft.between(1.5, 3.5));
    ending_lane(cast, [place_m - flow_mps * in_s + 15.0, end_m], limit_mps);
    cast.ego("ending-in", "through", place_m, [flow_mps, 0.95 * limit_mps], in_s);
    let (from_s, speed_mps, prefix, lane) = (in_s - ahead_s, flow_mps, "through", "through");
    cast.stream(&Stream { prefix, lane, to: None, place_m, speed_mps, from_s, headway_s, count });
}

/// Two slow queues become one.
pub(super) fn zipper(cast: &mut Cast) {
    let draft = &mut cast.draft;
    let (flow_mps, in_s, end_m) = (draft.between(4.0, 7.0), draft.between(5.0, 7.0), draft.between(160.0, 190.0));
    let place_m = end_m - draft.between(45.0, 60.0);
    let (headway_s, count) = ([1.7, draft.between(2.0, 2.6)], draft.count(7, 10));
    let (from_s, ahead_m) = (in_s - draft.between(4.0, 7.0), draft.between(9.0, 12.0));
    let ego_m = place_m - flow_mps * in_s;
    ending_lane(cast, [ego_m + 15.0, end_m], 8.3);
    cast.ego("ending-in", "through", place_m, [flow_mps, 8.0], in_s);
    let (prefix, lane) = ("through", "through");
    cast.stream(&Stream { prefix, lane, to: None, place_m, speed_mps: flow_mps, from_s, headway_s, count });
    // A vehicle that does not react could not leave the lane that ends.
    if !cast.is_of_keepers() {
        cast.partner("ahead", "ending-in", Some("through"), ego_m + ahead_m, flow_mps);
        cast.follower("ending-in", "through", ego_m, flow_mps);
    }
}

/// The ego drives on the left lane, and its exit leaves the right one, on which a stream drives.
pub(super) fn exit_across(cast: &mut Cast) {
    let draft = &mut cast.draft;
    let (limit_mps, exit_m) = (draft.between(16.0, 22.0), draft.between(300.0, 340.0));
    let flow_mps = draft.between(0.75, 0.9) * limit_mps;
    let (in_s, place_m) = (draft.between(4.0, 6.0), exit_m - draft.between(80.0, 110.0));
    let speed_mps = flow_mps + draft.between(0.0, 2.0);
    let (ego_m, limit) = (place_m - speed_mps * in_s, format!("speed_limit_mps = {limit_mps:.1}\n"));
    let open_m = ego_m + 15.0;
    draft.road("kind = \"network\"");
    let lanes: [(&str, [f64; 2], f64, &str); 5] = [
        ("right", [0.0, exit_m], 0.0, "left = { lane = \"left\" }\nsuccessors = [\"right-on\", \"exit\"]"),
        ("left-in", [0.0, open_m], 3.5, "successors = [\"left\"]"),
        ("left", [open_m, exit_m], 3.5, "right = { lane = \"right\" }\nsuccessors = [\"left-on\"]"),
        ("right-on", [exit_m, exit_m + 500.0], 0.0, "left = { lane = \"left-on\" }"),
        ("left-on", [exit_m, exit_m + 500.0], 3.5, "right = { lane = \"right-on\" }"),
    ];
    for (name, [from_m, to_m], y_m, more) in lanes {
        draft.lane(name, [[from_m, y_m], [to_m, y_m]], 3.5, &format!("{limit}{more}"));
    }
    draft.road(&format!(
        "\n[[road.lane]]\nname = \"exit\"\nstart = {{ x_m = {exit_m:.2}, y_m = 0.0, heading_deg = 0.0 }}\n\
         pieces = [{{ turn_deg = -12.0, radius_m = 150.0 }}, {{ straight_m = 150.0 }}]\nwidth_m = 3.5\n{limit}"
    ));
    let (headway_s, count, ahead_s) = ([1.1, draft.between(1.4, 1.9)], draft.count(6, 9), draft.between(2.5, 4.5));
    cast.ego("left-in", "exit", place_m, [speed_mps, 0.95 * limit_mps], in_s);
    cast.follower("left-in", "left-on", ego_m, speed_mps);
    let (from_s, prefix, lane, to) = (in_s - ahead_s, "right", "right", Some("right-on"));
    cast.stream(&Stream { prefix, lane, to, place_m, speed_mps: flow_mps, from_s, headway_s, count });
}
