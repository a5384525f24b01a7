//! Slips of an author, in a file or in code: the message names the intended key or value and the place to blame.

use interplay_scenarios::{
    Fault, LaneConfig, LaneNetwork, LoadError, Override, Road, Scenario, ScenarioFile, StartConfig, Stated,
    VehicleClass, VehicleConfig, from_text,
};
use serde_json::{Value as Json, json};

fn faults(text: &str, sets: &[&str]) -> Vec<Fault> {
    let sets: Vec<Override> = sets.iter().map(|set| Override::Set((*set).to_owned())).collect();
    from_text("my.toml", text, &sets).expect_err("the file is spoilt").faults().to_vec()
}

fn only(text: &str, sets: &[&str]) -> Fault {
    let faults = faults(text, sets);
    assert_eq!(faults.len(), 1, "{faults:?}");
    faults[0].clone()
}

fn hint(fault: &Fault) -> &str {
    fault.hint().unwrap_or_default()
}

const VARIANT: &str = "extends = \"lane-change/front-nice\"\ntitle = \"a\"\nshows = \"b\"\n";

#[test]
fn a_misspelt_vehicle_of_a_variant_gets_the_nearest_name_as_help() {
    let text = format!("{VARIANT}[[vehicle]]\nname = \"fornt\"\ndriver = {{ kind = \"human\", style = \"tough\" }}\n");
    let fault = only(&text, &[]);
    assert_eq!(fault.message(), "`vehicle.fornt.start` is missing");
    assert!(hint(&fault).starts_with("did you mean `front`?"), "{}", hint(&fault));
    assert_eq!((fault.file(), fault.line_and_column()), (Some("my.toml"), Some((5, 8))));
    let stranger = only(&text.replace("fornt", "lorry"), &[]);
    assert!(!hint(&stranger).contains("did you mean"), "{}", hint(&stranger));
}

#[test]
fn a_vehicle_that_a_variant_states_twice_is_refused() {
    let entry = "[[vehicle]]\nname = \"front\"\ndriver = { kind = \"human\", style = \"tough\" }\n";
    let fault = only(&format!("{VARIANT}{entry}{entry}"), &[]);
    assert_eq!(fault.message(), "`vehicle.front` stands there twice");
    assert_eq!(hint(&fault), "join them, or give one of them another name");
    assert_eq!((fault.file(), fault.line_and_column()), (Some("my.toml"), Some((8, 8))));
}

#[test]
fn a_word_in_capitals_gets_its_correct_spelling_as_help() {
    let fault = only(&format!("{VARIANT}[[vehicle]]\nname = \"front\"\ndriver = {{ kind = \"IDM\" }}\n"), &[]);
    assert_eq!(hint(&fault), "did you mean `idm`?");
    let by_flag = only(VARIANT, &["vehicle.front.driver.style=\"TOUGH\""]);
    assert_eq!(hint(&by_flag), "did you mean `tough`?");
}

#[test]
fn an_overlap_error_points_at_the_change_that_moved_a_vehicle() {
    // The ego comes first in the file that is extended, so that the overlap is found at the other's start.
    let moved = format!("{VARIANT}[[vehicle]]\nname = \"ego\"\nstart = {{ x_m = 0.0, y_m = 0.555 }}\n");
    let all = faults(&moved, &[]);
    assert!(all.iter().all(|fault| fault.message().contains("overlap at the start")), "{all:?}");
    let places: Vec<_> =
        all.iter().map(|fault| (fault.file(), fault.line_and_column().map(|(line, _)| line))).collect();
    assert!(places.iter().all(|place| *place == (Some("my.toml"), Some(6))), "{places:?}");
    for set in ["vehicle.rear.start.x_m=0.1", "vehicle.front.body.width_m=0.37"] {
        let text = VARIANT.replace("front-nice", "front-tough");
        let Err(error) = from_text("my.toml", &text, &[Override::Set(set.to_owned())]) else { continue };
        assert!(error.faults().iter().all(|fault| fault.file() == Some("--set")), "{error:?}");
    }
}

