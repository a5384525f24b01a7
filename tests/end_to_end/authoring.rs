//! Authoring: from an embedded scenario to a new one, with completion in an editor and a run at every save.

use std::fs;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Stdio};

use interplay_scenarios::embedded;
use serde_json::Value;

use crate::command::{command, contents, interplay, scratch};

fn digest(folder: &Path, scenario: &str) -> Value {
    let report = interplay(folder, &["run", scenario, "--no-record", "--json"]).json();
    let days = &report["building"]["iterations"];
    let costs = days.as_array().into_iter().flatten().map(|day| day["cost"].clone()).collect::<Vec<_>>();
    serde_json::json!([report["digest"], costs])
}

#[test]
fn a_new_scenario_is_valid_and_runs_like_its_original() {
    let folder = scratch("new");
    for (origin, name) in [("lane-change/front-nice", "mine.toml"), ("building/four-room-pid", "house.toml")] {
        let outcome = interplay(&folder, &["new", name, "--from", origin]);
        assert_eq!((outcome.code, outcome.stderr.as_str()), (Some(0), ""), "{outcome:?}");
        assert!(outcome.stdout.contains(&format!("interplay run {name}")), "{outcome:?}");
        let checked = interplay(&folder, &["check", name]);
        assert_eq!(checked.code, Some(0), "{checked:?}");
        assert_eq!(digest(&folder, name), digest(&folder, origin), "{name}");
    }
    assert_eq!(contents(&folder), ["house.toml", "interplay.schema.json", "mine.toml"]);
    let text = fs::read_to_string(folder.join("mine.toml")).expect("just written");
    let named = text.lines().next().and_then(|line| line.strip_prefix("#:schema ")).expect("editors look there");
    let beside: Value = serde_json::from_str(&fs::read_to_string(folder.join(named)).expect("there")).expect("JSON");
    assert_eq!(beside, published_schema());
}

#[test]
fn new_never_overwrites_files_and_leaves_none_when_it_fails() {
    let folder = scratch("new-refused");
    let cases: [(&[&str], &str); 3] = [
        (&["new", "mine.toml"], "exists already"),
        (&["new", "other.toml", "--from", "lane-change/front-nise"], "did you mean"),
        (&["new", "other.toml", "--from", "broken.toml"], "unknown key"),
    ];
    fs::write(folder.join("mine.toml"), "mine").expect("a scratch file");
    fs::write(folder.join("broken.toml"), "extends = 'lane-change/front-nice'\nspede = 1").expect("a scratch file");
    for (arguments, said) in cases {
        let outcome = interplay(&folder, arguments);
        assert!(outcome.code == Some(2) && outcome.stderr.contains(said), "{outcome:?}");
    }
    assert_eq!(contents(&folder), ["broken.toml", "mine.toml"]);
    assert_eq!(fs::read(folder.join("mine.toml")).expect("still there"), b"mine");
}

/// The schema of the command, with the kinds of drivers that the library does not know; the first line of every authored scenario names it.
fn published_schema() -> Value {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios/schema.json");
    serde_json::from_str(&fs::read_to_string(path).expect("there")).expect("JSON")
}

/// `INTERPLAY_BLESS=1` rewrites the file.
#[test]
fn the_schema_command_prints_the_schema_that_shipped_files_name() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios/schema.json");
    let printed = interplay(&scratch("schema"), &["schema"]);
    if std::env::var_os("INTERPLAY_BLESS").is_some() {
        fs::write(&path, &printed.stdout).expect("the file can be written");
    }
    assert_eq!(
        printed.json(),
        published_schema(),
        "renew it: INTERPLAY_BLESS=1 cargo test --release -p interplay-tests schema"
    );
    let path = path.canonicalize().expect("there");
    for file in embedded() {
        let line = file.text.lines().next().and_then(|line| line.strip_prefix("#:schema "));
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios/files").join(file.name);
        let named = folder.with_file_name(line.unwrap_or("no such line"));
        assert_eq!(named.canonicalize().ok().as_ref(), Some(&path), "{}: {}", file.name, named.display());
    }
}

/// How long it takes is measured by a benchmark of the scenarios crate.
#[test]
fn all_embedded_files_are_checked_in_one_call() {
    let names: Vec<&str> = embedded().iter().map(|file| file.name).collect();
    let outcome = interplay(&scratch("check-all"), &[&["check"], &names[..]].concat());
    assert_eq!(outcome.code, Some(0), "{outcome:?}");
    assert_eq!(outcome.stdout.lines().filter(|line| line.starts_with("ok  ")).count(), names.len());
}

