//! The recording: there after a run that was finished, whole, and nowhere else.

use std::fs;
use std::path::Path;
use std::thread::sleep;
use std::time::Duration;

use interplay_scenarios::load;

use crate::command::{command, contents, interplay, scratch};

const SHORT: [&str; 4] = ["run", "lane-change/front-tough", "--set", "duration_s=1"];

/// The first bytes of every Rerun recording.
fn is_recording(path: &Path) -> bool {
    fs::read(path).is_ok_and(|bytes| bytes.starts_with(b"RRF") && bytes.len() > 10_000)
}

fn short(folder: &Path, more: &[&str]) -> String {
    let outcome = interplay(folder, &[&SHORT[..], &["--set", "expect.completes=[]"], more].concat());
    assert!(matches!(outcome.code, Some(0 | 1)), "{outcome:?}");
    outcome.stderr
}

#[test]
fn a_recording_is_written_under_the_name_of_its_scenario() {
    let folder = scratch("default-recording");
    let said = short(&folder, &[]);
    assert!(
        said.starts_with(
            "recorded to recordings/lane-change/front-tough.rrd (`--no-record` writes none); to open it: "
        ),
        "{said}"
    );
    assert!(said.ends_with(" view recordings/lane-change/front-tough.rrd\n"), "{said}");
    let place = "recordings/lane-change/front-tough.rrd";
    assert_eq!(contents(&folder), ["recordings", "recordings/lane-change", place]);
    assert!(is_recording(&folder.join(place)));
}

#[test]
fn a_recording_is_written_to_the_path_of_the_flag_and_replaces_a_file() {
    let folder = scratch("named-recording");
    fs::write(folder.join("my.rrd"), "an old one").expect("a scratch file can be written");
    short(&folder, &["--record", "my.rrd"]);
    short(&folder, &["--record", "new/folder/my.rrd"]);
    assert_eq!(contents(&folder), ["my.rrd", "new", "new/folder", "new/folder/my.rrd"]);
    assert!(is_recording(&folder.join("my.rrd")) && is_recording(&folder.join("new/folder/my.rrd")));
}

/// A file elsewhere is recorded here, whether or not its name has an extension.
#[test]
fn a_recording_never_leaves_its_folder() {
    let folder = scratch("recording-of-a-file");
    let text = r#"
        title = "Alone"
        shows = "A short drive"
        duration_s = 0.2
        vehicle = [{ name = "ego", start = { x_m = 0.0, y_m = 0.185, speed_mps = 1.0 } }]
    "#;
    fs::create_dir(folder.join("here")).expect("a folder can be made");
    for name in ["one", "two.toml"] {
        fs::write(folder.join(name), text).expect("a scratch file can be written");
        let outcome = interplay(&folder.join("here"), &["run", &format!("../{name}")]);
        assert_eq!(outcome.code, Some(0), "{outcome:?}");
    }
    let expected = ["here", "here/recordings", "here/recordings/one.rrd", "here/recordings/two.rrd", "one", "two.toml"];
    assert_eq!(contents(&folder), expected);
}

/// A recording shows the command that repeats it.
#[test]
fn a_recording_contains_the_command_that_repeats_it() {
    let folder = scratch("repeat");
    short(&folder, &["--seed", "77", "--record", "my.rrd"]);
    let bytes = fs::read(folder.join("my.rrd")).expect("there is a recording");
    // The rest of the line is compressed.
    let command = b"Command: `interplay run";
    assert!(bytes.windows(command.len()).any(|window| window == command));
}

#[test]
fn no_record_writes_no_recording() {
    let folder = scratch("no-record");
    assert_eq!(short(&folder, &["--no-record"]), "");
    assert!(contents(&folder).is_empty());
}

/// A process that is killed half-way leaves no file that looks like a recording.
#[test]
fn a_run_that_is_killed_leaves_no_recording() {
    let folder = scratch("killed");
    let arguments = ["run", "--set", "duration_s=1000", "--record", "my.rrd"];
    let mut child = command(&folder, &arguments).spawn().expect("the command can be started");
    sleep(Duration::from_secs(1));
    assert!(child.try_wait().expect("the command can be asked").is_none(), "it ended too soon to be killed");
    child.kill().expect("the command can be killed");
    child.wait().expect("the command ends");
    let left = contents(&folder);
    assert!(left.iter().all(|name| name.starts_with('.') && name.ends_with(".part")), "{left:?}");
}

/// A run of 12 s takes about 1 MB; a building of a hundred rooms, of which every zone is drawn, less than 3 MB for ten days.
#[test]
fn recordings_keep_their_size_limit() {
    let folder = scratch("recording-size");
    for (name, most_bytes) in [("lane-change/front-nice", 2_000_000), ("building/hundred-zones", 5_000_000)] {
        interplay(&folder, &["run", name, "--record", "size.rrd"]);
        let bytes = fs::metadata(folder.join("size.rrd")).expect("there is a recording").len();
        assert!(bytes > 100_000 && bytes < most_bytes, "{name}: {bytes} bytes");
    }
}

/// Budgets are judged by what `check` states. Zones with plots of their own make more than those of a large building.
#[test]
fn recordings_are_about_as_large_as_stated() {
    let folder = scratch("recording-stated");
    let names =
        ["lane-change/front-nice", "building/four-room-pid", "building/distributed-sixteen", "building/hundred-zones"];
    for name in names {
        interplay(&folder, &["run", name, "--record", "size.rrd"]);
        let mb = fs::metadata(folder.join("size.rrd")).expect("there is a recording").len() as f64 / 1e6;
        let stated_mb = load(name, &[]).expect("authored").cost().recorded_mb;
        assert!(mb < 1.5 * stated_mb && mb > stated_mb / 2.5, "{name}: {mb} MB, stated are {stated_mb} MB");
    }
}
