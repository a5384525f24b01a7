//! The command does no harm to a user's files, terminal and build server. Each test covers a fault that was found once.

use std::fs;
use std::process::Stdio;

use crate::command::{command, interplay, scratch};

/// A small scenario, with a title.
fn scenario(title: &str) -> String {
    format!("extends = 'lane-change/front-nice'\ntitle = \"{title}\"\nduration_s = 4.0\n")
}

/// A build server with a full disk must not see success.
#[cfg(target_os = "linux")]
#[test]
fn an_unwritable_result_exits_with_code_3() {
    let folder = scratch("full-disk");
    for words in [
        &["list"][..],
        &["--help"],
        &["run", "--help"],
        &["--version"],
        &["schema"],
        &["check", "lane-change/front-nice"],
        &["run", "--no-record", "--json"],
    ] {
        let full = fs::OpenOptions::new().write(true).open("/dev/full").expect("the device");
        let output = command(&folder, words).stdout(Stdio::from(full)).output().expect("runs");
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(3), "{words:?}: {said}");
        assert!(said.contains("cannot write to the standard output"), "{words:?}: {said}");
    }
}

#[test]
fn no_output_overwrites_the_scenario() {
    let folder = scratch("overwritten");
    let text = scenario("Mine");
    fs::write(folder.join("mine.toml"), &text).expect("writes");
    let cases: [&[&str]; 3] = [
        &["run", "mine.toml", "--record", "mine.toml"],
        &["run", "mine.toml", "--record", "./nothing/../mine.toml"],
        &["suite", "mine.toml", "--junit", "mine.toml"],
    ];
    fs::create_dir(folder.join("nothing")).expect("makes");
    for words in cases {
        let outcome = interplay(&folder, words);
        assert_eq!(outcome.code, Some(2), "{words:?}: {}", outcome.stderr);
        assert!(outcome.stderr.contains("would overwrite"), "{words:?}: {}", outcome.stderr);
        assert_eq!(fs::read_to_string(folder.join("mine.toml")).expect("there"), text, "{words:?}");
    }
}

/// The weather file of a scenario is protected as its scenario file is, whether a flag or the scenario names it.
#[test]
fn no_output_overwrites_the_weather() {
    let folder = scratch("overwritten-weather");
    let weather = include_str!("../../scenarios/weather/tropical-july.epw");
    let names = |file: &str| {
        format!("extends = 'building/epw-weather'\niterations = 1\n[weather]\nkind = 'epw'\nfile = '{file}'\n")
    };
    for (file, text) in [("w.epw", weather), ("v.epw", weather), ("house.toml", &names("w.epw"))] {
        fs::write(folder.join(file), text).expect("writes");
    }
    let cases: [&[&str]; 4] = [
        &["run", "house.toml", "--record", "w.epw"],
        &["run", "house.toml", "--set", "weather.file='v.epw'", "--record", "v.epw"],
        &["suite", "house.toml", "--junit", "w.epw"],
        &["export-fmu", "house.toml", "--out", "w.epw"],
    ];
    for words in cases {
        let outcome = interplay(&folder, words);
        assert_eq!(outcome.code, Some(2), "{words:?}: {}", outcome.stderr);
        assert!(outcome.stderr.contains("overwr"), "{words:?}: {}", outcome.stderr);
        for file in ["w.epw", "v.epw"] {
            assert_eq!(fs::read_to_string(folder.join(file)).expect("there"), weather, "{words:?}");
        }
    }
}

#[test]
fn no_output_overwrites_another_output() {
    let folder = scratch("twice-the-same-name");
    fs::write(folder.join("mine.toml"), scenario("Mine")).expect("writes");
    for words in [["--record", "page/index.html"], ["--animate", "page/picture.gif"]] {
        let outcome = interplay(&folder, &[&["run", "mine.toml", "--report", "page"], &words[..]].concat());
        assert_eq!(outcome.code, Some(2), "{words:?}: {}", outcome.stderr);
        assert!(outcome.stderr.contains("cannot both be"), "{words:?}: {}", outcome.stderr);
        assert!(!folder.join("page").exists(), "{words:?}");
    }
}

