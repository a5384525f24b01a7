//! Traffic on one map with one time axis.

use interplay_scenarios::{RecordedMoment, RecordedTraffic, RecordedVehicle};

use super::lane_map::LaneMap;

/// Traffic on one map with one time axis.
#[derive(Clone, Debug)]
pub(crate) struct Timeline {
    pub group: usize,
    /// Time step \[s\].
    pub step_s: f64,
    pub map: LaneMap,
    pub tracks: Vec<Track>,
}

/// A vehicle with its recorded positions.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Track {
    pub id: String,
    /// The name of the real car: tracks that repeat rows of one another belong to one car.
    pub car: String,
    /// Whether it is a car, truck or bus.
    pub is_motor: bool,
    pub length_m: f64,
    pub width_m: f64,
    pub moments: Vec<RecordedMoment>,
    /// For each recorded time, whether an earlier track contains it.
    pub repeats: Vec<bool>,
}

/// Kinds of vehicles that drive along lanes.
const MOTOR_KINDS: [&str; 5] = ["car", "truck", "bus", "taxi", "priorityVehicle"];
/// A first step shorter than this share of speed times time step is an artefact of the recording.
const FIRST_STEP_SHARE: f64 = 0.8;

impl Timeline {
    pub(crate) fn of(traffic: RecordedTraffic, group: usize) -> Timeline {
        let step_s = traffic.step_s;
        let begin = traffic.vehicles.iter().filter_map(|it| it.moments.first()).map(|at| at.step).min().unwrap_or(0);
        let name = traffic.name;
        let track = |vehicle: RecordedVehicle| {
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

    /// The indices of the tracks of cars, trucks and buses.
    pub(crate) fn motor_tracks(&self) -> impl Iterator<Item = usize> {
        (0..self.tracks.len()).filter(|track| self.tracks[*track].is_motor)
    }

    /// The records of a vehicle a second apart, from the first one with `past_s` of records before it, each with whether an earlier
    /// track contains it \[s\].
    pub(crate) fn seconds(&self, track: usize, past_s: f64) -> impl Iterator<Item = (&RecordedMoment, bool)> {
        let in_steps = |time_s: f64| (time_s / self.step_s).round().max(1.0) as i64;
        let Track { moments, repeats, .. } = &self.tracks[track];
        let (from, between) = (moments.first().map_or(0, |at| at.step) + in_steps(past_s), in_steps(1.0));
        let told = moments.iter().zip(repeats.iter().copied());
        told.filter(move |(at, _)| at.step >= from && (at.step - from) % between == 0)
    }
}

impl Track {
    /// The record of the vehicle at a step; `None` without one.
    pub(crate) fn at(&self, step: i64) -> Option<&RecordedMoment> {
        let index = self.index_at(step)?;
        Some(&self.moments[index])
    }

    /// The index of its record at a step.
    pub(crate) fn index_at(&self, step: i64) -> Option<usize> {
        self.moments.binary_search_by_key(&step, |at| at.step).ok()
    }
}
