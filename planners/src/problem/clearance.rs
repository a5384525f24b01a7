//! The time gap that drivers who know comfort keep to those on the same road.
//!
//! Of recorded people, gaps between bumpers in steady following are 3.5 m + 1.15 s · v, and time gaps spread from 0.6 to 3.7 s
//! (`docs/guide/people.md`). A human keeps the more, the more safety weighs for it. No human pulls into a gap below a least one,
//! ahead or behind.

use crate::road::network::ConflictKind;
use crate::scene::duties::owed_gap_m;
use crate::scene::relation::Relation;
use crate::trajectory::Penalty;
use crate::trajectory::terms::KeepOut;
use crate::vehicle::OrientedEllipse;
use crate::{Agent, Route, SafetyEllipse, Scene, Trajectory};

/// Gap between bumpers at standstill, for 1/10 scale cars \[m\].
pub(crate) const STANDSTILL_GAP_M: f64 = 0.35;
/// A driver of safety weight 0 keeps this share of the usual time gap, and a nice one this one.
const GAP_SHARES: [f64; 2] = [0.6, 1.4];
/// The weight of a nice driver, up to which shares grow with the logarithm.
const NICE_WEIGHT: f64 = 50.0;
/// Smallest share of the usual time gap to which a driver approaches by choice.
pub(super) const FIRM_SHARE: f64 = 0.45;
/// The least gap ahead or behind for a change of lane, as a share of the usual time gap: 1 s.
const ACCEPTED_SHARE: f64 = 0.85;
/// A planner keeps this share of the usual time gap besides its safety ellipse.
pub(super) const PLANNER_SHARE: f64 = 0.7;
/// A gap that is shorter grows by this much in a second.
pub(super) const OPENING: f64 = 0.1;
/// Length of the ellipse that contains two bodies, as a multiple of theirs.
const CONTAINING_RATIO: f64 = 1.8;
/// In a gap, a body is kept out of this share of the space between it and the other one.
const FITTING_SHARE: f64 = 0.6;
/// Bodies side by side keep this far apart, for 1/10 scale cars \[m\].
pub(super) const ASIDE_M: f64 = 0.04;
/// A vehicle beyond the line of its lane by less than this stays in it, for 1/10 scale cars \[m\].
const BEYOND_LINE_M: f64 = 0.03;

/// The share of the usual time gap that a driver keeps, by its safety weight.
pub(crate) fn share_of(weight: f64) -> f64 {
    let [tough, nice] = GAP_SHARES;
    let politeness = (libm::log1p(weight) / libm::log1p(NICE_WEIGHT)).min(1.0);
    tough + (nice - tough) * politeness
}

/// The safety weight of which a human keeps a share of the usual time gap; those of shares beyond all weights are the outermost ones.
pub fn safety_weight_keeping(share: f64) -> f64 {
    let [tough, nice] = GAP_SHARES;
    let politeness = ((share - tough) / (nice - tough)).clamp(0.0, 1.0);
    libm::expm1(politeness * libm::log1p(NICE_WEIGHT))
}

impl Scene {
    /// An ellipse of the planning vehicle's safety distance around a predicted motion; the vehicle is number 0.
    /// Each ellipse lies along `route`.
    pub fn keep_out(&self, prediction: &Trajectory, route: &Route, penalty: Penalty) -> KeepOut {
        let centres = self.centres(prediction);
        KeepOut { vehicle: 0, ellipses: ellipses(self.goal.safety, route, &centres), centres, penalty }
    }

    /// Half the length of an ellipse around another vehicle at whose end there is a gap between bumpers \[m\].
    fn half_axis_m(&self, other: &Agent, gap_m: f64) -> f64 {
        let (ego, body) = (&self.ego.body, &other.body);
        0.5 * (ego.front_m + ego.rear_m + body.front_m + body.rear_m) + gap_m
    }

