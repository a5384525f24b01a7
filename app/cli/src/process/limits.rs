//! Limits of the operating system: a command that reaches one ends with exit code 3 and a reason, instead of being killed by a signal.

use std::num::NonZeroUsize;
use std::{io, thread};

use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};

use crate::output::error::CommandError;

/// Stack of the thread that does the work \[bytes\], whatever `ulimit -s` leaves to the first one.
const STACK_BYTES: usize = 16 << 20;

/// Does work on a thread with a stack of its own, once the threads that it may share are there.
///
/// # Errors
/// The system's reason, if it has no such threads.
pub(crate) fn on_a_thread_of_its_own<T: Send>(work: impl FnOnce() -> T + Send) -> io::Result<T> {
    // The threads are started beforehand, because rayon panics if it cannot start them later. A pool that already exists is not an error.
    if let Err(reason) = ThreadPoolBuilder::new().build_global()
        && !is_there_already(&reason)
    {
        return Err(io::Error::other(reason));
    }
    thread::scope(|scope| {
        let worker = thread::Builder::new().name("main work".to_owned()).stack_size(STACK_BYTES);
        let worker = worker.spawn_scoped(scope, work)?;
        // A panic in the worker thread continues on this thread.
        Ok(worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
    })
}

fn is_there_already(reason: &ThreadPoolBuildError) -> bool {
    std::error::Error::source(reason).is_none()
}

/// Writing more than `ulimit -f` allows fails as on a full disk, and does not end the process.
#[cfg(unix)]
pub(crate) fn writing_too_much_is_an_error() {
    #![expect(unsafe_code, reason = "a signal cannot be ignored in another way")]
    // SAFETY: the arguments are constants of the system, and no other thread runs yet.
    unsafe {
        libc::signal(libc::SIGXFSZ, libc::SIG_IGN);
    }
}

/// Other systems have no such signal.
#[cfg(not(unix))]
pub(crate) fn writing_too_much_is_an_error() {}

/// Most threads for each core: more would only wait for one another.
const MOST_PER_CORE: usize = 4;

/// Number of threads for `runs` in parallel: at most four per core; without a number, one per core.
///
/// # Errors
/// [`CommandError::Threads`] if the system refuses them.
pub(crate) fn pool(jobs: Option<NonZeroUsize>, runs: usize) -> Result<ThreadPool, CommandError> {
    let cores = thread::available_parallelism().map_or(1, NonZeroUsize::get);
    let jobs = jobs.map_or(cores, NonZeroUsize::get).min(MOST_PER_CORE * cores).min(runs.max(1));
    ThreadPoolBuilder::new().num_threads(jobs).build().map_err(|reason| CommandError::Threads { jobs, reason })
}
