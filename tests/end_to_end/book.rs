//! The documents are run: every command in a fenced block, every scenario, every link, every name of a test.
//!
//! A TOML block whose first line is `# name.toml`, or an XML block that begins with `<!-- name.xml -->`, is written to that file; every line of an `sh` block is then run in the
//! order of the document, in one folder for each document. It must end with 0, or with what follows `# exit code`.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use saphyr_parser::{Event, Parser};

use crate::command::{interplay, scratch};

/// Commands that are not run here, and why.
const NOT_RUN: &[(&str, &str)] = &[
    ("cargo ", "this test is run by it"),
    (".ci/run", "the same"),
    ("tests/peers/", "needs Python with CasADi"),
    ("python tests/peers/", "the same"),
    ("python python/benchmarks/", "needs the package and its peers"),
    ("tests/instructions/", "needs valgrind"),
    ("valgrind ", "another program"),
    ("tests/build_times.py", "needs the timings of a cold build"),
    ("pip ", "needs the network"),
    ("rerun", "another program"),
    ("interplay sweep real-roads", "takes six minutes; the mechanism is in `sweeps`"),
    ("interplay sweep --starts 200", "takes minutes; the mechanism is in `sweeps`"),
    ("interplay sweep --samples", "takes minutes; the mechanism is in `sweeps`"),
    ("interplay sweep perturbed-starts", "the same"),
    ("interplay sweep inferred", "the same"),
    ("interplay sweep people", "takes ten minutes; the mechanism is in `sweeps`"),
    ("interplay compare starts", "of a sweep that is not run here"),
    ("interplay compare inferred", "the same"),
    ("interplay sweep partners", "takes a quarter of an hour; the mechanism is in `sweeps`"),
    ("interplay compare partners", "of a sweep that is not run here"),
    ("interplay compare roads", "the same"),
    ("interplay sweep told.plan/plan.toml --out", "takes an hour; the mechanism is in `sweeps`"),
    ("interplay sweep benchmark --samples 5 --out", "the same"),
    ("interplay compare told", "of a sweep that is not run here"),
    ("interplay sweep contingency", "takes a quarter of an hour; the mechanism is in `sweeps`"),
    ("interplay run intersection/nice --set 'vehicle.ego.driver.passing_orders=", "a global search takes minutes"),
    ("interplay bench run --command", "needs Python; the mechanism is in `benchmark`"),
    ("interplay bench run --split", "takes an hour; the mechanism is in `benchmark`"),
    ("interplay bench board board", "of runs that are not made here"),
    ("mdbook ", "another program"),
    ("tests/cluster/", "needs a scheduler"),
    ("interplay view ", "waits for a viewer: see `authoring`"),
    ("interplay play ", "serves a page until Ctrl-C: see `played`"),
    ("interplay run mine.toml --watch", "never ends: see `authoring`"),
    ("interplay run lane-change/front-tough --connect", "needs a viewer that listens"),
    ("interplay predict us101/", "the recordings are not part of this repository; the mechanism is in `predictions`"),
    ("interplay fit USA_US101", "the same"),
    ("interplay identify dutch3/", "the measurements are not part of this repository"),
];

pub(crate) fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Path from the root and text of every document for users.
pub(crate) fn documents() -> Vec<(String, String)> {
    let mut names = pages();
    names.push("README.md".to_owned());
    names.sort();
    names.into_iter().map(|name| (name.clone(), fs::read_to_string(root().join(name)).expect("a document"))).collect()
}

/// Path from the root of every page of the book, the summary included.
pub(crate) fn pages() -> Vec<String> {
    let is_folder = |entry: &fs::DirEntry| entry.path().is_dir();
    let names_in = |folder: &str| -> Vec<(String, bool)> {
        let entries = fs::read_dir(root().join(folder)).expect("a folder of the book");
        let entries = entries.map(|entry| entry.expect("readable"));
        entries.map(|entry| (format!("{folder}/{}", entry.file_name().to_string_lossy()), is_folder(&entry))).collect()
    };
    let (folders, mut names): (Vec<_>, Vec<_>) = names_in("docs").into_iter().partition(|(_, is_folder)| *is_folder);
    names.extend(folders.iter().flat_map(|(folder, _)| names_in(folder)));
    names.into_iter().map(|(name, _)| name).filter(|name| name.ends_with(".md")).collect()
}

/// The fenced blocks of a document: language and content, in order.
fn blocks(text: &str) -> Vec<(&str, String)> {
    let mut found = Vec::new();
    let mut lines = text.lines();
    while let Some(line) = lines.next() {
        if let Some(language) = line.strip_prefix("```") {
            let content: Vec<&str> = lines.by_ref().take_while(|line| *line != "```").collect();
            found.push((language, content.join("\n")));
        }
    }
    found
}

