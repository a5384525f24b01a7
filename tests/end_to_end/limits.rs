//! The known limits of the guide: each names a test that would fail if the limit were gone. The tests that are about nothing else
//! are here.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use interplay_scenarios::{from_text, schema};

use crate::book::root;
use crate::command::{interplay, scratch};

/// The error messages of a scenario of real cars.
fn refused(text: &str) -> String {
    let head = "title = 'Limits'\nshows = 'What is refused'\nduration_s = 10.0\n[defaults]\nclass = 'car'\n";
    let error = from_text("limits.toml", &format!("{head}{text}"), &[]).expect_err("refused");
    error.faults().iter().map(|fault| fault.message().to_owned()).collect::<Vec<_>>().join("\n")
}

/// The names of the keys of the definition in the schema that has all of `some`.
fn keys_of_definition_with(some: &[&str]) -> BTreeSet<String> {
    let schema = schema();
    let definitions = schema["$defs"].as_object().expect("definitions");
    let properties = definitions.values().filter_map(|definition| definition["properties"].as_object());
    let mut found = properties.filter(|properties| some.iter().all(|key| properties.contains_key(*key)));
    let keys = found.next().expect("a definition has these keys").keys().cloned().collect();
    assert!(found.next().is_none(), "several definitions have {some:?}");
    keys
}

fn assert_keys(some: &[&str], all: &[&str]) {
    let all: BTreeSet<String> = all.iter().map(|key| (*key).to_owned()).collect();
    assert_eq!(keys_of_definition_with(some), all, "a limit of docs/guide/limits.md may be gone");
}

fn gather(folder: &Path, into: &mut BTreeSet<String>) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("readable").path();
        if path.is_dir() {
            if !path.ends_with("target") {
                gather(&path, into);
            }
        } else if path.extension().is_some_and(|extension| extension == "rs" || extension == "py") {
            let text = fs::read_to_string(&path).expect("a source");
            let name = |rest: &str| rest.split('(').next().unwrap_or_default().to_owned();
            let of_rust =
                text.split("#[test]").skip(1).filter_map(|rest| rest.split_once("fn ").map(|(_, rest)| name(rest)));
            into.extend(of_rust.chain(text.split("\ndef ").skip(1).filter(|rest| rest.starts_with("test_")).map(name)));
        }
    }
}

#[test]
fn the_limits_name_tests_that_exist() {
    let page = fs::read_to_string(root().join("docs/guide/limits.md")).expect("the page");
    let mut tests = BTreeSet::new();
    for folder in ["app", "building", "planners", "python/tests", "scenarios", "tests/end_to_end"] {
        gather(&root().join(folder), &mut tests);
    }
    let mut count = 0;
    let rows = page.lines().filter(|line| line.starts_with("| ") && !line.starts_with("| limit"));
    for row in rows {
        let cell = row.trim_end_matches(" |").rsplit("| ").next().unwrap_or_default();
        if let Some(test) = cell.strip_prefix('`').and_then(|rest| rest.strip_suffix('`')) {
            assert!(tests.contains(test), "the test `{test}` does not exist");
            count += 1;
        } else {
            assert!(cell.contains("](../evidence/"), "neither a test nor evidence: {row}");
        }
    }
    assert!(count > 12, "{count} limits with a test");
}

#[test]
fn points_of_lanes_have_no_height() {
    let lane = |points: &str| {
        format!(
            "[road]\nkind = 'network'\nlane = [{{ name = 'a', points = {points}, width_m = 3.5 }}]\n\
             [[vehicle]]\nname = 'ego'\nstart = {{ lane = 'a', along_m = 5.0, speed_mps = 5.0 }}\n"
        )
    };
    let sound = format!("title = 'Flat'\nshows = 'A road'\n{}", lane("[[0.0, 0.0], [90.0, 0.0]]"));
    assert!(from_text("flat.toml", &sound, &[]).is_ok());
    let said = refused(&lane("[[0.0, 0.0, 0.0], [90.0, 0.0, 5.0]]"));
    assert!(said.contains("road.lane"), "{said}");
}

