//! Figures and pages: every figure of the dissertation is made, the page contains all of them, and wrong names are refused.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::LazyLock;

use crate::command::{Outcome, contents, interplay, scratch};

/// All figures, made once for all tests.
static ALL: LazyLock<(PathBuf, Outcome)> = LazyLock::new(|| {
    let folder = scratch("figures");
    let outcome = interplay(&folder, &["reproduce", "--out", "out"]);
    (folder.join("out"), outcome)
});

fn page(folder: &Path) -> String {
    fs::read_to_string(folder.join("index.html")).expect("there is a page")
}

/// Tags of a page in order: name, whether it closes, whether it is closed at once.
fn tags(html: &str) -> Vec<(String, bool, bool)> {
    let mut found = Vec::new();
    for piece in html.split('<').skip(1) {
        let inside = piece.split('>').next().unwrap_or_default();
        if inside.starts_with('!') {
            continue;
        }
        let name = inside.trim_start_matches('/').split([' ', '/', '\n']).next().unwrap_or_default();
        found.push((name.to_owned(), inside.starts_with('/'), inside.ends_with('/')));
    }
    found
}

/// Every tag that is opened is closed in its turn.
fn assert_well_formed(html: &str) {
    let mut open: Vec<String> = Vec::new();
    for (name, closes, empty) in tags(html) {
        if closes {
            assert_eq!(open.pop().as_deref(), Some(name.as_str()), "closed but not open");
        } else if !empty && !["meta", "link"].contains(&name.as_str()) {
            open.push(name);
        }
    }
    assert_eq!(open, Vec::<String>::new(), "never closed");
}

/// A page needs nothing but itself: every picture is in it, every link leads to a part of it or to a file beside it.
fn assert_self_contained(folder: &Path) {
    let html = page(folder);
    assert_well_formed(&html);
    for address in ["http:", "https:", "//", "url(", "@import", "<script", "<img", "<iframe", "<object"] {
        assert!(!html.contains(address), "the page speaks of `{address}`");
    }
    for attribute in ["href=\"", "src=\""] {
        for target in html.split(attribute).skip(1).filter_map(|rest| rest.split('"').next()) {
            let known = match target.strip_prefix('#') {
                Some(id) => html.contains(&format!("id=\"{id}\"")),
                None => target == "data:," || folder.join(target).is_file(),
            };
            assert!(known, "`{target}` leads nowhere");
        }
    }
    let sections: Vec<&str> = html.split("<section").skip(1).collect();
    assert!(!sections.is_empty());
    for section in sections {
        let pictures: Vec<&str> = section.split("<svg").skip(1).collect();
        assert!(!pictures.is_empty(), "no picture in {}", &section[..60]);
        for picture in pictures {
            let marks = tags(picture.split("</svg>").next().unwrap_or_default()).len();
            assert!(marks > 10, "{marks} marks in a picture of {}", &section[..60]);
        }
    }
}

#[test]
fn every_figure_is_written_as_svg_and_png_and_shown_on_the_page() {
    let (folder, outcome) = &*ALL;
    assert_eq!(outcome.code, Some(0), "{outcome:?}");
    let listed = interplay(&scratch("figures-list"), &["reproduce", "--list"]).stdout;
    let ids: Vec<&str> = listed.lines().filter_map(|line| line.split_whitespace().next()).collect();
    assert_eq!(ids.len(), 43 + 8);
    let (files, html) = (contents(folder), page(folder));
    for id in ids {
        for ending in ["svg", "png"] {
            assert!(files.contains(&format!("{id}.{ending}")), "{id}.{ending} is missing");
        }
        assert!(html.contains(&format!("<section id=\"{id}\">")), "{id} is not on the page");
        assert!(html.contains(&format!("interplay reproduce {id}")), "the command of {id} is not on the page");
    }
    assert_self_contained(folder);
}

/// The commands that a page names are commands: they run, and give the numbers that are on it.
#[test]
fn commands_on_the_figure_page_repeat_the_runs() {
    let html = page(&ALL.0);
    let section = html.split("<section id=\"fig-6.2\">").nth(1).expect("it is there");
    let commands = section.split("<pre>").nth(1).and_then(|rest| rest.split("</pre>").next()).expect("commands");
    assert!(commands.lines().count() >= 3, "the figure, its run, and the run beside it: {commands}");
    let run = commands.lines().nth(1).expect("its run");
    let words: Vec<&str> = run.split_whitespace().skip(1).chain(["--json", "--no-record"]).collect();
    let report = interplay(&scratch("figures-again"), &words).json();
    let gap = report["min_gap_m"].as_f64().expect("a gap");
    assert!(section.contains(&format!("<td>{gap:.3}</td>")), "the gap {gap} is not in the table");
}

#[test]
fn single_figures_are_made_and_unknown_names_get_suggestions() {
    let folder = scratch("figures-one");
    let outcome = interplay(&folder, &["reproduce", "8.1", "Table 8.3"]);
    assert_eq!(outcome.code, Some(0), "{outcome:?}");
    let expected = ["fig-8.1.png", "fig-8.1.svg", "index.html", "table-8.3.png", "table-8.3.svg"];
    assert_eq!(contents(&folder.join("figures")), expected);
    let outcome = interplay(&folder, &["reproduce", "8.11"]);
    assert_eq!((outcome.code, outcome.stdout.as_str()), (Some(2), ""));
    assert!(outcome.stderr.contains("did you mean `fig-8.1`?"), "{outcome:?}");
    fs::write(folder.join("file"), "").expect("a file can be written");
    let outcome = interplay(&folder, &["reproduce", "8.1", "--out", "file"]);
    assert_eq!(outcome.code, Some(3), "{outcome:?}");
    assert!(outcome.stderr.contains("--out"), "{outcome:?}");
}

#[test]
fn a_report_page_of_a_run_is_written_with_its_recording() {
    let folder = scratch("report-page");
    for (name, pictures) in [("ramp-merge/nice", 3), ("building/four-room-ilc", 4)] {
        let outcome = interplay(&folder, &["run", name, "--report", name, "--seed", "1"]);
        assert_eq!(outcome.code, Some(0), "{outcome:?}");
        let report = folder.join(name);
        assert_self_contained(&report);
        let html = page(&report);
        assert_eq!(html.matches("<svg").count(), pictures, "{name}");
        assert!(html.contains("href=\"recording.rrd\"") && report.join("recording.rrd").is_file(), "{name}");
        assert!(html.contains(&format!("interplay run {name} --seed 1")), "{name}");
        assert!(html.contains("Expectations"), "{name}");
    }
    let outcome = interplay(&folder, &["run", "ramp-merge/nice", "--report", "bare", "--no-record"]);
    assert_eq!(outcome.code, Some(0), "{outcome:?}");
    assert!(!page(&folder.join("bare")).contains(".rrd"));
}

/// Opens the pages in headless Chromium: they request nothing, report no error, and show every picture.
#[test]
#[ignore = "needs Node and Chromium: cargo test --release -p interplay-tests -- --ignored a_browser_shows_every_picture"]
fn a_browser_shows_every_picture() {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("browser/check.mjs");
    let output = Command::new("node").arg(script).arg(ALL.0.join("index.html")).output().expect("node can be started");
    let said = [output.stdout, output.stderr].map(|text| String::from_utf8_lossy(&text).into_owned()).concat();
    assert!(output.status.success(), "{said}");
}