#[test]
fn scaled_numbers_in_messages_are_short() {
    let text = "title = \"a\"\nshows = \"b\"\nscale = 3.0\nvehicle = [{ name = \"ego\", \
                start = { x_m = 0.0, y_m = 0.5, speed_mps = 99.0 } }]\n";
    let said: String = faults(text, &[]).iter().map(|fault| format!("{} {}\n", fault.message(), hint(fault))).collect();
    assert!(said.contains("outside the vehicle's limits"), "{said}");
    let digits = |word: &str| word.chars().filter(char::is_ascii_digit).count();
    assert!(said.split_whitespace().all(|word| digits(word) <= 6), "{said}");
}

/// One bracket where a list wants two: at the header with one, whichever comes first.
#[test]
fn a_single_bracket_in_place_of_two_is_named_as_the_cause() {
    for (vehicles, line, message) in [
        ("[vehicle]\nname = 'a'\n[vehicle]\nname = 'b'\n", 5, "`[vehicle]` stands here for the second time"),
        ("[vehicle]\nname = 'a'\n[[vehicle]]\nname = 'b'\n", 3, "`[vehicle]` stands here beside `[[vehicle]]`"),
        ("[[vehicle]]\nname = 'a'\n[vehicle]\nname = 'b'\n", 5, "`[vehicle]` stands here beside `[[vehicle]]`"),
    ] {
        let fault = only(&format!("title = 'a'\nshows = 'b'\n{vehicles}"), &[]);
        assert_eq!((fault.message(), fault.line_and_column()), (message, Some((line, 1))));
        assert_eq!(hint(&fault), "of each one of several, write `[[vehicle]]`");
    }
}

/// The messages of a file with these lines below its head, in the order of the text.
fn messages(lines: &str) -> Vec<String> {
    faults(&format!("title = \"a\"\nshows = \"b\"\n{lines}"), &[])
        .iter()
        .map(|fault| fault.message().to_owned())
        .collect()
}

fn expect_messages(lines: &str, words: &[&str]) {
    let found = messages(lines);
    let all_match = found.len() == words.len() && found.iter().zip(words).all(|(message, word)| message.contains(word));
    assert!(all_match, "{words:?} in {found:#?}");
}

#[test]
fn a_wrong_start_does_not_hide_a_wrong_goal() {
    let car = |start: &str, goal: &str| {
        format!(
            "[[vehicle]]\nname = \"car\"\nstart = {{ {start}, along_m = 1.0, speed_mps = 0.5 }}\ngoal = {{ lane = {goal} }}\n"
        )
    };
    expect_messages(&car("lane = 7", "8"), &["car.start.lane` is 7", "car.goal.lane` is 8"]);
    expect_messages(
        &car("lane = 7", "\"west\""),
        &["car.start.lane` is 7", "`vehicle.car.goal.lane` names lane `west`"],
    );
    let network = "[road]\nkind = \"crossing\"\n";
    let on_network = |start: &str, goal: &str| format!("{network}{}", car(start, goal));
    let lanes = on_network("lane = \"nowhere\"", "\"elsewhere\"");
    expect_messages(&lanes, &["start.lane` names lane `nowhere`", "goal.lane` names lane `elsewhere`"]);
    let beyond = on_network("lane = \"west-in\"", "\"elsewhere\"").replace("along_m = 1.0", "along_m = 1e4");
    expect_messages(&beyond, &["start.along_m` (10000) is not on lane", "goal.lane` names lane `elsewhere`"]);
}

#[test]
fn faults_of_vehicles_do_not_hide_others() {
    let lines = "step_s = 2.0\nduration_s = 1.0\nplanning_period_s = 3.0\n[weather]\nkind = \"epw\"\nfile = \"nowhere.epw\"\n\
        [[vehicle]]\nname = \"car\"\nstart = { lane = 7, along_m = 1.0, speed_mps = 0.5 }\n[[counterfactual]]\nname = \"slower\"\n\
        set = { \"vehicle.lorry.start.speed_mps\" = 0.1 }\n";
    let found = messages(lines);
    for words in ["shorter than one step", "not a multiple of", "nowhere.epw", "car.start.lane` is 7", "lorry"] {
        assert!(found.iter().any(|message| message.contains(words)), "{words} in {found:#?}");
    }
    assert!(found.iter().any(|message| message.starts_with("in the counterfactual `slower`")), "{found:#?}");
}

