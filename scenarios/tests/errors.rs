//! Every error as rendered for users: each case is compared with a snapshot, and must name the cause and the remedy.

mod common;
mod spoiled;

use std::fmt::Write as _;
use std::fs;

use common::{Catalogue, rendered};
use interplay_scenarios::{Override, from_text};
use spoiled::{GOOD, refusal, spoiled};

#[test]
fn the_valid_reference_scenario_loads() {
    from_text("good.toml", GOOD, &[]).expect("nothing is wrong with it");
}

#[test]
fn syntax_errors_are_located_with_help() {
    let mut errors = Catalogue::default();
    refusal(&mut errors, "syntax", &[("lane_count = 2", "lane_count = = 2")], &["bad.toml:7:", "not valid TOML"]);
    refusal(
        &mut errors,
        "twice_the_same_key",
        &[("duration_s = 5.0", "title = \"Again\"")],
        &["bad.toml:3:1", "duplicate key"],
    );
    errors.error("control_characters", from_text("bad.toml", "title = \u{1b}[31m", &[]), &["not valid TOML"]);
    errors.error(
        "a_decimal_comma",
        from_text("bad.toml", "duration_s = 20,5\n", &[]),
        &["bad.toml:1:16", "decimal point: `20.5`"],
    );
    insta::assert_snapshot!("syntax", errors.0);
}

#[test]
fn wrong_keys_are_located_with_help() {
    let mut errors = Catalogue::default();
    refusal(&mut errors, "unknown_key", &[("speed_mps", "sped_mps")], &["bad.toml:11:", "`speed_mps`?"]);
    refusal(
        &mut errors,
        "unknown_key_far_from_all",
        &[("lane_count", "elephants")],
        &["bad.toml:7:1", "`lane_width_m`"],
    );
    refusal(&mut errors, "missing_title", &[("title = \"Two cars\"", "")], &["`title` is missing", "in a few words"]);
    refusal(
        &mut errors,
        "missing_start",
        &[("start = { x_m = 1.0, y_m = 0.185, speed_mps = 1.0 }\n", "")],
        &["bad.toml:15:1", "`vehicle.front.start` is missing"],
    );
    refusal(
        &mut errors,
        "missing_kind",
        &[("kind = \"human\", ", "")],
        &["`vehicle.front.driver.kind`", "`conservative`"],
    );
    errors.error(
        "a_plan",
        from_text("bad.toml", "title = 'a'\nscenario = ['lane-change']\nplanner = ['idm']\n", &[]),
        &["bad.toml:2:1", "plan of many runs", "interplay sweep"],
    );
    errors.error(
        "a_table_in_place_of_a_list",
        from_text("bad.toml", "extends = 'intersection/nice'\nvehicle.ego.start.speed_mps = 2.0\n", &[]),
        &["bad.toml:2:1", "`[[vehicle]]`"],
    );
    errors.error(
        "no_vehicle",
        from_text("bad.toml", "title = 'a'\nshows = 'b'\nvehicle = []", &[]),
        &["nothing to simulate"],
    );
    insta::assert_snapshot!("keys", errors.0);
}

#[test]
fn wrong_types_and_words_are_located_with_help() {
    let mut errors = Catalogue::default();
    refusal(&mut errors, "not_a_number", &[("5.0", "\"long\"")], &["bad.toml:3:14", "must be a number", "`long`"]);
    refusal(&mut errors, "not_a_whole_number", &[("lane_count = 2", "lane_count = 2.5")], &["whole number", "2.5"]);
    refusal(&mut errors, "not_a_table", &[("{ lane = 1 }", "1")], &["`vehicle.ego.goal` must be a table"]);
    refusal(&mut errors, "not_a_list", &[("[\"front\", \"ego\"]", "\"front\"")], &["`expect.order` must be a list"]);
    refusal(
        &mut errors,
        "not_true_or_false",
        &[("true", "1979-05-27")],
        &["`expect.no_collision` must be true or false"],
    );
    refusal(&mut errors, "unknown_word", &[("\"nice\"", "\"nise\"")], &["`nise`", "did you mean `nice`?"]);
    refusal(&mut errors, "unknown_kind", &[("\"lanes\"", "\"motorway\"")], &["`road.kind`", "`motorway`", "`lanes`"]);
    refusal(&mut errors, "not_a_name", &[("\"front\"\nstart", "\"The front\"\nstart")], &["`The front` is not a name"]);
    refusal(&mut errors, "empty_text", &[("\"Two cars\"", "\" \"")], &["`title` must not be empty"]);
    insta::assert_snapshot!("types_and_words", errors.0);
}