    /// The half axes along the road of the ellipses around the vehicle ahead: the comfortable one of a driver of a safety weight, who may
    /// state which multiple of the usual time gap it keeps, and the firm one; none for a driver who knows no comfort \[m\].
    pub(crate) fn following_axes_m(&self, leader: &Agent, weight: f64, ratio: Option<f64>) -> Option<[f64; 2]> {
        let time_gap_s = self.ego.limits.comfort?.time_gap_s;
        let (standstill_m, speed_mps) = (STANDSTILL_GAP_M * self.ego.body.scale, self.ego.state.speed_mps);
        let comfortable_m = standstill_m + ratio.unwrap_or_else(|| share_of(weight)) * time_gap_s * speed_mps;
        let firm_m = 0.5 * standstill_m + FIRM_SHARE * time_gap_s * speed_mps;
        Some([comfortable_m, firm_m].map(|gap_m| self.half_axis_m(leader, gap_m)))
    }

    /// What keeps a driver who knows comfort from pulling out right ahead of a vehicle in another lane of its road, or right behind: an
    /// ellipse as wide as both bodies.
    pub(crate) fn lane_change_keep_out(&self, other: &Agent, weight: f64) -> Option<KeepOut> {
        let ego = &self.ego;
        let is_same_way = libm::cos(other.state.heading_rad - ego.route.heading_at(other.state.position())) > 0.0;
        let is_aside = matches!(ego.relation(other), Relation::Alongside) && !ego.shares_lane_with(other);
        if !is_aside || !is_same_way || other.is_obstacle {
            return None;
        }
        let along_m = self.accepted_axis_m(other, weight)?;
        let across_m = 0.5 * (ego.body.width_m + other.body.width_m) + ASIDE_M * ego.body.scale;
        Some(self.around(other, SafetyEllipse { along_m, across_m }, Penalty::EXACT))
    }

    /// Half the length of an ellipse at whose end there is the least gap for a change of lane that a driver of a safety weight accepts;
    /// none for a driver who knows no comfort \[m\].
    fn accepted_axis_m(&self, other: &Agent, weight: f64) -> Option<f64> {
        let time_gap_s = self.ego.limits.comfort?.time_gap_s;
        let least_s = ACCEPTED_SHARE * time_gap_s * (0.5 + 0.5 * share_of(weight));
        Some(self.half_axis_m(other, least_s * self.ego.state.speed_mps.max(other.state.speed_mps)))
    }

    /// What a driver of a safety weight keeps free for a vehicle that is predicted to come into its way: the safety ellipse, and for one
    /// ahead in another lane of its road as much as that one needs in order to come.
    pub(crate) fn room_for(&self, other: &Agent, prediction: &Trajectory, weight: f64, penalty: Penalty) -> KeepOut {
        let mut room = self.keep_out(prediction, &other.route, penalty);
        let ego = &self.ego;
        let is_ahead = matches!(ego.relation(other), Relation::Alongside) && ego.lead_of(other) > 0.0;
        if let Some(accepted_m) = self.accepted_axis_m(other, weight).filter(|_| is_ahead) {
            let SafetyEllipse { along_m, across_m } = self.goal.safety;
            let safety = SafetyEllipse { along_m: along_m.max(accepted_m), across_m };
            room.ellipses = ellipses(safety, &other.route, &room.centres);
        }
        room
    }

    /// An ellipse around a prediction of another vehicle.
    fn around(&self, other: &Agent, ellipse: SafetyEllipse, penalty: Penalty) -> KeepOut {
        let centres = self.centres(&other.prediction);
        KeepOut { vehicle: 0, ellipses: ellipses(ellipse, &other.route, &centres), centres, penalty }
    }

    /// Whether a vehicle is oncoming: a driver that knows comfort passes it side by side.
    pub(crate) fn meets_in_its_lane(&self, other: &Agent) -> bool {
        let is_head_on =
            |relation| matches!(relation, Relation::Conflict(conflict) if conflict.kind == ConflictKind::HeadOn);
        self.ego.limits.comfort.is_some() && is_head_on(self.ego.relation(other))
    }

