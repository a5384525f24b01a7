//! `interplay export-fmu`: an archive that other programs read. What the unit computes is tested in `app/fmu/`, and in FMPy by
//! `tests/peers/fmu.py`.

use std::fs;
use std::path::Path;

use crate::command::{Outcome, interplay, scratch};

const LOCAL_HEADER: &[u8] = b"PK\x03\x04";

/// The files of an archive that stores them as they are.
fn stored_files(archive: &[u8]) -> Vec<(String, Vec<u8>)> {
    let number = |at: usize, bytes: usize| (0..bytes).rev().fold(0, |sum, i| 256 * sum + usize::from(archive[at + i]));
    let (mut files, mut at) = (Vec::new(), 0);
    while archive[at..].starts_with(LOCAL_HEADER) {
        assert_eq!(number(at + 8, 2), 0, "stored");
        let (size, name_length, extra) = (number(at + 22, 4), number(at + 26, 2), number(at + 28, 2));
        let name = String::from_utf8(archive[at + 30..at + 30 + name_length].to_vec()).expect("a name");
        let start = at + 30 + name_length + extra;
        files.push((name, archive[start..start + size].to_vec()));
        at = start + size;
    }
    files
}

fn export(folder: &Path, more: &[&str]) -> Outcome {
    interplay(folder, &[&["export-fmu", "building/four-room-pid", "--out", "rooms.fmu"], more].concat())
}

#[test]
fn an_fmu_is_complete_and_its_export_reproducible() {
    let folder = scratch("fmu");
    let outcome = export(&folder, &["--reference", "rooms.csv"]);
    assert_eq!((outcome.code, outcome.stdout.as_str()), (Some(0), ""), "{outcome:?}");
    let archive = fs::read(folder.join("rooms.fmu")).expect("it was written");
    let files = stored_files(&archive);
    let names: Vec<&str> = files.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!((names[0], names[2]), ("modelDescription.xml", "resources/plant.txt"), "{names:?}");
    assert!(names[1].starts_with("binaries/") && files[1].1.len() > 10_000, "{names:?}");
    let text = |index: usize| String::from_utf8(files[index].1.clone()).expect("text");
    let (description, resources) = (text(0), text(2));
    let guid = resources.lines().find_map(|line| line.strip_prefix("guid ")).expect("an identity");
    for piece in
        [guid, "fmiVersion=\"2.0\"", "room 1.heat", "room 4.temperature", "stopTime=\"864000\"", "stepSize=\"1800\""]
    {
        assert!(description.contains(piece), "{piece}:\n{description}");
    }
    let table = fs::read_to_string(folder.join("rooms.csv")).expect("it was written");
    assert_eq!(table.lines().count(), 1 + 480);
    assert!(table.starts_with("time_s,room 1.heat_kw,"), "{table}");
    assert_eq!(export(&folder, &[]).code, Some(0));
    assert_eq!(fs::read(folder.join("rooms.fmu")).expect("it was written"), archive);
    // Other weather is another unit.
    assert_eq!(export(&folder, &["--set", "seed=5"]).code, Some(0));
    assert_ne!(fs::read(folder.join("rooms.fmu")).expect("it was written"), archive);
}

/// The folder of the binaries, the description and the resources of an export of four rooms.
fn exported(folder: &Path, more: &[&str]) -> (String, String, Vec<u8>) {
    let outcome = export(folder, more);
    assert_eq!(outcome.code, Some(0), "{outcome:?}");
    let mut files = stored_files(&fs::read(folder.join("rooms.fmu")).expect("it was written")).into_iter();
    let mut next = || files.next().expect("three files");
    let (description, library, resources) = (next(), next(), next());
    assert_eq!((description.0.as_str(), resources.0.as_str()), ("modelDescription.xml", "resources/plant.txt"));
    let text = String::from_utf8(description.1).expect("text");
    (library.0.rsplit_once('/').expect("a folder").0.to_owned(), text, resources.1)
}

#[test]
fn both_fmi_versions_contain_the_same_resources() {
    let folder = scratch("fmu-versions");
    let (two, three) = (exported(&folder, &["--fmi", "2.0"]), exported(&folder, &["--fmi", "3.0"]));
    assert_eq!(two.2, three.2);
    assert_eq!(two, exported(&folder, &[]), "2.0 is the default");
    for (description, pieces) in [
        (&two.1, ["fmiVersion=\"2.0\"", "canGetAndSetFMUstate=\"true\"", "canSerializeFMUstate=\"true\""]),
        (&three.1, ["fmiVersion=\"3.0\"", "canGetAndSetFMUState=\"true\"", "canSerializeFMUState=\"true\""]),
    ] {
        let once = "canBeInstantiatedOnlyOncePerProcess=\"false\"";
        for piece in pieces.into_iter().chain([once, "room 1.heat", "room 4.gains", "stepSize=\"1800\""]) {
            assert!(description.contains(piece), "{piece}:\n{description}");
        }
    }
    if cfg!(all(target_os = "linux", target_arch = "x86_64")) {
        assert_eq!((two.0.as_str(), three.0.as_str()), ("binaries/linux64", "binaries/x86_64-linux"));
    }
    let outcome = export(&folder, &["--fmi", "1.0"]);
    assert_eq!(outcome.code, Some(2), "{outcome:?}");
    assert!(outcome.stderr.contains("2.0") && outcome.stderr.contains("3.0"), "{outcome:?}");
}

#[test]
fn a_failed_fmu_export_gives_the_reason_and_writes_no_file() {
    let folder = scratch("fmu-refused");
    let plant = "building.plant={ kind = \"socket\", address = \"localhost:1\" }";
    let refused: [(&str, &[&str], &str); 5] = [
        ("lane-change/front-nice", &[], "no building"),
        ("building/four-room-pid", &["--set", plant], "another program"),
        ("building/hundred-zones", &["--set", "building.grid={ rows = 20, columns = 30 }"], "at most 500"),
        ("building/hundred-zones", &["--set", "building.step_s=900", "--set", "iterations=900"], "lower `iterations`"),
        ("building/unknown", &[], "building/unknown"),
    ];
    for (scenario, more, said) in refused {
        let outcome = interplay(&folder, &[&["export-fmu", scenario, "--out", "out.fmu"], more].concat());
        assert_eq!((outcome.code, outcome.stdout.as_str()), (Some(2), ""), "{outcome:?}");
        assert!(outcome.stderr.contains(said), "`{said}` is not said in:\n{}", outcome.stderr);
        assert!(!folder.join("out.fmu").exists());
    }
    let same = export(&folder, &["--reference", "rooms.fmu"]);
    assert_eq!(same.code, Some(2), "{same:?}");
    assert!(!folder.join("rooms.fmu").exists());
    fs::write(folder.join("my.toml"), "extends = 'building/four-room-pid'\ntitle = 'Mine'\nshows = 'Mine'\n")
        .expect("written");
    let own = interplay(&folder, &["export-fmu", "my.toml", "--out", "my.toml"]);
    assert_eq!(own.code, Some(2), "{own:?}");
    let nowhere = interplay(&folder, &["export-fmu", "my.toml", "--out", "my.toml/x.fmu"]);
    assert_eq!(nowhere.code, Some(3), "{nowhere:?}");
}
