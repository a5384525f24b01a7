//! Keeps what a unit prints out of the answers.
#![allow(unsafe_code, reason = "the standard library has no function that exchanges the standard output")]

use std::fs::File;
use std::io;

/// The standard output as it was. What this process prints from now on goes to the standard error.
///
/// # Errors
/// What the system says.
#[cfg(unix)]
pub fn taken() -> io::Result<File> {
    use std::os::fd::FromRawFd;
    // SAFETY: both numbers are open files of this process, and no other thread runs yet.
    let kept = unsafe { libc::dup(libc::STDOUT_FILENO) };
    // SAFETY: as above.
    if kept < 0 || unsafe { libc::dup2(libc::STDERR_FILENO, libc::STDOUT_FILENO) } < 0 {
        return Err(io::Error::last_os_error());
    }
    // SAFETY: the number was made above, and nobody else has it.
    Ok(unsafe { File::from_raw_fd(kept) })
}

/// Nowhere else are units run.
///
/// # Errors
/// Always.
#[cfg(not(unix))]
pub fn taken() -> io::Result<File> {
    Err(io::ErrorKind::Unsupported.into())
}
