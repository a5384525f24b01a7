//! A file that appears whole or not at all: written beside its final place and renamed when it is complete.

use std::ffi::OsString;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::RecordError;

/// Checks that a file can be written to `target`, and leaves no trace of that.
///
/// # Errors
/// [`RecordError::Unwritable`] with the reason.
pub fn check(target: &Path) -> Result<(), RecordError> {
    let refuse = |reason: String| RecordError::Unwritable { path: target.to_owned(), reason };
    if target.file_name().is_none() {
        return Err(refuse("it names no file".to_owned()));
    }
    if fs::metadata(target).is_ok_and(|found| !found.is_file()) {
        let what = if target.is_dir() { "it is a folder" } else { "it is not an ordinary file" };
        return Err(refuse(what.to_owned()));
    }
    let nearest = folders_above(target).find(|folder| folder.exists()).unwrap_or_else(|| PathBuf::from("."));
    let probe = Guard { temporary: beside(&nearest.join("probe")), folders: Vec::new(), placed: false };
    create(&probe.temporary).map(drop).map_err(|error| refuse(error.to_string()))
}

/// Writes a file, making folders as needed.
///
/// # Errors
/// [`RecordError::Unwritable`] if the disk refuses. Then nothing was made, and what stood at `target` is as it was.
pub fn write(target: &Path, content: &[u8]) -> Result<(), RecordError> {
    check(target)?;
    let mut folders: Vec<PathBuf> = folders_above(target).take_while(|folder| !folder.exists()).collect();
    folders.reverse();
    let mut guard = Guard { temporary: beside(target), folders, placed: false };
    guard
        .fill(target, content)
        .map_err(|error| RecordError::Unwritable { path: target.to_owned(), reason: error.to_string() })
}

/// What a file in the making has created so far; taken back unless the file reaches its place.
struct Guard {
    temporary: PathBuf,
    /// Folders that did not exist, outermost first.
    folders: Vec<PathBuf>,
    placed: bool,
}

impl Guard {
    fn fill(&mut self, target: &Path, content: &[u8]) -> io::Result<()> {
        if let Some(folder) = self.folders.last() {
            fs::create_dir_all(folder)?;
        }
        let mut file = create(&self.temporary)?;
        file.write_all(content)?;
        file.sync_all()?;
        fs::rename(&self.temporary, target)?;
        self.placed = true;
        Ok(())
    }
}

impl Drop for Guard {
    fn drop(&mut self) {
        if self.placed {
            return;
        }
        // What cannot be removed was never created, or is in somebody else's use by now.
        let _ = fs::remove_file(&self.temporary);
        for folder in self.folders.iter().rev() {
            let _ = fs::remove_dir(folder);
        }
    }
}

fn create(path: &Path) -> io::Result<fs::File> {
    fs::OpenOptions::new().write(true).create_new(true).open(path)
}

/// A name of our own beside a path.
fn beside(path: &Path) -> PathBuf {
    let mut name = OsString::from(".");
    name.push(path.file_name().unwrap_or_default());
    name.push(format!(".{}-{:?}.part", std::process::id(), std::thread::current().id()));
    path.with_file_name(name)
}

/// The folders above a path, innermost first.
fn folders_above(target: &Path) -> impl Iterator<Item = PathBuf> {
    target.ancestors().skip(1).filter(|folder| !folder.as_os_str().is_empty()).map(Path::to_owned)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::tests::Folder;

    #[test]
    fn a_file_appears_whole_in_folders_made_for_it() {
        let folder = Folder::new("whole");
        let target = folder.0.join("a/b/run.rrd");
        check(&target).expect("writable");
        assert_eq!(folder.contents(), Vec::<String>::new(), "checking leaves no trace");
        write(&target, b"first").expect("writable");
        write(&target, b"second").expect("replaces");
        assert_eq!(fs::read(&target).expect("there"), b"second");
        assert_eq!(fs::read_dir(folder.0.join("a/b")).expect("there").count(), 1);
    }

    #[test]
    fn a_place_that_is_no_file_is_refused_with_its_reason() {
        let folder = Folder::new("refused");
        fs::write(folder.0.join("file"), b"mine").expect("writable");
        let cases = [
            (folder.0.clone(), "it is a folder"),
            (folder.0.join("file/below/run.rrd"), "ot a directory"),
            (PathBuf::from("/"), "it names no file"),
            (PathBuf::from("/dev/null"), "it is not an ordinary file"),
        ];
        for (target, expected) in cases {
            for outcome in [check(&target), write(&target, b"content")] {
                let error = outcome.expect_err("refused").to_string();
                assert!(error.contains(expected) && error.contains(&target.display().to_string()), "{error}");
            }
        }
        assert_eq!(folder.contents(), ["file"]);
        assert_eq!(fs::read(folder.0.join("file")).expect("there"), b"mine");
    }

    #[test]
    fn a_file_that_cannot_be_placed_takes_its_folders_along() {
        let folder = Folder::new("unplaced");
        let made = folder.0.join("made");
        let target = made.join("run.rrd");
        let mut guard = Guard { temporary: beside(&target), folders: vec![made.clone()], placed: false };
        guard.fill(Path::new("/proc/run.rrd"), b"content").expect_err("another file system");
        assert!(made.exists());
        drop(guard);
        assert!(!made.exists());
    }
}
