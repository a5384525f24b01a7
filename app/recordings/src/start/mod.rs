//! The starting points of predictions: the state of a recorded car at a full second, and its later positions.
//!
//! The initial state ([`TrafficMoment`]) is computed only from records up to the start: from the speed that the file
//! states at the start, and from slopes over the past [`PAST_S`]. A centred filter would use future records.

mod known;

pub(crate) use known::{HORIZONS_S, Later, PAST_S, Truth, known_at};

use interplay_planners::motion_prediction::TrafficMoment;
use rayon::prelude::*;

use crate::geometry::LaneLine;
use crate::traffic::{Recordings, Timeline};

/// Slower vehicles count as standing and are not predicted \[m/s\].
const MIN_SPEED_MPS: f64 = 1.0;

#[derive(Clone, Debug)]
pub(crate) struct Start {
    /// Index of the group of recordings.
    pub group: usize,
    /// Index of its timeline.
    pub timeline: usize,
    /// Index of the car's track.
    pub track: usize,
    /// The step of time.
    pub step: i64,
    /// The line of its lane and of those straight on.
    pub way: LaneLine,
    /// The car's arc length on `way` \[m\].
    pub along_m: f64,
    pub known: TrafficMoment,
    /// The car's position at each horizon.
    pub truth: [Truth; HORIZONS_S.len()],
}

/// All starts of moving cars, a second apart, with enough records before and after them, in the order of the files. Starts that repeat
/// another one are left out.
pub(crate) fn starts(recordings: &Recordings) -> Vec<Start> {
    let timelines: Vec<(usize, &Timeline)> = recordings.timelines.iter().enumerate().collect();
    let found: Vec<Vec<Start>> = timelines.par_iter().map(|(index, timeline)| of_timeline(*index, timeline)).collect();
    found.into_iter().flatten().collect()
}

fn of_timeline(index: usize, timeline: &Timeline) -> Vec<Start> {
    let mut found = Vec::new();
    for number in timeline.motor_tracks() {
        let seconds =
            timeline.seconds(number, PAST_S).filter(|(at, repeats)| !repeats && at.speed_mps >= MIN_SPEED_MPS);
        for (at, _) in seconds {
            let Some((way, along_m, known)) = known_at(timeline, number, at.step) else { continue };
            let later = Later { timeline, track: number, step: at.step };
            let Some(truth) = later.truth(&way, along_m) else { continue };
            found.push(Start {
                group: timeline.group,
                timeline: index,
                track: number,
                step: at.step,
                way,
                along_m,
                known,
                truth,
            });
        }
    }
    found
}

#[cfg(test)]
mod tests;