/// Everything between single backticks outside of blocks.
fn inline_code(text: &str) -> Vec<String> {
    let mut fenced = false;
    let prose = text.lines().filter(|line| {
        let fence = line.starts_with("```");
        fenced ^= fence;
        !fenced && !fence
    });
    let prose = prose.collect::<Vec<_>>().join(" ");
    prose.split('`').skip(1).step_by(2).map(str::to_owned).collect()
}

/// A folder in which `interplay` is the command under test, and the samples lie where a clone has them.
pub(crate) struct Shell {
    folder: PathBuf,
}

impl Shell {
    #[cfg(unix)]
    pub(crate) fn new(name: &str) -> Shell {
        let folder = scratch(name);
        fs::create_dir(folder.join("bin")).expect("a scratch folder");
        std::os::unix::fs::symlink(env!("CARGO_BIN_EXE_interplay-under-test"), folder.join("bin/interplay"))
            .expect("a link");
        // What a clone has beside the documents.
        fs::create_dir(folder.join("assets")).expect("a scratch folder");
        let telemetry = fs::canonicalize(root().join("assets/telemetry")).expect("it is there");
        std::os::unix::fs::symlink(telemetry, folder.join("assets/telemetry")).expect("a link");
        Shell { folder }
    }

    fn run(&self, line: &str) {
        self.said(line);
    }

    /// Runs a line; what it says on its standard output.
    pub(crate) fn said(&self, line: &str) -> String {
        let (line, expected) = line.split_once(" # exit code ").unwrap_or((line, "0"));
        let path = format!("{}:/bin:/usr/bin", self.folder.join("bin").display());
        let mut shell = Command::new("sh");
        let output = shell.args(["-c", line]).current_dir(&self.folder).env("PATH", path).stdin(Stdio::null()).output();
        let output = output.expect("there is a shell");
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code().map(|code| code.to_string()).as_deref(), Some(expected), "{line}\n{said}");
        String::from_utf8_lossy(&output.stdout).into_owned()
    }

    /// Writes all blocks of a text that are files.
    pub(crate) fn write_all(&self, text: &str) {
        for (_, block) in blocks(text).into_iter().filter(|(language, _)| ["toml", "xml"].contains(language)) {
            self.write(&block);
        }
    }

    /// Writes a block that is a file; says its name.
    fn write(&self, block: &str) -> Option<String> {
        let first = block.lines().next()?;
        let of_xml = || first.strip_prefix("<!-- ")?.strip_suffix(" -->").filter(|name| name.ends_with(".xml"));
        let name = first.strip_prefix("# ").filter(|name| name.ends_with(".toml")).or_else(of_xml)?;
        let path = self.folder.join(name);
        fs::create_dir_all(path.parent().expect("below the folder")).expect("a scratch folder");
        fs::write(path, block).expect("a scratch file");
        Some(name.to_owned())
    }
}

#[cfg(unix)]
#[test]
fn every_command_in_the_documents_runs() {
    let mut count = 0;
    for (name, text) in documents() {
        let shell = Shell::new(&format!("book/{}", name.replace('/', "-")));
        for (language, block) in blocks(&text) {
            if ["toml", "xml"].contains(&language) {
                shell.write(&block);
            }
            let commands = block.lines().map(|line| line.strip_prefix("$ ").unwrap_or(line));
            for line in commands.filter(|_| ["sh", "console"].contains(&language)) {
                assert!(line.starts_with("interplay") || is_not_run(line), "{name}: who runs `{line}`?");
                if !is_not_run(line) {
                    shell.run(line);
                    count += 1;
                }
            }
        }
    }
    assert!(count > 20, "{count} commands");
}

fn is_not_run(line: &str) -> bool {
    NOT_RUN.iter().any(|(start, _)| line.starts_with(start))
}

#[test]
fn every_scenario_in_the_documents_is_used_there() {
    for (name, text) in documents() {
        let commands: String =
            blocks(&text).into_iter().filter(|(word, _)| *word == "sh").map(|(_, block)| block).collect();
        for (_, block) in blocks(&text).iter().filter(|(language, _)| *language == "toml") {
            if let Some(file) = block.lines().next().and_then(|line| line.strip_prefix("# ")) {
                let folder = file.split('/').next().unwrap_or(file);
                assert!(commands.contains(folder), "{name}: no command uses {file}");
            } else {
                let scenario = interplay_scenarios::from_text(&name, block, &[]);
                assert!(scenario.is_ok(), "{name}: {:?}", scenario.err());
            }
        }
    }
}

