//! The meaning of the format: variants, overrides, defaults, the schema, and the authored files.

mod common;

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use common::{LEAST, least, set};
use interplay_common::bounds::Bound;
use interplay_planners::Driver;
use interplay_planners::drivers::human::Style;
use interplay_planners::trajectory::HomotopySearch;
use interplay_scenarios::{
    Override, ParallelLanes, Registry, Road, Scenario, ScenarioFile, Source, embedded, from_text, load, schema,
};
use serde_json::{Map, Value as Json};

#[test]
fn every_file_on_disk_is_embedded_and_loads_from_both() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("files");
    let mut on_disk = BTreeSet::new();
    for family in fs::read_dir(&folder).expect("the folder of authored files") {
        let family = family.expect("readable").path();
        for file in fs::read_dir(&family).expect("a folder for each family") {
            let path = file.expect("readable").path().with_extension("");
            let name = path.strip_prefix(&folder).expect("below the folder").to_string_lossy().replace('\\', "/");
            on_disk.insert(name);
        }
    }
    let names: Vec<&str> = embedded().iter().map(|file| file.name).collect();
    assert_eq!(names, on_disk.iter().map(String::as_str).collect::<Vec<_>>(), "embedded, sorted, and complete");
    for file in embedded() {
        let opening = file.text.strip_prefix("#:schema ../../schema.json\n").unwrap_or_default();
        assert!(opening.starts_with("# "), "{} names the schema, then says what to look for", file.name);
        let scenario = load(file.name, &[]).unwrap_or_else(|error| panic!("{}: {error:?}", file.name));
        let path = folder.join(file.name).with_extension("toml");
        assert_eq!(load(&path.to_string_lossy(), &[]).expect("the same text"), scenario);
    }
}

#[test]
fn a_written_scenario_reads_back_the_same() {
    for file in embedded() {
        let scenario = load(file.name, &[]).expect("authored files load");
        for text in [scenario.to_file().to_toml(), ScenarioFile::load(file.name, &[]).expect("authored").to_toml()] {
            let again = from_text("copy.toml", &text, &[]).unwrap_or_else(|error| panic!("{error:?}\n{text}"));
            assert!(again == scenario, "{} is another scenario:\n{text}", file.name);
        }
    }
}

#[test]
fn a_variant_states_only_its_differences() {
    let (nice, tough) = (load("lane-change/front-nice", &[]), load("lane-change/front-tough", &[]));
    let (nice, tough) = (nice.expect("authored"), tough.expect("authored"));
    let style = |scenario: &Scenario, name: &str| match &scenario.vehicle(name).expect("a vehicle").driver {
        Driver::Human(human) => human.style,
        other => panic!("{other:?} is not human"),
    };
    assert_eq!((style(&nice, "front"), style(&tough, "front")), (Some(Style::Nice), Some(Style::Tough)));
    assert_eq!(style(&tough, "rear"), Some(Style::Nice));
    assert_eq!(tough.vehicle("front").map(|v| v.start), nice.vehicle("front").map(|v| v.start));
    assert_eq!(tough.expect.order.as_deref().map(|order| order.join(" ")), Some("front ego rear".to_owned()));
    assert_eq!(tough.expect.no_collision, Some(true), "what a variant does not state stays");
    assert_eq!(load("lane-change/both-tough", &[]).expect("authored").figure, None, "a variant is another picture");
}

#[test]
fn a_file_extends_a_file_beside_it() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("a writable folder");
    write("a.toml", "extends = 'sub.toml'\n[[vehicle]]\nname = 'rear'\ngoal.speed_mps = 0.7");
    write(
        "sub.toml",
        "extends = 'lane-change/front-nice'\ntitle = 'Sub'\nvehicle = [{ name = 'rear', goal.y_m = 0.5 }]",
    );
    let path = folder.path().join("a.toml");
    let scenario = load(&path.to_string_lossy(), &[]).expect("a chain of three");
    let goal = &scenario.vehicle("rear").expect("inherited").goal;
    assert_eq!(
        (&goal.lane, goal.y_m, goal.speed_mps),
        (&None, Some(0.5), Some(0.7)),
        "`y_m` takes the place of `lane`"
    );
    assert_eq!((scenario.title.as_str(), scenario.vehicles.len()), ("Sub", 3));
    assert_eq!(Source::find(&path.to_string_lossy()).expect("there").name(), "a");
}

