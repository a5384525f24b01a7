//! The package for Python stands outside the workspace: what holds inside of it is checked here.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;

use toml::Table;

use crate::architecture::{crate_folder, dependencies, manifest, root};

/// The crates of the workspace that the package may depend on.
const ARROWS: &[&str] =
    &["planners", "building", "scenarios", "app/simulation", "app/sweep", "app/presentation", "app/cli"];
/// The most lines of a file.
const FILE_LINES: usize = 400;

fn python() -> Table {
    manifest(&root().join("python"))
}

#[test]
fn no_other_crate_depends_on_python() {
    let workspace = manifest(root());
    let excluded = workspace["workspace"]["exclude"].as_array().expect("a list");
    assert!(excluded.iter().any(|folder| folder.as_str() == Some("python")));
    for dependency in dependencies(&python()) {
        if let Some(folder) = crate_folder(&dependency) {
            assert!(ARROWS.contains(&folder.as_str()), "python must not depend on {folder}");
        }
    }
}

#[test]
fn the_python_package_has_the_version_and_profile_of_the_workspace() {
    let (workspace, python) = (manifest(root()), python());
    assert_eq!(python["package"]["version"], workspace["workspace"]["package"]["version"]);
    assert_eq!(python["package"]["rust-version"], workspace["workspace"]["package"]["rust-version"]);
    assert_eq!(python["profile"]["release"], workspace["profile"]["release"]);
}

/// The versions of each package in a lock file.
fn locked(folder: &str) -> BTreeMap<String, BTreeSet<String>> {
    let path = root().join(folder).join("Cargo.lock");
    let text = fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let lock: Table = text.parse().expect("a lock file is TOML");
    let mut versions: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for package in lock["package"].as_array().expect("a list") {
        let [name, version] = ["name", "version"].map(|key| package[key].as_str().expect("a text").to_owned());
        versions.entry(name).or_default().insert(version);
    }
    versions
}

/// A scenario runs the same code from Python as from the command: each library that both use has the same version.
#[test]
fn the_lock_file_of_the_python_package_agrees_with_the_workspace() {
    let (workspace, python) = (locked("."), locked("python"));
    for engine in ["clarabel", "nalgebra", "libm", "bevy_ecs", "rapier2d", "parry2d", "rand_chacha", "rustfft"] {
        assert!(python.contains_key(engine), "{engine}");
    }
    for (name, versions) in &python {
        if let Some(wanted) = workspace.get(name) {
            assert!(versions.is_subset(wanted), "{name}: {versions:?}, and the workspace has {wanted:?}");
        }
    }
}

#[test]
fn files_of_the_python_package_keep_the_line_limit() {
    let mut folders = vec![root().join("python")];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            if path.is_dir() && !name.starts_with('.') && name != "target" && name != "__pycache__" {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "py") {
                let lines = fs::read_to_string(&path).expect("a text").lines().count();
                assert!(lines <= FILE_LINES, "{}: {lines} lines, more than {FILE_LINES}", path.display());
            }
        }
    }
}
