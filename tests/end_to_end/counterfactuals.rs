//! Counterfactual runs, which change one thing of a scenario: judged by `run` and `suite`, listed by `why`.

use std::fs;
use std::path::Path;

use interplay_scenarios::load;
use interplay_simulation::run::{run, run_with_counterfactuals};
use serde_json::{Value, json};

use crate::command::{Outcome, contents, interplay, scratch};
use crate::film::FILMS;

/// A scenario of two cars at an intersection, and what may follow from another planner.
fn write(folder: &Path, name: &str, expect: &str) {
    let text = format!(
        "extends = 'intersection/nice'\ntitle = 'Mine'\n\n[[counterfactual]]\nname = 'who asks <no one>'\n\
         planner = 'conservative'\n\n[counterfactual.expect]\n{expect}\n"
    );
    fs::write(folder.join(name), text).expect("a scratch file can be written");
}

/// The expectations that hold for a conservative ego there.
const TRUE: &str = "order_differs = true\nlater = [{ vehicle = 'ego', by_s = 1.0 }]\n\
    earlier = [{ vehicle = 'crossing', by_s = 0.5 }]\nbreaks = ['order', 'completes.ego']\n\
    no_collision = true\norder = ['crossing', 'ego']";

fn run_file(folder: &Path, more: &[&str]) -> Outcome {
    interplay(folder, &[&["run", "my.toml", "--no-record"], more].concat())
}

/// Names of the expectations of the only counterfactual, those that held and the others.
fn judged(report: &Value) -> [Vec<&str>; 2] {
    let all = report["counterfactuals"][0]["expectations"].as_array().expect("a list");
    let those =
        |passed: bool| all.iter().filter(move |one| one["passed"] == passed).filter_map(|one| one["what"].as_str());
    [those(true).collect(), those(false).collect()]
}

#[test]
fn a_counterfactual_is_judged_beside_the_run() {
    let folder = scratch("counterfactual-held");
    write(&folder, "my.toml", TRUE);
    let outcome = run_file(&folder, &["--json"]);
    assert_eq!((outcome.code, outcome.stderr.as_str()), (Some(0), ""), "{outcome:?}");
    let report = outcome.json();
    let one = &report["counterfactuals"][0];
    let keys: Vec<&str> = one.as_object().expect("an object").keys().map(String::as_str).collect();
    assert_eq!(keys, ["name", "passed", "order", "expectations", "digest"]);
    assert_eq!((&one["name"], &one["passed"]), (&json!("who asks <no one>"), &json!(true)));
    assert_eq!((&report["order"], &one["order"]), (&json!(["ego", "crossing"]), &json!(["crossing", "ego"])));
    let held = ["order_differs", "later.ego", "earlier.crossing", "breaks", "no_collision", "order"];
    assert_eq!(judged(&report), [held.to_vec(), Vec::new()]);
    let flag = interplay(&folder, &["run", "intersection/nice", "--planner", "conservative", "--no-record", "--json"]);
    assert_eq!(one["digest"], flag.json()["digest"], "the run that the flag makes");
    let printed = run_file(&folder, &[]).stdout;
    let lines = "  counterfactuals, with something changed:\n  ok   who asks <no one> (order: crossing, ego)\n  \
        PASSED: the counterfactual did as claimed\n";
    assert!(printed.ends_with(lines), "{printed}");
}

#[test]
fn a_failed_counterfactual_exits_with_code_1() {
    let folder = scratch("counterfactual-failed");
    let wrong = "order_differs = false\nlater = [{ vehicle = 'ego', by_s = 9.0 }]\n\
        earlier = [{ vehicle = 'ego', by_s = 0.1 }]\nbreaks = []\norder = ['ego', 'crossing']";
    write(&folder, "my.toml", wrong);
    let outcome = run_file(&folder, &["--json"]);
    let report = outcome.json();
    assert_eq!((outcome.code, &report["passed"]), (Some(1), &json!(false)), "{outcome:?}");
    assert_eq!(judged(&report), [Vec::new(), vec!["order_differs", "later.ego", "earlier.ego", "breaks", "order"]]);
    let all = report["expectations"].as_array().expect("a list");
    assert!(all.iter().all(|one| one["passed"] == true), "the scenario's own expectations hold");
    let printed = run_file(&folder, &[]).stdout;
    for piece in
        ["  FAIL who asks <no one> ", "\n         breaks: wanted: none; got: order, completes.ego\n", "FAILED: 1 of 1 "]
    {
        assert!(printed.contains(piece), "{piece}: {printed}");
    }
}

