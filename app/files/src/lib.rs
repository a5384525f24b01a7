//! Files that appear whole or not at all, however the process ends.
//!
//! On Linux, where the file system allows it, a file has no name until it is complete: the system removes it if the process ends earlier.
//! Elsewhere it is written to a temporary name in the same folder and renamed. The file that it replaces stays until then. When a function
//! returns without an error, content and name are on the disk.
//!
//! ```
//! let folder = tempfile::tempdir()?;
//! let target = folder.path().join("reports/first.json");
//! interplay_files::write(&target, b"{}")?;
//! assert_eq!(std::fs::read(&target)?, b"{}");
//!
//! // What cannot be written leaves nothing behind, no folder either.
//! let below_a_file = target.join("second/third.json");
//! assert!(interplay_files::write(&below_a_file, b"{}").is_err());
//! assert!(!target.join("second").exists());
//! # Ok::<(), std::io::Error>(())
//! ```

#![allow(missing_docs, reason = "only this workspace uses the crate; a comment says what a name and its type do not")]

mod whole;

use std::io::{self, Write};
use std::path::Path;

pub use whole::{NewFolders, WholeFile, folder_of};

/// Checks that a file can be written to `target`, and leaves no trace of that.
///
/// # Errors
/// The system's reason why the file cannot be written.
pub fn check(target: &Path) -> io::Result<()> {
    if target.file_name().is_none() {
        return Err(io::Error::other("it names no file"));
    }
    if target.metadata().is_ok_and(|found| !found.is_file()) {
        let what = if target.is_dir() { "it is a folder" } else { "it is not an ordinary file" };
        return Err(io::Error::other(what));
    }
    let nearest = whole::above(target).find(|folder| folder.exists());
    WholeFile::begin(&nearest.unwrap_or_default().join("new")).map(drop)
}

/// Writes a file, replacing one that exists at `target`; creates folders as needed.
///
/// # Errors
/// The error of the file system. Then nothing was created, and a file that existed at `target` is unchanged.
pub fn write(target: &Path, content: &[u8]) -> io::Result<()> {
    check(target)?;
    in_new_folders(target, content, WholeFile::replace)
}

/// Writes a file unless one exists at `target`; creates folders as needed.
///
/// # Errors
/// [`io::ErrorKind::AlreadyExists`], and other errors of the file system. Then nothing was created.
pub fn write_new(target: &Path, content: &[u8]) -> io::Result<()> {
    in_new_folders(target, content, WholeFile::keep_out)
}

fn in_new_folders(target: &Path, content: &[u8], place: fn(WholeFile) -> io::Result<()>) -> io::Result<()> {
    let folders = NewFolders::make_above(target)?;
    let mut file = WholeFile::begin(target)?;
    file.write_all(content)?;
    place(file)?;
    folders.keep();
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::PathBuf;

    use super::*;

    fn contents(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).expect("it exists");
        let mut names: Vec<String> =
            entries.map(|entry| entry.expect("readable").file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    #[test]
    fn a_file_appears_complete_in_folders_created_for_it() {
        let folder = tempfile::tempdir().expect("a folder");
        let target = folder.path().join("a/b/run.rrd");
        check(&target).expect("writable");
        assert_eq!(contents(folder.path()), Vec::<String>::new(), "checking leaves no trace");
        write(&target, b"first").expect("writable");
        write(&target, b"second").expect("replaces");
        assert_eq!(fs::read(&target).expect("there"), b"second");
        assert_eq!(contents(&folder.path().join("a/b")), ["run.rrd"]);
        let plain = folder.path().join("plain");
        fs::write(&plain, b"").expect("writable");
        let permissions = |path: &Path| fs::metadata(path).expect("there").permissions();
        assert_eq!(permissions(&target), permissions(&plain), "a new file like any other");
    }

    #[test]
    fn a_new_file_does_not_replace_an_existing_one() {
        let folder = tempfile::tempdir().expect("a folder");
        let target = folder.path().join("a/mine.toml");
        write_new(&target, b"first").expect("writable");
        let error = write_new(&target, b"second").expect_err("it is taken");
        assert_eq!(error.kind(), io::ErrorKind::AlreadyExists);
        assert_eq!(fs::read(&target).expect("there"), b"first");
        assert_eq!(contents(&folder.path().join("a")), ["mine.toml"]);
    }

    #[test]
    fn a_target_that_cannot_be_a_file_is_refused_with_the_reason() {
        let folder = tempfile::tempdir().expect("a folder");
        fs::write(folder.path().join("file"), b"mine").expect("writable");
        let cases = [
            (folder.path().to_owned(), "it is a folder"),
            (folder.path().join("file/below/run.rrd"), "ot a directory"),
            (PathBuf::from("/"), "it names no file"),
            (PathBuf::from("/dev/null"), "it is not an ordinary file"),
        ];
        for (target, expected) in cases {
            for outcome in [check(&target), write(&target, b"content")] {
                let error = outcome.expect_err("refused").to_string();
                assert!(error.contains(expected), "{}: {error}", target.display());
            }
        }
        assert_eq!(contents(folder.path()), ["file"]);
        assert_eq!(fs::read(folder.path().join("file")).expect("there"), b"mine");
    }

    /// A file that is abandoned leaves nothing behind, and neither do the folders created for it.
    #[test]
    fn an_abandoned_file_leaves_no_trace_on_disk() {
        let folder = tempfile::tempdir().expect("a folder");
        let target = folder.path().join("a/b/run.rrd");
        {
            let _folders = NewFolders::make_above(&target).expect("writable");
            WholeFile::begin(&target).expect("writable").write_all(b"half").expect("writable");
            assert!(folder.path().join("a/b").exists());
        }
        assert_eq!(contents(folder.path()), Vec::<String>::new());
    }
}
