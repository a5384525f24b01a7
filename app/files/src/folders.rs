//! Folders that are created for a file, and removed again if the file is not written.

use std::path::{Path, PathBuf};
use std::{fs, io};

/// Folders that did not exist, innermost first; removed again unless they are kept.
#[derive(Debug)]
pub struct NewFolders(Vec<PathBuf>);

impl NewFolders {
    /// Creates the folders above a file.
    ///
    /// # Errors
    /// The error of the file system. Then no folder was created.
    pub fn make_above(target: &Path) -> io::Result<NewFolders> {
        let folders = NewFolders(above(target).take_while(|folder| !folder.exists()).collect());
        folders.0.first().map_or(Ok(()), fs::create_dir_all)?;
        Ok(folders)
    }

    /// Keeps the folders.
    pub fn keep(mut self) {
        self.0.clear();
    }
}

impl Drop for NewFolders {
    fn drop(&mut self) {
        // A folder that cannot be removed was never created, or another process now uses it.
        for folder in &self.0 {
            let _ = fs::remove_dir(folder);
        }
    }
}

/// The folders above a path, innermost first.
pub(crate) fn above(target: &Path) -> impl Iterator<Item = PathBuf> {
    target.ancestors().skip(1).filter(|folder| !folder.as_os_str().is_empty()).map(Path::to_owned)
}
