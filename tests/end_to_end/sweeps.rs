//! Sweeps: rows do not depend on threads, shards and interruptions, and wrong plans are refused before anything is run.

use std::fs;
use std::path::Path;
use std::thread::sleep;
use std::time::Duration;

use crate::command::{command, contents, interplay, scratch};

/// 24 short runs.
const PLAN: &str = "scenario = ['intersection/nice', 'lane-change/front-nice']\nplanner = ['conservative', 'idm']\n\
    style = ['nice', 'tough']\njitter = { position_m = 0.1, speed_mps = 0.1 }\nsamples = 3\n\
    set = { duration_s = 2.0, 'expect' = {} }\n[vary]\nvehicle.ego.start.speed_mps = { uniform = [0.9, 1.0] }\n";

fn plan(folder: &Path) {
    fs::write(folder.join("plan.toml"), PLAN).expect("a scratch file");
}

/// The rows of a folder without timings, as bytes.
fn rows(folder: &Path, out: &str) -> Vec<u8> {
    let to = format!("{out}.parquet");
    let merged = interplay(folder, &["sweep", "merge", out, "--to", &to, "--no-timings"]);
    assert_eq!(merged.code, Some(0), "{merged:?}");
    fs::read(folder.join(to)).expect("merged")
}

fn lines(folder: &Path, journal: &str) -> usize {
    fs::read(folder.join(journal)).map_or(0, |text| text.iter().filter(|byte| **byte == b'\n').count())
}

#[test]
fn threads_and_shards_do_not_change_the_rows() {
    let folder = scratch("sweep-shards");
    plan(&folder);
    for (out, jobs) in [("one", "1"), ("two", "2")] {
        let done = interplay(&folder, &["sweep", "plan.toml", "--out", out, "--jobs", jobs]);
        assert_eq!(done.code, Some(0), "{done:?}");
        assert!(done.stdout.contains("24 runs in") && done.stdout.contains("next: interplay compare"), "{done:?}");
    }
    for shard in ["1/3", "3/3"] {
        let done = interplay(&folder, &["sweep", "plan.toml", "--out", "shards", "--shard", shard]);
        assert_eq!(done.code, Some(0), "{done:?}");
    }
    let early = interplay(&folder, &["sweep", "merge", "shards"]);
    assert_eq!(early.code, Some(2));
    assert!(early.stderr.contains("shard 2 of 3 is missing"), "{}", early.stderr);
    // As a task of Slurm.
    let mut second = command(&folder, &["sweep", "plan.toml", "--out", "shards"]);
    for (name, value) in [("ID", "1"), ("COUNT", "3"), ("MIN", "0")] {
        second.env(format!("SLURM_ARRAY_TASK_{name}"), value);
    }
    assert!(second.output().expect("started").status.success());
    let expected = rows(&folder, "one");
    assert!(rows(&folder, "two") == expected && rows(&folder, "shards") == expected);
}

/// Two files that say the same have a row each, and a shard under the name of another is refused.
#[test]
fn identical_scenario_files_have_separate_rows() {
    let folder = scratch("sweep-same");
    for name in ["a", "b"] {
        let file = format!("{name}.toml");
        let made = interplay(&folder, &["new", &file, "--from", "lane-change/among-idm"]);
        assert_eq!(made.code, Some(0), "{made:?}");
    }
    fs::copy(folder.join("a.toml"), folder.join("b.toml")).expect("copied");
    let sweep = ["sweep", "--scenario", "a.toml", "--scenario", "b.toml", "--planner", "idm", "--starts", "1"];
    let done = interplay(&folder, &[&sweep[..], &["--out", "out"]].concat());
    assert!(done.stdout.contains("2 runs"), "{done:?}");
    for shard in ["1/2", "2/2"] {
        let done = interplay(&folder, &[&sweep[..], &["--out", "shards", "--shard", shard]].concat());
        assert_eq!(done.code, Some(0), "{done:?}");
    }
    let shards = folder.join("shards");
    fs::copy(shards.join("shard-1-of-2.parquet"), shards.join("shard-2-of-2.parquet")).expect("copied");
    let merged = interplay(&folder, &["sweep", "merge", "shards"]);
    assert_eq!(merged.code, Some(2), "{merged:?}");
    assert!(merged.stderr.contains("is not shard 2/2 but 1/2"), "{}", merged.stderr);
}

