//! Wrong buildings and wrong units, and what is said of them; as `errors.rs`.

mod common;

use common::Catalogue;
use interplay_scenarios::{Override, from_text};

/// A building without fault, for the cases to spoil.
const GOOD: &str = r#"title = "An office and a store"
shows = "Two rooms"
iterations = 2

[building]
step_s = 900.0

[[building.zone]]
name = "office"
limit_kw = 3.0

[[building.zone]]
name = "store"

[[building.wall]]
between = ["office", "store"]
resistance_k_per_kw = 62.5

[[building.wall]]
between = ["office", "ambient"]
resistance_k_per_kw = 31.25

[setpoints]
occupied_c = [24.0, 26.0]

[controller]
kind = "pid"
"#;

fn refusal(errors: &mut Catalogue, name: &str, (from, to): (&str, &str), fragments: &[&str]) {
    assert!(GOOD.contains(from), "{from} is not in the good building");
    errors.error(name, from_text("bad.toml", &GOOD.replacen(from, to, 1), &[]), fragments);
}

#[test]
fn the_good_building_is_good() {
    from_text("good.toml", GOOD, &[]).expect("nothing is wrong with it");
}

#[test]
fn wrong_units() {
    let mut errors = Catalogue::default();
    let all = &mut errors;
    let resistance = "resistance_k_per_kw = 62.5";
    refusal(
        all,
        "another_unit",
        (resistance, "resistance_k_per_w = 0.0625"),
        &["bad.toml:17:1", "`resistance_k_per_kw`", "[K/kW]"],
    );
    refusal(all, "no_unit", ("limit_kw = 3.0", "limit = 3.0"), &["bad.toml:10:1", "`limit_kw`", "[kW]"]);
    refusal(all, "minutes", ("step_s = 900.0", "step_min = 15"), &["`step_s`", "[s]"]);
    refusal(all, "minutes_as_seconds", ("step_s = 900.0", "step_s = 15"), &["at least 60", "[s]"]);
    refusal(
        all,
        "kelvin_as_celsius",
        ("[24.0, 26.0]", "[297.0, 299.0]"),
        &["bad.toml:24:15", "`setpoints.occupied_c.0` must be at most 100", "[°C]"],
    );
    refusal(all, "a_text_with_its_unit", ("limit_kw = 3.0", "limit_kw = \"3 kW\""), &["a number", "`3 kW`", "[kW]"]);
    let car = "title = 'a'\nshows = 'b'\nvehicle = [{ name = 'ego', start = { x_m = 0, y_m = 0.2, speed_kmh = 90 } }]";
    errors.error("km_per_hour", from_text("bad.toml", car, &[]), &["`speed_mps`", "[m/s]", "is missing"]);
    insta::assert_snapshot!("units", errors.0);
}

#[test]
fn zones_and_walls() {
    let mut errors = Catalogue::default();
    let all = &mut errors;
    refusal(all, "same_zone_twice", ("name = \"store\"", "name = \"office\""), &["bad.toml:13:8", "`office`"]);
    refusal(
        all,
        "unknown_zone",
        ("[\"office\", \"store\"]", "[\"ofice\", \"store\"]"),
        &["bad.toml:16:11", "`ofice`", "office"],
    );
    refusal(all, "wall_to_itself", ("[\"office\", \"store\"]", "[\"store\", \"store\"]"), &["bad.toml:16:11", "store"]);
    refusal(all, "three_sides", ("[\"office\", \"store\"]", "[\"office\", \"store\", \"ambient\"]"), &["at most 2"]);
    refusal(all, "negative_resistance", ("31.25", "-31.25"), &["bad.toml:21:23", "at least 0.000001"]);
    refusal(
        all,
        "preset_and_zones",
        ("step_s = 900.0", "preset = \"testbed\""),
        &["bad.toml:8:1", "both `preset` and `zone`", "beside `preset`"],
    );
    insta::assert_snapshot!("zones_and_walls", errors.0);
}

#[test]
fn days_and_controllers() {
    let mut errors = Catalogue::default();
    let all = &mut errors;
    refusal(all, "step_divides_no_day", ("900.0", "1000.0"), &["bad.toml:6:10", "does not divide a day", "1800"]);
    refusal(
        all,
        "too_few_temperatures",
        ("[24.0, 26.0]", "[24.0, 25.0, 26.0]"),
        &["3 temperatures for 2 zones", "one for all"],
    );
    refusal(all, "unknown_controller", ("\"pid\"", "\"pdi\""), &["`pdi`", "did you mean `pid`?"]);
    refusal(all, "no_days", ("iterations = 2", "iterations = 0"), &["at least 1"]);
    let weather = |file: &str| format!("[weather]\nkind = \"epw\"\nfile = \"{file}\"\n\n[setpoints]");
    refusal(
        all,
        "missing_weather",
        ("[setpoints]", &weather("tropical-juli.epw")),
        &["tropical-juli.epw", "tropical-july.epw"],
    );
    refusal(
        all,
        "only_for_vehicles",
        ("[controller]", "[expect]\nno_collision = true\n\n[controller]"),
        &["no vehicles"],
    );
    let none = "extends = 'lane-change/front-nice'\ntitle = 'a'\niterations = 3";
    errors.error("only_for_buildings", from_text("bad.toml", none, &[]), &["there is no building", "`[building]`"]);
    insta::assert_snapshot!("days_and_controllers", errors.0);
}

