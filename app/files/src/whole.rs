//! A file that appears at its path only when it is complete.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

/// A file that is being written. It is deleted if it is dropped before it is moved to its path.
#[derive(Debug)]
pub struct WholeFile {
    target: PathBuf,
    file: Unplaced,
}

#[derive(Debug)]
enum Unplaced {
    /// A file without a name, which vanishes when the process ends in any way.
    #[cfg(target_os = "linux")]
    Unnamed(File),
    Named(NamedTempFile),
}

impl WholeFile {
    /// Creates a file in the folder of `target`, which must exist.
    ///
    /// # Errors
    /// The error of the file system.
    pub fn begin(target: &Path) -> io::Result<WholeFile> {
        let folder = folder_of(target);
        #[cfg(target_os = "linux")]
        if let Some(file) = unnamed_in(folder) {
            return Ok(WholeFile { target: target.to_owned(), file: Unplaced::Unnamed(file?) });
        }
        let mut builder = parts();
        // Temporary files are private by default; this one gets the permissions of any new file.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        Ok(WholeFile {
            target: target.to_owned(),
            file: Unplaced::Named(builder.tempfile_in(folder).map_err(of_disk)?),
        })
    }

    /// Moves the file to its path, replacing a file that exists there.
    ///
    /// # Errors
    /// The error of the file system. The old file is unchanged, unless only its folder could not be synced to the disk.
    pub fn replace(self) -> io::Result<()> {
        self.place(true)
    }

    /// Moves the file to its path unless a file exists there.
    ///
    /// # Errors
    /// [`io::ErrorKind::AlreadyExists`], and other errors of the file system. Then nothing was created.
    pub fn keep_out(self) -> io::Result<()> {
        self.place(false)
    }

    fn place(self, replaces: bool) -> io::Result<()> {
        let folder = folder_of(&self.target);
        self.as_file().sync_all()?;
        match self.file {
            #[cfg(target_os = "linux")]
            Unplaced::Unnamed(file) => match link(&file, &self.target) {
                Err(error) if replaces && error.kind() == io::ErrorKind::AlreadyExists => {
                    // No system call replaces an existing file by an unnamed one, so the file briefly gets a temporary name.
                    let named = parts().make_in(folder, |name| link(&file, name))?;
                    named.into_temp_path().persist(&self.target).map_err(|error| error.error)?;
                }
                linked => linked?,
            },
            Unplaced::Named(file) if replaces => file.persist(&self.target).map(drop).map_err(|error| error.error)?,
            Unplaced::Named(file) => file.persist_noclobber(&self.target).map(drop).map_err(|error| error.error)?,
        }
        sync_folder(folder).inspect_err(|_| {
            if !replaces {
                let _ = fs::remove_file(&self.target);
            }
        })
    }

    fn as_file(&self) -> &File {
        match &self.file {
            #[cfg(target_os = "linux")]
            Unplaced::Unnamed(file) => file,
            Unplaced::Named(file) => file.as_file(),
        }
    }
}

impl Write for WholeFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.as_file().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.as_file().flush()
    }
}

/// The folder in which a file is or will be.
pub fn folder_of(target: &Path) -> &Path {
    target.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// The error of the file system, without the temporary name of the file.
fn of_disk(error: io::Error) -> io::Error {
    let said = error.to_string();
    let (reason, _) = said.split_once(" at path ").unwrap_or((&said, ""));
    io::Error::new(error.kind(), reason.to_owned())
}

/// Settings of the temporary names.
fn parts() -> tempfile::Builder<'static, 'static> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".").suffix(".part");
    builder
}

/// A file without a name; `None` where the file system does not support such files.
#[cfg(target_os = "linux")]
fn unnamed_in(folder: &Path) -> Option<io::Result<File>> {
    use rustix::fs::{Mode, OFlags};
    use rustix::io::Errno;
    // An unnamed file gets its name through this folder.
    if !Path::new("/proc/self/fd").exists() {
        return None;
    }
    let flags = OFlags::TMPFILE | OFlags::RDWR | OFlags::CLOEXEC;
    match rustix::fs::open(folder, flags, Mode::from_raw_mode(0o666)) {
        Ok(file) => Some(Ok(File::from(file))),
        Err(Errno::OPNOTSUPP | Errno::ISDIR | Errno::INVAL) => None,
        Err(error) => Some(Err(error.into())),
    }
}

#[cfg(target_os = "linux")]
fn link(file: &File, name: &Path) -> io::Result<()> {
    use std::os::fd::AsRawFd;

    use rustix::fs::{AtFlags, CWD, linkat};
    let itself = format!("/proc/self/fd/{}", file.as_raw_fd());
    Ok(linkat(CWD, itself, CWD, name, AtFlags::SYMLINK_FOLLOW)?)
}

/// Syncs the folder so that the file's new name survives a loss of power, where the file system supports that.
fn sync_folder(folder: &Path) -> io::Result<()> {
    if cfg!(not(unix)) {
        return Ok(());
    }
    match File::open(folder).and_then(|folder| folder.sync_all()) {
        Err(error) if matches!(error.kind(), io::ErrorKind::InvalidInput | io::ErrorKind::Unsupported) => Ok(()),
        synced => synced,
    }
}

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