#[test]
fn wrong_numbers_are_located_with_help() {
    let mut errors = Catalogue::default();
    refusal(&mut errors, "not_finite", &[("x_m = 1.0", "x_m = nan")], &["`vehicle.front.start.x_m`", "finite"]);
    refusal(&mut errors, "infinite", &[("5.0", "inf")], &["`duration_s`", "finite"]);
    refusal(
        &mut errors,
        "too_large_to_compute",
        &[("x_m = 1.0", "x_m = 1e300")],
        &["must be at most 100000000, not 1e300"],
    );
    refusal(
        &mut errors,
        "negative_width",
        &[("width_m = 0.19", "width_m = -0.19")],
        &["`vehicle.front.body.width_m`", "-0.19"],
    );
    refusal(&mut errors, "negative_duration", &[("5.0", "-5.0")], &["`duration_s` must be at least 0.001"]);
    refusal(
        &mut errors,
        "beta_not_below_one",
        &[("beta = 0.8", "beta = 1")],
        &["`vehicle.ego.driver.beta` must be below 1"],
    );
    refusal(&mut errors, "horizon_too_long", &[("[road]", "horizon_steps = 201\n[road]")], &["at most 200"]);
    let horizon = [("[road]", "horizon_steps = 999999999999\n[road]")];
    refusal(&mut errors, "horizon_beyond_every_limit", &horizon, &["at most 200, not 999999999999"]);
    let seed = [("[road]", "seed = 99999999999999999999999999999999999999999999\n[road]")];
    refusal(&mut errors, "seed_too_large", &seed, &["`seed` must be at most 18446744073709551615"]);
    insta::assert_snapshot!("numbers", errors.0);
}

#[test]
fn wrong_positions_are_located_with_help() {
    let mut errors = Catalogue::default();
    refusal(
        &mut errors,
        "start_outside_the_road",
        &[("y_m = 0.185", "y_m = 0.05")],
        &["bad.toml:11:9", "`ego` starts outside"],
    );
    refusal(
        &mut errors,
        "overlapping_cars",
        &[("x_m = 1.0", "x_m = 0.39")],
        &["`ego` and `front` overlap", "with this one"],
    );
    refusal(
        &mut errors,
        "lane_out_of_range",
        &[("lane = 1", "lane = 2")],
        &["bad.toml:12:17", "only 2 lanes", "0 to 1"],
    );
    refusal(&mut errors, "goal_beside_the_road", &[("lane = 1", "y_m = 1.0")], &["beside the road", "0.74"]);
    refusal(&mut errors, "lane_and_position", &[("lane = 1", "lane = 1, y_m = 0.5")], &["both `lane` and `y_m`"]);
    refusal(&mut errors, "weight_on_x", &[("goal = { lane = 1 }", "weights = { x = 1 }")], &["weights.x"]);
    insta::assert_snapshot!("places", errors.0);
}

#[test]
fn wrong_roads_are_located_with_help() {
    let mut errors = Catalogue::default();
    let ramp = ("kind = \"lanes\"", "kind = \"ramp-merge\"\nramp_end_m = 3.0");
    let crossing = ("kind = \"lanes\"", "kind = \"intersection\"");
    let cross = ("name = \"front\"", "name = \"front\"\nroad = \"cross\"");
    refusal(
        &mut errors,
        "no_crossing_road",
        &[cross],
        &["bad.toml:17:8", "no crossing road", "kind = \"intersection\""],
    );
    refusal(
        &mut errors,
        "start_past_the_ramp",
        &[ramp, ("x_m = 1.0", "x_m = 3.0")],
        &["`front` starts outside", "x = 3"],
    );
    refusal(&mut errors, "goal_on_the_ramp", &[ramp, ("lane = 1", "lane = 0")], &["the ramp, which ends", "lane 1"]);
    refusal(
        &mut errors,
        "a_ramp_needs_a_lane_beside_it",
        &[ramp, ("lane_count = 2", "lane_count = 1")],
        &["at least 2"],
    );
    refusal(
        &mut errors,
        "heads_elsewhere",
        &[crossing, cross],
        &["not along the vehicle's road", "heading_rad = 1.57"],
    );
    let north = ("x_m = 1.0, y_m = 0.185", "x_m = 1.0, y_m = -1.0, heading_rad = 1.5708");
    refusal(&mut errors, "beside_the_crossing_road", &[crossing, cross, north], &["reaches 0.37 to either side"]);
    let y_m = ("body = { width_m = 0.19 }", "goal = { y_m = 0.3 }");
    let there = ("x_m = 1.0, y_m = 0.185", "x_m = 0.2, y_m = -1.0, heading_rad = 1.5708");
    refusal(
        &mut errors,
        "no_lateral_position",
        &[crossing, cross, there, y_m],
        &["not a lateral position", "its `lane`"],
    );
    let slanted = ("kind = \"lanes\"", "kind = \"intersection\"\nangle_deg = 10");
    refusal(&mut errors, "hardly_crossing", &[slanted], &["hardly cross", "from 20 to 160"]);
    insta::assert_snapshot!("roads", errors.0);
}

