//! Why a vehicle does not pass an obstacle.

use super::{REST_M, STANDING_MPS, Standing, StandingReason};

/// Distance up to which oncoming traffic prevents a real car from passing an obstacle \[m\].
const ONCOMING_M: f64 = 150.0;
/// Lateral clearance needed for passing, beside both bodies, for a real car \[m\].
const ASIDE_M: f64 = 0.7;
/// Length of free road beyond an obstacle needed to return behind it, for a real car \[m\].
const RETURN_M: f64 = 60.0;

impl Standing<'_> {
    /// Why a vehicle does not pass an obstacle.
    pub(super) fn before_passing(&self, index: usize, obstacle: usize) -> Option<StandingReason> {
        let (own, other) = (&self.vehicles[index], &self.vehicles[obstacle]);
        let at = own.route.locate(self.state(obstacle).position(), None);
        let [right_m, left_m] = own.route.edges_before_end_m(at.along_m);
        let needed_m = 0.5 * other.body.width_m + own.body.width_m + ASIDE_M * self.scale(index);
        let name = || other.name.clone();
        if left_m - at.across_m < needed_m && at.across_m - right_m < needed_m {
            return Some(StandingReason::NoRoom(name()));
        }
        let reach_m = ONCOMING_M * self.scale(index);
        let others = self.others(index).filter(|other| *other != obstacle);
        let comes = |other: &usize| {
            let place = own.route.locate(self.state(*other).position(), None);
            let beside = (place.across_m - at.across_m).abs() > 0.5 * self.vehicles[*other].body.width_m;
            let speed_mps = self.state(*other).speed_mps;
            let is_near = (place.along_m - at.along_m).abs() < reach_m;
            is_near && beside && speed_mps > STANDING_MPS && (right_m..=left_m).contains(&place.across_m)
        };
        let waits_for = others.into_iter().find(comes)?;
        Some(StandingReason::Passing { waits_for: self.vehicles[waits_for].name.clone(), obstacle: name() })
    }

    /// Whether something stationary fills the road beside an obstacle, or so close beyond it that a vehicle cannot return behind it.
    pub(crate) fn is_walled(&self, index: usize, obstacle: usize) -> bool {
        let (own, scale) = (&self.vehicles[index], self.scale(index));
        let at = own.route.locate(self.state(obstacle).position(), None);
        let [right_m, left_m] = own.route.edges_before_end_m(at.along_m);
        let needed_m = own.body.width_m + ASIDE_M * scale;
        let half_m = 0.5 * self.vehicles[obstacle].body.width_m;
        let sides_m = [[at.across_m + half_m, left_m], [right_m, at.across_m - half_m]];
        self.others(index).filter(|other| *other != obstacle).any(|other| {
            let (half_m, state) = (0.5 * self.vehicles[other].body.width_m, self.state(other));
            let place = own.route.locate(state.position(), None);
            let stands = state.speed_mps < STANDING_MPS * self.scale(other).sqrt();
            let is_near = (-REST_M * scale..RETURN_M * scale).contains(&(place.along_m - at.along_m));
            // The wider of the two strips of a side that remain beside the other one.
            let free_m = |[from_m, to_m]: [f64; 2]| {
                let right_of_it_m = (place.across_m - half_m).min(to_m) - from_m;
                right_of_it_m.max(to_m - (place.across_m + half_m).max(from_m))
            };
            stands && is_near && sides_m.into_iter().all(|side_m| free_m(side_m) < needed_m)
        })
    }
}
