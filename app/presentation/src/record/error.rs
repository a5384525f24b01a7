//! Errors of recordings.

use std::io;
use std::path::{Path, PathBuf};

use rerun::RecordingStreamError;
use thiserror::Error;

/// Why a recording failed. No incomplete file is left behind.
#[derive(Debug, Error)]
pub enum RecordError {
    /// The file cannot be written.
    #[error("cannot write the recording {}: {reason}; name another file with --record, or do without (--no-record)", path.display())]
    Unwritable {
        /// Path of the file.
        path: PathBuf,
        /// The system's reason.
        reason: io::Error,
    },
    /// No viewer listens at the address.
    #[error(
        "no Rerun viewer listens on {address} ({reason}); start one first (`rerun`), or record into a file instead of --connect"
    )]
    NoViewer {
        /// Address at which a viewer was expected.
        address: String,
        /// The system's reason.
        reason: io::Error,
    },
    /// Rerun cannot parse its own default address.
    #[error(transparent)]
    Address(#[from] ViewerAddressError),
    /// Rerun refused data or lost the viewer.
    #[error("the recording broke off: {0}")]
    Broken(Box<dyn std::error::Error + Send + Sync>),
}

impl RecordError {
    pub(super) fn unwritable(path: &Path) -> impl Fn(io::Error) -> RecordError {
        move |reason| RecordError::Unwritable { path: path.to_owned(), reason }
    }
}

impl From<RecordingStreamError> for RecordError {
    fn from(error: RecordingStreamError) -> Self {
        RecordError::Broken(Box::new(error))
    }
}

/// A text that is not the address of a viewer.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
#[error("not the address of a viewer; write it like {}", rerun::DEFAULT_CONNECT_URL)]
pub struct ViewerAddressError;
