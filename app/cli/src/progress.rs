//! How far a long command has come, for whoever sits in front of it.

use std::io::{IsTerminal, Write, stderr};
use std::sync::{Mutex, PoisonError};

/// A line on stderr that is written over and over; nothing if stderr is no terminal.
pub(crate) struct Progress {
    total: usize,
    done: Mutex<usize>,
    shown: bool,
}

impl Progress {
    /// Shows that nothing of `total` is done yet.
    pub fn of(total: usize) -> Progress {
        let progress = Progress { total, done: Mutex::new(0), shown: stderr().is_terminal() };
        progress.write(&progress.line(0));
        progress
    }

    /// One more is done; may be called from any thread.
    pub fn advance(&self) {
        let mut done = self.done.lock().unwrap_or_else(PoisonError::into_inner);
        *done += 1;
        self.write(&self.line(*done));
    }

    /// Leaves an empty line.
    pub fn clear(self) {
        self.write(&format!("\r{:width$}\r", "", width = self.line(self.total).len()));
    }

    fn line(&self, done: usize) -> String {
        const WIDTH: usize = 30;
        let filled = done * WIDTH / self.total.max(1);
        format!("\r[{:-<WIDTH$}] {done} of {} runs", "#".repeat(filled), self.total)
    }

    fn write(&self, text: &str) {
        if self.shown {
            let mut stderr = stderr().lock();
            let _ = stderr.write_all(text.as_bytes()).and_then(|()| stderr.flush());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bar_fills_evenly() {
        let progress = Progress { total: 4, done: Mutex::new(0), shown: false };
        let filled = |done| progress.line(done).matches('#').count();
        assert_eq!([0, 1, 2, 3, 4].map(filled), [0, 7, 15, 22, 30]);
        progress.advance();
        assert_eq!(*progress.done.lock().expect("one thread"), 1);
        assert!((0..=4).all(|done| progress.line(done).len() == progress.line(0).len()));
    }
}