/// Flags change both runs; counterfactuals that they make impossible are left out, which the output says.
#[test]
fn flags_also_apply_to_counterfactuals() {
    let folder = scratch("counterfactual-flags");
    write(&folder, "my.toml", "order_differs = true");
    let report = run_file(&folder, &["--set", "vehicle.crossing.driver.style=\"tough\"", "--json"]).json();
    assert_eq!(report["order"], report["counterfactuals"][0]["order"], "no vehicle lets another go first");
    assert_eq!(report["counterfactuals"][0]["passed"], false);
    let text = fs::read_to_string(folder.join("my.toml")).expect("written");
    let setting = text.replace("planner = 'conservative'", "set = { vehicle.ego.driver.persuasion = false }");
    fs::write(folder.join("my.toml"), setting).expect("a scratch file can be written");
    let outcome = run_file(&folder, &["--set", "vehicle.ego.driver={ kind = \"idm\" }", "--json"]);
    assert_eq!(outcome.json()["counterfactuals"], json!([]));
    assert!(
        outcome.stderr.starts_with("the counterfactual \"who asks <no one>\" does not fit the flags: unknown key ")
    );
}

/// Counterfactuals are claims about the file's own planner: with another one they are not judged, and one line says so.
#[test]
fn counterfactuals_are_not_judged_with_another_planner() {
    let folder = scratch("counterfactual-planner");
    write(&folder, "my.toml", "order_differs = true");
    assert_eq!(run_file(&folder, &["--json"]).json()["counterfactuals"].as_array().map(Vec::len), Some(1));
    for planner in ["conservative", "idm"] {
        let outcome = run_file(&folder, &["--planner", planner, "--json"]);
        let report = outcome.json();
        assert_eq!(report["counterfactuals"], json!([]), "{planner}");
        assert!(report["passed"].is_boolean() && !report["expectations"].as_array().expect("a list").is_empty());
        let said =
            "counterfactuals are left out: they are claims about the scenario's own planner, not that of --planner\n";
        assert_eq!(outcome.stderr, said, "{planner}");
        assert!(!run_file(&folder, &["--planner", planner]).stdout.contains("counterfactual"));
    }
}

#[test]
fn a_wrong_counterfactual_is_refused_before_anything_runs() {
    let folder = scratch("counterfactual-wrong");
    write(&folder, "my.toml", "order_difers = true");
    for command in ["run", "check", "suite"] {
        let outcome = interplay(&folder, &[command, "my.toml"]);
        assert_eq!(outcome.code, Some(2), "{outcome:?}");
        // A suite says of each file what became of it.
        assert_eq!(outcome.stdout.contains("UNUSABLE"), command == "suite", "{outcome:?}");
        assert!(outcome.stderr.contains("my.toml:9:1") && outcome.stderr.contains("`order_differs`"), "{outcome:?}");
    }
    assert_eq!(contents(&folder), ["my.toml"], "nothing was run");
}