#[test]
fn overrides_change_the_named_keys_in_order() {
    let changes = [
        set("vehicle.ego.goal.speed_mps=1.2"),
        set("vehicle.front.driver.safety_weight = 8"),
        set("expect.completes.ego.before_s=9"),
        set("title=Not TOML but a text"),
        set("road={ lane_count = 3 }"),
        Override::Seed(u64::MAX),
        set("duration_s=1.0"),
        set("duration_s=10"),
    ];
    let scenario = load("lane-change/front-nice", &changes).expect("all keys exist");
    assert_eq!(scenario.ego().and_then(|ego| ego.goal.speed_mps), Some(1.2));
    let Driver::Human(front) = &scenario.vehicle("front").expect("there").driver else { panic!("not human") };
    assert_eq!((front.style, front.weight()), (None, 8.0), "`safety_weight` takes the place of `style`");
    assert_eq!(scenario.expect.completes[0].before_s, Some(9.0));
    assert_eq!((scenario.title.as_str(), scenario.seed, scenario.duration_s), ("Not TOML but a text", u64::MAX, 10.0));
    assert_eq!(scenario.road.parallel_lanes(), Some(ParallelLanes { count: 3, width_m: 0.37 }));
}

#[test]
fn a_table_set_on_a_vehicle_changes_only_the_keys_that_it_states() {
    let changed = least("", &[set("vehicle.car={ goal = { speed_mps = 0.5 } }")]);
    let mut expected = least("", &[]);
    expected.vehicles[0].goal.speed_mps = Some(0.5);
    assert_eq!(changed, expected);
}

#[test]
fn changing_the_planner_keeps_settings_that_the_new_one_has() {
    let one_class = Override::Set("vehicle.ego.driver.passing_orders=\"off\"".to_owned());
    let conservative = Override::Planner("conservative".to_owned());
    let scenario = load("lane-change/front-nice", &[one_class, conservative]).expect("a planner");
    let Some(Driver::Conservative(settings)) = scenario.ego().map(|ego| &ego.driver) else {
        panic!("not conservative")
    };
    assert_eq!(settings.passing_orders, HomotopySearch::Off);
    let same = load("lane-change/front-nice", &[Override::Planner("negotiation".to_owned())]).expect("a planner");
    assert_eq!(same, load("lane-change/front-nice", &[]).expect("authored"));
    let first = least("", &[Override::Planner("conservative".to_owned())]);
    assert!(matches!(first.vehicles[0].driver, Driver::Conservative(_)), "without an `ego` the first vehicle is it");
}

#[test]
fn a_vehicle_without_a_goal_keeps_its_lane_and_speed() {
    let scenario = least("", &[]);
    let car = &scenario.vehicles[0];
    assert_eq!(car.target(&scenario.road), car.start);
    assert_eq!(scenario.road, Road::default());
    assert_eq!((scenario.tick_count(), scenario.ego_index()), (120, 0));
    let changing = least("", &[set("vehicle.car.goal.lane=1")]);
    assert!((changing.vehicles[0].target(&changing.road).y_m - 0.555).abs() < 1e-15);
}

#[test]
fn start_jitter_is_bounded_and_repeats_with_the_seed() {
    let jittered = |seed| least("start_jitter = { position_m = 0.1, speed_mps = 0.6 }", &[Override::Seed(seed)]);
    let mut positions = BTreeSet::new();
    for seed in 0..200 {
        let (scenario, again) = (jittered(seed), jittered(seed));
        let start = scenario.starts()[0];
        assert_eq!(start, again.starts()[0]);
        assert!(start.x_m.abs() <= 0.1 && (0.4..=1.5).contains(&start.speed_mps), "{start:?}");
        assert_eq!(start.y_m, 0.2, "only along the heading");
        positions.insert(start.x_m.to_bits());
    }
    assert_eq!(positions.len(), 200, "every seed is another start");
    assert_eq!(least("", &[]).starts()[0], least("", &[]).vehicles[0].start);
}

