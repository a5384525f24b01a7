//! Errors of curved roads, and of vehicles that are placed on roads.

mod common;
mod spoiled;

use common::Catalogue;
use interplay_scenarios::from_text;
use spoiled::{refusal, spoiled};

/// A curve with two lanes of 0.37 m, 6.14 m long, for the cases to spoil.
const CURVE: &str = r#"kind = "curve"
pieces = [
    { straight_m = 1.5 },
    { turn_deg = 90.0, radius_m = 2.0 },
    { straight_m = 1.5 },
]
"#;

#[test]
fn wrong_curved_roads_are_refused() {
    let mut errors = Catalogue::default();
    let good = spoiled(&[("kind = \"lanes\"", CURVE)]);
    from_text("good.toml", &good, &[]).expect("nothing is wrong with it");
    let mut refuse = |name: &str, (from, to): (&str, &str), fragments: &[&str]| {
        assert!(good.contains(from), "{from} is not in the good scenario");
        errors.error(name, from_text("bad.toml", &good.replacen(from, to, 1), &[]), fragments);
    };
    refuse("zero_width", ("lane_count = 2", "lane_width_m = 0.0"), &["bad.toml:13:16", "at least 0.001"]);
    refuse("no_pieces", ("pieces = [", "pieces = []\nno = ["), &["bad.toml:7:10", "at least 1 entry"]);
    refuse("neither_key", ("{ straight_m = 1.5 }", "{ }"), &["bad.toml:8:5", "neither straight nor a turn"]);
    refuse(
        "both_keys",
        ("turn_deg = 90.0", "straight_m = 1.0, turn_deg = 90.0"),
        &["both `straight_m` and `turn_deg`"],
    );
    refuse("no_radius", (", radius_m = 2.0", ""), &["bad.toml:9:5", "`road.pieces.1.radius_m` is missing"]);
    refuse("no_angle", ("turn_deg = 90.0, ", ""), &["`road.pieces.1.turn_deg` is missing"]);
    refuse("turn_of_zero", ("turn_deg = 90.0", "turn_deg = 0.0"), &["bad.toml:9:18", "straight piece"]);
    refuse("inner_edge_crosses", ("radius_m = 2.0", "radius_m = 0.37"), &["bad.toml:9:35", "more than 0.37 m"]);
    refuse(
        "transition_too_long",
        ("pieces = [", "transition_m = 3.5\npieces = ["),
        &["bad.toml:7:16", "too long for `road.pieces.0`, which is 1.5 m long", "at most 3 m", "for this piece"],
    );
    let circle = ("{ straight_m = 1.5 },\n]", "{ straight_m = 1.5 },\n    { turn_deg = 360.0, radius_m = 2.0 },\n]");
    refuse("meets_itself", circle, &["bad.toml:7:10", "the road meets itself", "turn less"]);
    let onwards = ("turn_deg = 90.0", "turn_deg = 270.0");
    refuse("meets_its_continuation", onwards, &["bad.toml:7:10", "the road meets itself"]);
    refuse("too_long", ("straight_m = 1.5", "straight_m = 1e6"), &["1000004.642 m long", "at most 14800 m"]);
    let end = |text: &'static str| ("lane_count = 2", text);
    refuse(
        "end_beyond",
        end("lane_end = { end_m = 7.0, taper_m = 0.3 }"),
        &["bad.toml:13:22", "6.141 m long together"],
    );
    let single = end("lane_count = 1\nlane_end = { end_m = 4.0, taper_m = 0.3 }");
    refuse("single_lane_ends", single, &["no lane beside it", "at least 2"]);
    let goal = good.replacen("lane_count = 2", "lane_end = { end_m = 5.0, taper_m = 0.3 }", 1);
    let goal = goal.replacen("goal = { lane = 1 }", "goal = { lane = 0 }", 1);
    errors.error("goal_in_ending_lane", from_text("bad.toml", &goal, &[]), &["is 0, which ends", "lane 1"]);
    insta::assert_snapshot!("curves", errors.0);
}

