//! Running again when a scenario file is saved.

use std::path::PathBuf;
use std::thread::sleep;
use std::time::{Duration, SystemTime};

use interplay_scenarios::{Registry, files};

/// Time between two looks.
const POLL_INTERVAL: Duration = Duration::from_millis(200);

/// The files of a scenario as they were when it was last looked at.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct WatchedFiles {
    scenario: String,
    seen: Vec<(PathBuf, Option<(SystemTime, u64)>)>,
}

impl WatchedFiles {
    /// Records the present state of the files of a scenario: its own, and those that it extends or names.
    pub fn look(registry: &Registry, scenario: &str) -> WatchedFiles {
        let state = |path: &PathBuf| {
            let found = std::fs::metadata(path).ok()?;
            Some((found.modified().ok()?, found.len()))
        };
        let seen = files(registry, scenario, &[]).into_iter().map(|path| (path.clone(), state(&path))).collect();
        WatchedFiles { scenario: scenario.to_owned(), seen }
    }

    /// Whether there is any file that could change.
    pub fn is_empty(&self) -> bool {
        self.seen.is_empty()
    }

    /// Waits until a file has changed and then stays unchanged for a moment, because editors save in several steps.
    pub fn wait(self, registry: &Registry) -> WatchedFiles {
        loop {
            sleep(POLL_INTERVAL);
            let now = WatchedFiles::look(registry, &self.scenario);
            if now == self || now.is_empty() {
                continue;
            }
            sleep(POLL_INTERVAL);
            let later = WatchedFiles::look(registry, &self.scenario);
            if later == now {
                return later;
            }
        }
    }
}
