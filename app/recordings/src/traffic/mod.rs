//! Recorded traffic from files: consecutive windows are joined, and rows that repeat others are marked.

mod lane_map;
mod timeline;
mod windows;

pub(crate) use timeline::{Timeline, Track};

use std::fs;
use std::path::{Path, PathBuf};

use interplay_scenarios::{is_commonroad, recorded_traffic_in_commonroad, recorded_traffic_in_table};
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
            let found = found_at(argument)?;
            let read: Vec<_> = found
                .par_iter()
                .map(|path| {
                    let is_table = path.extension().is_some_and(|it| it.eq_ignore_ascii_case("csv"));
                    if is_table { recorded_traffic_in_table(path) } else { recorded_traffic_in_commonroad(path) }
                })
                .collect::<Result<_, _>>()?;
            recordings.files += read.len();
            recordings.groups.push(group_name(argument));
            let joined = windows::joined(read);
            recordings.timelines.extend(joined.into_iter().map(|traffic| Timeline::of(traffic, group)));
        }
        windows::mark(&mut recordings.timelines);
        Ok(recordings)
    }

    /// Recordings from timelines, as one group.
    #[cfg(test)]
    pub(crate) fn of(timelines: Vec<Timeline>) -> Recordings {
        Recordings { groups: vec!["test".to_owned()], timelines, files: 1 }
    }

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

/// The recordings that an argument names: a file, or the files below a folder, sorted.
fn found_at(argument: &Path) -> Result<Vec<PathBuf>, RecordingsError> {
    if !argument.is_dir() {
        let is_xml = argument.extension().is_some_and(|it| it.eq_ignore_ascii_case("xml"));
        if is_xml || is_table(argument) {
            return Ok(vec![argument.to_owned()]);
        }
        return Err(RecordingsError::UnknownFormat(argument.to_owned()));
    }
    let mut found = Vec::new();
    collect(argument, &mut found)?;
    found.sort();
    if found.is_empty() { Err(RecordingsError::EmptyFolder(argument.to_owned())) } else { Ok(found) }
}

fn is_table(path: &Path) -> bool {
    path.extension().is_some_and(|it| it.eq_ignore_ascii_case("csv"))
}

fn collect(folder: &Path, found: &mut Vec<PathBuf>) -> Result<(), RecordingsError> {
    let unreadable = |reason| RecordingsError::UnreadableFolder { folder: folder.to_owned(), reason };
    for entry in fs::read_dir(folder).map_err(unreadable)? {
        let entry = entry.map_err(unreadable)?;
        let path = entry.path();
        // Links to folders are not followed, because one could lead back to itself.
        if entry.file_type().map_err(unreadable)?.is_dir() {
            collect(&path, found)?;
        } else if is_table(&path) || is_commonroad(&path) {
            found.push(path);
        }
    }
    Ok(())
}

/// The name of an argument's group: its last path component, without the extension of a file.
fn group_name(argument: &Path) -> String {
    let name = if argument.is_dir() { argument.file_name() } else { argument.file_stem() };
    name.map_or_else(|| argument.display().to_string(), |name| name.to_string_lossy().into_owned())
}