    /// Whether a vehicle that is oncoming, or waits for the planning vehicle, is not expected in the lane in which that one
    /// stays: its lines alone keep the two apart.
    pub(crate) fn is_parted_by_lane_line(&self, other: &Agent) -> bool {
        let ego = &self.ego;
        if !ego.rules.stays_in_lane || !(self.meets_in_its_lane(other) || ego.is_waited_for_by(other)) {
            return false;
        }
        let (tolerance_m, body) = (BEYOND_LINE_M * ego.body.scale, &other.body);
        let positions: Vec<[f64; 2]> = other.prediction.states.iter().map(|state| state.position()).collect();
        ego.route.locate_all(&positions).zip(&other.prediction.states).all(|(at, state)| {
            let (sin, cos) = libm::sincos(state.heading_rad - at.heading_rad);
            let reach_m = 0.5 * body.width_m * cos.abs() + body.front_m.max(body.rear_m) * sin.abs();
            at.across_m.abs() + tolerance_m > ego.route.half_width.value(at.along_m) + reach_m
        })
    }

    /// What keeps the planning vehicle from touching a vehicle that waits for it or is oncoming, or an obstacle.
    pub(crate) fn beside(&self, other: &Agent, penalty: Penalty) -> KeepOut {
        let ego = &self.ego.body;
        let [half_length_m, half_width_m] = other.half_extents_m(other.place().heading_rad);
        let along_m = 0.5 * (ego.front_m + ego.rear_m) + half_length_m;
        let beside_m = 0.5 * ego.width_m + half_width_m + ASIDE_M * ego.scale;
        let passes = self.ego.rules.passes.as_ref().filter(|_| other.is_obstacle);
        let room_m = passes.map_or(f64::INFINITY, |obstacle| {
            (self.ego.route.across(other.state.position()) - obstacle.pass_at_m).abs()
        });
        let touching_m = 0.5 * ego.width_m + half_width_m;
        self.around(other, containing(along_m, beside_m).fitting(along_m, touching_m, room_m), penalty)
    }

    /// The ellipse that a planner asks another vehicle to leave it: the safety ellipse, and before or behind one in another lane of which
    /// the motion is seen, what is owed at equal speeds.
    pub(crate) fn room_asked_of(&self, other: &Agent) -> SafetyEllipse {
        let SafetyEllipse { along_m, across_m } = self.goal.safety;
        let ego = &self.ego;
        let is_beside = matches!(ego.relation(other), Relation::Alongside) && !ego.shares_lane_with(other);
        if !self.knowledge.is_of_motion() || !is_beside {
            return self.goal.safety;
        }
        let behind = if ego.lead_of(other) < 0.0 { other } else { ego };
        let (body, speed_mps) = (&behind.body, behind.state.speed_mps);
        let owed_m = self.half_axis_m(other, owed_gap_m(body, speed_mps, speed_mps));
        SafetyEllipse { along_m: along_m.max(owed_m), across_m }
    }

    /// Whether the safety ellipse around another vehicle concerns the planning vehicle; for a driver that knows comfort it does not once
    /// their ways do not meet any more, nor where a line parts it from a vehicle that waits, nor around one behind while it stays in its
    /// lane: that one keeps its distance.
    pub(crate) fn minds(&self, other: &Agent) -> bool {
        let ego = &self.ego;
        let is_beside = || ego.is_waited_for_by(other) && self.is_parted_by_lane_line(other);
        let stays = self.knowledge.is_of_motion() && ego.rules.stays_in_lane;
        let is_behind = || stays && ego.shares_lane_with(other) && ego.lead_of(other) < 0.0;
        ego.limits.comfort.is_none() || ego.may_meet(other) && !is_beside() && !is_behind()
    }