/// A comparison reads the rows of a sweep, and must not write its page over them, or over any other file that is not a page.
#[test]
fn no_comparison_overwrites_rows() {
    let folder = scratch("overwritten-rows");
    fs::create_dir(folder.join("rows")).expect("makes");
    for file in ["rows/runs.parquet", "rows/comparison.html"] {
        fs::write(folder.join(file), "the user's").expect("writes");
    }
    for words in [&["compare", "rows", "--page", "rows/runs.parquet"][..], &["compare", "rows"]] {
        let outcome = interplay(&folder, words);
        assert_eq!(outcome.code, Some(2), "{words:?}: {}", outcome.stderr);
        assert!(outcome.stderr.contains("is not a page that Interplay wrote"), "{words:?}: {}", outcome.stderr);
        for file in ["rows/runs.parquet", "rows/comparison.html"] {
            assert_eq!(fs::read_to_string(folder.join(file)).expect("there"), "the user's", "{words:?}");
        }
    }
}

/// Titles, names of counterfactuals and the like are shown on terminals.
#[test]
fn a_title_with_control_characters_is_refused() {
    let folder = scratch("obeyed-titles");
    for (written, code) in
        [("\\u001b[31mred", "U+001B"), ("\\u0007", "U+0007"), ("\\u009b31m", "U+009B"), ("\\u202egnp", "U+202E")]
    {
        fs::write(folder.join("mine.toml"), scenario(written)).expect("writes");
        let outcome = interplay(&folder, &["check", "mine.toml"]);
        assert_eq!(outcome.code, Some(2), "{written}: {}", outcome.stderr);
        let said = format!("`title` has the control character {code}");
        assert!(outcome.stderr.contains(&said) && outcome.stderr.contains("mine.toml:2:9"), "{}", outcome.stderr);
    }
}

#[test]
fn report_pages_by_other_programs_are_not_replaced() {
    let folder = scratch("foreign-page");
    fs::write(folder.join("index.html"), "<h1>My home page</h1>").expect("writes");
    for words in [&["run", "--set", "duration_s=4", "--report", "."][..], &["reproduce", "6.1", "--out", "."]] {
        let outcome = interplay(&folder, words);
        assert_eq!(outcome.code, Some(2), "{words:?}: {}", outcome.stderr);
        assert_eq!(fs::read_to_string(folder.join("index.html")).expect("there"), "<h1>My home page</h1>");
    }
    // A page that Interplay wrote is replaced.
    let words = ["run", "--set", "duration_s=4", "--no-record", "--report", "mine"];
    for _ in 0..2 {
        let outcome = interplay(&folder, &words);
        assert!(outcome.code.is_some_and(|code| code <= 1), "{}", outcome.stderr);
    }
}

/// Reading these would wait for ever, or never end.
#[cfg(target_os = "linux")]
#[test]
fn pipes_and_devices_as_inputs_are_refused_without_blocking() {
    let folder = scratch("devices");
    let made = std::process::Command::new("mkfifo").arg(folder.join("pipe.toml")).status().expect("mkfifo");
    assert!(made.success());
    fs::write(folder.join("child.toml"), "extends = 'pipe.toml'\n").expect("writes");
    for path in ["pipe.toml", "child.toml", "/dev/zero", "/dev/stdin"] {
        let outcome = interplay(&folder, &["check", path]);
        assert_eq!(outcome.code, Some(2), "{path}: {}", outcome.stderr);
    }
    for words in [["identify", "pipe.toml"], ["view", "/dev/zero"]] {
        let outcome = interplay(&folder, &words);
        assert_ne!(outcome.code, Some(0), "{words:?}: {}", outcome.stderr);
    }
}

/// A title may hold what clears a terminal or names its window.
#[test]
fn texts_with_control_characters_are_escaped_for_a_terminal() {
    let folder = scratch("escapes");
    fs::write(folder.join("bold.toml"), scenario("\\u001b[2J\\u001b]0;owned\\u0007")).expect("writes");
    let outcome = interplay(&folder, &["run", "bold.toml", "--no-record"]);
    let said = outcome.stdout + &outcome.stderr;
    assert!(said.contains("owned"), "{said}");
    assert!(!said.contains('\u{1b}') && !said.contains('\u{7}'), "{said:?}");
}

/// The recorder drew a dash for every metre of road.
#[test]
fn a_start_far_beyond_the_road_is_refused() {
    let outcome = interplay(&scratch("far"), &["run", "lane-change/front-tough", "--set", "vehicle.ego.start.x_m=1e9"]);
    assert_eq!(outcome.code, Some(2));
    assert!(outcome.stderr.contains("must be at most 100000"), "{}", outcome.stderr);
}

