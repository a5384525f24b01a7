//! The planner of this crate through every command: it is treated like ours.

use std::path::Path;
use std::process::{Command, Output};

use interplay_planners::scene::inferred_futures::InferredFutures;
use interplay_planners::{Drive, DriverKind, Plan, PlanError, Scene};
use interplay_scenarios::{Override, Registry, RegistryError};
use own_planner::GapAcceptance;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use tempfile::tempdir;

fn command(folder: &Path, words: &[&str]) -> Output {
    let program = env!("CARGO_BIN_EXE_own-planner");
    Command::new(program).args(words).current_dir(folder).env("NO_COLOR", "1").output().expect("it starts")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("UTF-8")
}

/// The report of a run that ends with this code.
fn report(folder: &Path, words: &[&str], code: i32) -> Value {
    let output = command(folder, &[words, &["--no-record", "--json"]].concat());
    assert_eq!(output.status.code(), Some(code), "{}", text(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("one JSON document")
}

const SCENARIO: &str = "extends = 'lane-change/front-nice'\n";

#[test]
fn a_custom_planner_reaches_its_goal_behind_the_front_driver() {
    let folder = tempdir().expect("a folder");
    let run = ["run", "lane-change/front-nice", "--planner", "gap-acceptance"];
    // The scenario expects what negotiation does: the ego ahead of both.
    let report = report(folder.path(), &run, 1);
    let ego = &report["vehicles"][0];
    assert_eq!(ego["driver"], "gap-acceptance");
    assert!(ego["completed_s"].is_number(), "it reaches its goal: {ego}");
    assert_eq!((&report["order"][0], &ego["plans"]["failed"]), (&Value::from("front"), &Value::from(0)), "{report}");
    assert_eq!(report["collisions"], Value::Array(Vec::new()), "{report}");
}

#[test]
fn settings_of_a_custom_planner_are_checked_like_built_in_ones() {
    let folder = tempdir().expect("a folder");
    let check = |driver: &str| {
        let file = format!("{SCENARIO}[[vehicle]]\nname = 'ego'\ndriver = {{ {driver} }}\n");
        std::fs::write(folder.path().join("mine.toml"), file).expect("a file");
        let output = command(folder.path(), &["check", "mine.toml"]);
        (output.status.code(), text(&output.stderr))
    };
    assert_eq!(check("kind = 'gap-acceptance', gap_s = 0.2"), (Some(0), String::new()));
    for (driver, said) in [
        ("kind = 'gap-acceptance', gap = 0.2", "it is called `gap_s` here, after its unit"),
        ("kind = 'gap-acceptance', gap_s = -1", "must be at least 0"),
        ("kind = 'gap-acceptance', beta = 0.8", "unknown key `beta` in `vehicle.ego.driver`"),
        ("kind = 'gap-aceptance'", "did you mean `gap-acceptance`?"),
    ] {
        let (code, stderr) = check(driver);
        assert!(code == Some(2) && stderr.contains(said) && stderr.contains("mine.toml:4:"), "{driver}: {stderr}");
    }
    let schema = text(&command(folder.path(), &["schema"]).stdout);
    assert!(schema.contains("\"const\": \"gap-acceptance\"") && schema.contains("goal lane [s]"));
    let help = text(&command(folder.path(), &["run", "--help"]).stdout);
    assert!(help.contains("gap-acceptance"), "{help}");
}

#[test]
fn a_custom_planner_is_compared_with_built_in_planners() {
    let folder = tempdir().expect("a folder");
    let planners = ["--planner", "gap-acceptance", "--planner", "conservative", "--planner", "negotiation"];
    let sweep = [&["sweep", "--scenario", "lane-change/front-nice", "--starts", "4", "--out", "rows"], &planners[..]];
    let output = command(folder.path(), &sweep.concat());
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let output = command(folder.path(), &["compare", "rows"]);
    let table = text(&output.stdout);
    for planner in ["gap-acceptance", "conservative", "negotiation"] {
        assert!(table.contains(planner), "{table}");
    }
}

#[test]
fn counterfactuals_and_why_accept_a_custom_planner() {
    let folder = tempdir().expect("a folder");
    let claim = "[[counterfactual]]\nname = 'gaps'\nplanner = 'gap-acceptance'\n[counterfactual.expect]\norder_differs = true\n";
    std::fs::write(folder.path().join("claim.toml"), format!("{SCENARIO}{claim}")).expect("a file");
    let report = report(folder.path(), &["run", "claim.toml"], 0);
    assert_eq!(report["counterfactuals"][0]["name"], "gaps", "{report}");
    std::fs::write(
        folder.path().join("mine.toml"),
        format!("{SCENARIO}duration_s = 3\n[[vehicle]]\nname = 'ego'\ndriver = {{ kind = 'gap-acceptance' }}\n"),
    )
    .expect("a file");
    let output = command(folder.path(), &["why", "mine.toml"]);
    assert!(text(&output.stdout).contains("ego: planner = negotiation"), "{}", text(&output.stderr));
}

/// A driver who never finds a plan.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema, Serialize)]
#[serde(deny_unknown_fields, default)]
struct Lost {}

impl DriverKind for Lost {
    fn kind(&self) -> &'static str {
        "lost"
    }

    fn driver(&self) -> Box<dyn Drive> {
        Box::new(self.clone())
    }
}

impl Drive for Lost {
    fn plan(&mut self, _: &Scene, _: &InferredFutures) -> Result<Plan, PlanError> {
        Err(PlanError::Infeasible("never".to_owned()))
    }
}

#[test]
fn a_custom_planner_without_a_plan_drives_the_fallback() {
    let registry = Registry::default().with_driver::<Lost>().expect("a new word");
    let changes = [Override::Planner("lost".to_owned()), Override::Set("duration_s=2".to_owned())];
    let scenario = registry.load("lane-change/front-nice", &changes).expect("sound");
    let report = interplay_simulation::run::run("lost", &scenario, Vec::new()).expect("it ends");
    assert_eq!(report.vehicles[0].plans.failed, 20, "each is counted");
}

#[test]
fn registering_a_kind_twice_is_refused() {
    let twice = Registry::default().with_driver::<GapAcceptance>().and_then(Registry::with_driver::<GapAcceptance>);
    assert_eq!(twice.err(), Some(RegistryError::KindTaken("gap-acceptance")));
}

/// The metric of this crate is in the report, may be bound, and is in the comparison.
#[test]
fn a_custom_metric_is_reported_judged_and_compared() {
    let folder = tempdir().expect("a folder");
    let bound = "expect.metric=[{ name = 'waiting_share', vehicle = 'ego', at_most = 0.5 }]";
    let report = report(folder.path(), &["run", "lane-change/front-nice", "--set", bound], 0);
    let share = report["vehicles"][0]["waiting_share"].as_f64().expect("a number");
    assert!((0.0..0.5).contains(&share), "{share}");
    let what = |one: &&Value| one["what"] == "metric.waiting_share.ego.at_most";
    let judged = report["expectations"].as_array().expect("a list").iter().find(what).expect("it is judged");
    assert_eq!((&judged["got"], &judged["passed"]), (&Value::from(share), &Value::from(true)));
    let starts =
        ["sweep", "--scenario", "lane-change/front-nice", "--planner", "idm", "--starts", "2", "--out", "rows"];
    assert_eq!(command(folder.path(), &starts).status.code(), Some(0));
    let compared = command(folder.path(), &["compare", "rows", "--json"]);
    assert!(text(&compared.stdout).contains("waiting_share"), "{}", text(&compared.stdout));
}
