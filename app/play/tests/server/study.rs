//! Studies: people who drive the runs of a plan.

use std::path::Path;

use interplay_play::{PlannedStudy, PlayServer, ServeOptions, StudyError};
use interplay_scenarios::{Registry, SweepPlan};
use interplay_sweep::compare::{Comparison, GroupBy, compare};
use interplay_sweep::{Shard, SweepOptions, sweep};
use serde_json::{Value as Json, json};

use super::pages::{Page, Served};

const PLAN: &str = "scenario = ['lane-change/front-nice']\nplanner = ['negotiation', 'conservative']\nstyle = ['nice', 'tough']\n\
    set = { duration_s = 1.5, expect = {} }\n";

fn plan(folder: &Path) -> SweepPlan {
    SweepPlan::from_text("people", PLAN, folder).expect("a plan")
}

/// Makes the rows of planners, which a study needs.
fn make_rows(folder: &Path) {
    let options = SweepOptions {
        folder,
        shard: Shard::WHOLE,
        keep: None,
        trajectories: false,
        checked: &|| (),
        begin: &|_, _| (),
        advance: &|| (),
    };
    assert_eq!(sweep(&plan(folder), &options).expect("rows").rows, 4);
}

fn serve(folder: &Path, seats: &[&str]) -> Served {
    let study = PlannedStudy::of(plan(folder), seats).expect("a plan").open(folder).expect("a study");
    let options = ServeOptions { folder: folder.join("played"), ..ServeOptions::new(Registry::standard()) };
    Served::of(PlayServer::bind(options).expect("a free port").with_study(study))
}

/// Drives a run to its end; returns the progress of the person.
fn drive(page: &mut Page) -> Json {
    page.hear("world");
    page.drive();
    page.hear("study")
}

fn compared(folder: &Path) -> Comparison {
    compare(folder, Some("conservative"), GroupBy::Scenario, plan(folder).metrics()).expect("rows")
}

#[test]
fn runs_of_participants_become_rows_like_runs_of_planners() {
    let folder = tempfile::tempdir().expect("a folder");
    make_rows(folder.path());
    let served = serve(folder.path(), &["front"]);
    let mut page = served.own_page();
    let place = page.hear("study");
    assert_eq!(
        (&place["participant"], &place["of"]),
        (&Json::Null, &json!(2)),
        "two planners, and no person has agreed"
    );
    page.say(&json!({ "type": "agree" }));
    assert_eq!(drive(&mut page)["done"], 1);
    page.say(&json!({ "type": "next" }));
    page.hear("world");
    for barred in [
        json!({ "type": "rewind", "seconds": 5 }),
        json!({ "type": "hand_over", "to": "idm" }),
        json!({ "type": "end" }),
    ] {
        page.say(&barred);
        assert!(page.hear("refused")["text"].as_str().is_some_and(|text| text.contains("study")));
    }
    page.drive();
    while page.hear("frame")["tick"].as_u64().unwrap_or_default() < 2 {}
    // A pause restarts the run.
    page.say(&json!({ "type": "pause", "paused": true }));
    let place = drive(&mut page);
    assert_eq!((&place["done"], &place["participant"]), (&json!(2), &json!(1)));
    drop(page);
    served.end();
    let figures = compared(folder.path());
    assert_eq!(figures.runs, 6);
    let group =
        figures.groups.iter().find(|group| group.style.as_deref() == Some("person")).expect("a group of people");
    let planners: Vec<(&str, usize)> = group.planners.iter().map(|one| (one.planner.as_str(), one.runs)).collect();
    assert_eq!(planners, [("conservative", 1), ("negotiation", 1)]);
    let pairs = group.planners.iter().find_map(|one| one.versus_baseline.as_ref()).expect("a pair");
    assert_eq!(pairs.pairs, 1, "of one person");
    let rows = std::fs::read_to_string(folder.path().join("people.jsonl")).expect("rows");
    let rows: Vec<Json> = rows.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
    assert_eq!((&rows[0]["inputs"]["restarts"], &rows[1]["inputs"]["restarts"]), (&json!(0), &json!(1)));
}

#[test]
fn a_person_as_the_ego_replaces_a_planner_and_unfinished_runs_do_not_count() {
    let folder = tempfile::tempdir().expect("a folder");
    make_rows(folder.path());
    let served = serve(folder.path(), &[]);
    let mut page = served.own_page();
    page.say(&json!({ "type": "agree" }));
    page.hear("world");
    page.drive();
    while page.hear("frame")["tick"].as_u64().unwrap_or_default() < 2 {}
    drop(page);
    let mut page = served.own_page();
    while page.hear("study")["participant"] != 1 {}
    page.say(&json!({ "type": "next" }));
    assert_eq!(drive(&mut page)["done"], 1);
    page.say(&json!({ "type": "leave" }));
    assert_eq!(page.hear("study")["participant"], Json::Null);
    drop(page);
    served.end();
    let figures = compared(folder.path());
    assert_eq!(figures.runs, 5);
    let people = figures.groups.iter().flat_map(|group| &group.planners).filter(|one| one.planner == "person");
    assert!(people.clone().count() > 0 && people.clone().all(|one| one.runs == 1));
    assert!(people.filter_map(|one| one.versus_baseline.as_ref()).all(|pair| pair.pairs == 1));
}

#[test]
fn seats_that_no_scenario_has_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let refused = |seats: &[&str]| PlannedStudy::of(plan(folder.path()), seats).err().expect("a refusal");
    assert!(matches!(refused(&["stranger"]), StudyError::NoSeatHere { .. }));
    assert!(refused(&["stranger"]).to_string().contains("has none of the seats stranger"));
    assert!(std::fs::read_dir(folder.path()).expect("the folder").next().is_none(), "nothing is written");
}