/// Thousands of threads were made for three runs.
#[test]
fn a_huge_number_of_jobs_is_accepted() {
    let folder = scratch("jobs");
    fs::write(folder.join("mine.toml"), scenario("Mine")).expect("writes");
    let outcome = interplay(&folder, &["suite", "mine.toml", "--jobs", "100000"]);
    assert!(outcome.code.is_some_and(|code| code <= 1), "{}", outcome.stderr);
}

/// `check` accepted scenarios that no run could finish.
#[test]
fn runs_beyond_the_limits_are_refused_before_they_begin() {
    let folder = scratch("budget");
    fs::write(folder.join("mine.toml"), scenario("Mine")).expect("writes");
    let dynamic = ["run", "mine.toml", "--set", "plant={ kind = \"dynamic\" }", "--set", "step_s=1e6"];
    let outcome = interplay(&folder, &[&dynamic[..], &["--set", "duration_s=1e6"]].concat());
    assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
    assert!(outcome.stderr.contains("more than 20000000"), "{}", outcome.stderr);
    assert!(!folder.join("recordings").exists(), "nothing was begun");
    let outcome = interplay(&folder, &["check", "mine.toml"]);
    assert_eq!(
        outcome.stdout,
        "ok  mine.toml\n    makes 120 plans, 240 steps, 40 records in about 0.6 MB, about 0.1 s of a processor\n"
    );
}

/// Planners failed on lanes of 50 m, and two vehicles touched on lanes of 1000 m.
#[test]
fn a_lane_wider_than_any_road_is_refused() {
    for width_m in ["50", "1000"] {
        let outcome = interplay(&scratch("wide"), &["run", "--set", &format!("road.lane_width_m={width_m}")]);
        assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
        assert!(outcome.stderr.contains("must be at most 40"), "{}", outcome.stderr);
    }
}

/// The name of the file stands in a comment, which was two lines.
#[cfg(unix)]
#[test]
fn a_new_file_is_valid_with_any_file_name() {
    let folder = scratch("newline");
    let outcome = interplay(&folder, &["new", "two\nlines.toml"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let outcome = interplay(&folder, &["check", "two\nlines.toml"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
}

/// The message was "there is no scenario" although the file exists.
#[cfg(target_os = "linux")]
#[test]
fn a_file_name_that_is_not_utf_8_is_reported() {
    use std::os::unix::ffi::OsStrExt;
    let folder = scratch("not-utf-8");
    fs::write(folder.join(std::ffi::OsStr::from_bytes(b"m\xffne.toml")), scenario("Mine")).expect("writes");
    fs::write(folder.join("plan.toml"), "scenario = [\".\"]\n").expect("writes");
    for words in [&["check", "."][..], &["suite", "."], &["sweep", "plan.toml", "--out", "out"]] {
        let outcome = interplay(&folder, words);
        assert_eq!(outcome.code, Some(2), "{words:?}: {}", outcome.stderr);
        assert!(outcome.stderr.contains("is not UTF-8 text"), "{words:?}: {}", outcome.stderr);
    }
}

/// A folder in the place of the output, and a file in the place of its folder.
#[test]
fn unwritable_outputs_exit_with_code_3_in_every_command() {
    let folder = scratch("unwritable-output");
    fs::write(folder.join("mine.toml"), scenario("Mine")).expect("writes");
    fs::write(folder.join("file"), "mine").expect("writes");
    fs::write(folder.join("plan.toml"), "scenario = [\"mine.toml\"]\n").expect("writes");
    fs::create_dir(folder.join("taken")).expect("makes");
    let cases: [&[&str]; 6] = [
        &["run", "mine.toml", "--record", "taken"],
        &["run", "mine.toml", "--no-record", "--report", "file/report"],
        &["suite", "mine.toml", "--junit", "taken"],
        &["new", "file/new.toml"],
        &["sweep", "plan.toml", "--out", "file/out"],
        &["reproduce", "table-6.1", "--out", "file/out"],
    ];
    for words in cases {
        let outcome = interplay(&folder, words);
        assert_eq!(outcome.code, Some(3), "{words:?}: {}", outcome.stderr);
        assert_eq!(fs::read_to_string(folder.join("file")).expect("there"), "mine", "{words:?}");
    }
}