#[test]
fn shells_complete_every_command_and_every_command_has_a_manual_page() {
    let folder = scratch("shells");
    let help = interplay(&folder, &["--help"]).stdout;
    let listed = help.split("Commands:\n").nth(1).and_then(|rest| rest.split("\n\n").next()).expect("a list");
    let commands: Vec<&str> = listed.lines().filter_map(|line| line.strip_prefix("  ")?.split(' ').next()).collect();
    let commands: Vec<&str> = commands.into_iter().filter(|name| !matches!(*name, "" | "help")).collect();
    assert!(commands.contains(&"run") && commands.contains(&"new"), "{help}");
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = interplay(&folder, &["completions", shell]).stdout;
        for word in commands.iter().chain(&["no-record"]) {
            assert!(script.contains(word), "{shell} does not know {word}");
        }
        let has_names = script.contains("lane-change/front-nice");
        assert!(has_names || ["elvish", "powershell"].contains(&shell), "{shell} does not know scenarios");
    }
    for name in commands {
        let page = interplay(&folder, &["man", name]).stdout;
        assert!(page.contains(&format!(".TH interplay-{name} 1")), "{page}");
        let usage = interplay(&folder, &[name, "--help"]).stdout;
        assert!(usage.contains("Example"), "`interplay {name} --help` has no example");
    }
    assert!(interplay(&folder, &["man"]).stdout.contains(".TH interplay 1"));
    assert_eq!(interplay(&folder, &["man", "dance"]).code, Some(2));
}

/// A command `rerun` that says it is of that version and writes down what it was asked to show.
#[cfg(unix)]
fn viewer(folder: &Path, version: &str) {
    use std::os::unix::fs::PermissionsExt;
    let script = format!(
        "#!/bin/sh\nif [ \"$1\" = --version ]; then echo 'rerun-cli {version} [rustc 1.90.0] x86_64'; else echo \"$@\" > shown; fi\n"
    );
    fs::create_dir_all(folder.join("bin")).expect("a scratch folder");
    let path = folder.join("bin/rerun");
    fs::write(&path, script).expect("a scratch file");
    fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).expect("our own file");
}

#[cfg(unix)]
#[test]
fn view_opens_the_matching_viewer_or_explains_its_installation() {
    let folder = scratch("view");
    let made =
        interplay(&folder, &["run", "--set", "duration_s=0.2", "--set", "expect.completes=[]", "--record", "my.rrd"]);
    assert!(folder.join("my.rrd").exists(), "{made:?}");
    fs::write(folder.join("no.rrd"), "a text").expect("a scratch file");
    let path = format!("{}:/bin:/usr/bin", folder.join("bin").display());
    let view = |file: &str| {
        let output = command(&folder, &["view", file]).env("PATH", &path).output().expect("it can be started");
        (output.status.code(), String::from_utf8(output.stderr).expect("UTF-8"))
    };
    let (code, said) = view("my.rrd");
    assert!(code == Some(3) && said.contains("pip install rerun-sdk==0.36.3") && said.lines().count() == 1, "{said}");
    viewer(&folder, "0.35.0");
    let (code, said) = view("my.rrd");
    assert!(code == Some(3) && said.contains("version 0.35.0") && said.contains("rerun-sdk==0.36.3"), "{said}");
    assert!(!folder.join("shown").exists());
    viewer(&folder, "0.36.3");
    assert_eq!(view("my.rrd"), (Some(0), String::new()));
    assert_eq!(fs::read_to_string(folder.join("shown")).expect("it was asked"), "my.rrd\n");
    for wrong in ["no.rrd", "missing.rrd", "."] {
        let (code, said) = view(wrong);
        assert!(code == Some(2) && said.contains("interplay run"), "{wrong}: {said}");
    }
}

/// A process that ends with the test.
struct Background(Child);

impl Drop for Background {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

#[test]
fn watch_runs_again_when_a_file_or_its_parent_is_saved() {
    let folder = scratch("watch");
    // At once: a file that is empty for as long as it takes to look twice would be run, too.
    let write = |name: &str, text: &str| {
        fs::write(folder.join("new"), text).expect("a scratch file");
        fs::rename(folder.join("new"), folder.join(name)).expect("a scratch file");
    };
    write("parent.toml", "extends = 'lane-change/front-nice'\nduration_s = 0.3\n[expect]\ncompletes = []\n");
    write("mine.toml", "extends = 'parent.toml'\ntitle = 'First'\n");
    let mut started = command(&folder, &["run", "mine.toml", "--watch", "--no-record"]);
    let started = started.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("it can be started");
    let mut process = Background(started);
    let mut said = BufReader::new(process.0.stderr.take().expect("piped")).lines().map(|line| line.expect("UTF-8"));
    let mut printed = BufReader::new(process.0.stdout.take().expect("piped")).lines().map(|line| line.expect("UTF-8"));
    let mut until_watching = || said.by_ref().take_while(|line| !line.starts_with("watching")).collect::<Vec<_>>();
    let mut title = |word: &str| printed.by_ref().find(|line| line.starts_with(word));
    assert!(until_watching().is_empty());
    assert!(title("First").is_some());
    write("mine.toml", "extends = 'parent.toml'\ntitle = 'Second'\n");
    assert!(until_watching().is_empty());
    assert!(title("Second").is_some());
    write("parent.toml", "extends = 'lane-change/front-nice'\nduration_s = -0.4\n");
    assert!(until_watching().join("\n").contains("parent.toml:2"), "the error is shown, and watching goes on");
    write("parent.toml", "extends = 'lane-change/front-nice'\nduration_s = 0.40\n[expect]\ncompletes = []\n");
    assert!(until_watching().is_empty());
    assert!(title("  0.4 s simulated").is_some());
}

#[test]
fn only_files_can_be_watched() {
    let outcome = interplay(&scratch("watch-nothing"), &["run", "--watch"]);
    assert!(outcome.code == Some(2) && outcome.stderr.contains("interplay new"), "{outcome:?}");
}
