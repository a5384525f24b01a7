//! The documents agree with the program: the README's commands, its example and its sample output, and what CI runs.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::Command;

use interplay_scenarios::{embedded, from_text};
use saphyr_parser::Parser;

use crate::command::{contents, interplay, scratch};

fn document(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(name);
    fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The fenced blocks of a Markdown document: language and content, in order.
fn blocks(text: &str) -> Vec<(String, String)> {
    let mut found = Vec::new();
    let mut lines = text.lines();
    while let Some(line) = lines.next() {
        if let Some(language) = line.strip_prefix("```") {
            let content: Vec<&str> = lines.by_ref().take_while(|line| *line != "```").collect();
            found.push((language.to_owned(), content.join("\n")));
        }
    }
    found
}

/// The first block in that language that contains `piece`.
fn block(text: &str, language: &str, piece: &str) -> String {
    let found = blocks(text).into_iter().find(|(word, content)| word == language && content.contains(piece));
    found.unwrap_or_else(|| panic!("no `{language}` block with `{piece}`")).1
}

#[test]
fn the_readme_begins_with_the_run_and_test_commands() {
    let readme = document("README.md");
    let blocks = blocks(&readme);
    let sh = |command: &str| ("sh".to_owned(), command.to_owned());
    assert_eq!(blocks[..2], [sh("cargo run --release"), sh("cargo test --release --workspace")]);
    let before = &readme[..readme.find("```").expect("there are blocks")];
    assert!(before.lines().count() <= 8 && !before.contains("\n## "), "only what it is, and a picture, come before");
    assert!(before.contains("](docs/gallery/"), "the first screen has a moving picture");
}

#[test]
fn ci_runs_the_readme_s_test_command() {
    let (ci, readme) = (document(".ci/run"), document("README.md"));
    let test = &blocks(&readme)[1].1;
    assert!(ci.lines().any(|line| line.starts_with(&format!("run {test} "))), "`{test}` is not in .ci/run");
    assert!(
        ci.contains("\nrun .ci/lint\n") && document("justfile").contains("\n    .ci/lint\n"),
        "both check the same"
    );
    for check in ["cargo fmt", "cargo clippy", "cargo doc"] {
        assert!((document(".ci/lint") + &ci).contains(check), "{check} is not in .ci/run");
    }
}

/// The sample in the README is the command's own output, but for the numbers.
#[test]
fn the_readme_s_sample_is_what_the_command_prints() {
    let sample = block(&document("README.md"), "text", "[people/intersection]");
    let folder = scratch("sample");
    let outcome = interplay(&folder, &[]);
    let printed = outcome.stdout;
    let masked = |text: &str| -> Vec<String> {
        let lines = text.lines().map(|line| {
            let words = line.split_whitespace().map(|word| {
                let shape: String = word.chars().map(|c| if c.is_ascii_digit() { '#' } else { c }).collect();
                shape.split('#').filter(|part| !matches!(*part, "" | ".")).collect::<Vec<_>>().join("#")
            });
            words.collect::<Vec<_>>().join(" ")
        });
        lines.collect()
    };
    assert_eq!(masked(&sample), masked(&printed), "paste the output anew:\n{printed}");
    // The first run fits a screen, leaves no file behind, and ends with what to try next.
    let said = outcome.stderr.lines().collect::<Vec<_>>();
    assert!(printed.lines().count() + said.len() <= 15 && contents(&folder).is_empty(), "{printed}{said:?}");
    let next = ["why", "play", "new"].map(|command| format!(" {command} "));
    assert!(said.len() == 3 && said.iter().zip(&next).all(|(line, next)| line.contains(next)), "{said:?}");
    assert!(!printed.contains('{'), "no JSON on the first screen: {printed}");
}

#[test]
fn the_readme_s_example_is_a_scenario_and_its_commands_exist() {
    let readme = document("README.md");
    let example = block(&readme, "toml", "[[vehicle]]");
    if let Err(error) = from_text("README.toml", &example, &[]) {
        panic!("{:?}", error.faults());
    }
    let help = ["run", "suite", "new", "identify", "play"]
        .map(|word| interplay(&scratch("readme-help"), &[word, "--help"]).stdout)
        .concat();
    for flag in readme.split(|c: char| !(c.is_alphanumeric() || c == '-')).filter(|word| is_flag(word)) {
        let known = help.contains(flag) || ["--release", "--workspace", "--locked", "--path"].contains(&flag);
        assert!(known, "the README speaks of `{flag}`");
    }
}

fn is_flag(word: &str) -> bool {
    word.strip_prefix("--").is_some_and(|name| name.starts_with(char::is_alphabetic))
}

/// Scenarios that the README names are there; `docs/reference/scenarios.md` has all of them.
#[test]
fn the_readme_names_scenarios_that_exist() {
    let readme = document("README.md");
    let families: BTreeSet<&str> = embedded().iter().filter_map(|file| file.name.split('/').next()).collect();
    let is_name = |word: &&str| word.split_once('/').is_some_and(|(family, _)| families.contains(family));
    let words = readme.split(|c: char| c.is_whitespace() || "`\"()[]".contains(c));
    let named: BTreeSet<&str> = words.filter(is_name).collect();
    assert!(named.len() >= 3, "{named:?}");
    for name in named {
        assert!(embedded().iter().any(|file| file.name == name), "there is no {name}");
    }
}

/// Paths that the documents speak of exist.
#[test]
fn files_that_the_documents_mention_exist() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut names =
        ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md", "examples/README.md"].map(str::to_owned).to_vec();
    names.extend(crate::book::pages());
    for name in &names {
        for path in document(name).split('`').filter(|word| is_path(word)) {
            assert!(root.join(path.trim_end_matches('/')).exists(), "{name} speaks of `{path}`");
        }
    }
}