#[cfg(unix)]
enum Moment {
    /// When this number of rows exists.
    Rows(usize),
    Millis(u64),
}

/// Kills a sweep at a moment and resumes it. Returns the number of rows at the kill.
#[cfg(unix)]
fn killed_at(folder: &Path, out: &str, moment: &Moment) -> usize {
    let mut child = command(folder, &["sweep", "plan.toml", "--out", out, "--jobs", "2"]);
    let mut child =
        child.stdout(std::process::Stdio::null()).stderr(std::process::Stdio::null()).spawn().expect("started");
    match moment {
        Moment::Rows(count) => {
            while lines(folder, &format!("{out}/journal.jsonl")) < *count {
                sleep(Duration::from_millis(1));
            }
        }
        Moment::Millis(millis) => sleep(Duration::from_millis(*millis)),
    }
    child.kill().expect("killed, or done");
    child.wait().expect("ended");
    let before = lines(folder, &format!("{out}/journal.jsonl"));
    let done = interplay(folder, &["sweep", "plan.toml", "--out", out]);
    assert_eq!(done.code, Some(0), "{done:?}");
    assert!(done.stderr.contains(&format!("{before} made before")), "{done:?}");
    assert_eq!(lines(folder, &format!("{out}/journal.jsonl")), 24, "no run is made twice");
    before
}

#[cfg(unix)]
fn kill_at(name: &str, moments: impl Iterator<Item = Moment>) {
    let folder = scratch(name);
    plan(&folder);
    assert_eq!(interplay(&folder, &["sweep", "plan.toml", "--out", "whole"]).code, Some(0));
    let expected = rows(&folder, "whole");
    let mut partly = 0;
    for (index, moment) in moments.enumerate() {
        let out = format!("killed-{index}");
        let before = killed_at(&folder, &out, &moment);
        partly += usize::from(before > 0 && before < 24);
        assert!(rows(&folder, &out) == expected, "killed with {before} rows");
    }
    assert!(partly > 0, "no kill came between the first and the last run");
}

#[cfg(unix)]
#[test]
fn a_killed_sweep_continues_and_gives_the_same_rows() {
    kill_at("sweep-killed", [1, 7, 16].map(Moment::Rows).into_iter());
}

#[cfg(unix)]
#[test]
#[ignore = "takes a minute: 20 moments"]
fn a_sweep_killed_at_any_of_20_times_gives_the_same_rows() {
    // Steps of the golden ratio are spread evenly and never repeat.
    kill_at("sweep-killed-20", (1..=20).map(|index| Moment::Millis((f64::from(index) * 618.034) as u64 % 1500)));
}

#[test]
fn a_larger_sweep_reuses_the_rows_of_a_smaller_one() {
    let folder = scratch("sweep-bigger");
    plan(&folder);
    assert_eq!(interplay(&folder, &["sweep", "plan.toml", "--out", "out", "--samples", "1"]).code, Some(0));
    let bigger = interplay(&folder, &["sweep", "plan.toml", "--out", "out"]);
    assert!(bigger.stderr.contains("16 runs to make, 8 made before"), "{bigger:?}");
    assert_eq!(interplay(&folder, &["sweep", "plan.toml", "--out", "fresh"]).code, Some(0));
    assert!(rows(&folder, "out") == rows(&folder, "fresh"));
}