/// Calls `visit` with every property of the schema, by path.
fn each_property(root: &Json, schema: &Json, path: &str, visit: &mut impl FnMut(&str, &Json)) {
    let name = schema.get("$ref").and_then(Json::as_str).and_then(|path| path.strip_prefix("#/$defs/"));
    let schema = name.map_or(schema, |name| &root["$defs"][name]);
    // Alternatives that only state required keys have no type.
    let alternatives = ["oneOf", "anyOf"].iter().filter_map(|key| schema.get(*key)?.as_array()).flatten();
    for alternative in alternatives.filter(|one| one.get("type").is_some()) {
        each_property(root, alternative, path, visit);
    }
    for (key, property) in schema.get("properties").and_then(Json::as_object).into_iter().flatten() {
        let path = format!("{path}.{key}");
        visit(&path, property);
        each_property(root, property, &path, visit);
    }
    if let Some(items) = schema.get("items") {
        each_property(root, items, path, visit);
    }
}

#[test]
fn the_schema_describes_every_key() {
    let root = schema();
    let mut paths = Vec::new();
    each_property(&root, &root, "", &mut |path, property| {
        let description = property.get("description").and_then(Json::as_str).unwrap_or_default();
        assert!(description.len() > 10, "{path} is not described");
        assert!(!description.contains("\\["), "{path}: {description}");
        paths.push(path.to_owned());
    });
    assert!(paths.contains(&".vehicle.driver.beta".to_owned()), "{paths:?}");
    assert!(paths.contains(&".extends".to_owned()));
    assert!(!root.to_string().contains("null"), "TOML has no null");
}

/// A value with every default of the schema that `stated` does not have.
fn with_defaults(root: &Json, schema: &Json, stated: &Json) -> Json {
    let name = schema.get("$ref").and_then(Json::as_str).and_then(|path| path.strip_prefix("#/$defs/"));
    let schema = name.map_or(schema, |name| &root["$defs"][name]);
    let of_kind = |one: &&Json| one["properties"]["kind"]["const"] == stated["kind"];
    let tagged = stated.get("kind").and(schema.get("anyOf")).and_then(Json::as_array);
    let schema = tagged.and_then(|all| all.iter().find(of_kind)).unwrap_or(schema);
    if let (Some(items), Some(stated)) = (schema.get("items"), stated.as_array()) {
        return stated.iter().map(|item| with_defaults(root, items, item)).collect();
    }
    let (Some(properties), Some(stated)) = (schema.get("properties").and_then(Json::as_object), stated.as_object())
    else {
        return stated.clone();
    };
    let mut filled = Map::new();
    for (key, property) in properties {
        if let Some(value) = stated.get(key).or_else(|| property.get("default")) {
            filled.insert(key.clone(), with_defaults(root, property, value));
        }
    }
    Json::Object(filled)
}

#[test]
fn writing_out_every_default_of_the_schema_changes_nothing() {
    let root = schema();
    let stated: Json = toml::from_str(LEAST).expect("TOML");
    let written = with_defaults(&root, &root, &stated);
    let text = toml::to_string(&written).expect("no nulls");
    assert!(text.contains("following_weight") && text.contains("lane_width_m"), "{text}");
    assert_eq!(from_text("full.toml", &text, &[]).expect("the schema's own defaults"), least("", &[]));
}

/// A file of `interplay new` means the same as its origin, and explains each key once.
#[test]
fn a_commented_file_means_the_same_as_its_original() {
    for file in embedded() {
        let scenario = Scenario { figure: None, ..load(file.name, &[]).expect("authored") };
        let text = Registry::standard().commented(file.name, Path::new(""), true).expect("authored");
        let again = from_text("new.toml", &text, &[]).unwrap_or_else(|error| panic!("{error:?}\n{text}"));
        assert!(again == scenario, "{} is another scenario:\n{text}", file.name);
        let comments = text.lines().filter(|line| line.starts_with("# "));
        assert!(comments.map(|line| line.chars().count()).max().is_some_and(|longest| longest <= 110), "{text}");
    }
    let text = Registry::standard().commented("lane-change/front-nice", Path::new(""), true).expect("authored");
    for piece in [
        "# Width of each lane [m]. At least 0.001, at most 40.\nlane_width_m = 0.37",
        "\n#patience_steps = 5",
        "#[vehicle.limits]",
    ] {
        assert!(text.contains(piece), "no {piece:?} in\n{text}");
    }
    assert_eq!(text.matches("# Position of the mass centre along the world's x axis [m].").count(), 1, "{text}");
    let settings = text.lines().filter(|line| line.starts_with('#') && !line.starts_with("# ") && line.contains(" = "));
    assert!(settings.count() > 20, "{text}");
}

