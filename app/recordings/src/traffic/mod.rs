//! Recorded traffic from files: consecutive windows are joined, and rows that repeat others are marked.

mod files;
mod lane_map;
mod repeats;
mod timeline;
mod windows;

pub(crate) use timeline::{Timeline, Track};

use std::path::PathBuf;

use interplay_scenarios::{recorded_traffic_in_commonroad, recorded_traffic_in_table};
use rayon::prelude::*;

use crate::error::RecordingsError;

/// Recorded traffic, in groups: one for each named file or folder.
#[derive(Clone, Debug, Default)]
pub struct Recordings {
    pub(crate) groups: Vec<String>,
    pub(crate) timelines: Vec<Timeline>,
    files: usize,
}

impl Recordings {
    /// Reads files and folders; each argument becomes a separate group.
    ///
    /// # Errors
    /// [`RecordingsError`] if a file cannot be read, with the place.
    pub fn read(arguments: &[PathBuf]) -> Result<Recordings, RecordingsError> {
        let mut recordings = Recordings::default();
        for (group, argument) in arguments.iter().enumerate() {
            let found = files::found_at(argument)?;
            let read: Vec<_> = found
                .par_iter()
                .map(|path| {
                    let is_table = path.extension().is_some_and(|it| it.eq_ignore_ascii_case("csv"));
                    if is_table { recorded_traffic_in_table(path) } else { recorded_traffic_in_commonroad(path) }
                })
                .collect::<Result<_, _>>()?;
            recordings.files += read.len();
            recordings.groups.push(files::group_name(argument));
            let joined = windows::joined(read);
            recordings.timelines.extend(joined.into_iter().map(|traffic| Timeline::of(traffic, group)));
        }
        repeats::mark(&mut recordings.timelines);
        Ok(recordings)
    }

    /// Recordings from timelines, as one group.
    #[cfg(test)]
    pub(crate) fn of(timelines: Vec<Timeline>) -> Recordings {
        Recordings { groups: vec!["test".to_owned()], timelines, files: 1 }
    }

    /// Number of files.
    pub fn files(&self) -> usize {
        self.files
    }

    /// Number of tracks, and of the distinct vehicles.
    pub fn vehicles(&self) -> [usize; 2] {
        let tracks = || self.timelines.iter().flat_map(|timeline| &timeline.tracks);
        let mut cars: Vec<&str> = tracks().map(|track| track.car.as_str()).collect();
        cars.sort_unstable();
        cars.dedup();
        [tracks().count(), cars.len()]
    }

    /// Number of rows, and of those that repeat others.
    pub fn rows(&self) -> [usize; 2] {
        let tracks = || self.timelines.iter().flat_map(|timeline| &timeline.tracks);
        let repeated = tracks().flat_map(|track| &track.repeats).filter(|repeats| **repeats).count();
        [tracks().map(|track| track.moments.len()).sum(), repeated]
    }
}
