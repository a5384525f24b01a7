//! Errors of missing and unreadable files, and of files that extend others.

mod common;

use std::fs;

use common::Catalogue;
use interplay_scenarios::{SweepPlan, load};

/// A scenario with a misspelt key.
const PARENT: &str = r#"title = "Two cars"
shows = "One follows the other"
duration_s = 5.0

[road]
kind = "lanes"
lane_count = 2

[[vehicle]]
name = "ego"
start = { x_m = 0.0, y_m = 0.185, speed_mps = 1.0 }
goal = { lane = 1 }
driver = { kind = "negotiation", beta = 0.8 }

[[vehicle]]
name = "front"
start = { x_m = 1.0, y_m = 0.185, speed_mps = 1.0 }
body = { widht_m = 0.19 }
driver = { kind = "human", style = "nice" }

[expect]
no_collision = true
order = ["front", "ego"]

[[expect.completes]]
vehicle = "ego"
before_s = 4.0
"#;

#[test]
fn missing_files_are_reported_with_help() {
    let mut errors = Catalogue::default();
    errors.add("no_such_name", load("lane-change/front-nicer", &[]), 100);
    errors.add("no_such_name_near", load("something-else-entirely", &[]), 100);
    errors.add("no_such_file", load("front-tuogh.toml", &[]), 100);
    errors.add("no_name", load("", &[]), 100);
    insta::assert_snapshot!("missing_files", errors.0);
}

#[test]
fn unreadable_files_are_reported_with_the_reason() {
    let mut errors = Catalogue::default();
    let folder = tempfile::tempdir().expect("a temporary folder");
    let write = |name: &str, bytes: &[u8]| fs::write(folder.path().join(name), bytes).expect("a writable folder");
    write("empty.toml", b"");
    write("blank.toml", b"\n  \n");
    write("binary.toml", b"title = 'a'\n\x80\xff");
    let mut state = 1_u32;
    let random = (0..10 << 20).map(|_| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        state.to_be_bytes()[0]
    });
    write("large.toml", &random.collect::<Vec<u8>>());
    errors.file(folder.path(), "empty.toml");
    errors.file(folder.path(), "blank.toml");
    errors.file(folder.path(), "binary.toml");
    errors.file(folder.path(), "large.toml");
    errors.file(folder.path(), "");
    insta::assert_snapshot!("unreadable_files", errors.0);
}

#[test]
fn errors_in_chains_of_extended_files_are_located() {
    let mut errors = Catalogue::default();
    let folder = tempfile::tempdir().expect("a temporary folder");
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("a writable folder");
    write("a.toml", "extends = 'b.toml'\ntitle = 'a'\n");
    write("b.toml", "title = 'b'\nextends = 'a.toml'\n");
    write("itself.toml", "extends = 'itself.toml'\n");
    write("orphan.toml", "title = 'a'\nextends = 'front-nise.toml'\n");
    write("list.toml", "extends = ['a.toml']\n");
    write("parent.toml", PARENT);
    write("child.toml", "extends = 'parent.toml'\ntitle = 'The error is my parent’s'\n");
    errors.file(folder.path(), "a.toml");
    errors.file(folder.path(), "itself.toml");
    errors.file(folder.path(), "orphan.toml");
    errors.file(folder.path(), "list.toml");
    errors.file(folder.path(), "child.toml");
    insta::assert_snapshot!("chains_of_files", errors.0);
}

const SECRET: &str = "root:x:0:0:root:/root:/bin/bash\nalice:$6$secret:1000:1000::/home/alice:/bin/sh\n";

/// A scenario may name any file, and its user may not be its author: errors show no text of a file of another kind.
#[test]
fn errors_do_not_show_the_text_of_files_of_another_kind() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let write = |name: &str, text: &[u8]| {
        let path = folder.path().join(name);
        fs::write(&path, text).expect("a writable folder");
        path.to_string_lossy().into_owned()
    };
    write("passwd", SECRET.as_bytes());
    write("passwd.csv", format!("time,{}\n{}\n", "a".repeat(50), SECRET.repeat(3).replace('\n', ",")).as_bytes());
    write("latin", b"root = 'secret \xe4'\n");
    let house = "title = 'h'\nshows = 'h'\n[building]\n[[building.zone]]\nname = 'z'\n[[building.wall]]\n\
        between = ['z', 'ambient']\nresistance_k_per_kw = 30.0\n";
    let car =
        "title = 'c'\nshows = 'c'\n[[vehicle]]\nname = 'car'\nstart = { lane = 0, along_m = 1.0, speed_mps = 0.5 }\n";
    for (text, words) in [
        (
            "extends = 'passwd'\n".to_owned(),
            ["mine.toml:1:11", "`FOLDER/passwd` is not a scenario: its line 1 is not valid TOML"],
        ),
        ("extends = 'latin'\n".to_owned(), ["mine.toml:1:11", "`FOLDER/latin` is not UTF-8 text"]),
        (format!("{house}[weather]\nkind = 'epw'\nfile = 'passwd'\n"), ["passwd:1:1", "begins with `LOCATION,`"]),
        (
            format!("{house}[weather]\nkind = 'csv'\nfile = 'passwd'\ntemperature = 'T'\n"),
            ["passwd:2:1", "a text of 46 characters"],
        ),
        (
            format!("{house}[weather]\nkind = 'csv'\nfile = 'passwd.csv'\ntemperature = 'T'\n"),
            ["passwd.csv:2:1", "fields"],
        ),
        (format!("{house}[tariff]\nfile = 'passwd'\n"), ["passwd:2:1", "is not a table of prices"]),
        (format!("{house}[[gains]]\nfile = 'passwd'\n"), ["passwd:2:1", "is not a table of gains"]),
        (format!("{car}driver = {{ kind = 'recorded', file = 'passwd' }}\n"), ["passwd:1:1", "has no column"]),
    ] {
        let path = write("mine.toml", text.as_bytes());
        let error = load(&path, &[]).expect_err("it names no such file");
        let shown = common::rendered(&error, 2000).replace(&*folder.path().to_string_lossy(), "FOLDER");
        assert!(words.iter().all(|word| shown.contains(word)), "{words:?} in\n{shown}");
        assert!(!["root:", "secret", "alice", "/bin/"].iter().any(|word| shown.contains(word)), "{shown}");
    }
    let plan = format!("title = 'p'\nscenario = [{:?}]\n", write("passwd", SECRET.as_bytes()));
    let error = SweepPlan::from_text("plan.toml", &plan, folder.path()).err().expect("no scenario");
    let shown = common::rendered(&error, 2000);
    assert!(shown.contains("plan.toml:2:13") && shown.contains("its line 1 is not valid TOML"), "{shown}");
    assert!(!shown.contains("root:"), "{shown}");
}