#[test]
fn comparisons_are_printed_as_a_page_and_as_json() {
    let folder = scratch("sweep-compare");
    plan(&folder);
    let done = interplay(&folder, &["sweep", "plan.toml", "--out", "out", "--keep", "failures"]);
    assert!(done.stdout.contains("versus conservative"), "{done:?}");
    let page = fs::read_to_string(folder.join("out/comparison.html")).expect("a page");
    assert!(page.contains("<svg") && !page.contains("http://") && !page.contains("<script"), "self-contained");
    let figures = interplay(&folder, &["compare", "out", "--json", "--baseline", "idm"]).json();
    assert_eq!((&figures["runs"], &figures["baseline"]), (&24.into(), &"idm".into()));
    let all = figures["groups"].as_array().expect("a list").last().expect("a group");
    assert_eq!((&all["family"], &all["style"]), (&serde_json::Value::Null, &serde_json::Value::Null));
    let planners = all["planners"].as_array().expect("a list");
    let failures: u64 = planners
        .iter()
        .map(|one| one["success"]["of"].as_u64().expect("a count") - one["success"]["count"].as_u64().expect("a count"))
        .sum();
    let recordings = contents(&folder.join("out")).iter().filter(|name| name.ends_with(".rrd")).count() as u64;
    assert_eq!(recordings, failures, "every failure has a recording, and nothing else");
    assert!(failures > 0, "2 s are too short for some");
    let wrong = interplay(&folder, &["compare", "out", "--baseline", "imd"]);
    assert_eq!(wrong.code, Some(2));
    assert!(wrong.stderr.contains("did you mean `idm`?"), "{}", wrong.stderr);
}

fn journal(folder: &Path, out: &str) -> Vec<serde_json::Value> {
    let text = fs::read_to_string(folder.join(out).join("journal.jsonl")).expect("a journal");
    text.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect()
}

/// A planner among those of the last group.
fn of_planner<'a>(figures: &'a serde_json::Value, name: &str) -> &'a serde_json::Value {
    let planners = figures["groups"].as_array().expect("a list").last().expect("a group")["planners"].as_array();
    planners.expect("a list").iter().find(|one| one["planner"] == name).unwrap_or_else(|| panic!("no {name}"))
}

#[test]
fn scenarios_are_compared_with_their_counterfactuals() {
    let folder = scratch("sweep-counterfactuals");
    let flags = ["--scenario", "intersection/nice", "--counterfactuals", "--planner", "conservative", "--starts", "2"];
    let done = interplay(&folder, &[&["sweep", "--out", "out"], &flags[..]].concat());
    assert_eq!(done.code, Some(0), "{done:?}");
    // The scenario, a conservative ego, and three counterfactuals, of which the first is the conservative ego: one run, two rows.
    assert!(done.stderr.contains("8 runs to make") && done.stdout.contains("10 runs in"), "{done:?}");
    assert_eq!(journal(&folder, "out").len(), 8);
    let figures = interplay(&folder, &["compare", "out", "--json"]).json();
    assert_eq!(figures["baseline"], "as-written");
    let [same, counterfactual, own] =
        ["conservative", "A conservative ego crosses second", "as-written"].map(|name| of_planner(&figures, name));
    for key in ["runs", "completed_s", "order_kept", "hard_braking", "touched"] {
        assert_eq!(same[key]["of"], counterfactual[key]["of"], "{key}");
        assert_eq!(same[key]["mean"], counterfactual[key]["mean"], "{key}");
    }
    assert_eq!((&own["order_kept"]["count"], &own["order_kept"]["of"]), (&2.into(), &2.into()), "as its file expects");
    assert_eq!(counterfactual["order_kept"]["count"], 0, "as its counterfactual claims");
    assert_eq!(counterfactual["versus_baseline"]["place"]["losses"], 2);
    // Both rows stay when the table is merged.
    let merged = interplay(&folder, &["sweep", "merge", "out", "--to", "merged.parquet"]);
    assert!(merged.stdout.contains("10 runs"), "{merged:?}");
}