#[test]
fn wrong_names_and_times_are_located_with_help() {
    let mut errors = Catalogue::default();
    refusal(
        &mut errors,
        "same_name_twice",
        &[("name = \"front\"", "name = \"ego\"")],
        &["called `ego`", "the first", "the second"],
    );
    refusal(
        &mut errors,
        "unknown_vehicle_in_order",
        &[("[\"front\"", "[\"fornt\"")],
        &["`fornt`", "did you mean `front`?"],
    );
    refusal(&mut errors, "named_twice_in_order", &[("[\"front\"", "[\"ego\"")], &["names `ego` twice"]);
    refusal(
        &mut errors,
        "unknown_vehicle_in_completes",
        &[("vehicle = \"ego\"", "vehicle = \"truck\"")],
        &["`truck`", "`front`"],
    );
    refusal(
        &mut errors,
        "empty_window",
        &[("before_s = 4.0", "before_s = 4.0\nafter_s = 4.5")],
        &["after 4.5 s and before 4 s"],
    );
    refusal(
        &mut errors,
        "window_after_the_end",
        &[("before_s = 4.0", "after_s = 5.0")],
        &["the end of the run at 5 s"],
    );
    refusal(
        &mut errors,
        "expects_nothing",
        &[("[[expect.completes]]", "[[expect.speed]]"), ("before_s = 4.0\n", "")],
        &["nothing"],
    );
    refusal(&mut errors, "too_many_ticks", &[("5.0", "1e6")], &["more than 100000 ticks"]);
    refusal(&mut errors, "shorter_than_a_step", &[("5.0", "0.05")], &["shorter than one step"]);
    insta::assert_snapshot!("names_and_times", errors.0);
}

#[test]
fn wrong_drivers_and_limits_are_located_with_help() {
    let mut errors = Catalogue::default();
    let limits = |text: &'static str| [("goal = { lane = 1 }", text)];
    refusal(&mut errors, "limits_inverted", &limits("limits = { speed_min_mps = 2.0 }"), &["not below the largest"]);
    refusal(
        &mut errors,
        "start_outside_limits",
        &limits("limits = { speed_max_mps = 0.9 }"),
        &["start.speed_mps", "0.9"],
    );
    refusal(&mut errors, "goal_outside_limits", &limits("goal = { speed_mps = 1.6 }"), &["goal.speed_mps", "1.5"]);
    refusal(
        &mut errors,
        "style_and_weight",
        &[("style = \"nice\"", "style = \"nice\", safety_weight = 8")],
        &["both `style`"],
    );
    refusal(&mut errors, "settled_too_long", &[("beta = 0.8", "settled_steps = 30")], &["settled_steps", "(30)"]);
    refusal(
        &mut errors,
        "weights_inverted",
        &[("kind = \"negotiation\", beta = 0.8", "kind = \"bayesian\", w_1_min = 90.0")],
        &["`w_1_max` (20)"],
    );
    insta::assert_snapshot!("drivers_and_limits", errors.0);
}

#[test]
fn wrong_plants_and_crash_expectations_are_located_with_help() {
    let mut errors = Catalogue::default();
    let plant = |plant: &'static str| [("duration_s = 5.0", plant)];
    refusal(
        &mut errors,
        "a_word_for_a_plant",
        &plant("plant = \"dynamic\""),
        &["bad.toml:3:9", "{ kind = \"dynamic\" }"],
    );
    let ice = plant("plant = { kind = \"dynamic\", friction = 0 }");
    refusal(&mut errors, "no_friction", &ice, &["bad.toml:3:40", "`plant.friction` must be above 0"]);
    let kinematic = plant("plant = { kind = \"kinematic\", friction = 0.5 }");
    refusal(&mut errors, "friction_without_tyres", &kinematic, &["unknown key `friction`"]);
    let crash = |pair: &'static str| [("no_collision = true", pair)];
    refusal(
        &mut errors,
        "crash_with_an_unknown_vehicle",
        &crash("collisions = [[\"ego\", \"frnt\"]]"),
        &["no vehicle `frnt`", "`front`?"],
    );
    refusal(&mut errors, "crash_with_itself", &crash("collisions = [[\"ego\", \"ego\"]]"), &["named twice"]);
    refusal(&mut errors, "crash_of_three", &crash("collisions = [[\"ego\", \"front\", \"ego\"]]"), &["at most 2"]);
    let both = crash("no_collision = false\ncollisions = [[\"ego\", \"front\"]]");
    refusal(&mut errors, "said_twice", &both, &["both `collisions` and `no_collision`"]);
    insta::assert_snapshot!("plants_and_crashes", errors.0);
}

