//! Every example runs to its end and prints something, is short, and is on the page of the examples.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

/// The most lines of an example.
const MOST_LINES: usize = 65;

fn sources() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples")
}

fn names() -> Vec<String> {
    let entries = fs::read_dir(sources()).expect("the folder of the examples");
    let paths = entries.map(|entry| entry.expect("readable").path());
    let sources = paths.filter(|path| path.extension().is_some_and(|extension| extension == "rs"));
    sources.filter_map(|path| Some(path.file_stem()?.to_str()?.to_owned())).collect()
}

/// Where Cargo puts the examples that it builds together with this test.
fn folder() -> PathBuf {
    let test = env::current_exe().expect("this test has a path");
    test.ancestors().nth(2).expect("it is in `deps`").join("examples")
}

#[test]
fn every_example_runs() {
    let scratch = Path::new(env!("CARGO_TARGET_TMPDIR"));
    for name in names() {
        let program = folder().join(format!("{name}{}", env::consts::EXE_SUFFIX));
        assert!(program.exists(), "{name} is not built: run `cargo test -p interplay` without `--test`");
        let done = Command::new(program).arg(scratch.join(&name)).output().expect("started");
        assert!(done.status.success(), "{name}: {}", String::from_utf8_lossy(&done.stderr));
        assert!(!done.stdout.is_empty(), "{name} prints nothing");
    }
}

#[test]
fn every_example_is_short_and_on_the_page() {
    let page = fs::read_to_string(sources().join("README.md")).expect("the page");
    let names = names();
    assert!(names.len() > 3, "{names:?}");
    for name in names {
        assert!(page.contains(&format!("| `{name}` |")), "examples/README.md does not list {name}");
        let text = fs::read_to_string(sources().join(format!("{name}.rs"))).expect("a source");
        assert!(text.lines().count() <= MOST_LINES, "{name} has more than {MOST_LINES} lines");
    }
}
