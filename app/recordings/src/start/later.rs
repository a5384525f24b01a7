//! Records after a start, used only to evaluate predictions.

use interplay_scenarios::RecordedMoment;

use super::times::HORIZONS_S;
use crate::geometry::{Box2, LaneLine};
use crate::traffic::{Timeline, Track};

/// Position of a car at a horizon.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Truth {
    /// Distance along its lane \[m\].
    pub along_m: f64,
    /// Lateral offset \[m\].
    pub across_m: f64,
}

/// The record after a start.
#[derive(Clone, Copy)]
pub(crate) struct Later<'a> {
    pub timeline: &'a Timeline,
    pub track: usize,
    pub step: i64,
}

impl<'a> Later<'a> {
    pub(crate) fn car(&self) -> &'a Track {
        &self.timeline.tracks[self.track]
    }

    fn step_after(&self, time_s: f64) -> i64 {
        self.step + (time_s / self.timeline.step_s).round() as i64
    }

    /// The car's position at each horizon; none if the record ends before the last one.
    pub(crate) fn truth(&self, way: &LaneLine, along_m: f64) -> Option<[Truth; HORIZONS_S.len()]> {
        let mut truth = [Truth::default(); HORIZONS_S.len()];
        for (truth, horizon_s) in truth.iter_mut().zip(HORIZONS_S) {
            let place = way.project(self.car().at(self.step_after(horizon_s))?.position);
            *truth = Truth { along_m: place.along_m - along_m, across_m: place.across_m };
        }
        Some(truth)
    }

    /// The body of the car a given time after the start.
    pub(crate) fn own_box(&self, time_s: f64) -> Option<Box2> {
        self.car().at(self.step_after(time_s)).map(|at| body(self.car(), at))
    }

    /// The vehicles whose bodies do not overlap the car's at the start; in some records bodies do.
    pub(crate) fn others(&self) -> Vec<&'a Track> {
        let own = self.own_box(0.0);
        let others = self.timeline.tracks.iter().enumerate().filter(|(index, _)| *index != self.track);
        let apart = |other: &&Track| {
            let at = other.at(self.step).map(|at| body(other, at));
            own.zip(at).is_none_or(|(own, other)| !own.overlaps(&other))
        };
        others.map(|(_, other)| other).filter(apart).collect()
    }

    /// Whether a body overlaps any recorded body of `others` a given time after the start.
    pub(crate) fn touches(&self, own: &Box2, others: &[&Track], time_s: f64) -> bool {
        let step = self.step_after(time_s);
        others.iter().any(|other| other.at(step).is_some_and(|at| body(other, at).overlaps(own)))
    }
}

/// The body of a vehicle at a recorded time.
pub(crate) fn body(track: &Track, at: &RecordedMoment) -> Box2 {
    Box2 { middle: at.position, heading_rad: at.heading_rad, half_m: [0.5 * track.length_m, 0.5 * track.width_m] }
}
