//! The threads in which many worlds are stepped.
//!
//! A child process that is made by `fork`, as in `SubprocVecEnv`, does not have the threads of its parent. Therefore a
//! pool belongs to the process that made it, and a child makes its own when it first needs one.

use std::sync::{Mutex, PoisonError};

use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::errors::RunError;

/// The pool of the process with this number. Pools are never dropped: joining threads that are not there would wait for ever.
static POOL: Mutex<Option<(u32, &'static ThreadPool)>> = Mutex::new(None);

/// Runs something that uses all cores.
pub fn on_all_cores<T: Send>(run: impl FnOnce() -> T + Send) -> PyResult<T> {
    let process = std::process::id();
    let mut pool = POOL.lock().unwrap_or_else(PoisonError::into_inner);
    let threads = match *pool {
        Some((owner, threads)) if owner == process => threads,
        _ => {
            let made = ThreadPoolBuilder::new().build().map_err(|error| RunError::new_err(error.to_string()))?;
            let threads: &'static ThreadPool = Box::leak(Box::new(made));
            *pool = Some((process, threads));
            threads
        }
    };
    drop(pool);
    Ok(threads.install(run))
}
