//! Every example runs to its end and prints something, and the page of the examples lists it.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

/// The names of the files beside the manifest.
fn names() -> Vec<String> {
    let entries = fs::read_dir(env!("CARGO_MANIFEST_DIR")).expect("the folder of the examples");
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
        assert!(program.exists(), "{name} is not built: run `cargo test -p interplay-examples` without `--test`");
        let done = Command::new(program).arg(scratch.join(&name)).output().expect("started");
        assert!(done.status.success(), "{name}: {}", String::from_utf8_lossy(&done.stderr));
        assert!(!done.stdout.is_empty(), "{name} prints nothing");
    }
}

#[test]
fn the_page_lists_every_example() {
    let page = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("README.md")).expect("the page");
    let names = names();
    assert!(names.len() > 2, "{names:?}");
    for name in names {
        assert!(page.contains(&format!("| `{name}` |")), "examples/README.md does not list {name}");
    }
}
