//! Staying behind the vehicle ahead, by its motion alone.
//!
//! A line moves with the rear of the leader as far as that is expected to come, a firm gap before it; the cost of being beyond it has no
//! bound, so that neither a wanted speed nor the other side of the leader outweighs it. Before the line there is an approach profile, as
//! before a line at rest:
//!
//! ```text
//! gap    g(t) = g₀ + share · T v_l(t)
//! speed  v(t) ≤ v_l(t) + √(2 b r(t)),  r(t) = s_l(t) − g(t) − s(t)     while r ≥ 0
//!        v(t) ≤ v_l(t) + r(t)/τ                                        in a gap that is too short
//! ```
//!
//! `b` is the comfortable braking, or what is needed to come to the end of the leader's expected motion behind it.

use super::clearance::{ASIDE_M, FIRM_SHARE, OPENING, PLANNER_SHARE, STANDSTILL_GAP_M};
use crate::scene::road_rules::Followed;
use crate::vehicle::ComfortLimits;
use crate::{Agent, Scene, State};

/// No line leaves a gap below this share of the one at standstill.
const LEAST_SHARE: f64 = 0.15;
/// The firm gap at standstill, as a share of the comfortable one.
const FIRM_STANDSTILL_SHARE: f64 = 0.75;
/// A gap that is too short opens within about this time, of real vehicles \[s\].
const OPENING_S: f64 = 4.0;
/// Time gap ahead and behind that is enough to merge, of real vehicles \[s\].
const MERGING_S: f64 = 0.5;
/// A vehicle beside or behind within this time is in the way of passing, of real vehicles \[s\].
const BESIDE_S: f64 = 1.0;

impl Scene {
    /// The speeds of a comfortable approach to the vehicle that is followed; empty without one \[m/s\].
    pub(super) fn following_speeds_mps(&self) -> &[f64] {
        self.ego.rules.follows.as_ref().map_or(&[], |followed| &followed.speeds_mps)
    }

    /// The vehicle ahead behind which the planning vehicle stays because it cannot pass: it has to stay in its lane, or the road beside is
    /// narrow or taken.
    pub(crate) fn kept_behind(&self) -> Option<Followed> {
        let rules = &self.ego.rules;
        let stays_behind = |leader: &&Agent| {
            let is_passed = rules.passes.as_ref().is_some_and(|obstacle| obstacle.name == leader.name);
            !is_passed && (rules.stays_in_lane || !self.has_room_beside(leader))
        };
        let Some(leader) = self.ego.leader_among(&self.others).filter(stays_behind) else {
            return self.before_lane_end();
        };
        self.followed(leader, PLANNER_SHARE)
    }

    /// How the planning vehicle stays before the end of its lane on a straight road while the lane beside is taken.
    pub(crate) fn before_lane_end(&self) -> Option<Followed> {
        let ego = &self.ego;
        let corridor = ego.route.straight()?;
        let end = corridor.end?;
        let [along_m, across_m] = [ego.along_m(), ego.across_m()];
        let (edge_m, half_m) = (corridor.right_m + end.height_m, 0.5 * ego.body.width_m);
        let (front_m, line_m) = (along_m + ego.body.front_m, end.end_m - end.taper_m);
        if across_m - half_m >= edge_m || front_m >= line_m {
            return None;
        }
        let aim_m = ego.route.across(self.goal.target.position()).max(edge_m + half_m);
        let taken_by = self.others.iter().find(|other| self.is_too_near_to_merge(other, aim_m))?;
        let rears = vec![[line_m, 0.0]; self.horizon];
        let speeds_mps = self.approach_mps(front_m, &rears, |_| 0.0);
        Some(Followed { name: taken_by.name.clone(), lines_m: vec![line_m; self.horizon], speeds_mps })
    }

    /// Whether a vehicle is in the lane at a lateral place, beside the planning vehicle or a shorter time gap away than is needed to merge.
    fn is_too_near_to_merge(&self, other: &Agent, across_m: f64) -> bool {
        let (ego, lead_m) = (&self.ego, self.ego.lead_of(other));
        let reach_m = 0.5 * (ego.body.width_m + other.body.width_m);
        if other.is_obstacle || (ego.route.across(other.state.position()) - across_m).abs() >= reach_m {
            return false;
        }
        let gap_m = if lead_m > 0.0 {
            lead_m - other.body.rear_m - ego.body.front_m
        } else {
            -lead_m - other.body.front_m - ego.body.rear_m
        };
        let behind = if lead_m > 0.0 { ego } else { other };
        gap_m < MERGING_S * ego.body.real_ratio().sqrt() * behind.state.speed_mps
    }

    /// Whether the road beside a vehicle ahead is wide enough and free.
    fn has_room_beside(&self, leader: &Agent) -> bool {
        let ego = &self.ego;
        let at = ego.route.locate(leader.state.position(), None);
        let [right_m, left_m] = ego.route.edges_before_end_m(at.along_m);
        let (half_m, beside_m) = (0.5 * ego.body.width_m, 0.5 * (ego.body.width_m + leader.body.width_m));
        let beside_m = beside_m + ASIDE_M * ego.body.scale;
        let is_free = |across_m: &f64| {
            (right_m + half_m..=left_m - half_m).contains(across_m)
                && !self
                    .others
                    .iter()
                    .any(|other| other.name != leader.name && self.is_beside(other, leader, *across_m))
        };
        [at.across_m + beside_m, at.across_m - beside_m].iter().any(is_free)
    }

