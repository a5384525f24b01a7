//! Recorded traffic from files: joined where windows follow one another, with the rows marked that repeat others.

mod files;
mod lane_map;
mod repeats;
mod windows;

pub(crate) use lane_map::LaneMap;

use std::path::PathBuf;

use interplay_scenarios::{RecordedMoment, recorded_traffic_in_commonroad, recorded_traffic_in_table};
use rayon::prelude::*;

use crate::error::RecordingsError;

/// Recorded traffic, in groups: one for each file or folder that was named.
#[derive(Clone, Debug, Default)]
pub struct Recordings {
    pub(crate) groups: Vec<String>,
    pub(crate) timelines: Vec<Timeline>,
    files: usize,
}

/// Traffic on one map, with one axis of time.
#[derive(Clone, Debug)]
pub(crate) struct Timeline {
    /// Index of its group.
    pub group: usize,
    /// Length of a step of time \[s\].
    pub step_s: f64,
    pub map: LaneMap,
    pub tracks: Vec<Track>,
}

/// A vehicle with where it was.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Track {
    pub id: String,
    /// What the real car is called: tracks that repeat rows of one another are of one car.
    pub car: String,
    /// Whether it is a car, truck or bus.
    pub is_motor: bool,
    pub length_m: f64,
    pub width_m: f64,
    pub moments: Vec<RecordedMoment>,
    /// For each moment whether another track has told it before.
    pub repeats: Vec<bool>,
}

/// Kinds of vehicles that drive along lanes.
const MOTOR_KINDS: [&str; 5] = ["car", "truck", "bus", "taxi", "priorityVehicle"];
/// A first step that is shorter than this share of speed times step is an artefact of recording.
const FIRST_STEP_SHARE: f64 = 0.8;

impl Recordings {
    /// Reads files and folders; each argument is a group of its own.
    ///
    /// # Errors
    /// [`RecordingsError`] for what cannot be read, with its place.
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

    /// Recordings of some timelines, as one group.
    #[cfg(test)]
    pub(crate) fn of(timelines: Vec<Timeline>) -> Recordings {
        Recordings { groups: vec!["test".to_owned()], timelines, files: 1 }
    }

    /// How many files were read.
    pub fn files(&self) -> usize {
        self.files
    }

    /// How many tracks of vehicles there are, and of how many real vehicles.
    pub fn vehicles(&self) -> [usize; 2] {
        let tracks = || self.timelines.iter().flat_map(|timeline| &timeline.tracks);
        let mut cars: Vec<&str> = tracks().map(|track| track.car.as_str()).collect();
        cars.sort_unstable();
        cars.dedup();
        [tracks().count(), cars.len()]
    }

    /// How many rows were read, and how many of them repeat others.
    pub fn rows(&self) -> [usize; 2] {
        let tracks = || self.timelines.iter().flat_map(|timeline| &timeline.tracks);
        let repeated = tracks().flat_map(|track| &track.repeats).filter(|repeats| **repeats).count();
        [tracks().map(|track| track.moments.len()).sum(), repeated]
    }
}

impl Timeline {
    pub(crate) fn of(traffic: interplay_scenarios::RecordedTraffic, group: usize) -> Timeline {
        let step_s = traffic.step_s;
        let begin = traffic.vehicles.iter().filter_map(|it| it.moments.first()).map(|at| at.step).min().unwrap_or(0);
        let name = traffic.name;
        let track = |vehicle: interplay_scenarios::RecordedVehicle| {
            let mut moments = vehicle.moments;
            if let [first, second, ..] = moments.as_slice() {
                let [dx, dy] = [0, 1].map(|axis| second.position[axis] - first.position[axis]);
                let expected_m = second.speed_mps * step_s * (second.step - first.step) as f64;
                if first.step > begin && libm::hypot(dx, dy) < FIRST_STEP_SHARE * expected_m {
                    moments.remove(0);
                }
            }
            Track {
                car: format!("{name}/{}", vehicle.id),
                id: vehicle.id,
                is_motor: MOTOR_KINDS.contains(&vehicle.kind.as_str()),
                length_m: vehicle.length_m,
                width_m: vehicle.width_m,
                repeats: vec![false; moments.len()],
                moments,
            }
        };
        let tracks = traffic.vehicles.into_iter().map(track).collect();
        Timeline { group, map: LaneMap::new(traffic.lanes), step_s, tracks }
    }
}

impl Track {
    /// Where it was at a step of time, if the record says so.
    pub(crate) fn at(&self, step: i64) -> Option<&RecordedMoment> {
        let index = self.index_at(step)?;
        Some(&self.moments[index])
    }

    /// The index of the moment of a step of time.
    pub(crate) fn index_at(&self, step: i64) -> Option<usize> {
        self.moments.binary_search_by_key(&step, |at| at.step).ok()
    }
}