/// What a row says of braking is what the report of a run says.
#[test]
fn hard_braking_in_sweeps_is_relative_to_the_braking_limit() {
    let folder = scratch("sweep-braking");
    let mut found = Vec::new();
    for limit in ["-1.0", "-6.0"] {
        let set = format!("vehicle.ego.limits.acceleration_min_mps2={limit}");
        let run =
            interplay(&folder, &["run", "intersection/tough", "--seed", "1", "--set", &set, "--no-record", "--json"]);
        let peak_mps2 = run.json()["vehicles"][0]["peak_braking_mps2"].as_f64().expect("a number");
        let out = format!("limit{limit}");
        let flags = ["--scenario", "intersection/tough", "--set", &set, "--out", &out];
        assert_eq!(interplay(&folder, &[&["sweep"], &flags[..]].concat()).code, Some(0));
        let row = &journal(&folder, &out)[0]["result"]["traffic"];
        let share = peak_mps2 / -limit.parse::<f64>().expect("a number");
        assert!((row["peak_braking_share"].as_f64().expect("a number") - share).abs() < 1e-12, "{row}");
        assert_eq!(row["hard_braking"], share >= 0.75, "{share}");
        found.push(share >= 0.75);
    }
    assert!(found.contains(&true) && found.contains(&false), "{found:?}: the test says nothing");
}

/// The bill of a row is that of the days of a run.
#[test]
fn bills_and_electricity_of_buildings_are_compared() {
    let folder = scratch("sweep-bills");
    let fewer = "iterations=2";
    let flags = ["--scenario", "building/office-and-flat", "--counterfactuals", "--set", fewer, "--out", "out"];
    let done = interplay(&folder, &[&["sweep"], &flags[..]].concat());
    assert!(done.stdout.contains("cheaper / dearer") && !done.stdout.contains("stuck"), "{done:?}");
    let figures = interplay(&folder, &["compare", "out", "--json"]).json();
    let run = interplay(
        &folder,
        &["run", "building/office-and-flat", "--seed", "1", "--set", fewer, "--json", "--no-record"],
    );
    let report = run.json();
    let days = report["building"]["iterations"].as_array().expect("days");
    let own = &of_planner(&figures, "as-written")["building"];
    for (key, of_day) in [("bill", "energy_cost"), ("electricity_kwh", "electricity_kwh"), ("energy_kwh", "energy_kwh")]
    {
        let sum: f64 = days.iter().map(|day| day[of_day].as_f64().expect("a number")).sum();
        let found = own[key]["mean"].as_f64().expect("a number");
        assert!((found - sum).abs() < 1e-9 * sum, "{key}: {found} and {sum}");
    }
    assert_eq!(own["currency"], "EUR");
    let versus =
        &of_planner(&figures, "Plans that ignore prices and COP cost a tenth more")["versus_baseline"]["building"];
    assert_eq!(versus["cheaper"]["losses"], 1, "it is dearer");
    assert!(versus["bill"]["mean"].as_f64().expect("a number") > 0.0);
}

#[test]
fn two_sweeps_by_one_version_do_not_differ() {
    let folder = scratch("sweep-versions");
    plan(&folder);
    for out in ["before", "after"] {
        assert_eq!(interplay(&folder, &["sweep", "plan.toml", "--out", out]).code, Some(0));
    }
    let figures = interplay(&folder, &["compare", "before", "after", "--json"]).json();
    assert_eq!((&figures["pairs"], &figures["changed"]), (&24.into(), &0.into()));
    assert_eq!(figures["unpaired"], serde_json::json!([0, 0]));
}

/// What flags cannot say names the flag.
#[test]
fn wrong_sweep_flags_are_refused_by_name() {
    let folder = scratch("sweep-wrong-flags");
    for (arguments, words) in [
        (&["--set", "seed=4", "--starts", "3"][..], &["follows from", "\"seed\" = 4 # --set"][..]),
        (&["--arm", "seed=4"], &["follows from", "# --arm"]),
        (&["--set", "duration_s=0.5"], &["is not before the end of the run", "\"duration_s\" = 0.5 # --set"]),
        (&["--set", "duration_s=3", "--set", "duration_s = 4"], &["`--set` states `duration_s` twice"]),
        (&["--arm", "duration_s=3; duration_s=4"], &["states `duration_s` twice"]),
        (
            &["--vary", "duration_s=[8, 9]", "--set", "duration_s=8"],
            &["is set here, and the plan varies", "# --set", "# --vary"],
        ),
        (&["--arm", ""], &["--arm", "write PATH=VALUE"]),
        (&["--set", "duration_s"], &["--set", "write PATH=VALUE"]),
        (&["--starts", "-3"], &["--starts", "write a whole number of at least 1"]),
    ] {
        let refused = interplay(&folder, &[&["sweep", "--scenario", "lane-change/front-nice"], arguments].concat());
        assert_eq!(refused.code, Some(2), "{arguments:?}: {refused:?}");
        for word in words {
            assert!(refused.stderr.contains(word), "{arguments:?}: {}", refused.stderr);
        }
        assert!(contents(&folder).is_empty(), "{arguments:?}");
    }
}

