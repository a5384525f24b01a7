//! Why a vehicle stands before others whose ways cross its own or lead towards it.

use interplay_planners::Driver;
use interplay_planners::road::network::ConflictKind;

use super::{REST_M, STANDING_MPS, Standing, StandingReason};

/// A vehicle that reaches a conflict zone within this time has others wait before it, for a real car \[s\].
const ARRIVAL_S: f64 = 5.0;

impl Standing<'_> {
    /// Why a vehicle waits for one that wants to drive and is on its route before it: it follows it only if both drive the same way.
    pub(super) fn because_of(&self, index: usize, other: usize) -> StandingReason {
        let name = self.vehicles[other].name.clone();
        let along = self.cosine_to_route(index, other);
        if along > std::f64::consts::FRAC_1_SQRT_2 {
            StandingReason::Behind(name)
        } else if along < 0.0 && self.meet_in_passage(index, other) {
            StandingReason::Passage(name)
        } else {
            StandingReason::InWay(name)
        }
    }

    /// Cosine of the angle between the heading of a vehicle and the route of another one there.
    fn cosine_to_route(&self, index: usize, other: usize) -> f64 {
        let state = self.state(other);
        let at = self.vehicles[index].route.locate(state.position(), None);
        libm::cos(state.heading_rad - at.heading_rad)
    }

    /// Whether the routes of two vehicles run against each other on one strip.
    fn meet_in_passage(&self, index: usize, other: usize) -> bool {
        let mut conflicts = self.vehicles[index].route.conflicts_with(&self.vehicles[other].route);
        conflicts.any(|conflict| conflict.kind == ConflictKind::HeadOn)
    }

    /// Whether a vehicle on foot is on its way across the route of another one.
    pub(super) fn walks_across(&self, index: usize, walker: usize) -> bool {
        let along = self.cosine_to_route(index, walker).abs();
        matches!(self.vehicles[walker].driver, Driver::Walker(_)) && along < std::f64::consts::FRAC_1_SQRT_2
    }

    /// Why a vehicle stands before a walker who crosses its route.
    pub(super) fn before_walker(&self, index: usize, walker: usize) -> StandingReason {
        let (rules, name) = (&self.frame.vehicles[index].rules, &self.vehicles[walker].name);
        if rules.waits_for.contains(name) {
            return StandingReason::GivesWay(rules.waits_for.clone());
        }
        if rules.are_kept { StandingReason::GivesWay(vec![name.clone()]) } else { StandingReason::InWay(name.clone()) }
    }

    /// Why a vehicle stands before a conflict zone close ahead that another, moving one has entered or soon enters.
    pub(super) fn before_conflict(&self, index: usize, other: usize) -> Option<StandingReason> {
        let (own, theirs, scale) = (&self.vehicles[index], &self.vehicles[other], self.scale(index));
        let speed_mps = self.state(other).speed_mps;
        if speed_mps < STANDING_MPS * self.scale(other).sqrt() || !self.wants_to_drive(other) {
            return None;
        }
        let front_m = self.along_m(index) + own.body.front_m;
        let their_m = self.along_m(other);
        let reach_m = speed_mps * ARRIVAL_S * scale.sqrt();
        let mut conflicts = own.route.conflicts_with(&theirs.route);
        let conflict = conflicts.find(|conflict| {
            let is_near = (0.0..REST_M * scale).contains(&(conflict.own_m[0] - front_m));
            let comes = their_m + theirs.body.front_m + reach_m > conflict.their_m[0];
            is_near && comes && their_m - theirs.body.rear_m < conflict.their_m[1]
        })?;
        let name = theirs.name.clone();
        let is_passage = conflict.kind == ConflictKind::HeadOn;
        Some(if is_passage { StandingReason::Passage(name) } else { StandingReason::InWay(name) })
    }
}