#[test]
fn wrong_vehicles_on_curves_are_refused() {
    let mut errors = Catalogue::default();
    let good = spoiled(&[("kind = \"lanes\"", CURVE)]);
    let mut refuse = |name: &str, (from, to): (&str, &str), fragments: &[&str]| {
        assert!(good.contains(from), "{from} is not in the good scenario");
        errors.error(name, from_text("bad.toml", &good.replacen(from, to, 1), &[]), fragments);
    };
    let front = |to: &'static str| ("start = { x_m = 1.0, y_m = 0.185, speed_mps = 1.0 }", to);
    refuse("no_lateral_position", ("lane = 1 }", "y_m = 0.3 }"), &["not a lateral position on a curve", "its `lane`"]);
    refuse("cross", ("name = \"front\"", "name = \"front\"\nroad = \"cross\""), &["no crossing road"]);
    let outside = front("start = { x_m = 3.5, y_m = 0.185, speed_mps = 1.0 }");
    refuse("outside_of_the_turn", outside, &["`front` starts outside the road", "0.37 m to either side"]);
    let backwards = front("start = { x_m = 1.0, y_m = 0.185, heading_deg = 180.0, speed_mps = 1.0 }");
    refuse("against_its_direction", backwards, &["`front` is not along its road", "`heading_deg = 0`"]);
    let stiff = ("body = { width_m = 0.19 }", "limits = { steering_max_rad = 0.15 }");
    refuse("turning_circle", stiff, &["radius of 2.185 m", "needs 2.653 m", "this turn", "`steering_max_rad`"]);
    insta::assert_snapshot!("vehicles_on_curves", errors.0);
}

#[test]
fn wrong_positions_in_lanes_are_refused() {
    let mut errors = Catalogue::default();
    let front = |to: &'static str| [("start = { x_m = 1.0, y_m = 0.185, speed_mps = 1.0 }", to)];
    let mut refuse = |name: &str, to: &'static str, fragments: &[&str]| {
        refusal(&mut errors, name, &front(to), fragments);
    };
    refuse(
        "lane_and_coordinates",
        "start = { lane = 0, along_m = 1.0, x_m = 1.0, speed_mps = 1.0 }",
        &["1 error", "bad.toml:17:42", "both `lane` and `x_m`"],
    );
    refuse("nowhere", "start = { speed_mps = 1.0 }", &["bad.toml:17:9", "does not say where", "`lane` and `along_m`"]);
    refuse("only_x", "start = { x_m = 1.0, speed_mps = 1.0 }", &["`vehicle.front.start.y_m` is missing"]);
    refuse("only_lane", "start = { lane = 0, speed_mps = 1.0 }", &["`vehicle.front.start.along_m` is missing"]);
    refuse("no_lane", "start = { along_m = 1.0, speed_mps = 1.0 }", &["`vehicle.front.start.lane` is missing"]);
    refuse(
        "lane_out_of_range",
        "start = { lane = 2, along_m = 1.0, speed_mps = 1.0 }",
        &["bad.toml:17:18", "only 2 lanes", "0 to 1"],
    );
    refuse(
        "off_its_lane",
        "start = { lane = 0, along_m = 1.0, lateral_offset_m = 0.2, speed_mps = 1.0 }",
        &["bad.toml:17:55", "out of the lane", "at most 0.185 m"],
    );
    refuse(
        "over_the_edge",
        "start = { lane = 0, along_m = 1.0, lateral_offset_m = -0.1, speed_mps = 1.0 }",
        &["`front` starts outside the road"],
    );
    refuse(
        "turned_away",
        "start = { lane = 0, along_m = 1.0, heading_error_deg = 90.0, speed_mps = 1.0 }",
        &["must be at most 60"],
    );
    refuse(
        "two_angles",
        "start = { x_m = 1.0, y_m = 0.185, heading_rad = 0.0, heading_deg = 0.0, speed_mps = 1.0 }",
        &["both `heading_deg` and `heading_rad`"],
    );
    refuse(
        "against_the_lanes",
        "start = { x_m = 1.0, y_m = 0.185, heading_deg = 180.0, speed_mps = 1.0 }",
        &["`front` is not along its road"],
    );
    insta::assert_snapshot!("places_in_lanes", errors.0);
}
