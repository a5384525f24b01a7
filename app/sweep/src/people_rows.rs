//! The rows of people in a folder.

use std::path::{Path, PathBuf};

use crate::error::SweepError;
use crate::journal::read_rows;
use crate::row::SweepRow;

/// The columns of a run with a person.
pub(crate) const COLUMNS: [&str; 2] = [PARTICIPANT, RESTARTS];

pub(crate) const PARTICIPANT: &str = "participant";

pub(crate) const RESTARTS: &str = "restarts";

pub(crate) fn path_in(folder: &Path) -> PathBuf {
    folder.join("people.jsonl")
}

/// The rows of people in a folder, in the order in which they drove.
pub(crate) fn rows(folder: &Path) -> Result<Vec<SweepRow>, SweepError> {
    let path = path_in(folder);
    if path.is_file() { read_rows(&path) } else { Ok(Vec::new()) }
}
