//! Separates the output that a unit prints from the answers.
#![allow(unsafe_code, reason = "the standard library has no function that exchanges the standard output")]

use std::fs::File;
use std::io;

/// Returns the original standard output. From now on this process prints to the standard error instead.
///
/// # Errors
/// The error of the system.
#[cfg(unix)]
pub fn taken() -> io::Result<File> {
    use std::os::fd::FromRawFd;
    // SAFETY: both descriptors are open files of this process, and no other thread runs yet.
    let kept = unsafe { libc::dup(libc::STDOUT_FILENO) };
    // SAFETY: as above.
    if kept < 0 || unsafe { libc::dup2(libc::STDERR_FILENO, libc::STDOUT_FILENO) } < 0 {
        return Err(io::Error::last_os_error());
    }
    // SAFETY: the descriptor was created above and has no other owner.
    Ok(unsafe { File::from_raw_fd(kept) })
}

/// Units run on no other system.
///
/// # Errors
/// Always.
#[cfg(not(unix))]
pub fn taken() -> io::Result<File> {
    Err(io::ErrorKind::Unsupported.into())
}
