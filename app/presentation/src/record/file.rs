//! A file that appears whole or not at all: written beside its final place and renamed when it is complete.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use super::error::RecordError;

/// Checks that a file can be written to `target`, and leaves no trace of that.
///
/// # Errors
/// [`RecordError::Unwritable`] with the reason.
pub fn check(target: &Path) -> Result<(), RecordError> {
    check_place(target).map_err(|reason| RecordError::Unwritable { path: target.to_owned(), reason })
}

fn check_place(target: &Path) -> io::Result<()> {
    if target.file_name().is_none() {
        return Err(io::Error::other("it names no file"));
    }
    if fs::metadata(target).is_ok_and(|found| !found.is_file()) {
        let what = if target.is_dir() { "it is a folder" } else { "it is not an ordinary file" };
        return Err(io::Error::other(what));
    }
    let nearest = folders_above(target).find(|folder| folder.exists()).unwrap_or_else(|| PathBuf::from("."));
    #[cfg(target_os = "linux")]
    if let Some(file) = unnamed_in(&nearest) {
        return file.map(drop);
    }
    temporary_in(&nearest).map(drop)
}

/// Writes a file, making folders as needed.
///
/// # Errors
/// [`RecordError::Unwritable`] if the disk refuses. Then nothing was made, and what stood at `target` is as it was.
pub fn write(target: &Path, content: &[u8]) -> Result<(), RecordError> {
    write_whole(target, content).map_err(|reason| RecordError::Unwritable { path: target.to_owned(), reason })
}

/// Writes a file of any sort, as [`write`] does.
///
/// # Errors
/// What the disk says. Then nothing was made, and what stood at `target` is as it was.
pub fn write_whole(target: &Path, content: &[u8]) -> io::Result<()> {
    check_place(target)?;
    let missing = folders_above(target).take_while(|folder| !folder.exists()).collect();
    let folders = NewFolders(missing);
    folders.make().and_then(|()| place(target, content))?;
    folders.keep();
    Ok(())
}

/// Writes beside the target and renames. What is left of a failure is removed.
fn place(target: &Path, content: &[u8]) -> io::Result<()> {
    let folder = target.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    #[cfg(target_os = "linux")]
    if let Some(file) = unnamed_in(folder) {
        return place_unnamed(file?, folder, target, content);
    }
    let mut file = temporary_in(folder)?;
    file.write_all(content)?;
    file.as_file().sync_all()?;
    file.persist(target).map_err(|error| error.error)?;
    sync_folder(folder)
}

/// A file without a name, which vanishes with the process however that ends; none where the file system knows no such files.
#[cfg(target_os = "linux")]
fn unnamed_in(folder: &Path) -> Option<io::Result<fs::File>> {
    use rustix::fs::{Mode, OFlags};
    let flags = OFlags::TMPFILE | OFlags::RDWR | OFlags::CLOEXEC;
    match rustix::fs::open(folder, flags, Mode::from_raw_mode(0o666)) {
        Ok(file) => Some(Ok(fs::File::from(file))),
        Err(rustix::io::Errno::OPNOTSUPP | rustix::io::Errno::ISDIR | rustix::io::Errno::INVAL) => None,
        Err(error) => Some(Err(error.into())),
    }
}

/// Fills the file and gives it its name. Where that name is taken, the file has another for the time of one rename: a
/// process that is killed leaves nothing behind before that.
#[cfg(target_os = "linux")]
fn place_unnamed(mut file: fs::File, folder: &Path, target: &Path, content: &[u8]) -> io::Result<()> {
    use std::os::fd::AsRawFd;

    use rustix::fs::{AtFlags, CWD, linkat};
    file.write_all(content)?;
    file.sync_all()?;
    let link = |name: &Path| {
        let itself = format!("/proc/self/fd/{}", file.as_raw_fd());
        linkat(CWD, itself, CWD, name, AtFlags::SYMLINK_FOLLOW)
    };
    match link(target) {
        Ok(()) => sync_folder(folder),
        Err(rustix::io::Errno::EXIST) => {
            let name = folder.join(format!(".{}-{}.part", std::process::id(), file.as_raw_fd()));
            link(&name)?;
            fs::rename(&name, target).inspect_err(|_| {
                // What is there is ours, and has no place.
                let _ = fs::remove_file(&name);
            })?;
            sync_folder(folder)
        }
        Err(error) => Err(error.into()),
    }
}

/// Makes the new name of a file last through a loss of power, where the file system can.
fn sync_folder(folder: &Path) -> io::Result<()> {
    if cfg!(not(unix)) {
        return Ok(());
    }
    match fs::File::open(folder).and_then(|folder| folder.sync_all()) {
        Err(error) if error.kind() == io::ErrorKind::InvalidInput || error.kind() == io::ErrorKind::Unsupported => {
            Ok(())
        }
        synced => synced,
    }
}

/// A file that vanishes unless it is given a place; readable for whom any new file would be.
fn temporary_in(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".").suffix(".part");
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder)
}

/// Folders that did not exist, innermost first; removed again unless they are kept.
struct NewFolders(Vec<PathBuf>);

impl NewFolders {
    fn make(&self) -> io::Result<()> {
        self.0.first().map_or(Ok(()), fs::create_dir_all)
    }

    fn keep(mut self) {
        self.0.clear();
    }
}

impl Drop for NewFolders {
    fn drop(&mut self) {
        // What cannot be removed was never created, or is in somebody else's use by now.
        for folder in &self.0 {
            let _ = fs::remove_dir(folder);
        }
    }
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
        let plain = folder.0.join("plain");
        fs::write(&plain, b"").expect("writable");
        let permissions = |path: &Path| fs::metadata(path).expect("there").permissions();
        assert_eq!(permissions(&target), permissions(&plain), "a new file like any other");
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
        let folders = NewFolders(vec![made.clone()]);
        folders.make().expect("writable");
        place(Path::new("/proc/run.rrd"), b"content").expect_err("no place for files");
        assert!(made.exists());
        drop(folders);
        assert!(!made.exists());
    }
}