/// In a suite a counterfactual has a row, and a test case, of its own.
#[test]
fn a_suite_judges_counterfactuals() {
    let folder = scratch("counterfactual-suite");
    write(&folder, "good.toml", TRUE);
    write(&folder, "bad.toml", "order_differs = false");
    let outcome = interplay(&folder, &["suite", "good.toml", "bad.toml", "--junit", "out.xml"]);
    assert_eq!((outcome.code, outcome.stderr.as_str()), (Some(1), ""), "{outcome:?}");
    let lines: Vec<&str> = outcome.stdout.lines().collect();
    let starts = [
        "scenario ",
        "good ",
        "  if: who asks <no one>  passed ",
        "bad ",
        "  if: who asks <no one>  FAILED ",
        "  FAIL order_differs: wanted: the same order; got: another order",
        "FAILED: 1 of 2 met their expectations",
    ];
    assert_eq!(lines.len(), starts.len(), "{}", outcome.stdout);
    for (line, start) in lines.iter().zip(starts) {
        assert!(line.starts_with(start), "`{line}` does not start with `{start}`");
    }
    let xml = fs::read_to_string(folder.join("out.xml")).expect("written");
    assert!(xml.contains("tests=\"4\" skipped=\"0\" failures=\"1\" errors=\"0\""), "{xml}");
    for piece in [
        "name=\"good: who asks &lt;no one&gt;\"",
        "message=\"order_differs: wanted: the same order; got: another order\"",
    ] {
        assert_eq!(xml.matches(piece).count(), 1, "{piece}: {xml}");
    }
    let reports = interplay(&folder, &["suite", ".", "--json"]).json();
    assert_eq!(reports[0]["counterfactuals"][0]["passed"], false);
    assert_eq!(reports[1]["counterfactuals"][0]["passed"], true);
}

/// The page and the recording say what became of the counterfactuals.
#[test]
fn report_page_and_recording_list_every_counterfactual() {
    let folder = scratch("counterfactual-page");
    write(&folder, "my.toml", TRUE);
    let outcome = interplay(&folder, &["run", "my.toml", "--report", "page"]);
    assert_eq!(outcome.code, Some(0), "{outcome:?}");
    let page = fs::read_to_string(folder.join("page/index.html")).expect("a page");
    assert!(page.contains("Counterfactuals") && page.contains("who asks &lt;no one&gt;"));
    let recording = fs::read(folder.join("page/recording.rrd")).expect("a recording");
    assert!(!recording.is_empty());
}

/// Bit for bit, with and without counterfactuals: they run elsewhere.
#[test]
fn counterfactuals_do_not_change_the_scenarios_own_run() {
    let scenario = load("intersection/nice", &[]).expect("authored");
    let alone = run("nice", &scenario, Vec::new()).expect("a run");
    let beside = run_with_counterfactuals("nice", &scenario, Vec::new()).expect("a run");
    assert_eq!((alone.digest, alone.phase_digests), (beside.digest, beside.phase_digests));
    assert_eq!((alone.counterfactuals.len(), beside.counterfactuals.len()), (0, scenario.counterfactuals.len()));
}

/// `breaks` names expectations as reports do.
#[test]
fn expectation_names_match_those_in_reports() {
    for film in FILMS.iter() {
        let mut judged: Vec<&str> = film.report.expectations.iter().map(|one| one.what.as_str()).collect();
        judged.sort_unstable();
        judged.dedup();
        assert!(judged.iter().copied().eq(film.scenario.expect.names().iter()), "{}: {judged:?}", film.name());
    }
    let house = load("building/four-room-ilc", &[]).expect("authored").expect.names();
    assert!(house.iter().all(|name| name.starts_with("building.") && !name.contains("after_iterations")), "{house:?}");
}

#[test]
fn why_says_what_the_order_depends_on() {
    let folder = scratch("why");
    let outcome = interplay(&folder, &["why", "intersection/nice"]);
    assert_eq!((outcome.code, outcome.stderr.as_str()), (Some(0), ""), "{outcome:?}");
    for piece in [
        "Intersection, crossing driver nice  [intersection/nice]\n  what is changed ",
        "\n  nothing  ",
        "\n  ego: planner = conservative ",
        "\n  ego: without concession (concession = false) ",
        "\n  crossing: style = tough ",
        "FAIL: order, completes.ego",
        "\nThe order depends on ego's planner and replacement by IDM, and crossing's style and knowledge of plans.\nIt does not depend on ego's ",
        "\nWhether the expectations hold depends on the same factors as the order.\n",
        "\nTo see one of these runs: interplay run intersection/nice --set 'vehicle.ego.driver.kind=\"conservative\"'\n",
    ] {
        assert!(outcome.stdout.contains(piece), "{piece:?} is not in\n{}", outcome.stdout);
    }
    let report = interplay(&folder, &["why", "intersection/nice", "--json", "--jobs", "2"]).json();
    assert_eq!(
        report["order_depends_on"],
        json!(["ego's planner", "ego's replacement by IDM", "crossing's style", "crossing's knowledge of plans"])
    );
    let runs = report["runs"].as_array().expect("a list");
    assert_eq!((&runs[0]["change"], &runs[0]["expectations_hold"]), (&Value::Null, &json!(true)));
    for run in runs.iter().skip(1).take(3) {
        let set = run["set"][0].as_str().expect("a flag");
        let same = interplay(&folder, &["run", "intersection/nice", "--no-record", "--json", "--set", set]).json();
        assert_eq!((&run["digest"], &run["order"]), (&same["digest"], &same["order"]), "{set}");
    }
    assert_eq!(contents(&folder), Vec::<String>::new());
}

