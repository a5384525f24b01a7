//! Reads files that users name: only regular files, up to a size, and without blocking.

use std::fs::{File, OpenOptions};
use std::io::{self, Read};
use std::path::Path;

/// Opens a file for reading.
///
/// Refuses a pipe or a device, because reading it may block forever or never end. If a file that claims to be regular
/// would block a reader, as some files below `/proc` do, reading it fails instead.
///
/// # Errors
/// The system's error, or the type of the file if it is not regular.
pub fn open_regular(path: &Path) -> io::Result<File> {
    let mut options = OpenOptions::new();
    options.read(true);
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::custom_flags(&mut options, libc::O_NONBLOCK);
    let file = options.open(path)?;
    let found = file.metadata()?;
    if found.is_dir() {
        return Err(io::Error::new(io::ErrorKind::IsADirectory, "it is a directory"));
    }
    if !found.is_file() {
        return Err(io::Error::other("it is a pipe or a device, not an ordinary file"));
    }
    Ok(file)
}

/// The content of a regular file of at most `limit` bytes; `None` for a larger one.
///
/// # Errors
/// As [`open_regular`], and those of reading.
pub fn read_regular(path: &Path, limit: u64) -> io::Result<Option<Vec<u8>>> {
    let mut bytes = Vec::new();
    open_regular(path)?.take(limit + 1).read_to_end(&mut bytes)?;
    Ok((bytes.len() as u64 <= limit).then_some(bytes))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regular_files_are_read_up_to_the_limit() {
        let here = Path::new(env!("CARGO_MANIFEST_DIR")).join("Cargo.toml");
        let length = std::fs::metadata(&here).expect("there").len();
        assert_eq!(read_regular(&here, length).expect("read").expect("within the limit").len() as u64, length);
        assert_eq!(read_regular(&here, length - 1).expect("read"), None);
    }

    /// An endless device, one that blocks its reader, and a folder.
    #[cfg(unix)]
    #[test]
    fn pipes_devices_and_folders_are_refused_without_blocking() {
        for path in ["/dev/zero", "/dev/tty", "/dev", "/nowhere"] {
            assert!(read_regular(Path::new(path), 10).is_err(), "{path}");
        }
    }
}