/// A flag that is about vehicles says that there are none.
#[test]
fn flags_for_vehicles() {
    let mut errors = Catalogue::default();
    let with = |text: &str, change: Override| from_text("good.toml", text, &[change]);
    let planner = || Override::Planner("idm".to_owned());
    let none = "the scenario has no vehicles, so `--planner` has nothing to change";
    errors.error("planner", with(GOOD, planner()), &["--planner:1:1", none, "`--set controller.kind=KIND`"]);
    let empty = format!("vehicle = []\n{GOOD}");
    errors.error("planner_of_an_empty_list", with(&empty, planner()), &["--planner:1:1", none]);
    let nothing = with("title = 'a'\nshows = 'b'", planner());
    errors.error("planner_of_nothing", nothing, &["--planner:1:1", none, "`[[vehicle]]`"]);
    let set = with(GOOD, Override::Set("vehicle.ego.goal.lane=1".to_owned()));
    errors.error("set", set, &["--set:1:9", "there is no `ego` in `vehicle`", "no entries"]);
    with(GOOD, Override::Set("controller.kind=iterative-learning".to_owned())).expect("what the help says works");
    insta::assert_snapshot!("flags_for_vehicles", errors.0);
}

/// Each error points at the key that it is about, also where only the building crate can find it.
#[test]
fn keys_of_controllers_and_setpoints() {
    let mut errors = Catalogue::default();
    let all = &mut errors;
    let controller = |settings: &str| format!("kind = {settings}");
    let learning = "\"iterative-learning\"\nproportional_kw_per_k = 0.1\nfeedback = { proportional_kw_per_k = -0.1 }";
    refusal(
        all,
        "negative_gain_of_the_feedback",
        ("kind = \"pid\"", &controller(learning)),
        &["bad.toml:29:38", "`controller.feedback.proportional_kw_per_k` must be at least 0"],
    );
    refusal(
        all,
        "silent_zone_beyond_the_last",
        ("kind = \"pid\"", &controller("\"distributed\"\nsilent_zone = 2")),
        &["bad.toml:28:15", "`silent_zone` is 2; it must be at most 1"],
    );
    refusal(
        all,
        "end_before_the_start",
        ("[setpoints]", "[setpoints]\nfrom_h = 9.0\nto_h = 8.5"),
        &["bad.toml:25:8", "`to_h` is 8.5; it must be at least 9"],
    );
    let heavy = "resistance_k_per_kw = 31.25\ncapacity_kj_per_k = 5000.0";
    let spoilt = GOOD.replacen("resistance_k_per_kw = 31.25", heavy, 1);
    let spoilt = spoilt.replacen("kind = \"pid\"", &controller("\"iterative\"\ndecay = 0.7"), 1);
    let slow = &["bad.toml:29:9", "`decay` is 0.7", "walls settle by a factor of 0.9775", "leave it out for 0.982"];
    errors.error("decay_beyond_the_walls", from_text("bad.toml", &spoilt, &[]), slow);
    let grid = |rooms: usize, kind: &str| {
        let building = format!("grid = {{ rows = 1, columns = {rooms} }}");
        let head = "title = 'a'\nshows = 'b'\niterations = 2\n[setpoints]\noccupied_c = [24.0]\n";
        format!("{head}[building]\n{building}\n[controller]\nkind = \"{kind}\"\n")
    };
    let large: &[(&str, usize, &[&str])] = &[
        ("iterative", 26, &["bad.toml:9:8", "1248 unknowns", "at most 1200", "distributed"]),
        ("concurrent", 17, &["bad.toml:9:8", "1156 unknowns", "at most 1024", "distributed"]),
    ];
    for &(kind, rooms, fragments) in large {
        let text = grid(rooms, kind);
        errors.error(&format!("too_many_rooms_for_{kind}"), from_text("bad.toml", &text, &[]), fragments);
    }
    let regret = format!("{}[expect.building]\nregret_at_most = 3.0\n", grid(11, "pid"));
    let refused = &["bad.toml:11:18", "at most 500 inputs", "has 528", "clairvoyant"];
    errors.error("regret_of_many_rooms", from_text("bad.toml", &regret, &[]), refused);
    let all = &mut errors;
    refusal(all, "zone_called_ambient", ("\"store\"", "\"ambient\""), &["bad.toml:13:8", "zone 2", "`ambient`"]);
    insta::assert_snapshot!("keys_of_controllers_and_setpoints", errors.0);
}
