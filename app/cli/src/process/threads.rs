//! The threads of a command that runs many scenarios.

use std::num::NonZeroUsize;

use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::output::error::CommandError;

/// Most threads for each core: more would only wait for one another.
const MOST_PER_CORE: usize = 4;

/// Number of threads for `runs` in parallel: at most four per core; without a number, one per core.
///
/// # Errors
/// [`CommandError::Threads`] if the system refuses them.
pub(crate) fn pool(jobs: Option<NonZeroUsize>, runs: usize) -> Result<ThreadPool, CommandError> {
    let cores = std::thread::available_parallelism().map_or(1, NonZeroUsize::get);
    let jobs = jobs.map_or(cores, NonZeroUsize::get).min(MOST_PER_CORE * cores).min(runs.max(1));
    ThreadPoolBuilder::new().num_threads(jobs).build().map_err(|reason| CommandError::Threads { jobs, reason })
}
