//! The last line that a process writes to its standard error, which is usually the reason why it ends.

use std::io::{BufRead, BufReader, Read};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::Duration;

/// Maximum length of a line of the process that an error shows \[characters\].
const SHOWN_CHARACTERS: usize = 120;

/// Reads the standard error of a process to its end, in a thread, and keeps the last line that is not blank.
#[derive(Debug)]
pub(crate) struct LastLine {
    line: Arc<Mutex<String>>,
    /// Disconnected once the thread has read everything.
    open: Mutex<Receiver<()>>,
}

impl LastLine {
    pub(crate) fn read(errors: impl Read + Send + 'static) -> Self {
        let line = Arc::new(Mutex::new(String::new()));
        let (reading, open) = mpsc::channel();
        let last = Arc::clone(&line);
        thread::spawn(move || {
            // This sender is dropped when the thread ends.
            let _reading: mpsc::Sender<()> = reading;
            // Units in other languages may write encodings other than UTF-8.
            for line in BufReader::new(errors).split(b'\n').map_while(Result::ok) {
                let line = String::from_utf8_lossy(&line);
                if !line.trim().is_empty()
                    && let Ok(mut last) = last.lock()
                {
                    *last = shown(line.trim_end());
                }
            }
        });
        Self { line, open: Mutex::new(open) }
    }

    /// Returns the last line of a process that has ended, or nothing if it wrote none.
    ///
    /// Waits until everything is read, but at most `timeout`: a child of the ended process may keep the standard error open.
    pub(crate) fn at_end(&mut self, timeout: Duration) -> String {
        if let Ok(open) = self.open.get_mut() {
            // The channel carries no messages: it only disconnects.
            let (Ok(()) | Err(RecvTimeoutError::Timeout | RecvTimeoutError::Disconnected)) = open.recv_timeout(timeout);
        }
        self.line.lock().map(|line| line.clone()).unwrap_or_default()
    }
}

/// The beginning of a line of the process, as an error shows it.
pub(crate) fn shown(line: &str) -> String {
    line.chars().take(SHOWN_CHARACTERS).flat_map(char::escape_debug).collect()
}
