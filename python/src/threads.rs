//! The threads in which many worlds are stepped, and calls that a signal ends.
//!
//! A child process that is made by `fork`, as in `SubprocVecEnv`, does not have the threads of its parent. Therefore a
//! pool belongs to the process that made it, and a child makes its own when it first needs one.

use std::cell::Cell;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use pyo3::exceptions::PyRecursionError;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::errors::RunError;

/// The pool of the process with this number. Pools are never dropped: joining threads that are not there would wait for ever.
static POOL: Mutex<Option<(u32, &'static ThreadPool)>> = Mutex::new(None);

/// Interval at which a call looks for signals.
const SIGNALS_EVERY: Duration = Duration::from_millis(50);
/// Largest number of calls inside each other, by functions of Python that run something themselves.
const MAX_DEPTH: usize = 16;

thread_local! {
    /// Number of calls in which the work of this thread is.
    static DEPTH: Cell<usize> = const { Cell::new(0) };
}

/// Runs something in a thread of its own, and tells it to end after a signal that raises an exception, such as `KeyboardInterrupt`, or if
/// `is_cancelled` returns true. The exception is raised when the thread has ended.
pub fn interruptible<T: Send>(
    py: Python<'_>,
    is_cancelled: Option<&Py<PyAny>>,
    run: impl FnOnce(&AtomicBool) -> PyResult<T> + Send,
) -> PyResult<T> {
    let depth = DEPTH.get() + 1;
    if depth > MAX_DEPTH {
        return Err(PyRecursionError::new_err(format!("more than {MAX_DEPTH} runs in functions of each other")));
    }
    let (ended, (sender, receiver)) = (AtomicBool::new(false), channel());
    let (ended, receiver) = (&ended, Mutex::new(receiver));
    let asked = || -> PyResult<bool> {
        py.check_signals()?;
        is_cancelled.map_or(Ok(false), |function| function.call0(py)?.extract(py))
    };
    thread::scope(|scope| {
        scope.spawn(move || {
            DEPTH.set(depth);
            drop(sender.send(run(ended)));
        });
        let mut raised = None;
        loop {
            let wait = || receiver.lock().unwrap_or_else(PoisonError::into_inner).recv_timeout(SIGNALS_EVERY);
            match py.detach(wait) {
                Ok(result) => return raised.map_or(result, Err),
                Err(RecvTimeoutError::Disconnected) => return Err(RunError::new_err("the run has ended with a panic")),
                Err(RecvTimeoutError::Timeout) if raised.is_some() => {}
                Err(RecvTimeoutError::Timeout) => {
                    raised = asked().map_or_else(Some, |is| is.then(|| RunError::new_err("the run was cancelled")));
                    ended.store(raised.is_some(), Ordering::Relaxed);
                }
            }
        }
    })
}

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