fn scripted(orders: &str) -> String {
    format!(
        "duration_s = 9.0\n[[vehicle]]\nname = \"car\"\nstart = {{ lane = 0, along_m = 1.0, speed_mps = 0.5 }}\n\
         driver = {{ kind = \"scripted\", script = [{orders}] }}\n"
    )
}

#[test]
fn empty_or_unordered_scripts_are_refused() {
    expect_messages(&scripted(""), &["the script of vehicle `car` has no orders"]);
    expect_messages(
        &scripted("{ from_s = 1.0 }"),
        &["order 0 of vehicle `car` says neither how fast nor where to drive"],
    );
    let late = "{ from_s = 3.0, speed_mps = 0.4 }, { from_s = 1.0, lateral_m = 0.2 }";
    expect_messages(&scripted(late), &["order 1 of vehicle `car` begins at 1 s, before order 0 above it, at 3 s"]);
    let fault = only(&format!("title = \"a\"\nshows = \"b\"\n{}", scripted(late)), &[]);
    assert_eq!(fault.line_and_column(), Some((7, 87)), "{fault:?}");
    let sound = "{ from_s = 1.0, lateral_m = 0.2 }, { from_s = 1.0, speed_mps = 0.4 }";
    let of_script =
        |orders: &str| from_text("my.toml", &format!("title = \"a\"\nshows = \"b\"\n{}", scripted(orders)), &[]);
    let scenario = of_script(sound).expect("a script");
    // A driver without a script is written without one.
    let idle = Override::Set("vehicle.car.driver={ kind = \"scripted\" }".to_owned());
    let idle = from_text("my.toml", &format!("title = \"a\"\nshows = \"b\"\n{}", scripted(sound)), &[idle]);
    for scenario in [scenario, idle.expect("no script")] {
        assert!(scenario.to_file().resolve().is_ok());
    }
}

/// The key of the first fault of a scenario with one more line.
fn key(line: &str) -> Option<String> {
    let text = format!(
        "title = 'a'\nshows = 'b'\nvehicle = [{{ name = 'a', start = {{ x_m = 0, y_m = 0.2, speed_mps = 1 }} }}]\n{line}"
    );
    let error = from_text("keys.toml", &text, &[]).expect_err("a fault");
    error.faults()[0].key().map(str::to_owned)
}

#[test]
fn a_fault_names_the_key_on_its_line() {
    assert_eq!(key("duration_z = 3.0").as_deref(), Some("duration_z"));
    assert_eq!(key("duration_s = 'long'").as_deref(), Some("duration_s"));
    assert_eq!(key("expect = { no_collision = 3 }").as_deref(), Some("no_collision"));
    assert_eq!(key("[road]\nkind = 'lanes'\nlane_count = -1").as_deref(), Some("lane_count"));
}

fn vehicle(name: &str, along_m: f64) -> VehicleConfig {
    VehicleConfig::new(name, StartConfig::in_lane("main", along_m, 10.0))
}

fn network() -> ScenarioFile {
    let lane = |name: &str, from_m: f64| LaneConfig::through(name, &[[from_m, 0.0], [from_m + 100.0, 0.0]], 3.5);
    let main = LaneConfig { successors: vec!["next".to_owned()], ..lane("main", 0.0) };
    ScenarioFile {
        road: Some(Road::Network(LaneNetwork { lanes: vec![main, lane("next", 100.0)] }).into()),
        vehicles: vec![vehicle("ego", 10.0), vehicle("front", 40.0)],
        ..ScenarioFile::new("A network", "Two vehicles on lanes with names")
    }
}

fn of_json(table: Json) -> Result<Scenario, LoadError> {
    ScenarioFile::from_json(table.as_object().expect("a table"))?.resolve()
}

#[test]
fn a_network_of_lanes_is_built_and_written_out() {
    let scenario = network().resolve().expect("sound");
    let lanes = |scenario: &Scenario| scenario.vehicles[0].route.legs.iter().map(|leg| leg.lane.clone()).collect();
    let route: Vec<String> = lanes(&scenario);
    assert_eq!(route, ["main", "next"], "there is only one way");
    assert_eq!(scenario.network.as_ref().map(|network| network.lanes().len()), Some(2));
    assert_eq!(from_text("written.toml", &scenario.to_file().to_toml(), &[]).expect("what was written"), scenario);
    assert_eq!(scenario.to_file().resolve().expect("what was resolved"), scenario);
}

