//! A file that appears whole or not at all: written beside its final place and renamed when it is complete.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::RecordError;

/// A file that does not exist yet. Dropped unfinished, it takes back all that it created.
#[derive(Debug)]
pub struct PartialFile {
    target: PathBuf,
    temporary: PathBuf,
    /// Folders that were made for it, outermost first.
    folders: Vec<PathBuf>,
    open: Option<fs::File>,
    placed: bool,
}

impl PartialFile {
    /// Reserves a place beside `target`, making folders as needed.
    ///
    /// # Errors
    /// [`RecordError::Unwritable`] if `target` cannot become a file; then nothing was changed.
    pub fn create(target: &Path) -> Result<PartialFile, RecordError> {
        let refuse = |reason: String| RecordError::Unwritable { path: target.to_owned(), reason };
        let Some(name) = target.file_name() else { return Err(refuse("it names no file".to_owned())) };
        if fs::metadata(target).is_ok_and(|found| !found.is_file()) {
            let kind = if target.is_dir() { "it is a folder" } else { "it is not an ordinary file" };
            return Err(refuse(kind.to_owned()));
        }
        let mut temporary_name = std::ffi::OsString::from(".");
        temporary_name.push(name);
        temporary_name.push(format!(".{}.part", std::process::id()));
        let mut file = PartialFile {
            target: target.to_owned(),
            temporary: target.with_file_name(temporary_name),
            folders: missing_folders(target),
            open: None,
            placed: false,
        };
        file.open().map_err(|error| refuse(error.to_string()))?;
        Ok(file)
    }

    fn open(&mut self) -> io::Result<()> {
        for folder in &self.folders {
            match fs::create_dir(folder) {
                Err(error) if error.kind() != io::ErrorKind::AlreadyExists => return Err(error),
                _ => {}
            }
        }
        self.open = Some(fs::OpenOptions::new().write(true).create_new(true).open(&self.temporary)?);
        Ok(())
    }

    /// Writes the content and puts the file in its place.
    ///
    /// # Errors
    /// [`RecordError::Unwritable`] if the disk refuses; what stood at the place before stays as it was.
    pub fn finish(mut self, content: &[u8]) -> Result<(), RecordError> {
        self.fill(content)
            .map_err(|error| RecordError::Unwritable { path: self.target.clone(), reason: error.to_string() })
    }

    fn fill(&mut self, content: &[u8]) -> io::Result<()> {
        if let Some(mut open) = self.open.take() {
            open.write_all(content)?;
            open.sync_all()?;
        }
        fs::rename(&self.temporary, &self.target)?;
        self.placed = true;
        Ok(())
    }
}

impl Drop for PartialFile {
    fn drop(&mut self) {
        if self.placed {
            return;
        }
        // What cannot be removed was not created, or somebody else uses it by now.
        drop(self.open.take());
        let _ = fs::remove_file(&self.temporary);
        for folder in self.folders.iter().rev() {
            let _ = fs::remove_dir(folder);
        }
    }
}

/// The folders above `target` that do not exist, outermost first.
fn missing_folders(target: &Path) -> Vec<PathBuf> {
    let above = target.ancestors().skip(1).filter(|folder| !folder.as_os_str().is_empty());
    let mut missing: Vec<PathBuf> = above.take_while(|folder| !folder.exists()).map(Path::to_owned).collect();
    missing.reverse();
    missing
}
