//! Lane changes: the time at which the centre of a vehicle crosses the line, and the vehicles ahead and behind in the new lane then.

use interplay_scenarios::RecordedMoment;

use crate::geometry::LaneLine;
use crate::traffic::{Timeline, Track};

#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct LaneChange {
    /// Time gap to the vehicle ahead in the new lane; none without one \[s\].
    pub lead_gap_s: Option<f64>,
    /// Time gap of the vehicle behind in the new lane; none without one \[s\].
    pub lag_gap_s: Option<f64>,
    /// Hardest braking of the vehicle behind after the lane change \[m/s²\].
    pub lag_braking_mps2: Option<f64>,
    /// Duration of the lateral motion; none if the record begins or ends during it \[s\].
    pub duration_s: Option<f64>,
}

/// Below this speed a lateral motion counts as a turn, not as a lane change \[m/s\].
const MIN_SPEED_MPS: f64 = 3.0;
/// Vehicles farther away than this do not define a gap \[m\].
const SIGHT_M: f64 = 100.0;
/// Minimum lateral speed during a lane change \[m/s\].
const SIDEWAYS_MPS: f64 = 0.15;
/// Time window over which that speed is measured, and in which the vehicle behind brakes \[s\].
const WINDOW_S: f64 = 0.6;
const AFTER_S: f64 = 3.0;
/// Minimum lateral offset of a line that belongs to another lane \[m\].
const BESIDE_M: f64 = 1.5;

/// The lane changes in a timeline, except those that repeat others.
pub(super) fn of(timeline: &Timeline) -> Vec<LaneChange> {
    if timeline.map.is_empty() {
        return Vec::new();
    }
    let stride = (1.0 / timeline.step_s).round().max(1.0) as usize;
    let mut found = Vec::new();
    for (number, track) in timeline.tracks.iter().enumerate().filter(|(_, track)| track.is_motor) {
        for from in (0..track.moments.len().saturating_sub(stride)).step_by(stride) {
            let [before, after] = [track.moments[from], track.moments[from + stride]];
            if track.repeats[from] || before.speed_mps < MIN_SPEED_MPS {
                continue;
            }
            let (old, _) = timeline.map.way(before.position, before.heading_rad);
            let (new, _) = timeline.map.way(after.position, after.heading_rad);
            if is_beside(&old, &new, &before, &after) {
                found.push(change(timeline, number, from, stride, &new));
            }
        }
    }
    found
}

/// Whether a vehicle was in one lane and is in an adjacent one a second later.
fn is_beside(old: &LaneLine, new: &LaneLine, before: &RecordedMoment, after: &RecordedMoment) -> bool {
    let [was, is] = [old.project(before.position), new.project(after.position)];
    let left = old.project(after.position);
    let is_in = |across_m: f64, width_m: f64| across_m.abs() <= 0.5 * width_m;
    // The distance between the lines of both lanes at this position.
    let (middle, _) = new.position(is.along_m, 0.0);
    let beside_m = old.project(middle).across_m.abs();
    is_in(was.across_m, was.width_m)
        && is_in(is.across_m, is.width_m)
        && !is_in(left.across_m, left.width_m)
        && beside_m > BESIDE_M
}

fn change(timeline: &Timeline, number: usize, from: usize, stride: usize, new: &LaneLine) -> LaneChange {
    let track = &timeline.tracks[number];
    let crosses = |at: &&RecordedMoment| {
        let place = new.project(at.position);
        place.across_m.abs() <= 0.5 * place.width_m
    };
    let between = &track.moments[from..=from + stride];
    let Some(at) = between.iter().find(crosses) else { return LaneChange::default() };
    let own = new.project(at.position);
    let mut nearest: [Option<(f64, &Track)>; 2] = [None; 2];
    for (index, other) in timeline.tracks.iter().enumerate() {
        let Some(there) = other.at(at.step).filter(|_| index != number) else { continue };
        let place = new.project(there.position);
        let ahead_m = place.along_m - own.along_m;
        if place.across_m.abs() > 0.5 * place.width_m || ahead_m.abs() > SIGHT_M {
            continue;
        }
        let gap_m = ahead_m.abs() - 0.5 * (other.length_m + track.length_m);
        let place = &mut nearest[usize::from(ahead_m <= 0.0)];
        if place.is_none_or(|(nearest_m, _)| gap_m < nearest_m) {
            *place = Some((gap_m, other));
        }
    }
    let [lead, lag] = nearest;
    let time_s = |gap_m: f64, speed_mps: f64| (speed_mps > MIN_SPEED_MPS).then(|| gap_m.max(0.0) / speed_mps);
    LaneChange {
        lead_gap_s: lead.and_then(|(gap_m, _)| time_s(gap_m, at.speed_mps)),
        lag_gap_s: lag.and_then(|(gap_m, other)| time_s(gap_m, other.at(at.step)?.speed_mps)),
        lag_braking_mps2: lag.and_then(|(_, other)| braking_mps2(other, at.step, timeline.step_s)),
        duration_s: duration_s(track, at.step, new, timeline.step_s),
    }
}

/// The hardest braking of a vehicle in the 3 s after a step, averaged over a second \[m/s²\].
fn braking_mps2(track: &Track, step: i64, step_s: f64) -> Option<f64> {
    let [second, last] = [1.0, AFTER_S].map(|time_s| (time_s / step_s).round() as i64);
    let pairs = (step..=step + last - second).filter_map(|from| Some([track.at(from)?, track.at(from + second)?]));
    pairs
        .map(|[from, to]| (from.speed_mps - to.speed_mps) / (second as f64 * step_s))
        .reduce(f64::max)
        .map(|it| it.max(0.0))
}

/// Duration of the lateral motion around a step \[s\].
fn duration_s(track: &Track, step: i64, new: &LaneLine, step_s: f64) -> Option<f64> {
    let half = (0.5 * WINDOW_S / step_s).round().max(1.0) as i64;
    let sideways_mps = |at: i64| {
        let [from, to] = [track.at(at - half)?, track.at(at + half)?].map(|at| new.project(at.position).across_m);
        Some((to - from) / (2.0 * half as f64 * step_s))
    };
    let direction = sideways_mps(step)?.signum();
    let end = |towards: i64| {
        let mut at = step;
        while direction * sideways_mps(at)? > SIDEWAYS_MPS {
            at += towards;
        }
        Some(at)
    };
    Some((end(1)? - end(-1)?) as f64 * step_s)
}
