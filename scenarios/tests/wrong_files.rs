//! Files that are not there or cannot be read, and what is said of them; as `errors.rs`.

mod common;

use std::fs;

use common::Catalogue;
use interplay_scenarios::load;

#[test]
fn missing_files() {
    let mut errors = Catalogue::default();
    errors.error("no_such_name", load("lane-change/front-nicer", &[]), &["did you mean", "lane-change/front-nice"]);
    errors.error("no_such_name_near", load("something-else-entirely", &[]), &["interplay list"]);
    errors.error("no_such_file", load("front-tuogh.toml", &[]), &["no file", "lane-change/front-tough"]);
    errors.error("no_name", load("", &[]), &["no scenario and no file"]);
    insta::assert_snapshot!("missing_files", errors.0);
}

#[test]
fn unreadable_files() {
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