/// What decides at the beginning decides no more when the vehicles have passed each other; and a change from the first tick on is the
/// change of the whole run.
#[test]
fn why_at_a_time_finds_what_decides_from_then_on() {
    let folder = scratch("why-at");
    let why = |more: &[&str]| interplay(&folder, &[&["why", "intersection/nice", "--json"], more].concat()).json();
    let (whole, first, late) = (why(&[]), why(&["--at", "0"]), why(&["--at", "3.95"]));
    for key in ["order_depends_on", "times_depend_on", "expectations_depend_on"] {
        assert_eq!(whole[key], first[key], "{key}");
        assert_eq!(late[key], json!([]), "{key}");
    }
    assert_eq!((&whole["at_s"], &first["at_s"], &late["at_s"]), (&Value::Null, &json!(0.0), &json!(4.0)));
    let digests = |report: &Value| -> Vec<String> {
        let runs = report["runs"].as_array().expect("a list");
        runs.iter().map(|run| run["digest"].as_str().expect("a digest").to_owned()).collect()
    };
    assert_eq!(digests(&whole), digests(&first), "from the first tick on");
    assert_eq!(digests(&whole)[0], digests(&late)[0], "the scenario's own run");
    let text = interplay(&folder, &["why", "intersection/nice", "--at", "1.5"]);
    assert!(
        text.stdout.starts_with(
            "Intersection, crossing driver nice  [intersection/nice]; what is changed holds from 1.5 s on\n"
        ),
        "{text:?}"
    );
    for (wrong, piece) in [("12", "not within the run"), ("-1", "at least 0"), ("soon", "at least 0")] {
        let refused = interplay(&folder, &["why", "intersection/nice", "--at", wrong]);
        assert_eq!((refused.code, refused.stdout.as_str()), (Some(2), ""), "{refused:?}");
        assert!(refused.stderr.contains(piece), "{refused:?}");
    }
}

/// Every planner that is declared to have mechanisms can be run without each of them.
#[test]
fn why_switches_off_every_mechanism() {
    let folder = scratch("why-mechanisms");
    for (name, mechanisms) in [
        ("intersection/nice", &["reinforcement", "concession", "persuasion", "safety filter", "passing orders"][..]),
        ("intersection/bayesian-nice", &["persuasion"]),
        ("intersection/game-friendly", &["prospect theory", "expression of intention", "forgetting"]),
    ] {
        let report = interplay(&folder, &["why", name, "--json"]).json();
        let factors: Vec<&str> =
            report["runs"].as_array().expect("a list").iter().filter_map(|run| run["factor"].as_str()).collect();
        for mechanism in mechanisms {
            assert!(factors.contains(&format!("ego's {mechanism}").as_str()), "{name}: {mechanism} not in {factors:?}");
        }
    }
}

#[test]
fn why_refuses_buildings_and_unknown_scenarios() {
    let folder = scratch("why-refuses");
    let building = interplay(&folder, &["why", "building/four-room-pid"]);
    assert_eq!((building.code, building.stdout.as_str()), (Some(2), ""), "{building:?}");
    assert!(building.stderr.contains("has no vehicles"), "{building:?}");
    let missing = interplay(&folder, &["why", "nowhere"]);
    assert_eq!(missing.code, Some(2), "{missing:?}");
}
