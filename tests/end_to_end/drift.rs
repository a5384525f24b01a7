//! Pictures, quoted output and tables in the documents are those of this version of the program.
//!
//! - `docs/gallery/made.txt` has the bytes of each animation and the digest of the run that it shows. A run that has changed, or
//!   a picture that was changed by hand, is found here; `docs/gallery/make.sh` makes them again.
//! - `<!-- output of: COMMAND -->` stands above a block of output. The command is run, and says every line of the block in this order;
//!   times are masked.
//! - `<!-- made by: COMMAND -->` stands above a table that takes long to make. `docs/made.txt` has the digest of the table and the version
//!   of the program that made it, so that nothing is changed by hand; the test prints which are older than this version.
//!   `docs/make.py` makes them again.
//!
//! `INTERPLAY_BLESS=1` writes the two lists anew, once pictures and tables are made.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::PathBuf;

use interplay_simulation::run::run;
use interplay_sweep::program_version;
use rayon::prelude::*;
use sha2::{Digest, Sha256};

use crate::book::{Shell, documents, root};
use crate::gallery::entries;

fn digest(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().take(8).map(|byte| format!("{byte:02x}")).collect()
}

/// Compares a list with what is written, or writes it.
fn compare(path: &PathBuf, found: &BTreeSet<String>, remedy: &str) {
    let text: String = found.iter().map(|line| format!("{line}\n")).collect();
    if std::env::var_os("INTERPLAY_BLESS").is_some() {
        fs::write(path, &text).expect("the list can be written");
    }
    let written: BTreeSet<String> = fs::read_to_string(path).unwrap_or_default().lines().map(str::to_owned).collect();
    let new: Vec<&String> = found.difference(&written).collect();
    let old: Vec<&String> = written.difference(found).collect();
    assert!(new.is_empty() && old.is_empty(), "{remedy}\nfound: {new:#?}\nwritten: {old:#?}");
}

#[test]
fn animations_in_documents_match_the_present_runs() {
    let folder = root().join("docs/gallery");
    let line = |entry: &crate::gallery::Entry| {
        let picture = digest(&fs::read(folder.join(&entry.file)).expect("an animation"));
        let report = run(&entry.file, &entry.scenario, Vec::new()).expect("a run");
        format!("{} {picture} {}", entry.file, report.digest)
    };
    let found: BTreeSet<String> = entries().par_iter().map(line).collect();
    compare(&folder.join("made.txt"), &found, "make these animations again with docs/gallery/make.sh, then bless");
}

/// A marked place of a document: what the mark says, and the lines of the block or table below it.
struct Marked<'a> {
    command: &'a str,
    lines: Vec<&'a str>,
    before: &'a str,
}

fn marked<'a>(text: &'a str, mark: &str) -> Vec<Marked<'a>> {
    let begin = format!("<!-- {mark}: ");
    let mut found = Vec::new();
    let mut at = 0;
    while let Some(offset) = text[at..].find(&begin) {
        let start = at + offset;
        let rest = &text[start + begin.len()..];
        let (command, below) = rest.split_once(" -->\n").expect("the mark has an end");
        let mut lines = below.trim_start_matches('\n').lines();
        let first = lines.next().expect("something below the mark");
        let lines = if first.starts_with("```") {
            lines.take_while(|line| !line.starts_with("```")).collect()
        } else {
            std::iter::once(first).chain(lines.take_while(|line| line.starts_with('|'))).collect()
        };
        found.push(Marked { command, lines, before: &text[..start] });
        at = start + begin.len();
    }
    found
}

/// A line without what depends on the machine: times of plans, which end the rows below a heading that ends with them, and how long a run
/// took.
fn masked(line: &str, is_row_of_times: bool) -> String {
    if line.contains(" simulated in ") {
        return line.split(" in ").next().unwrap_or_default().to_owned();
    }
    let words: Vec<&str> = line.split_whitespace().collect();
    let kept = if is_row_of_times && words.len() > 2 { words.len() - 2 } else { words.len() };
    words[..kept].join(" ")
}

fn all_masked<'a>(lines: impl Iterator<Item = &'a str>) -> Vec<String> {
    let mut is_row_of_times = false;
    let mut all = Vec::new();
    for line in lines {
        is_row_of_times = is_row_of_times && !line.trim_start().starts_with("ok");
        all.push(masked(line, is_row_of_times));
        is_row_of_times = is_row_of_times || line.trim_end().ends_with("p99 ms");
    }
    all
}

#[cfg(unix)]
#[test]
fn quoted_output_matches_what_the_command_prints() {
    let mut count = 0;
    for (name, text) in documents() {
        for Marked { command, lines, before } in marked(&text, "output of") {
            let shell = Shell::new(&format!("quoted/{}-{count}", name.replace('/', "-")));
            shell.write_all(before);
            let said = shell.said(command);
            let said = all_masked(said.lines());
            let mut said = said.iter();
            for line in all_masked(lines.into_iter()) {
                assert!(said.any(|other| *other == line), "{name}: `{command}` does not say, in this place:\n{line}");
            }
            count += 1;
        }
    }
    assert!(count >= 2, "{count} quotations");
}

#[test]
#[expect(clippy::print_stderr, reason = "the output of the test names the tables that are old")]
fn tables_in_documents_match_their_generated_versions() {
    let path = root().join("docs/made.txt");
    let written = fs::read_to_string(&path).unwrap_or_default();
    let versions: BTreeMap<&str, &str> = written.lines().filter_map(|line| line.rsplit_once(" by ")).collect();
    let now = program_version();
    let mut found = BTreeSet::new();
    for (name, text) in documents() {
        for Marked { command, lines, .. } in marked(&text, "made by") {
            let table = format!("{name} {} {command}", digest(lines.join("\n").as_bytes()));
            let version = versions.get(table.as_str()).copied().unwrap_or(&now);
            if version != now {
                eprintln!("older than this version: {name}, {command}, made by {version}");
            }
            found.insert(format!("{table} by {version}"));
        }
    }
    assert!(found.len() > 10, "{} tables", found.len());
    compare(&path, &found, "make these tables again with docs/make.py, then bless");
}

#[test]
fn changed_numbers_pictures_and_lines_of_documents_are_detected() {
    let text = "# Page\n\n<!-- made by: cargo x -->\n| a | b |\n|---|---|\n| 1 | 2 |\n\nText.\n";
    let changed = text.replace("| 2 |", "| 3 |");
    let table = |text: &str| digest(marked(text, "made by")[0].lines.join("\n").as_bytes());
    assert_eq!(marked(text, "made by")[0].lines.len(), 3);
    assert_ne!(table(text), table(&changed));
    assert_ne!(digest(b"GIF89a"), digest(b"GIF89b"));
    let said =
        ["12.0 s simulated in 0.34 s (35 times real time)", "  who p99 ms", "  ego 120 0.51 20.87", "  ok   x: 1"];
    let other =
        ["12.0 s simulated in 9.99 s (1 times real time)", "  who p99 ms", "  ego 120 0.99 1.00", "  ok   x: 2"];
    let [said, other] = [said, other].map(|lines| all_masked(lines.into_iter()));
    assert_eq!(said[..3], other[..3]);
    assert_ne!(said[3], other[3]);
}
