//! Errors of wrong buildings and wrong units; as `errors.rs`.

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

fn refusal(errors: &mut Catalogue, name: &str, from: &str, to: &str, fragments: &[&str]) {
    assert!(GOOD.contains(from), "{from} is not in the good building");
    errors.error(name, from_text("bad.toml", &GOOD.replacen(from, to, 1), &[]), fragments);
}

#[test]
fn the_valid_reference_building_loads() {
    from_text("good.toml", GOOD, &[]).expect("nothing is wrong with it");
}

#[test]
fn keys_with_a_wrong_unit_are_refused() {
    let mut errors = Catalogue::default();
    let all = &mut errors;
    let resistance = "resistance_k_per_kw = 62.5";
    refusal(
        all,
        "another_unit",
        resistance,
        "resistance_k_per_w = 0.0625",
        &["bad.toml:17:1", "`resistance_k_per_kw`", "[K/kW]"],
    );
    refusal(all, "no_unit", "limit_kw = 3.0", "limit = 3.0", &["bad.toml:10:1", "`limit_kw`", "[kW]"]);
    refusal(all, "minutes", "step_s = 900.0", "step_min = 15", &["`step_s`", "[s]"]);
    refusal(all, "minutes_as_seconds", "step_s = 900.0", "step_s = 15", &["at least 60", "[s]"]);
    refusal(
        all,
        "kelvin_as_celsius",
        "[24.0, 26.0]",
        "[297.0, 299.0]",
        &["bad.toml:24:15", "`setpoints.occupied_c.0` must be at most 100", "[°C]"],
    );
    refusal(all, "a_text_with_its_unit", "limit_kw = 3.0", "limit_kw = \"3 kW\"", &["a number", "`3 kW`", "[kW]"]);
    let car = "title = 'a'\nshows = 'b'\nvehicle = [{ name = 'ego', start = { x_m = 0, y_m = 0.2, speed_kmh = 90 } }]";
    errors.error("km_per_hour", from_text("bad.toml", car, &[]), &["`speed_mps`", "[m/s]", "divide km/h by 3.6"]);
    insta::assert_snapshot!("units", errors.0);
}

#[test]
fn wrong_zones_and_walls_are_refused() {
    let mut errors = Catalogue::default();
    let all = &mut errors;
    refusal(all, "same_zone_twice", "name = \"store\"", "name = \"office\"", &["bad.toml:13:8", "`office`"]);
    refusal(
        all,
        "unknown_zone",
        "[\"office\", \"store\"]",
        "[\"ofice\", \"store\"]",
        &["bad.toml:16:11", "`ofice`", "office"],
    );
    refusal(all, "wall_to_itself", "[\"office\", \"store\"]", "[\"store\", \"store\"]", &["bad.toml:16:11", "store"]);
    refusal(all, "three_sides", "[\"office\", \"store\"]", "[\"office\", \"store\", \"ambient\"]", &["at most 2"]);
    refusal(all, "negative_resistance", "31.25", "-31.25", &["bad.toml:21:23", "at least 0.000001"]);
    refusal(
        all,
        "preset_and_zones",
        "step_s = 900.0",
        "preset = \"testbed\"",
        &["bad.toml:8:1", "both `preset` and `zone`", "beside `preset`"],
    );
    insta::assert_snapshot!("zones_and_walls", errors.0);
}

#[test]
fn wrong_days_and_controllers_are_refused() {
    let mut errors = Catalogue::default();
    let all = &mut errors;
    refusal(all, "step_divides_no_day", "900.0", "1000.0", &["bad.toml:6:10", "does not divide a day", "1800"]);
    refusal(
        all,
        "too_few_temperatures",
        "[24.0, 26.0]",
        "[24.0, 25.0, 26.0]",
        &["3 temperatures for 2 zones", "one for all"],
    );
    refusal(all, "unknown_controller", "\"pid\"", "\"pdi\"", &["`pdi`", "did you mean `pid`?"]);
    refusal(all, "no_days", "iterations = 2", "iterations = 0", &["at least 1"]);
    let weather = |file: &str| format!("[weather]\nkind = \"epw\"\nfile = \"{file}\"\n\n[setpoints]");
    refusal(
        all,
        "missing_weather",
        "[setpoints]",
        &weather("tropical-juli.epw"),
        &["tropical-juli.epw", "tropical-july.epw"],
    );
    refusal(
        all,
        "only_for_vehicles",
        "[controller]",
        "[expect]\nno_collision = true\n\n[controller]",
        &["no vehicles"],
    );
    let none = "extends = 'lane-change/front-nice'\ntitle = 'a'\niterations = 3";
    errors.error("only_for_buildings", from_text("bad.toml", none, &[]), &["there is no building", "`[building]`"]);
    insta::assert_snapshot!("days_and_controllers", errors.0);
}

