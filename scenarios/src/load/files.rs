//! Lists the files of a scenario, and the scenarios of a folder.

use std::io;
use std::path::{Path, PathBuf};

use crate::commonroad::is_commonroad;
use crate::format::read::overrides::Override;
use crate::format::read::source::Source;
use crate::format::read::stated_path::path_beside;
use crate::format::read::tree::{self, TomlNode, TomlValue};
use crate::format::registry::Registry;
use crate::load;

/// The files of a scenario, as far as they can be read: its own, those that it extends, and those that any of them or
/// of `overrides` names, such as its weather. Scenarios in the binary never change and are not among them.
pub fn files(registry: &Registry, name_or_path: &str, overrides: &[Override]) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut next = Source::find(name_or_path).ok();
    while let Some(source @ Source::File(path)) = &next {
        if found.contains(path) {
            break;
        }
        found.push(path.clone());
        next = parent(source);
    }
    let Ok(mut tree) = load::tree(registry, name_or_path) else { return found };
    if let TomlValue::Table(root) = &mut tree.value {
        // An invalid change is refused when the scenario is loaded.
        overrides.iter().for_each(|change| drop(change.apply(root, registry.complete())));
    }
    add_named(&tree, &mut found);
    found
}

/// Adds all files that a tree names.
fn add_named(node: &TomlNode, found: &mut Vec<PathBuf>) {
    match &node.value {
        TomlValue::Table(table) => {
            for (key, entry) in table {
                match entry.node.text().filter(|_| key == "file" || key.ends_with(".file")) {
                    Some(file) => found.push(path_beside(&entry.node.place, file)),
                    None => add_named(&entry.node, found),
                }
            }
        }
        TomlValue::Array(items) => items.iter().for_each(|item| add_named(item, found)),
        _ => {}
    }
}

/// What a file extends, if it can be read that far.
fn parent(source: &Source) -> Option<Source> {
    if matches!(source, Source::File(path) if is_commonroad(path)) {
        return None;
    }
    let (document, text) = source.read(1).ok()?;
    let node = tree::parse(&document, &text).ok()?;
    source.parent(node.table()?.get("extends")?.node.text()?).ok()
}

/// Whether a file counts as a scenario: TOML, or XML of CommonRoad.
fn is_scenario(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension == "toml") || is_commonroad(path)
}

/// Name of the folders of sweeps, which hold plans and copies of scenarios.
const SWEEPS: &str = "sweeps";

/// What a folder holds.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FolderContents {
    /// The scenarios, sorted by name.
    pub scenarios: Vec<FolderScenario>,
    /// The plans of many runs, sorted by name.
    pub plans: Vec<PathBuf>,
}

/// A file of a folder that counts as a scenario.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FolderScenario {
    /// Its path.
    pub path: PathBuf,
    /// Whether another file of the folder extends it: then it need not be complete.
    pub is_extended: bool,
}

/// The .toml files below a folder, and scenarios of CommonRoad. Folders of sweeps and hidden folders are not entered.
///
/// # Errors
/// The system's error, if a folder cannot be read.
pub fn files_below(folder: &Path) -> io::Result<FolderContents> {
    let (mut folders, mut found) = (vec![folder.to_owned()], Vec::new());
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder)? {
            let entry = entry?;
            let name = entry.file_name();
            let is_entered = name != SWEEPS && !name.to_string_lossy().starts_with('.');
            if entry.file_type()?.is_dir() {
                folders.extend(is_entered.then(|| entry.path()));
            } else if is_scenario(&entry.path()) {
                found.push(entry.path());
            }
        }
    }
    // The files are sorted by name without extension: `distributed` comes before `distributed-hundred`.
    found.sort_by_key(|path| path.with_extension(""));
    let (plans, scenarios): (Vec<PathBuf>, Vec<PathBuf>) = found.into_iter().partition(|path| is_plan(path));
    let real = |path: &Path| path.canonicalize().ok();
    let parents = scenarios.iter().filter_map(|path| match parent(&Source::File(path.clone()))? {
        Source::File(path) => real(&path),
        _ => None,
    });
    let extended: Vec<PathBuf> = parents.collect();
    let scenario =
        |path: PathBuf| FolderScenario { is_extended: real(&path).is_some_and(|path| extended.contains(&path)), path };
    Ok(FolderContents { scenarios: scenarios.into_iter().map(scenario).collect(), plans })
}

/// Whether a file is a plan of many runs; not where it cannot be read.
fn is_plan(path: &Path) -> bool {
    let source = Source::File(path.to_owned());
    let read = (!is_commonroad(path)).then(|| source.read(1).ok()).flatten();
    let tree = read.and_then(|(document, text)| tree::parse(&document, &text).ok());
    tree.is_some_and(|tree| load::plan_in_its_place(&tree).is_some())
}
