//! Comments, messages and documents name vehicles, drivers, users and callers, and say "is not a" where that is meant.
//!
//! `plain_words.txt` lists the files that still have words of [`REFUSED`], one line `COUNT PATH` each. A count may only fall:
//! a file with more fails, and one with fewer needs a new list, which `INTERPLAY_BLESS=1` writes. A file that is renamed has its
//! line renamed by hand.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;
use std::{env, fs};

use crate::architecture::root;

/// Words that stand for a vehicle, a driver, a user or a value, and turns of phrase that read as translated. In lower case.
const REFUSED: [&str; 6] = ["somebody", "nobody", "whoever", "everybody", "so many", "by as much"];

/// Refused where a letter follows, as in "`x` is no number". "There is no number" is counted, too: "without a number" and "no number
/// exists" are shorter.
const REFUSED_BEFORE_A_LETTER: &str = "is no ";

const EXTENSIONS: [&str; 7] = ["rs", "md", "toml", "py", "js", "html", "sh"];

/// This file, which has the words to refuse them.
const OWN: &str = "tests/end_to_end/plain_words.rs";

const LIST: &str = "tests/end_to_end/plain_words.txt";

/// The number of refused words in a text.
fn count(text: &str) -> usize {
    let text = text.to_ascii_lowercase();
    let words: usize = REFUSED.iter().map(|word| text.matches(word).count()).sum();
    let begins_with_letter = |rest: &str| rest.starts_with(|first: char| first.is_ascii_lowercase());
    let negations = text.match_indices(REFUSED_BEFORE_A_LETTER);
    words + negations.filter(|(at, phrase)| begins_with_letter(&text[at + phrase.len()..])).count()
}

/// The part of a file that is checked: of the changelog, the unreleased part.
fn checked_part<'a>(path: &str, text: &'a str) -> &'a str {
    match text.find("\n## [") {
        Some(released) if path == "CHANGELOG.md" => &text[..released],
        _ => text,
    }
}

fn is_checked(path: &str) -> bool {
    let extension = Path::new(path).extension().and_then(|extension| extension.to_str());
    extension.is_some_and(|extension| EXTENSIONS.contains(&extension))
        && path != OWN
        && !path.starts_with("tests/golden/")
        && !path.contains("LICENSE")
}

/// The tracked text files that exist; empty without Git or outside a repository.
fn tracked_files() -> Vec<String> {
    let listed = Command::new("git").args(["ls-files", "-z"]).current_dir(root()).output();
    let Ok(output) = listed else { return Vec::new() };
    let paths = String::from_utf8_lossy(&output.stdout).into_owned();
    paths.split('\0').filter(|path| is_checked(path) && root().join(path).is_file()).map(str::to_owned).collect()
}

/// Each file with refused words, and how many it has.
fn found(files: &[String]) -> BTreeMap<String, usize> {
    let counted = files.iter().map(|path| {
        let bytes = fs::read(root().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"));
        let text = String::from_utf8_lossy(&bytes);
        (path.clone(), count(checked_part(path, &text)))
    });
    counted.filter(|(_, count)| *count > 0).collect()
}

fn listed() -> BTreeMap<String, usize> {
    let text = fs::read_to_string(root().join(LIST)).unwrap_or_default();
    let entries = text.lines().map(|line| {
        let (count, path) = line.split_once(' ').unwrap_or_else(|| panic!("{LIST}: `{line}` is not `COUNT PATH`"));
        (path.to_owned(), count.parse::<usize>().unwrap_or_else(|error| panic!("{LIST}: `{line}`: {error}")))
    });
    entries.collect()
}

/// Each file with more refused words than its line allows.
fn grown(found: &BTreeMap<String, usize>, listed: &BTreeMap<String, usize>) -> Vec<String> {
    let allowed = |path: &String| listed.get(path).copied().unwrap_or(0);
    let above = found.iter().filter(|(path, count)| **count > allowed(path));
    above.map(|(path, count)| format!("{path}: {count}, and {} are allowed", allowed(path))).collect()
}

#[test]
#[expect(clippy::print_stderr, reason = "a test that skips says so")]
fn the_count_of_refused_words_never_grows() {
    let files = tracked_files();
    if files.is_empty() {
        eprintln!("skipped: Git lists no files here");
        return;
    }
    let found = found(&files);
    let grown = grown(&found, &listed());
    assert!(
        grown.is_empty(),
        "name the vehicle, driver, user or value instead of {REFUSED:?}, and write \"is not a\" for \"is no\": {grown:#?}"
    );
    if env::var_os("INTERPLAY_BLESS").is_some() {
        let text: String = found.iter().map(|(path, count)| format!("{count} {path}\n")).collect();
        fs::write(root().join(LIST), text).expect("the list can be written");
    }
    assert_eq!(listed(), found, "fewer refused words than {LIST} has: INTERPLAY_BLESS=1 writes it anew");
}

#[test]
fn refused_words_are_counted_in_any_case_and_only_with_a_letter_after_is_no() {
    let cases = [
        ("Nobody waits for SOMEBODY.", 2),
        ("this is no number", 1),
        ("the answer is no.", 0),
        ("it is not a number", 0),
        ("is no 5", 0),
        ("there is no lane, and it is no longer there", 2),
        ("up to so many, wider by as much; whoever and everybody", 4),
    ];
    for (text, expected) in cases {
        assert_eq!(count(text), expected, "{text}");
    }
}

#[test]
fn released_parts_of_the_changelog_are_not_checked() {
    let text = "# Changelog\n\n## Unreleased\nnobody\n\n## [0.1.0]\nnobody\n";
    assert_eq!(count(checked_part("CHANGELOG.md", text)), 1);
    assert_eq!(count(checked_part("docs/page.md", text)), 2);
}

#[test]
fn a_growing_count_of_refused_words_is_reported_and_a_falling_one_is_not() {
    let of = |entries: &[(&str, usize)]| -> BTreeMap<String, usize> {
        entries.iter().map(|(path, count)| ((*path).to_owned(), *count)).collect()
    };
    let listed = of(&[("a.rs", 2), ("b.rs", 1)]);
    assert!(grown(&of(&[("a.rs", 1)]), &listed).is_empty());
    assert_eq!(grown(&of(&[("a.rs", 3)]), &listed), ["a.rs: 3, and 2 are allowed"]);
    assert_eq!(grown(&of(&[("c.rs", 1)]), &listed), ["c.rs: 1, and 0 are allowed"]);
}