/// A flag about vehicles is refused without any.
#[test]
fn flags_about_vehicles_are_refused_for_a_building() {
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

/// Each error points at its key, even if only the building crate can find it.
#[test]
fn wrong_keys_of_controllers_and_setpoints_are_refused() {
    let mut errors = Catalogue::default();
    let all = &mut errors;
    let controller = |settings: &str| format!("kind = {settings}");
    let learning = "\"iterative-learning\"\nproportional_kw_per_k = 0.1\nfeedback = { proportional_kw_per_k = -0.1 }";
    refusal(
        all,
        "negative_gain_of_the_feedback",
        "kind = \"pid\"",
        &controller(learning),
        &["bad.toml:29:38", "`controller.feedback.proportional_kw_per_k` must be at least 0"],
    );
    refusal(
        all,
        "silent_zone_beyond_the_last",
        "kind = \"pid\"",
        &controller("\"distributed\"\nsilent_zone = 2"),
        &["bad.toml:28:15", "`silent_zone` is 2; it must be at most 1"],
    );
    refusal(
        all,
        "end_before_the_start",
        "[setpoints]",
        "[setpoints]\nfrom_h = 9.0\nto_h = 8.5",
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
    refusal(all, "zone_called_ambient", "\"store\"", "\"ambient\"", &["bad.toml:13:8", "zone 2", "`ambient`"]);
    insta::assert_snapshot!("keys_of_controllers_and_setpoints", errors.0);
}

/// Errors of schedules, prices and zones.
#[test]
fn wrong_schedules_and_prices_are_refused() {
    let mut errors = Catalogue::default();
    let mut refused = |name: &str, more: &str, fragments: &[&str]| {
        errors.error(name, from_text("bad.toml", &format!("{GOOD}{more}"), &[]), fragments);
    };
    let office = "\n[[schedule]]\nzones = [\"office\"]\n";
    let period = "\n[[schedule.period]]\nfrom_h = 8.0\nto_h = 18.0\nwanted_c = 21.0\n";
    refused(
        "schedule_of_an_unknown_zone",
        &office.replace("office", "ofice"),
        &["bad.toml:30:10", "did you mean `office`?"],
    );
    let night = period.replace("8.0\nto_h = 18.0", "22.0\nto_h = 6.0");
    refused("a_night_in_one_period", &format!("{office}{night}"), &["bad.toml:34:8", "from 22 to 24 and from 0 to 6"]);
    refused("periods_that_overlap", &format!("{office}{period}{period}"), &["bad.toml:38:10", "overlaps"]);
    let twice = format!("{office}days = [\"workday\"]\n{office}days = [\"monday\"]\n");
    refused("two_schedules_for_mondays", &twice, &["bad.toml:34:10", "two schedules for Mondays"]);
    let learning = format!("{office}days = [\"workday\"]\n{period}");
    let learned = GOOD.replace("\"pid\"", "\"iterative-learning\"");
    let said = &["bad.toml:27:8", "repeats the inputs of the day before", "another controller"];
    let mut refused_beside = |name: &str, good: &str, more: &str, fragments: &[&str]| {
        errors.error(name, from_text("bad.toml", &format!("{good}{more}"), &[]), fragments);
    };
    refused_beside("plain_learning_with_weekends", &learned, &learning, said);
    let yesterday = GOOD.replace("\"pid\"", "\"concurrent\"\nprediction = \"yesterday\"");
    refused_beside("yesterday_with_weekends", &yesterday, &learning, &["bad.toml:28:14", "that of the day before"]);
    let mut refused = |name: &str, more: &str, fragments: &[&str]| {
        errors.error(name, from_text("bad.toml", &format!("{GOOD}{more}"), &[]), fragments);
    };
    refused("no_date", "\n[calendar]\nfirst_day = \"6.7.2026\"\n", &["bad.toml:30:13", "such as 2026-07-06"]);
    refused(
        "a_holiday_from_nowhere",
        "\n[calendar]\nholidays = [\"2026-07-06\"]\n",
        &["bad.toml:30:13", "state `first_day`"],
    );
    let weather = "\n[calendar]\nfirst_day = \"2026-07-09\"\n\n[weather]\nkind = \"epw\"\nfile = \"tropical-july.epw\"\nmonth = 7\nday = 8\n";
    refused("another_day_than_the_weather", weather, &["bad.toml:30:13", "day 8 of month 7", "day = 9"]);
    refused("no_prices", "\n[tariff]\ncurrency = \"CHF\"\n", &["bad.toml:29:1", "there are no prices"]);
    refused("prices_below_nothing", "\n[tariff]\nprices_per_kwh = [0.1, -0.3]\n", &["bad.toml:30:18", "above 0"]);
    refused("no_table_of_prices", "\n[tariff]\nfile = \"nowhere.csv\"\n", &["bad.toml:30:8", "nowhere.csv"]);
    let both = "\n[tariff]\nprices_per_kwh = [0.1]\nfile = \"nowhere.csv\"\n";
    refused("two_sources_of_prices", both, &["`prices_per_kwh`", "`file`"]);
    let falling = "\n[heat_pump]\nheating = [{ outdoor_c = 5.0, cop = 3.0 }, { outdoor_c = 2.0, cop = 2.5 }]\n";
    refused("a_curve_that_goes_back", falling, &["bad.toml:30:58", "above 5"]);
    let no_cop = "\n[heat_pump]\ncooling = [{ outdoor_c = 5.0, cop = 0.0 }]\n";
    refused("a_cop_of_nothing", no_cop, &["bad.toml:30:37", "at least 0.1"]);
    refused(
        "money_without_a_price",
        "\n[expect.building]\nenergy_cost_at_most = 3.0\n",
        &["bad.toml:30:23", "no price"],
    );
    let unknown = "\n[[expect.zone]]\nzone = \"attic\"\nenergy_kwh_at_most = 3.0\n";
    refused("expectation_of_no_zone", unknown, &["bad.toml:30:8", "`office`, `store`"]);
    refused(
        "expectation_of_nothing",
        "\n[[expect.zone]]\nzone = \"store\"\n",
        &["expects nothing", "energy_kwh_at_most"],
    );
    insta::assert_snapshot!("schedules_and_prices", errors.0);
}

/// A table of prices beside the scenario is read, and its errors are located in it.
#[test]
fn prices_are_read_from_a_table() {
    let folder = std::env::temp_dir().join(format!("interplay-prices-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let path = folder.join("priced.toml");
    std::fs::write(&path, format!("{GOOD}\n[tariff]\nfile = \"prices.csv\"\n")).expect("written");
    let load = |table: &str| {
        std::fs::write(folder.join("prices.csv"), table).expect("written");
        interplay_scenarios::load(path.to_str().expect("a plain path"), &[])
    };
    let scenario = load("hour,price_per_kwh\n0,0.25\n1,0.5\n").expect("two prices");
    assert_eq!(scenario.tariff.expect("a tariff").prices_per_kwh, [0.25, 0.5]);
    let error = load("hour,price_per_kwh\n0,0.25\n1,cheap\n").expect_err("no number");
    let error = common::rendered(&error, 2000);
    assert!(error.contains("prices.csv:3:1") && error.contains("`cheap`"), "{error}");
    let error = load("hour,price_per_kwh\n0,-0.25\n").expect_err("no mean");
    let error = common::rendered(&error, 2000);
    assert!(error.contains("priced.toml:30:8") && error.contains("above 0"), "{error}");
    std::fs::remove_dir_all(&folder).expect("removed");
}
