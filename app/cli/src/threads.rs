//! The threads of a command that runs many scenarios.

use std::num::NonZeroUsize;

use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::error::CommandError;

/// Threads for so many runs at a time; without a number, one for each core.
///
/// # Errors
/// [`CommandError::Threads`] if the system refuses them.
pub(crate) fn pool(jobs: Option<NonZeroUsize>) -> Result<ThreadPool, CommandError> {
    let jobs = jobs.map_or(0, NonZeroUsize::get);
    ThreadPoolBuilder::new().num_threads(jobs).build().map_err(|reason| CommandError::Threads { jobs, reason })
}