    /// Whether a vehicle is on the strip beside the own one and the leader, or comes up on it from behind.
    fn is_beside(&self, other: &Agent, leader: &Agent, across_m: f64) -> bool {
        let ego = &self.ego;
        let reach_m = 0.5 * (ego.body.width_m + other.body.width_m);
        let length_m = ego.body.front_m + ego.body.rear_m;
        let behind_m = length_m + BESIDE_S * ego.body.real_ratio().sqrt() * other.state.speed_mps;
        let lead_m = ego.lead_of(other);
        (ego.route.across(other.state.position()) - across_m).abs() < reach_m
            && lead_m > -behind_m
            && lead_m < ego.lead_of(leader) + length_m
    }

    /// How the planning vehicle stays behind a vehicle ahead with a share of the usual time gap; none for a driver who knows no comfort.
    pub(crate) fn followed(&self, leader: &Agent, share: f64) -> Option<Followed> {
        let ego = &self.ego;
        let comfort = ego.limits.comfort?;
        let standstill_m = STANDSTILL_GAP_M * ego.body.scale;
        let (front_m, now_m) = (ego.body.front_m, ego.along_m());
        let gap_now_m = now_m + ego.lead_of(leader) - leader.body.rear_m - now_m - front_m;
        let firm_m = |stage: usize, mps: f64| {
            let firm_m = FIRM_STANDSTILL_SHARE * standstill_m + FIRM_SHARE * comfort.time_gap_s * mps;
            let opened_m = gap_now_m + OPENING * self.step_s * (stage + 1) as f64 * ego.state.speed_mps;
            firm_m.min(opened_m).max(LEAST_SHARE * standstill_m)
        };
        let rears = self.rears(leader);
        let line_m = |(stage, ([rear_m, mps], braked_m)): (usize, (&[f64; 2], f64))| {
            let latest_m = rear_m - LEAST_SHARE * standstill_m;
            (rear_m - firm_m(stage, *mps)).max(braked_m.min(latest_m))
        };
        let lines_m = rears.iter().zip(self.braked_fronts_m(&comfort)).enumerate().map(line_m).collect();
        let gap_m = |mps: f64| standstill_m + share * comfort.time_gap_s * mps;
        let speeds_mps = self.approach_mps(now_m + front_m, &rears, gap_m);
        Some(Followed { name: leader.name.clone(), lines_m, speeds_mps })
    }

    /// Where the front comes at `t = 1…N` along the own route with as much braking as the urgency permits: a line that asks for more
    /// would be kept by swerving \[m\].
    fn braked_fronts_m(&self, comfort: &ComfortLimits) -> Vec<f64> {
        let (ego, step_s) = (&self.ego, self.step_s);
        let most_mps2 = comfort.jerk_mps3 * ego.urgency * ego.urgency * step_s;
        let mut front_m = ego.along_m() + ego.body.front_m;
        let (mut speed_mps, mut acceleration_mps2) = (ego.state.speed_mps, ego.previous_input.acceleration_mps2);
        let fronts = (0..self.horizon).map(|_| {
            front_m += step_s * speed_mps;
            let least_mps2 = -comfort.braking_at_mps2(ego.urgency, speed_mps);
            acceleration_mps2 = (acceleration_mps2 - most_mps2).max(least_mps2.max(ego.limits.acceleration_min_mps2));
            speed_mps = (speed_mps + step_s * acceleration_mps2).max(0.0);
            front_m
        });
        fronts.collect()
    }

    /// Where the rear of a vehicle is expected at `t = 1…N` along the own route \[m\], and its speed there along it \[m/s\].
    fn rears(&self, leader: &Agent) -> Vec<[f64; 2]> {
        let states = &leader.prediction.states;
        let last = states.last().unwrap_or(&leader.state);
        let mut near_m = None;
        let rear = |t: usize| {
            let state: &State = states.get(t).unwrap_or(last);
            let at = self.ego.route.locate(state.position(), near_m);
            near_m = Some(at.along_m);
            let along_mps = state.speed_mps * libm::cos(state.heading_rad - at.heading_rad);
            [at.along_m - leader.body.rear_m, along_mps.max(0.0)]
        };
        (1..=self.horizon).map(rear).collect()
    }

    /// The speeds of an approach in comfort from a front at `front_m`, to a gap that depends on the speed of the vehicle ahead.
    fn approach_mps(&self, mut front_m: f64, rears: &[[f64; 2]], gap_m: impl Fn(f64) -> f64) -> Vec<f64> {
        let (ego, step_s) = (&self.ego, self.step_s);
        let needed_mps2 = rears.last().map_or(0.0, |[rear_m, ahead_mps]| {
            let room_m = (rear_m - gap_m(*ahead_mps) - front_m).max(LEAST_SHARE * ego.body.scale);
            0.5 * (ego.state.speed_mps * ego.state.speed_mps - ahead_mps * ahead_mps) / room_m
        });
        let braking_mps2 = ego.comfortable_braking_mps2().max(needed_mps2).min(-ego.limits.acceleration_min_mps2);
        let opening_s = OPENING_S * ego.body.real_ratio().sqrt();
        let [low, high] = [-braking_mps2, ego.limits.acceleration_max_mps2].map(|mps2| mps2 * step_s);
        let wanted_mps = self.goal.target.speed_mps;
        let mut speed_mps = ego.state.speed_mps;
        let speeds = rears.iter().map(|[rear_m, ahead_mps]| {
            let room_m = rear_m - gap_m(*ahead_mps) - front_m;
            let permitted_mps = if room_m >= 0.0 {
                ahead_mps + (2.0 * braking_mps2 * room_m).sqrt()
            } else {
                (ahead_mps + room_m / opening_s).max(0.0)
            };
            speed_mps = (speed_mps + (permitted_mps.min(wanted_mps) - speed_mps).clamp(low, high)).max(0.0);
            front_m += step_s * speed_mps;
            if permitted_mps < wanted_mps { speed_mps } else { f64::INFINITY }
        });
        speeds.collect()
    }
}