/// The excerpt of an error message in the authoring guide is what the command says.
#[test]
fn the_error_quoted_in_the_authoring_guide_is_what_check_prints() {
    let text = fs::read_to_string(root().join("docs/guide/authoring.md")).expect("the guide");
    let folder = scratch("book-error");
    let blocks = blocks(&text);
    let find = |language: &str, piece: &str| {
        let found = blocks.iter().find(|(word, block)| *word == language && block.contains(piece));
        found.map(|(_, block)| block.clone()).expect("there is such a block")
    };
    fs::write(folder.join("wrong.toml"), find("toml", "# wrong.toml")).expect("a scratch file");
    let said = interplay(&folder, &["check", "wrong.toml"]).stderr;
    let bare = |text: &str| text.lines().map(str::trim_end).collect::<Vec<_>>().join("\n");
    assert!(bare(&said).contains(&bare(&find("text", "unknown key"))), "{said}");
}

/// Commands that the documents quote exist, and so do the flags beside them.
#[test]
fn commands_and_flags_quoted_in_documents_exist() {
    let folder = scratch("book-help");
    let all = interplay(&folder, &["--help"]).stdout;
    for (name, text) in documents() {
        for code in inline_code(&text).iter().filter(|code| code.starts_with("interplay ")) {
            let words: Vec<&str> = code.split_whitespace().skip(1).collect();
            let Some(command) = words.first().filter(|word| !word.starts_with('-')) else { continue };
            assert!(all.contains(&format!("\n  {command}")), "{name}: there is no `{code}`");
            let help = interplay(&folder, &[command, "--help"]).stdout;
            for flag in words.iter().filter(|word| word.starts_with("--")) {
                let flag = flag.split('=').next().unwrap_or(flag);
                assert!(help.contains(flag), "{name}: `interplay {command}` has no {flag}");
            }
        }
    }
}

#[test]
fn links_in_the_book_work_and_the_summary_lists_every_page() {
    let summary = fs::read_to_string(root().join("docs/SUMMARY.md")).expect("the summary");
    for (name, text) in documents() {
        let folder = root().join(&name).parent().expect("below the root").to_owned();
        for target in text.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            let path = target.split('#').next().unwrap_or(target);
            assert!(target.starts_with("https://") || folder.join(path).exists(), "{name}: {target} leads nowhere");
        }
        if let Some(page) = name.strip_prefix("docs/").filter(|page| *page != "SUMMARY.md") {
            assert!(summary.contains(&format!("]({page})")), "{page} is not in the summary");
        }
    }
}

/// Largest number of words in all pages of the guide together.
const MAX_GUIDE_WORDS: usize = 45_000;

/// Largest number of words in the summary of a report of measurements.
const MAX_SUMMARY_WORDS: usize = 200;

#[test]
fn the_guide_is_short_enough_to_read() {
    let guide = documents().into_iter().filter(|(name, _)| name.starts_with("docs/guide/"));
    let words: usize = guide.map(|(_, text)| text.split_whitespace().count()).sum();
    assert!((10_000..=MAX_GUIDE_WORDS).contains(&words), "{words} words");
}

#[test]
fn every_report_begins_with_a_summary() {
    let mut count = 0;
    for (name, text) in documents().into_iter().filter(|(name, _)| name.starts_with("docs/evidence/")) {
        let (_, rest) = text.split_once("\n\n## Summary\n\n").unwrap_or_else(|| panic!("{name} has no summary"));
        let words = rest.split("\n## ").next().unwrap_or(rest).split_whitespace().count();
        assert!((20..=MAX_SUMMARY_WORDS).contains(&words), "{name}: {words} words");
        count += 1;
    }
    assert!(count > 10, "{count} reports");
}

/// The page of all authored scenarios is what they say of themselves. `INTERPLAY_BLESS=1` writes it anew.
#[test]
fn the_list_of_scenarios_is_complete() {
    let listed = interplay(&scratch("book-list"), &["list", "--json"]).json();
    let mut page = "# Authored scenarios\n\nWhat is in the binary, as `interplay list` has it.\n\n\
                    | name | what it shows | figure |\n|---|---|---|\n"
        .to_owned();
    for row in listed.as_array().expect("a list") {
        let [name, shows, figure] = ["name", "shows", "figure"].map(|key| row[key].as_str().unwrap_or_default());
        page += &format!("| `{name}` | {} | {figure} |\n", shows.replace('|', "\\|"));
    }
    let path = root().join("docs/reference/scenarios.md");
    if std::env::var_os("INTERPLAY_BLESS").is_some() {
        fs::write(&path, &page).expect("the page can be written");
    }
    let written = fs::read_to_string(&path).unwrap_or_default();
    assert!(written == page, "docs/reference/scenarios.md is out of date: renew it with INTERPLAY_BLESS=1");
}

