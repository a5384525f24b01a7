//! Errors as users see them: the tables in `refusals` hold wrong scenarios, and one snapshot a table what is said of each.
//!
//! A case is its name, and pairs of a text of the section's good scenario and what replaces it. A last text without a pair is
//! appended; `--text` replaces the whole scenario, and `--set` and `--planner` are flags.

mod common;

use std::collections::BTreeMap;
use std::fmt::Write as _;

use common::{Catalogue, LEAST, rendered};
use interplay_scenarios::{Override, from_text};
use serde::Deserialize;

#[derive(Deserialize)]
struct Refusals {
    good: BTreeMap<String, String>,
    section: Vec<Section>,
}

#[derive(Deserialize)]
struct Section {
    name: String,
    good: String,
    #[serde(default = "bad_file")]
    file: String,
    cases: Vec<Vec<String>>,
}

fn bad_file() -> String {
    "bad.toml".to_owned()
}

fn spoilt(good: &str, changes: &[String]) -> (String, Vec<Override>) {
    let (mut text, mut flags) = (good.to_owned(), Vec::new());
    for change in changes.chunks(2) {
        match change {
            [more] => text += more,
            [flag, value] if flag == "--set" => flags.push(Override::Set(value.clone())),
            [flag, value] if flag == "--planner" => flags.push(Override::Planner(value.clone())),
            [flag, whole] if flag == "--text" => text.clone_from(whole),
            [from, to] => {
                assert!(text.contains(from), "{from} is not in the good scenario");
                text = text.replacen(from, to, 1);
            }
            _ => unreachable!("a chunk has one or two entries"),
        }
    }
    (text, flags)
}

/// What is said of all cases of a table, whose good scenarios are accepted.
fn refused(table: &str) -> String {
    let table: Refusals = toml::from_str(table).expect("a table of refusals");
    for good in table.good.values() {
        from_text("good.toml", good, &[]).expect("nothing is wrong with it");
    }
    let mut errors = Catalogue::default();
    for section in &table.section {
        for case in &section.cases {
            let (text, flags) = spoilt(&table.good[&section.good], &case[1..]);
            let name = format!("{}/{}", section.name, case[0]);
            errors.add(&name, from_text(&section.file, &text, &flags), 100);
        }
    }
    errors.0
}

#[test]
fn scenarios_of_vehicles() {
    insta::assert_snapshot!("vehicles", refused(include_str!("cases/vehicles.toml")));
}

#[test]
fn networks_and_vehicles_on_them() {
    insta::assert_snapshot!("networks", refused(include_str!("cases/networks.toml")));
}

#[test]
fn buildings() {
    insta::assert_snapshot!("buildings", refused(include_str!("cases/buildings.toml")));
}

#[test]
fn counterfactuals() {
    insta::assert_snapshot!("counterfactuals", refused(include_str!("cases/counterfactuals.toml")));
}

#[test]
fn at_most_20_errors_are_shown() {
    let mut many = LEAST.to_owned();
    for index in 0..30 {
        writeln!(many, "unknown_{index:02} = 1").expect("writing to a string cannot fail");
    }
    let error = from_text("bad.toml", &many, &[]).expect_err("unknown keys");
    assert_eq!(error.faults().len(), 20);
    assert!(rendered(&error, 100).contains("10 more are not shown"));
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
fn a_path_of_100000_keys_is_refused() {
    let deep = Override::Set(format!("{}=1", "a.".repeat(100_000)));
    let error = from_text("good.toml", LEAST, &[deep]).expect_err("too deep");
    assert!(rendered(&error, 100).contains("no key of a scenario"), "{error:?}");
}
