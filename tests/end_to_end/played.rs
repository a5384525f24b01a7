//! Playing from a file: what comes out is a scenario that repeats the run.

use std::fs;

use crate::command::{interplay, scratch};

const SCRIPT: &str = r#"{"tick": 0, "type": "input", "acceleration": 0.3, "steering": 0.0, "assist": true}
{"tick": 4, "type": "input", "acceleration": 0.2, "steering": 1.0, "assist": true}
{"tick": 12, "type": "rewind", "seconds": 0.5}
{"tick": 14, "type": "hand_over", "to": "conservative"}
{"tick": 25, "type": "hand_over", "to": null}
{"tick": 30, "type": "input", "acceleration": -0.4, "steering": -0.1}
{"tick": 40, "type": "end"}
"#;

#[test]
fn a_played_run_repeats_with_the_same_digest() {
    let folder = scratch("played");
    fs::write(folder.join("drive.jsonl"), SCRIPT).expect("the folder can be written");
    let play = ["play", "lane-change/front-nice", "--input", "drive.jsonl", "--out", "again/played.toml", "--json"];
    let played = interplay(&folder, &play).json();
    assert!(played["score"]["you"]["smallest_gap_m"].is_number(), "{played}");
    let again = interplay(&folder, &["run", "again/played.toml", "--no-record", "--json"]).json();
    assert_eq!(again["digest"], played["digest"]);
    let text = fs::read_to_string(folder.join("again/played.toml")).expect("written");
    assert!(text.contains("kind = \"inputs\"") && text.contains("to = \"conservative\""), "{text}");
}

/// A front driver that yields is not asked again; the ego waits for one that does not yield.
#[test]
fn negotiation_reacts_to_a_person_in_the_other_car() {
    let folder = scratch("played-front");
    let order = |acceleration: &str| {
        let line = format!(
            "{{\"tick\": 0, \"type\": \"input\", \"acceleration\": {acceleration}, \"steering\": 0, \"assist\": true}}\n"
        );
        let release = "{\"tick\": 12, \"type\": \"input\", \"acceleration\": 0, \"steering\": 0, \"assist\": true}\n";
        fs::write(folder.join("front.jsonl"), line + release).expect("the folder can be written");
        let out = format!("front{acceleration}.toml");
        let play = ["play", "lane-change/front-nice", "--as", "front", "--input", "front.jsonl", "--out", &out];
        interplay(&folder, &play);
        let report = interplay(&folder, &["run", &out, "--no-record", "--json"]).json();
        report["order"].as_array().expect("an order").iter().map(|name| name.to_string()).collect::<Vec<_>>()
    };
    assert_eq!(order("-0.3")[0], "\"ego\"", "the ego goes first ahead of who brakes");
    assert_eq!(order("0.2")[0], "\"front\"", "and not ahead of who does not");
}

#[test]
fn wrong_scripts_are_refused_before_anything_is_written() {
    let folder = scratch("played-wrong");
    fs::write(folder.join("wrong.jsonl"), "{\"tick\": 1, \"type\": \"fly\"}\n").expect("the folder can be written");
    fs::write(folder.join("drive.jsonl"), SCRIPT).expect("the folder can be written");
    for (arguments, part) in [
        (&["lane-change/front-nice", "--as", "stranger", "--input", "drive.jsonl"][..], "choose from ego, front, rear"),
        (&["lane-change/front-nice", "--input", "wrong.jsonl"], "wrong.jsonl:1: unknown variant `fly`"),
        (&["lane-change/front-nice", "--input", "nowhere.jsonl"], "cannot read nowhere.jsonl"),
        (
            &["lane-change/front-nice", "--input", "drive.jsonl", "--out", "drive.jsonl"],
            "would overwrite `drive.jsonl`",
        ),
        (&["building/four-room-pid", "--input", "drive.jsonl"], "no vehicle that a person can drive"),
        (&["lane-change/front-nice", "--join", "ego"], "the seat of the first page already"),
    ] {
        let outcome = interplay(&folder, &[&["play"], arguments].concat());
        assert_eq!(outcome.code, Some(2), "{arguments:?}: {}", outcome.stderr);
        assert!(outcome.stderr.contains(part), "{arguments:?}: {}", outcome.stderr);
        assert!(!folder.join("played").exists());
    }
    assert_eq!(fs::read_to_string(folder.join("drive.jsonl")).expect("there"), SCRIPT);
}
