//! Errors of recordings that cannot be evaluated.

use std::io;
use std::path::PathBuf;

use interplay_scenarios::LoadError;
use thiserror::Error;

#[derive(Debug, Error)]
pub enum RecordingsError {
    /// A folder cannot be read.
    #[error("cannot read folder `{}`: {reason}", .folder.display())]
    UnreadableFolder { folder: PathBuf, reason: io::Error },
    /// A folder has no recordings.
    #[error("there is no .xml and no .csv file in folder `{}`", .0.display())]
    EmptyFolder(PathBuf),
    /// A file is neither a scenario of CommonRoad nor a table.
    #[error("`{}` is neither a scenario of CommonRoad (.xml) nor a table (.csv)", .0.display())]
    UnknownFormat(PathBuf),
    /// A file is invalid; the error states the place.
    #[error(transparent)]
    Refused(Box<LoadError>),
    /// The recordings have no vehicle of this name.
    #[error("the recordings have no vehicle `{vehicle}`")]
    UnknownVehicle { vehicle: String },
    /// A vehicle follows others for too short a time.
    #[error(
        "`{vehicle}` follows another vehicle at {starts} whole seconds that have 1.2 s before them and 5 s after them; {needed} are needed"
    )]
    TooLittleFollowing {
        vehicle: String,
        starts: usize,
        /// Number of starts that are needed.
        needed: usize,
    },
    /// There are too few starts to compare models.
    #[error(
        "{starts} starts of moving cars with 1.2 s before them and 5 s after them are too few: both halves of the cars need some"
    )]
    TooFewStarts { starts: usize },
}

impl From<LoadError> for RecordingsError {
    fn from(error: LoadError) -> Self {
        RecordingsError::Refused(Box::new(error))
    }
}