#[test]
fn all_independent_errors_are_reported_together() {
    let mut errors = Catalogue::default();
    let changes =
        [("5.0", "-1"), ("lane_count", "lanes"), ("\"nice\"", "3"), ("no_collision = true", "no_collision = 0")];
    refusal(
        &mut errors,
        "several",
        &changes,
        &["4 errors", "bad.toml:3:", "bad.toml:7:", "bad.toml:19:", "bad.toml:22:"],
    );
    let mut many = GOOD.to_owned();
    for index in 0..30 {
        writeln!(many, "unknown_{index:02} = 1").expect("writing to a string cannot fail");
    }
    let error = from_text("bad.toml", &many, &[]).expect_err("unknown keys");
    assert_eq!(error.faults().len(), 20);
    assert!(rendered(&error, 100).contains("10 more are not shown"));
    insta::assert_snapshot!("all_independent_errors_at_once", errors.0);
}

#[test]
fn long_lines_are_shortened_around_the_error() {
    let long = format!("# {}\nshows = [{}nan]", "a".repeat(5000), "0.5, ".repeat(2000));
    let error = from_text("bad.toml", &long, &[]).expect_err("not a text");
    let text = rendered(&error, 100);
    assert!(text.chars().count() < 6000, "{} characters", text.chars().count());
    assert!(error.faults().iter().any(|fault| fault.line_and_column() == Some((2, 9))), "{text}");
}

#[test]
fn errors_in_overrides_are_located_with_help() {
    let mut errors = Catalogue::default();
    let set = |text: &str| from_text("good.toml", GOOD, &[Override::Set(text.to_owned())]);
    errors.error("set_unknown_vehicle", set("vehicle.eggo.goal.lane=1"), &["--set:1:9", "`eggo`", "`ego`?"]);
    errors.error("set_unknown_key", set("vehicle.ego.goal.sped=1"), &["--set:1:18", "unknown key `sped`"]);
    errors.error("set_wrong_type", set("duration_s=long"), &["--set:1:12", "must be a number"]);
    errors.error("set_without_value", set("duration_s"), &["PATH=VALUE", "for example"]);
    errors.error("set_without_key", set("vehicle..goal=1"), &["--set:1:9", "a key is missing here"]);
    errors.error("set_below_a_number", set("duration_s.x=1"), &["--set:1:1", "not a table"]);
    errors.error("set_outside_the_road", set("vehicle.ego.start.y_m=0.05"), &["--set:1:19", "outside the road"]);
    errors.error("set_too_deep", set(&format!("{}=1", "a.".repeat(100_000))), &["no key of a scenario"]);
    let planner = from_text("good.toml", GOOD, &[Override::Planner("negotiate".to_owned())]);
    errors.error("unknown_planner", planner, &["--planner:1:1", "`negotiation`?"]);
    errors.error("set_entry_to_a_number", set("vehicle.ego=5"), &["--set:1:13", "`vehicle.ego` must be a table"]);
    insta::assert_snapshot!("overrides", errors.0);
}

#[test]
fn errors_in_chains_of_extended_files_are_located() {
    let mut errors = Catalogue::default();
    let folder = tempfile::tempdir().expect("a temporary folder");
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("a writable folder");
    write("a.toml", "extends = 'b.toml'\ntitle = 'a'\n");
    write("b.toml", "title = 'b'\nextends = 'a.toml'\n");
    write("itself.toml", "extends = 'itself.toml'\n");
    write("orphan.toml", "title = 'a'\nextends = 'front-nise.toml'\n");
    write("list.toml", "extends = ['a.toml']\n");
    write("parent.toml", &spoiled(&[("width_m = 0.19", "widht_m = 0.19")]));
    write("child.toml", "extends = 'parent.toml'\ntitle = 'The error is my parent’s'\n");
    errors.file(folder.path(), "a.toml", &["b.toml:2:11", "extends itself"]);
    errors.file(folder.path(), "itself.toml", &["itself.toml:1:11", "extends itself"]);
    errors.file(folder.path(), "orphan.toml", &["orphan.toml:2:11", "lane-change/front-nice"]);
    errors.file(folder.path(), "list.toml", &["list.toml:1:11", "`extends`"]);
    errors.file(folder.path(), "child.toml", &["parent.toml:18:10", "`width_m`?"]);
    insta::assert_snapshot!("chains_of_files", errors.0);
}