#[test]
fn vehicles_that_come_or_leave_need_the_kinematic_plant() {
    let said = refused(
        "[plant]\nkind = 'dynamic'\n[road]\nkind = 'two-way'\n\
         [[vehicle]]\nname = 'ego'\nstart = { lane = 'east', along_m = 50.0, speed_mps = 5.0 }\n\
         [[vehicle]]\nname = 'later'\nstart = { lane = 'west', along_m = 50.0, speed_mps = 5.0 }\nenters_s = 3.0\n",
    );
    assert!(said.contains("kinematic") || said.contains("dynamic"), "{said}");
}

#[test]
fn lights_have_a_fixed_programme() {
    assert_keys(&["lanes", "phases"], &["name", "lanes", "phases", "offset_s"]);
    assert_keys(&["colour", "duration_s"], &["colour", "duration_s"]);
}

#[test]
fn sensing_has_no_camera() {
    let all = [
        "delay_s",
        "position_sd_m",
        "speed_sd_mps",
        "heading_sd_rad",
        "heading_sd_deg",
        "range_m",
        "field_of_view_rad",
        "field_of_view_deg",
        "occlusion",
        "drop_rate",
    ];
    assert_keys(&["occlusion", "drop_rate"], &all);
}

#[test]
fn a_zone_has_a_temperature_and_nothing_else() {
    let all = [
        "name",
        "capacity_kj_per_k",
        "limit_kw",
        "heating_limit_kw",
        "cooling_limit_kw",
        "solar_aperture_m2",
        "window",
    ];
    assert_keys(&["capacity_kj_per_k", "limit_kw"], &all);
}

#[test]
fn a_flow_has_at_most_10_000_vehicles() {
    let flow = "title = 'Limits'\nshows = 'A crowd'\nduration_s = 400.0\ndefaults = { class = 'car' }\n\
                road = { kind = 'lanes', lane_count = 2, lane_width_m = 3.5 }\n\
                [[flow]]\nname = 'a'\nfrom = [0]\nspeed_mps = 20.0\nvehicles_per_h = 100000.0\n";
    let error = from_text("crowd.toml", flow, &[]).expect_err("refused");
    let said = error.faults()[0].message();
    assert!(said.contains("10000") || said.contains("10,000"), "{said}");
}

#[test]
fn opendrive_is_not_read() {
    let folder = scratch("opendrive");
    let map = "<?xml version='1.0'?>\n<OpenDRIVE><header revMajor='1' revMinor='6'/></OpenDRIVE>\n";
    for name in ["road.xodr", "road.xml"] {
        fs::write(folder.join(name), map).expect("a scratch file");
        let outcome = interplay(&folder, &["import", name]);
        assert_eq!(outcome.code, Some(2), "{outcome:?}");
    }
}

#[test]
fn other_versions_of_commonroad_are_refused() {
    let page = fs::read_to_string(root().join("docs/guide/commonroad.md")).expect("the page");
    let (_, rest) = page.split_once("```xml\n").expect("a scenario");
    let (sound, _) = rest.split_once("```").expect("its end");
    let folder = scratch("commonroad-versions");
    for (version, code) in [("2020a", 0), ("2018b", 0), ("2023a", 2)] {
        let text = sound.replace("commonRoadVersion=\"2020a\"", &format!("commonRoadVersion=\"{version}\""));
        fs::write(folder.join("map.xml"), text).expect("a scratch file");
        let outcome = interplay(&folder, &["check", "map.xml"]);
        assert_eq!(outcome.code, Some(code), "{version}: {outcome:?}");
    }
}

#[test]
fn boptest_is_reached_by_plain_http() {
    let page = fs::read_to_string(root().join("docs/guide/foreign-plants.md")).expect("the page");
    let (_, rest) = page.split_once("# on-boptest.toml\n").expect("a scenario");
    let (sound, _) = rest.split_once("```").expect("its end");
    assert!(from_text("on-boptest.toml", sound, &[]).is_ok());
    let error = from_text("on-boptest.toml", &sound.replace("http://", "https://"), &[]).expect_err("refused");
    assert!(error.faults()[0].message().contains("http://127.0.0.1:8080"), "{error:?}");
}

#[test]
fn releases_are_for_linux() {
    let workflow = fs::read_to_string(root().join(".github/workflows/release.yml")).expect("the workflow");
    let runners = workflow.lines().find_map(|line| line.trim().strip_prefix("runner: [")).expect("a list of runners");
    let runners: Vec<&str> = runners.trim_end_matches(']').split(", ").collect();
    assert_eq!(runners, ["ubuntu-22.04", "ubuntu-22.04-arm"]);
}
