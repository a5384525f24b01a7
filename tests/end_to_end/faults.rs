//! Fault and kill loops, in short: at a sample of the changes that a command makes to files the disk fails, or the command is
//! killed, or memory runs out. `tests/faults/loops.py` has the whole, and `docs/evidence/reliability.md` its counts.

#![allow(clippy::print_stderr, reason = "a test that skips says so")]

use std::path::Path;
use std::process::Command;

fn loops(commands: &[&str]) {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("faults/loops.py");
    let mut command = Command::new("python3");
    command.arg(script).args(["--short", "--binary"]).arg(env!("CARGO_BIN_EXE_interplay-under-test")).args(commands);
    let Ok(output) = command.output() else {
        eprintln!("skipped: no python3 here");
        return;
    };
    let [stdout, stderr] = [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text).into_owned());
    eprintln!("{stdout}");
    assert!(output.status.success(), "{stdout}\n{stderr}");
}

#[test]
fn a_full_disk_leaves_complete_files_and_exits_with_code_3() {
    loops(&["run", "suite --junit", "new"]);
}

#[test]
fn an_interrupted_sweep_can_be_continued() {
    loops(&["sweep"]);
}
