//! Motion of vehicles within a tick, and the next time at which two of them can touch.
//!
//! Every component of a state changes linearly from its value at the beginning of the tick to that at its end. Over the whole
//! tick, two points of two vehicles approach by at most `‖Δp_a − Δp_b‖ + |Δθ_a| r_a + |Δθ_b| r_b`, with the
//! displacements `Δp` of the mass centres, the rotations `Δθ` and the distances `r` of the farthest corners. So two
//! vehicles that are `gap` apart cannot touch before the share `gap / approach` of a tick has passed. Checking again at that
//! time (conservative advancement) finds, at any speed, every contact that is longer than the shortest step.

use interplay_planners::State;

use super::footprint::{Footprint, distance_m};
use super::gap::least_gap_m;
use super::near_pairs::near_pairs;

/// The shortest step between two checks, in ticks: the resolution of contact times.
pub(super) const MIN_STEP_TICKS: f64 = 1e-3;
/// The longest step between two checks, in ticks, at any distance of the vehicles.
const MAX_STEP_TICKS: f64 = 0.25;

/// The motion of one vehicle during a tick.
pub(super) struct Path {
    /// Footprint of the vehicle.
    pub footprint: Footprint,
    /// Whether it is not on the road.
    pub is_absent: bool,
    /// State at the beginning of the tick.
    pub from: State,
    /// State at the end of the tick.
    pub to: State,
}

impl Path {
    /// The state when a share of the tick has passed.
    pub fn at(&self, share: f64) -> State {
        self.from.towards(&self.to, share)
    }

    /// The circle around it in a state; none if it is not on the road.
    fn circle(&self, state: &State) -> Option<([f64; 2], f64)> {
        (!self.is_absent).then(|| (state.position(), self.footprint.radius_m))
    }

    /// Upper bound of the displacement of its points during the tick \[m\].
    fn moved_m(&self) -> f64 {
        let moved_m = libm::hypot(self.to.x_m - self.from.x_m, self.to.y_m - self.from.y_m);
        moved_m + (self.to.heading_rad - self.from.heading_rad).abs() * self.footprint.radius_m
    }

    /// Upper bound of the decrease of the gap to another vehicle during the tick \[m\].
    fn approach_m(&self, other: &Path) -> f64 {
        let moved = |path: &Path| [path.to.x_m - path.from.x_m, path.to.y_m - path.from.y_m];
        let swept = |path: &Path| (path.to.heading_rad - path.from.heading_rad).abs() * path.footprint.radius_m;
        let ([ax, ay], [bx, by]) = (moved(self), moved(other));
        ((ax - bx) * (ax - bx) + (ay - by) * (ay - by)).sqrt() + swept(self) + swept(other)
    }
}

/// The share of the tick at the next check, after one at `share`.
pub(super) fn next_look(paths: &[Path], share: f64) -> f64 {
    let states: Vec<State> = paths.iter().map(|path| path.at(share)).collect();
    let mut step = MAX_STEP_TICKS;
    let circles: Vec<_> = paths.iter().zip(&states).map(|(path, state)| path.circle(state)).collect();
    // Vehicles too far apart to meet in the longest step do not shorten it.
    let fastest_m = paths.iter().map(Path::moved_m).fold(0.0, f64::max);
    for [one, other] in near_pairs(&circles, 2.0 * MAX_STEP_TICKS * fastest_m) {
        let (a, b) = (&paths[one], &paths[other]);
        let (a_now, b_now) = ((&a.footprint, &states[one]), (&b.footprint, &states[other]));
        let approach = a.approach_m(b);
        if least_gap_m(a_now, b_now) >= step * approach {
            continue;
        }
        let gap = distance_m(a_now, b_now);
        // Vehicles that touch already cannot begin to touch.
        if approach > 0.0 && gap > 0.0 {
            step = step.min(gap / approach);
        }
    }
    (share + step.max(MIN_STEP_TICKS)).min(1.0)
}