#[test]
fn wrong_plans_are_refused_before_any_run_or_file() {
    let folder = scratch("sweep-wrong");
    let write = |text: &str| fs::write(folder.join("plan.toml"), text).expect("a scratch file");
    for (text, arguments, words) in [
        ("scenario = ['nowhere']\n", &[][..], "plan.toml:1:13"),
        ("scenario = ['lane-change/front-nice']\nsamples = 1000000000000\n", &[], "1000000000000 runs"),
        // Every drawn value is checked, not only those at the ends.
        (
            "scenario = ['lane-change/front-nice']\nsamples = 50\n[vary]\nvehicle.front.start.x_m = \
             { normal = { mean = -0.35, sd = 2.0 } }\n",
            &[],
            "overlap at the start",
        ),
        // A dry run checks what a run would.
        (
            "scenario = ['lane-change/front-nice']\nsamples = 50\n[vary]\nvehicle.front.start.x_m = \
             { normal = { mean = -0.35, sd = 2.0 } }\n",
            &["--dry-run"],
            "8 runs have",
        ),
        (PLAN, &["--samples", "-1"], "write a whole number of at least 1"),
        (PLAN, &["--jobs", "0"], "write a whole number of at least 1"),
        // Another number of samples moves no line.
        ("scenario = ['lane-change/front-nice']\nsample = 3\n", &["--samples", "2"], "plan.toml:2:1"),
        (PLAN, &["--shard", "9/8"], "there is no shard 9 of 8"),
        (PLAN, &["--shards", "8"], "JOB_COMPLETION_INDEX"),
        (PLAN, &["--planner", "idm"], "cannot be used with"),
    ] {
        write(text);
        let refused = interplay(&folder, &[&["sweep", "plan.toml"], arguments].concat());
        assert_eq!(refused.code, Some(2), "{text}: {refused:?}");
        assert!(refused.stderr.contains(words), "{text}: {}", refused.stderr);
        assert!(refused.stderr.matches("overlap at the start").count() <= 1, "said once: {}", refused.stderr);
        assert_eq!(contents(&folder), ["plan.toml"], "{text}");
    }
    write(PLAN);
    for arguments in [&["--out", "plan.toml"][..], &["--out", "plan.toml/rows", "--dry-run"]] {
        let refused = interplay(&folder, &[&["sweep", "plan.toml"], arguments].concat());
        assert_eq!(refused.code, Some(3), "as of every output that cannot be written: {refused:?}");
        assert!(refused.stderr.contains("`plan.toml` is a file"), "{}", refused.stderr);
        assert_eq!(contents(&folder), ["plan.toml"], "{arguments:?}");
    }
    fs::create_dir(folder.join("mine")).expect("a folder");
    fs::write(folder.join("mine/plan.toml"), "title = 'mine'").expect("a scratch file");
    write(PLAN);
    let refused = interplay(&folder, &["sweep", "plan.toml", "--out", "mine"]);
    assert_eq!(refused.code, Some(2));
    assert_eq!(contents(&folder.join("mine")), ["plan.toml"]);
    for arguments in [&["compare", "nowhere"][..], &["sweep", "merge", "mine"], &["compare", "plan.toml"]] {
        let refused = interplay(&folder, arguments);
        assert!(matches!(refused.code, Some(2 | 3)), "{arguments:?}: {refused:?}");
        assert!(!refused.stderr.contains("panicked"), "{refused:?}");
    }
}