/// Whether a quoted word is a path of this repository, from its root.
fn is_path(word: &str) -> bool {
    let folders = [
        ".ci/",
        ".github/",
        "app/",
        "assets/",
        "building/experiments/",
        "common/",
        "convex/",
        "docs/",
        "examples/",
        "packaging/",
        "planners/",
        "python/",
        "scenarios/",
        "tests/",
    ];
    folders.iter().any(|folder| word.starts_with(folder)) && !word.contains(char::is_whitespace)
}

/// Workflows and issue forms are YAML, and the programs of this repository that workflows and the `justfile` start are there.
#[test]
fn workflows_are_valid_yaml_and_run_existing_programs() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut started = document("justfile");
    let mut count = 0;
    for folder in [".github/workflows", ".github/ISSUE_TEMPLATE"] {
        for entry in fs::read_dir(root.join(folder)).expect("a folder") {
            let path = entry.expect("readable").path();
            let text = fs::read_to_string(&path).expect("a text");
            for event in Parser::new_from_str(&text) {
                assert!(event.is_ok(), "{}: {event:?}", path.display());
            }
            started += &text;
            count += 1;
        }
    }
    for other in [".github/dependabot.yml", "CITATION.cff"] {
        for event in Parser::new_from_str(&document(other)) {
            assert!(event.is_ok(), "{other}: {event:?}");
        }
    }
    assert!(count >= 6 && started.contains("\n      - run: .ci/run\n"), "{count} files");
    for test in
        ["python/test.sh", "tests/browser/play.mjs", "tests/browser/play_parts.mjs", ".github/check-subjects.sh"]
    {
        assert!(started.contains(test), "no workflow runs {test}");
    }
    for word in started.split_whitespace().filter(|word| is_path(word) && !word.contains('*')) {
        assert!(root.join(word).exists(), "a workflow or the justfile starts `{word}`");
    }
}

/// The description of the architecture is short enough to read.
#[test]
fn the_architecture_document_keeps_its_length_limit() {
    let words = document("ARCHITECTURE.md").split_whitespace().count();
    assert!((1_000..=2_500).contains(&words), "{words} words");
}

/// The check of subjects accepts imperatives and refuses what is longer, or begins with another word.
#[cfg(unix)]
#[test]
fn commit_subjects_are_imperative_and_short() {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("../.github/check-subjects.sh");
    let accepts = |subject: &str| {
        let input = format!("printf '%s\\n' \"$1\" | {} -", script.display());
        let status = Command::new("bash").args(["-c", &input, "bash", subject]).status().expect("there is a shell");
        status.success()
    };
    let longest = format!("Bound {}", "x".repeat(66));
    for good in ["Bound steering rate in plans", "Pass the seed on", "Embed the font", longest.as_str()] {
        assert!(accepts(good), "{good}");
    }
    let too_long = format!("{longest}x");
    let wrong =
        ["What a dash means", "Plans know their wheels", "Added a test", "bound rates", "Bound rates.", "Adding"];
    for bad in wrong.into_iter().chain([too_long.as_str()]) {
        assert!(!accepts(bad), "{bad}");
    }
}

/// The version that is cited is that of the program.
#[test]
fn the_citation_states_the_version() {
    let stated = format!("\nversion: {}\n", env!("CARGO_PKG_VERSION"));
    assert!(document("CITATION.cff").contains(&stated), "no {stated}");
}