/// Lines such as `#step_s = 0.1` show defaults: stating any of them in a complete scenario changes nothing,
/// unless the schema knows no default and gives an example.
#[test]
fn the_defaults_in_a_commented_file_are_the_defaults() {
    let mut stated = 0;
    for name in ["lane-change/front-nice", "building/four-room-ilc"] {
        let scenario = Scenario { figure: None, ..load(name, &[]).expect("authored") };
        let text = Registry::standard().commented(name, Path::new(""), true).expect("authored");
        let mut live = true;
        for (at, line) in text.match_indices('\n').map(|(end, _)| (end + 1, text[end + 1..].lines().next())) {
            let line = line.unwrap_or_default();
            if line.starts_with(['[', '#']) && line.trim_start_matches('#').starts_with('[') {
                live = line.starts_with('[');
            }
            let default = line.strip_prefix('#').filter(|rest| live && !rest.starts_with([' ', '[']));
            let Some((key, _)) = default.and_then(|rest| rest.split_once(" = ")) else { continue };
            let changed = text[..at].to_owned() + &text[at + 1..];
            if let Ok(again) = from_text("new.toml", &changed, &[])
                && again == scenario
            {
                stated += 1;
                continue;
            }
            assert!(text[at..].starts_with('#') && example_only(key), "{name}: {line}");
        }
    }
    assert!(stated > 20, "{stated} defaults");
}

/// Whether some table has that key without a default.
fn example_only(key: &str) -> bool {
    let (root, mut found) = (schema(), false);
    each_property(&root, &root, "", &mut |path, property| {
        found |= path.rsplit('.').next() == Some(key) && property.get("default").is_none();
    });
    found
}

/// A number has a unit, which its description states once, where editors show it. Whole numbers count something.
#[test]
fn the_schema_gives_every_number_a_unit_and_every_key_a_default_or_an_example() {
    let root = schema();
    let mut numbers = 0;
    each_property(&root, &root, "", &mut |path, property| {
        let kind = |schema: &Json| schema.get("type").and_then(Json::as_str) == Some("number");
        if kind(property) || property.get("items").is_some_and(kind) {
            numbers += 1;
            let unit = property.get("x-unit").and_then(Json::as_str);
            let unit = unit.unwrap_or_else(|| panic!("{path}: name its unit at the end of the key, or as `x-unit`"));
            let description = property["description"].as_str().unwrap_or_default();
            assert_eq!(description.matches(&format!("[{unit}]")).count(), 1, "{path} is in {unit}: {description}");
        }
        let said = ["default", "examples", "const"].iter().any(|keyword| property.get(*keyword).is_some());
        assert!(said, "{path} has neither default nor example: `#[schemars(example = …)]` on its field");
    });
    assert!(numbers > 100, "{numbers}");
}

/// A default or an example that breaks a bound of its own key would mislead users who copy it.
#[test]
fn defaults_and_examples_are_within_their_bounds() {
    let root = schema();
    let mut bounded = 0;
    each_property(&root, &root, "", &mut |path, property| {
        let examples = property.get("examples").and_then(Json::as_array).into_iter().flatten();
        for value in examples.chain(property.get("default")).filter_map(Json::as_f64) {
            for bound in Bound::read(property) {
                bounded += 1;
                assert!(bound.admits(value), "{path}: {value} is not {bound}");
            }
        }
    });
    assert!(bounded > 100, "{bounded}");
}

/// The dissertation assumes that all plans are known. Each figure that depends on this says so.
#[test]
fn every_driving_figure_states_that_plans_are_known() {
    let text = |name: &str| embedded().iter().find(|file| file.name == name).map(|file| file.text).unwrap_or_default();
    let says = |name: &str| {
        let mut chain = Some(name.to_owned());
        std::iter::from_fn(|| {
            let here = text(chain.as_deref()?);
            let base = here.lines().find_map(|line| line.strip_prefix("extends = "));
            chain = base.map(|base| base.trim_matches('"').to_owned());
            Some(here)
        })
        .any(|here| here.contains("prediction = \"plan\""))
    };
    let mut figures = 0;
    for file in embedded() {
        let scenario = load(file.name, &[]).expect("an authored file");
        if scenario.figure.is_some() && !scenario.vehicles.is_empty() {
            figures += 1;
            assert!(says(file.name), "{} has a figure, and does not state `prediction = \"plan\"`", file.name);
        }
    }
    assert!(figures >= 16, "{figures} figures");
}
