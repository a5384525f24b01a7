//! The files that a scenario is made of, and those in a folder.

use std::io;
use std::path::{Path, PathBuf};

use crate::source::Source;
use crate::tree;

/// The scenario file and those that it extends, as far as they can be read: what to look at to see whether it has changed.
/// Scenarios in the binary never change and are not among them.
pub fn files(name_or_path: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut next = Source::find(name_or_path).ok();
    while let Some(source @ Source::File(path)) = &next {
        if found.contains(path) {
            break;
        }
        found.push(path.clone());
        next = parent(source);
    }
    found
}

/// What a file extends, if it can be read that far.
fn parent(source: &Source) -> Option<Source> {
    let (document, text) = source.read(1).ok()?;
    let node = tree::parse(&document, &text).ok()?;
    source.parent(node.table()?.get("extends")?.node.text()?).ok()
}

/// All .toml files below a folder, sorted by name.
///
/// # Errors
/// That of the system, if a folder cannot be read.
pub fn files_below(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let (mut folders, mut found) = (vec![folder.to_owned()], Vec::new());
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder)? {
            let entry = entry?;
            if entry.file_type()?.is_dir() {
                folders.push(entry.path());
            } else if entry.path().extension().is_some_and(|extension| extension == "toml") {
                found.push(entry.path());
            }
        }
    }
    // By name: `distributed` before `distributed-hundred`.
    found.sort_by_key(|path| path.with_extension(""));
    Ok(found)
}
