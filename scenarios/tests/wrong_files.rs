//! Errors of missing and unreadable files; as `errors.rs`.

mod common;

use std::fs;

use common::Catalogue;
use interplay_scenarios::{SweepPlan, load};

#[test]
fn missing_files_are_reported_with_help() {
    let mut errors = Catalogue::default();
    errors.error("no_such_name", load("lane-change/front-nicer", &[]), &["did you mean", "lane-change/front-nice"]);
    errors.error("no_such_name_near", load("something-else-entirely", &[]), &["interplay list"]);
    errors.error("no_such_file", load("front-tuogh.toml", &[]), &["no file", "lane-change/front-tough"]);
    errors.error("no_name", load("", &[]), &["no scenario and no file"]);
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
    errors.file(folder.path(), "empty.toml", &["is empty", "`title`"]);
    errors.file(folder.path(), "blank.toml", &["is empty"]);
    errors.file(folder.path(), "binary.toml", &["binary.toml:2:1", "not UTF-8"]);
    errors.file(folder.path(), "large.toml", &["larger than 1 MiB"]);
    errors.file(folder.path(), "", &["is a directory"]);
    insta::assert_snapshot!("unreadable_files", errors.0);
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