/// The page of all keys is what the schema says, and its links lead to headings. `INTERPLAY_BLESS=1` writes it anew.
#[test]
fn the_reference_of_keys_matches_the_schema() {
    let page = interplay_scenarios::key_reference();
    let path = root().join("docs/reference/reference.md");
    if std::env::var_os("INTERPLAY_BLESS").is_some() {
        fs::write(&path, &page).expect("the page can be written");
    }
    let written = fs::read_to_string(&path).unwrap_or_default();
    assert!(written == page, "docs/reference/reference.md is out of date: renew it with INTERPLAY_BLESS=1");
    let headings: BTreeSet<String> = page.lines().filter_map(|line| line.strip_prefix("## ")).map(place_of).collect();
    let links: Vec<&str> = page.split("](#").skip(1).filter_map(|rest| rest.split(')').next()).collect();
    assert!(links.len() > 100 && headings.len() > 50, "{} links, {} sections", links.len(), headings.len());
    let broken: Vec<&&str> = links.iter().filter(|link| !headings.contains(**link)).collect();
    assert!(broken.is_empty(), "{broken:?} lead nowhere");
    for row in ["| `speed_mps` | number | m/s |", "| `safety_weight` | number | 1 | at least 0 |  | `8.0` |"] {
        assert!(page.contains(row), "{row}");
    }
}

/// Where GitHub and mdBook put a heading.
fn place_of(heading: &str) -> String {
    let kept = heading.chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c));
    kept.map(|c| if c == ' ' { '-' } else { c }).collect::<String>().to_lowercase()
}

/// Tests that the errata name are there.
#[test]
fn the_errata_name_tests_that_exist() {
    let text = fs::read_to_string(root().join("docs/theory/errata.md")).expect("the errata");
    let named: BTreeSet<&str> = text
        .lines()
        .filter(|line| line.starts_with('|'))
        .filter_map(|line| line.trim_end_matches(" |").rsplit("| ").next())
        .flat_map(|cell| cell.split('`').skip(1).step_by(2))
        .collect();
    let mut sources = String::new();
    for folder in ["planners/src", "planners/tests", "building/src", "building/tests"] {
        gather(&root().join(folder), &mut sources);
    }
    for test in &named {
        let found = sources.split("#[test]").skip(1).any(|rest| rest.trim_start().starts_with(&format!("fn {test}(")));
        assert!(found, "the errata name `{test}`, which is not a test");
    }
    assert!(named.len() > 30, "{named:?}");
}

fn gather(folder: &Path, into: &mut String) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("readable").path();
        if path.is_dir() {
            gather(&path, into);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            into.push_str(&fs::read_to_string(path).expect("a source"));
        }
    }
}

/// The workflow for users is what the page shows, is YAML, and what it runs of Interplay runs.
#[cfg(unix)]
#[test]
fn the_example_workflow_for_users_is_valid() {
    let text = fs::read_to_string(root().join("assets/ci/interplay.yml")).expect("the workflow");
    let page = fs::read_to_string(root().join("docs/guide/ci.md")).expect("the page");
    let shown = blocks(&page).into_iter().find(|(language, _)| *language == "yaml").expect("it is shown").1;
    assert_eq!(shown.trim_end(), text.trim_end());
    let events = Parser::new_from_str(&text).map(|event| event.expect("YAML").0);
    let words: Vec<String> = events
        .filter_map(|event| if let Event::Scalar(text, ..) = event { Some(text.into_owned()) } else { None })
        .collect();
    let steps: Vec<&String> = words.windows(2).filter(|pair| pair[0] == "run").map(|pair| &pair[1]).collect();
    let shell = Shell::new("book/workflow");
    let scenario = blocks(&page).into_iter().find(|(language, _)| *language == "toml").expect("a scenario").1;
    assert_eq!(shell.write(&scenario).as_deref(), Some("scenarios/merge.toml"));
    let (install, ours): (Vec<&String>, Vec<&String>) =
        steps.into_iter().partition(|step| step.starts_with("cargo install"));
    assert_eq!((install.len(), ours.len()), (1, 3));
    ours.iter().for_each(|step| shell.run(step));
    let results = fs::read_to_string(shell.folder.join("results.xml")).expect("written");
    assert!(results.contains("name=\"merge\""), "{results}");
    assert!(shell.folder.join("recordings/merge.rrd").exists());
}
