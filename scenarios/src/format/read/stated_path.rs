//! Paths of files that a scenario, a plan or a flag states.

use std::path::{Path, PathBuf};

use crate::text::error::{Place, quoted};

/// The path of a file that is called `file` at a place: relative to the folder of the text that states it. A path in a flag is
/// relative to the current folder.
pub(crate) fn path_beside(place: &Place, file: &str) -> PathBuf {
    folder_of(place).join(file)
}

/// What such a path is relative to, in words.
pub(crate) fn base_in_words(place: &Place) -> String {
    if folder_of(place) == Path::new("") {
        return "the path is relative to the current folder".to_owned();
    }
    format!("the path is relative to the folder of {}, where it is stated", quoted(&place.document.name))
}

fn folder_of(place: &Place) -> &Path {
    Path::new(&place.document.name).parent().unwrap_or(Path::new(""))
}