    /// The safety ellipses around a prediction of another vehicle for a planner: longer by a time gap for one on the same road if the
    /// driver knows comfort. A gap that is too short now, behind a vehicle in the same lane, opens slowly.
    pub(crate) fn safety_around(&self, other: &Agent, penalty: Penalty) -> KeepOut {
        if self.ego.is_waited_for_by(other) || other.is_obstacle {
            return self.beside(other, penalty);
        }
        let keep_out = self.keep_out(&other.prediction, &other.route, penalty);
        let Some(comfort) = self.ego.limits.comfort else { return keep_out };
        let (ego, lead_m) = (&self.ego, self.ego.lead_of(other));
        let is_in_lane = ego.shares_lane_with(other);
        if !matches!(ego.relation(other), Relation::Alongside) || (is_in_lane && lead_m < 0.0) {
            return keep_out;
        }
        let speed_mps = if lead_m < 0.0 { other.state.speed_mps } else { ego.state.speed_mps };
        let wanted_m = PLANNER_SHARE * comfort.time_gap_s * speed_mps;
        let now_m = (lead_m - self.goal.safety.along_m).max(0.0);
        // To come into another lane, what is owed suffices at first where the motion of the other is seen.
        let owed_m = (self.knowledge.is_of_motion() && !is_in_lane).then(|| {
            let [behind, ahead] = if lead_m < 0.0 { [other, ego] } else { [ego, other] };
            let gap_m = owed_gap_m(&behind.body, behind.state.speed_mps, ahead.state.speed_mps);
            (self.half_axis_m(other, gap_m) - self.goal.safety.along_m).max(0.0)
        });
        let longer_m = |stage: usize| {
            let opened_m = OPENING * self.step_s * (stage + 1) as f64 * speed_mps;
            match owed_m {
                Some(owed_m) => wanted_m.min(owed_m + opened_m).max(owed_m),
                None if is_in_lane => wanted_m.min(now_m + opened_m),
                None => wanted_m,
            }
        };
        let longer = |(stage, ellipse): (usize, &OrientedEllipse)| {
            let SafetyEllipse { along_m, across_m } = ellipse.shape();
            SafetyEllipse { along_m: along_m + longer_m(stage), across_m }.oriented(ellipse.heading_rad())
        };
        KeepOut { ellipses: keep_out.ellipses.iter().enumerate().map(longer).collect(), ..keep_out }
    }
}

/// The ellipse that contains the rectangle of a half length and a half width, and is not much wider beside its middle \[m\].
pub(crate) fn containing(half_length_m: f64, half_width_m: f64) -> SafetyEllipse {
    // The corner is on it: `(1/1.8)² + (w/b)² = 1`.
    let share = (1.0 - CONTAINING_RATIO.powi(-2)).sqrt();
    SafetyEllipse { along_m: CONTAINING_RATIO * half_length_m, across_m: half_width_m / share }
}

impl SafetyEllipse {
    /// The ellipse, made narrower and longer where the way past it is nearer to its middle than its edge, as in a gap. It contains the
    /// rectangle of the half lengths and half widths of both bodies, which touch at `touching_m` \[m\].
    pub(crate) fn fitting(self, half_length_m: f64, touching_m: f64, room_m: f64) -> SafetyEllipse {
        if room_m >= self.across_m || room_m <= touching_m {
            return self;
        }
        let across_m = touching_m + FITTING_SHARE * (room_m - touching_m);
        let share = (1.0 - (touching_m / across_m).powi(2)).sqrt();
        SafetyEllipse { along_m: half_length_m / share, across_m }
    }
}

/// A safety ellipse around each centre, along a road.
pub(crate) fn ellipses(safety: SafetyEllipse, route: &Route, centres: &[[f64; 2]]) -> Vec<OrientedEllipse> {
    match route.straight() {
        Some(corridor) => vec![safety.oriented(corridor.heading_rad); centres.len()],
        None => route.locate_all(centres).map(|at| safety.oriented(at.heading_rad)).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::{real_car, scene};
    use crate::scene::Knowledge;
    use crate::vehicle::ComfortLimits;

    #[test]
    fn people_who_stay_in_their_lane_do_not_avoid_vehicles_behind() {
        let mut ego = real_car(0.0, 2.0);
        ego.limits.comfort = Some(ComfortLimits::default());
        let minds = |x_m: f64, stays_in_lane: bool, knowledge: Knowledge| {
            let mut ego = ego.clone();
            ego.rules.stays_in_lane = stays_in_lane;
            Scene { knowledge, ..scene(ego, Vec::new()) }.minds(&real_car(x_m, 1.0))
        };
        let motion = Knowledge::Motion { late_steps: 0 };
        assert!(!minds(-8.0, true, motion));
        assert!(minds(-8.0, false, motion) && minds(8.0, true, motion) && minds(-8.0, true, Knowledge::Plans));
    }
}