/// A text and the same values in code describe the same scenario, and a file that was read may be changed in code.
#[test]
fn a_scenario_made_in_code_equals_its_text() {
    let text = "title = 'A'\nshows = 'B'\nroad = { kind = 'crossing' }\n[[vehicle]]\nname = 'ego'\nclass = 'van'\n\
                start = { lane = 'west-in', along_m = 20, speed_mps = 8 }\nlimits.speed_max_mps = 12.0\ngoal.lane = 'east-out'";
    let mut ego = VehicleConfig::new("ego", StartConfig::in_lane("west-in", 20.0, 8.0));
    ego.class = Some(VehicleClass::Van);
    ego.limits = Some(Stated::default().with("speed_max_mps", 12.0));
    ego.goal.lane = Some("east-out".into());
    let made =
        ScenarioFile { road: Some(Stated::kind("crossing")), vehicles: vec![ego], ..ScenarioFile::new("A", "B") };
    let read = from_text("crossing.toml", text, &[]).expect("sound");
    assert_eq!(made.resolve().expect("sound"), read);
    assert_eq!((read.vehicles[0].limits.speed_max_mps, read.vehicles[0].body.width_m), (12.0, 2.0));
    let mut file = ScenarioFile::load("lane-change/front-nice", &[]).expect("authored");
    file.duration_s = Some(3.0);
    assert_eq!(file.resolve().expect("sound").tick_count(), 30);
    let largest = ScenarioFile { seed: Some(u64::MAX), ..made };
    assert_eq!(from_text("written.toml", &largest.to_toml(), &[]).expect("sound").seed, u64::MAX);
}

#[test]
fn a_table_of_json_may_extend_an_authored_scenario() {
    let table = json!({ "extends": "lane-change/front-nice", "title": "Mine", "vehicle": [{ "name": "ego", "goal": { "speed_mps": 0.9 } }] });
    let scenario = of_json(table).expect("sound");
    assert_eq!((scenario.title.as_str(), scenario.vehicles.len()), ("Mine", 3));
    assert_eq!(scenario.ego().and_then(|ego| ego.goal.speed_mps), Some(0.9));
}

/// Each error names the path of the key and shows its value.
#[test]
fn errors_name_the_path_of_the_key() {
    let first = |result: Result<Scenario, LoadError>| {
        let error = result.expect_err("it is wrong");
        let fault: &Fault = &error.faults()[0];
        assert_eq!(fault.line_and_column(), None, "a text does not exist: {fault}");
        (fault.file().unwrap_or_default().to_owned(), fault.message().to_owned())
    };
    let of = |change: &dyn Fn(&mut ScenarioFile)| {
        let mut file = network();
        change(&mut file);
        first(file.resolve())
    };
    let cases = [
        (of(&|file| file.vehicles[1].start.lane = Some("mian".into())), "vehicle.front.start.lane", "`mian`"),
        (of(&|file| file.vehicles[1].start.speed_mps = f64::NAN), "vehicle.front.start.speed_mps", "number"),
        (of(&|file| file.duration_s = Some(0.0)), "duration_s", "at least 0.001"),
        (
            of(&|file| file.vehicles[0].driver = Some(Stated::kind("negotiaton"))),
            "vehicle.ego.driver.kind",
            "negotiaton",
        ),
        (
            of(&|file| file.vehicles[0].driver = Some(Stated::kind("human").with("stile", "nice"))),
            "vehicle.ego.driver.stile",
            "`stile`",
        ),
        (of(&|file| file.vehicles.clear()), "scenario", "nothing to simulate"),
        (first(of_json(json!({ "title": "A", "shows": "B", "vehicles": [] }))), "vehicles", "unknown key"),
    ];
    for ((path, message), expected_path, fragment) in cases {
        assert!(path == expected_path && message.contains(fragment), "{path}: {message}");
    }
}
