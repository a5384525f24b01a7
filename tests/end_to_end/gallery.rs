//! The gallery has an animation of every family of scenarios and of every kind of driver and controller, and is not too large.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use interplay_scenarios::{Override, Registry, Scenario, embedded, load};

/// Largest size of all animations together \[bytes\].
const MOST_BYTES: u64 = 15_000_000;

/// An animation: its file, and the scenario that it shows.
pub(crate) struct Entry {
    pub file: String,
    family: String,
    pub scenario: Scenario,
}

fn docs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs")
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The entries of the gallery: a line with the arguments of `interplay run`, and below it the picture.
pub(crate) fn entries() -> Vec<Entry> {
    let text = read(&docs().join("reference/gallery.md"));
    let mut command = None;
    let mut entries = Vec::new();
    for line in text.lines() {
        if let Some(words) = line.strip_suffix("`.").and_then(|line| line.rsplit('`').next()) {
            command = Some(words.to_owned());
        }
        let Some((_, file)) = line.split_once("](../gallery/").filter(|_| line.starts_with("![")) else { continue };
        let command = command.take().unwrap_or_else(|| panic!("no command above {file}"));
        let mut parts = command.split(" --set ");
        let name = parts.next().unwrap_or_default();
        let set: Vec<Override> = parts.map(|set| Override::Set(set.trim_matches('\'').to_owned())).collect();
        let scenario = load(name, &set).unwrap_or_else(|error| panic!("{command}: {error}"));
        let family = name.split('/').next().unwrap_or_default().to_owned();
        entries.push(Entry { file: file.trim_end_matches(')').to_owned(), family, scenario });
    }
    entries
}

#[test]
fn every_family_driver_and_controller_has_an_animation() {
    let entries = entries();
    let shown: BTreeSet<&str> = entries.iter().map(|entry| entry.family.as_str()).collect();
    let families: BTreeSet<&str> = embedded().iter().filter_map(|file| file.name.split('/').next()).collect();
    assert_eq!(shown, families);
    let vehicles =
        entries.iter().flat_map(|entry| &entry.scenario.vehicles).filter(|vehicle| vehicle.obstacle.is_none());
    let drivers: BTreeSet<&str> = vehicles.map(|vehicle| vehicle.driver.kind()).collect();
    // Drivers from outside and recorded drivers are in none of the authored scenarios.
    let kinds = Registry::standard().driver_kinds().into_iter();
    let every: BTreeSet<&str> = kinds.filter(|kind| !["external", "inputs", "recorded"].contains(kind)).collect();
    assert_eq!(drivers, every, "kinds of drivers");
    let buildings = entries.iter().filter(|entry| entry.scenario.building.is_some());
    let controllers: BTreeSet<&str> = buildings.map(|entry| entry.scenario.controller().kind()).collect();
    let every: BTreeSet<&str> = Registry::standard().controller_kinds().into_iter().collect();
    assert_eq!(controllers, every, "kinds of controllers");
}

#[test]
fn every_gallery_animation_exists_is_generated_and_is_shown() {
    let folder = docs().join("gallery");
    let script = read(&folder.join("make.sh"));
    let shown: BTreeSet<String> = entries().into_iter().map(|entry| entry.file).collect();
    let files = fs::read_dir(&folder).expect("a folder").map(|file| file.expect("readable"));
    let mut bytes = 0;
    let mut there = BTreeSet::new();
    for file in files {
        let name = file.file_name().into_string().expect("plain names");
        bytes += file.metadata().expect("readable").len();
        if let Some(stem) = name.strip_suffix(".gif") {
            let is_made = script.split_whitespace().any(|word| word.replace('/', "-") == stem);
            assert!(is_made, "make.sh does not make {name}");
            there.insert(name);
        }
    }
    assert_eq!(there, shown);
    assert!(bytes < MOST_BYTES, "{bytes} bytes");
}
