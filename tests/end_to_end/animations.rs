//! Animations through the binary: the files that are written, the flags that are refused, and the runs, which do not change.

use std::fs;
use std::path::Path;

use crate::command::{Outcome, command, contents, interplay, scratch};

/// A run that is over soon.
const SHORT: [&str; 4] = ["run", "lane-change/front-nice", "--set", "duration_s=4.0"];

fn run(folder: &Path, more: &[&str]) -> Outcome {
    interplay(folder, &[&SHORT[..], more].concat())
}

/// The endings and how the files begin.
#[test]
fn every_animation_format_is_written_completely() {
    let folder = scratch("animate-formats");
    for (file, begins) in [("a/b/run.gif", &b"GIF89a"[..]), ("run.webp", b"RIFF"), ("run.PNG", b"\x89PNG")] {
        let outcome = run(&folder, &["--no-record", "--animate", file]);
        assert!(outcome.code.is_some_and(|code| code <= 1), "{file}: {}", outcome.stderr);
        assert!(outcome.stderr.contains(&format!("animation in {file}")), "{}", outcome.stderr);
        let bytes = fs::read(folder.join(file)).expect("written");
        assert!(bytes.starts_with(begins) && bytes.len() > 5000, "{file}");
    }
    assert_eq!(contents(&folder), ["a", "a/b", "a/b/run.gif", "run.PNG", "run.webp"]);
}

#[test]
fn drawing_an_animation_does_not_change_the_run() {
    let folder = scratch("animate-same");
    let digest = |more: &[&str]| run(&folder, more).json()["digest"].clone();
    let plain = digest(&["--no-record", "--json"]);
    for file in ["one.gif", "two.gif"] {
        assert_eq!(digest(&["--no-record", "--json", "--animate", file]), plain);
    }
    let bytes = |file: &str| fs::read(folder.join(file)).expect("written");
    assert!(bytes("one.gif") == bytes("two.gif"));
}

#[test]
fn an_unknown_ending_is_refused_with_the_list() {
    let folder = scratch("animate-ending");
    for file in ["run.avi", "run", ".gif"] {
        let outcome = run(&folder, &["--animate", file]);
        assert_eq!(outcome.code, Some(2), "{file}: {}", outcome.stderr);
        for ending in [".gif", ".webp", ".png", ".mp4"] {
            assert!(outcome.stderr.contains(ending), "{}", outcome.stderr);
        }
    }
    assert_eq!(contents(&folder), Vec::<String>::new(), "nothing was run");
}

/// Without the program the other endings are named; with it, it is given every picture.
#[cfg(unix)]
#[test]
fn mp4_animations_are_made_by_ffmpeg() {
    use std::os::unix::fs::PermissionsExt;

    let folder = scratch("animate-film");
    let words = [&SHORT[..], &["--no-record", "--animate", "run.mp4"]].concat();
    let outcome: Outcome = command(&folder, &words).env("PATH", &folder).output().expect("runs").into();
    assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
    assert!(outcome.stderr.contains("ffmpeg") && outcome.stderr.contains(".gif"), "{}", outcome.stderr);
    assert_eq!(contents(&folder), Vec::<String>::new());

    let program = folder.join("ffmpeg");
    fs::write(&program, "#!/bin/sh\nfor last; do :; done\n/bin/cat > \"$last\"\n").expect("writes");
    fs::set_permissions(&program, fs::Permissions::from_mode(0o755)).expect("an own file");
    let film = || -> Outcome { command(&folder, &words).env("PATH", &folder).output().expect("runs").into() };
    let outcome = film();
    assert!(outcome.code.is_some_and(|code| code <= 1), "{}", outcome.stderr);
    let bytes = fs::metadata(folder.join("run.mp4")).expect("written").len();
    assert!(bytes > 10 * 720 * 200 * 3 && bytes.is_multiple_of(720 * 3), "{bytes} bytes of pictures");

    fs::write(&program, "#!/bin/sh\n/bin/cat > /dev/null\necho no such codec >&2\nexit 1\n").expect("writes");
    let before = fs::read(folder.join("run.mp4")).expect("there");
    let outcome = film();
    assert_eq!(outcome.code, Some(3), "{}", outcome.stderr);
    assert!(outcome.stderr.contains("no such codec"), "{}", outcome.stderr);
    assert!(fs::read(folder.join("run.mp4")).expect("there") == before, "what stood there is as it was");
}

#[test]
fn an_animation_never_overwrites_an_input_or_another_output() {
    let folder = scratch("animate-overwrites");
    let text = "extends = 'lane-change/front-nice'\ntitle = 'Mine'\nduration_s = 4.0\n";
    fs::write(folder.join("mine.toml"), text).expect("writes");
    fs::write(folder.join("child.toml"), "extends = 'mine.toml'\n").expect("writes");
    // A link with an ending of a picture is the scenario all the same.
    #[cfg(unix)]
    std::os::unix::fs::symlink("mine.toml", folder.join("mine.gif")).expect("a link");
    #[cfg(unix)]
    for scenario in ["mine.toml", "child.toml"] {
        let outcome = interplay(&folder, &["run", scenario, "--no-record", "--animate", "mine.gif"]);
        assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
        assert!(outcome.stderr.contains("would overwrite"), "{}", outcome.stderr);
    }
    let outcome = interplay(&folder, &["run", "mine.toml", "--record", "run.gif", "--animate", "./run.gif"]);
    assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
    assert!(outcome.stderr.contains("cannot both be"), "{}", outcome.stderr);
    assert_eq!(fs::read_to_string(folder.join("mine.toml")).expect("there"), text);
    assert!(!folder.join("run.gif").exists());
}

#[test]
fn an_unwritable_animation_exits_with_code_3_before_any_run() {
    let folder = scratch("animate-unwritable");
    fs::write(folder.join("file"), "mine").expect("writes");
    fs::create_dir(folder.join("folder.gif")).expect("makes");
    for file in ["file/run.gif", "folder.gif"] {
        let outcome = run(&folder, &["--no-record", "--animate", file]);
        assert_eq!(outcome.code, Some(3), "{file}: {}", outcome.stderr);
        assert!(outcome.stderr.contains("cannot write the animation"), "{}", outcome.stderr);
        assert_eq!(outcome.stdout, "", "nothing was run");
    }
    assert_eq!(contents(&folder), ["file", "folder.gif"]);
}

#[test]
fn a_suite_animates_only_failed_scenarios() {
    let folder = scratch("animate-failures");
    fs::create_dir(folder.join("mine")).expect("makes");
    fs::write(folder.join("mine/good.toml"), "extends = 'lane-change/front-nice'\ntitle = 'Good'\n").expect("writes");
    fs::write(
        folder.join("mine/bad.toml"),
        "extends = 'lane-change/front-nice'\ntitle = 'Bad'\n[expect]\norder = ['rear', 'front', 'ego']\n",
    )
    .expect("writes");
    let outcome = interplay(&folder, &["suite", "mine", "--animate-failures", "failures"]);
    assert_eq!(outcome.code, Some(1), "{}{}", outcome.stdout, outcome.stderr);
    assert_eq!(contents(&folder.join("failures")), ["bad.gif"]);
    assert!(fs::read(folder.join("failures/bad.gif")).expect("there").starts_with(b"GIF89a"));
    fs::write(folder.join("taken"), "mine").expect("writes");
    let outcome = interplay(&folder, &["suite", "mine", "--animate-failures", "taken"]);
    assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
    assert!(outcome.stderr.contains("is not a folder"), "{}", outcome.stderr);
}
