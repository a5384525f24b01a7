//! Finds the files that an argument names.

use std::fs;
use std::path::{Path, PathBuf};

use interplay_scenarios::is_commonroad;

use crate::error::RecordingsError;

/// The recordings that an argument names: a file, or the files below a folder, sorted.
pub(super) fn found_at(argument: &Path) -> Result<Vec<PathBuf>, RecordingsError> {
    if !argument.is_dir() {
        let is_xml = argument.extension().is_some_and(|it| it.eq_ignore_ascii_case("xml"));
        if is_xml || is_table(argument) {
            return Ok(vec![argument.to_owned()]);
        }
        return Err(RecordingsError::UnknownFormat(argument.to_owned()));
    }
    let mut found = Vec::new();
    collect(argument, &mut found)?;
    found.sort();
    if found.is_empty() { Err(RecordingsError::EmptyFolder(argument.to_owned())) } else { Ok(found) }
}

fn is_table(path: &Path) -> bool {
    path.extension().is_some_and(|it| it.eq_ignore_ascii_case("csv"))
}

fn collect(folder: &Path, found: &mut Vec<PathBuf>) -> Result<(), RecordingsError> {
    let unreadable = |reason| RecordingsError::UnreadableFolder { folder: folder.to_owned(), reason };
    for entry in fs::read_dir(folder).map_err(unreadable)? {
        let entry = entry.map_err(unreadable)?;
        let path = entry.path();
        // Links to folders are not followed, because one could lead back to itself.
        if entry.file_type().map_err(unreadable)?.is_dir() {
            collect(&path, found)?;
        } else if is_table(&path) || is_commonroad(&path) {
            found.push(path);
        }
    }
    Ok(())
}

/// The name of an argument's group: its last path component, without the extension of a file.
pub(super) fn group_name(argument: &Path) -> String {
    let name = if argument.is_dir() { argument.file_name() } else { argument.file_stem() };
    name.map_or_else(|| argument.display().to_string(), |name| name.to_string_lossy().into_owned())
}
