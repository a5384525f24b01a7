//! From a scene to the terms of a trajectory problem: what a vehicle wants, and what it keeps clear of.
//!
//! [`JointVehicle`] and [`joint_problem`] do so for several vehicles that decide together.

pub(crate) mod clearance;
mod following;
mod joint;
pub(crate) mod permitted_speed;
mod stage_bounds;

use std::sync::Arc;

pub use joint::{JointVehicle, joint_problem};

use crate::problem::clearance::ellipses;
use crate::trajectory::terms::{Comfort, FrenetTarget, FrenetTracking, RoadEdge, Separation, StopLine, Tracking};
use crate::trajectory::{Participant, Penalty, RouteStart, Term};
use crate::vehicle::slip_on_curve_rad;
use crate::{Agent, Goal, SafetyEllipse, Scene};

/// Cost of leaving the road for people, as a multiple of that for the drivers of the dissertation: more than to come near a vehicle, for
/// which a plan would otherwise trade the road. In danger it grows with the urgency.
const PEOPLE_ON_ROAD: f64 = 5.0;
/// People plan to stay this far within the road, since what they drive lags behind what they plan, for 1/10 scale cars \[m\].
const WITHIN_EDGE_M: f64 = 0.01;

impl Agent {
    /// Corners that stay on the road, of this agent as number `vehicle` of a trajectory problem.
    pub fn road_edge(&self, vehicle: usize) -> RoadEdge {
        let (route, mut body, mut penalty) = (Arc::clone(&self.route), self.body, Penalty::road_edge(self.body.scale));
        if self.limits.comfort.is_some() {
            let Penalty { linear, quadratic } = penalty;
            let ratio = PEOPLE_ON_ROAD * self.urgency;
            penalty = Penalty { linear: ratio * linear, quadratic: ratio * quadratic };
            body.width_m += 2.0 * WITHIN_EDGE_M * body.scale;
        }
        RoadEdge { vehicle, body, route, penalty }
    }

    /// The lines of its lane where it stays in it, as number `vehicle` of a trajectory problem.
    fn lane_lines(&self, vehicle: usize) -> Option<RoadEdge> {
        let lane = self.route.own_lane().filter(|_| self.rules.stays_in_lane)?;
        let penalty = Penalty::lane_line(self.body.scale);
        Some(RoadEdge { vehicle, body: self.body, route: Arc::clone(lane), penalty })
    }

    /// A line that its front stays before, given at `t = 1…N`, as number `vehicle` of a trajectory problem.
    pub(crate) fn stop_line(&self, vehicle: usize, lines_m: Vec<f64>) -> StopLine {
        StopLine {
            vehicle,
            front_m: self.body.front_m,
            route: Arc::clone(&self.route),
            lines_m,
            // A driver does not leave the road in order to stay before a line.
            penalty: if self.rules.are_kept { Penalty::road_edge(self.body.scale) } else { Penalty::ROAD_EDGE },
        }
    }

    /// The slip angles with which it follows its route at arc lengths \[rad\].
    fn slips_rad(&self, along_m: &[f64]) -> Vec<f64> {
        let curvature_1pm = |along_m: &f64| self.route.centre.at(*along_m).curvature_1pm;
        along_m.iter().map(|along_m| slip_on_curve_rad(self.body.rear_axle_m, curvature_1pm(along_m))).collect()
    }
}

impl Scene {
    /// The planning vehicle as a participant of a trajectory problem.
    pub fn participant(&self) -> Participant {
        Participant {
            model: self.model(),
            limits: self.ego.limits,
            stage_bounds: self.ego.stage_bounds(self.horizon, self.step_s, &self.speed_caps_mps()),
            start: self.ego.state,
            previous_input: self.ego.previous_input,
            known_inputs: Vec::new(),
            route_start: RouteStart::new(&self.ego.route, &self.ego.state),
        }
    }

    /// What a goal, the road and its rules ask of the planning vehicle as number `vehicle` of a trajectory problem: comfort, tracking
    /// (eq. 6.6), road edges (eq. 6.7), and the line at which it has to wait.
    pub fn own_terms(&self, vehicle: usize, goal: &Goal) -> Vec<Term> {
        let comfort = Term::Comfort(Comfort { vehicle, weights: goal.comfort });
        let rules = &self.ego.rules;
        let line = rules
            .stop_line_m
            .filter(|_| rules.are_kept)
            .map(|line_m| Term::StopLine(self.ego.stop_line(vehicle, vec![line_m; self.horizon])));
        let followed = rules.follows.as_ref();
        let behind = followed.map(|followed| Term::StopLine(self.ego.stop_line(vehicle, followed.lines_m.clone())));
        let terms = [comfort, self.tracking(vehicle, goal), Term::RoadEdge(self.ego.road_edge(vehicle))];
        terms.into_iter().chain(line).chain(behind).chain(self.ego.lane_lines(vehicle).map(Term::RoadEdge)).collect()
    }

    /// What the planning vehicle pays for deviations from a goal: in Frenet coordinates where its road is curved.
    fn tracking(&self, vehicle: usize, goal: &Goal) -> Term {
        let route = &self.ego.route;
        if route.straight().is_some() {
            let mut targets = vec![goal.target; self.horizon];
            for (target, speed_mps) in targets.iter_mut().zip(self.following_speeds_mps()) {
                target.speed_mps = target.speed_mps.min(*speed_mps);
            }
            return Term::Tracking(Tracking { vehicle, weights: goal.tracking, axes: goal.axes(), targets });
        }
        let wanted = route.locate(goal.target.position(), None);
        let near_m = self.ego.expected_along_m(self.horizon, self.step_s);
        let permitted_mps = self.ego.permitted_speeds_mps(&near_m);
        let mut permitted_mps =
            self.ego.up_to_its_line(permitted_mps, goal.target.speed_mps, self.horizon, self.step_s);
        if !self.following_speeds_mps().is_empty() {
            permitted_mps.resize(self.horizon, f64::INFINITY);
        }
        for (permitted_mps, speed_mps) in permitted_mps.iter_mut().zip(self.following_speeds_mps()) {
            *permitted_mps = permitted_mps.min(*speed_mps);
        }
        Term::FrenetTracking(FrenetTracking {
            vehicle,
            weights: goal.tracking,
            target: FrenetTarget {
                along_m: wanted.along_m,
                across_m: wanted.across_m,
                speed_mps: goal.target.speed_mps,
            },
            permitted_mps,
            slips_rad: self.ego.slips_rad(&near_m),
        })
    }

    /// Vehicle number `vehicle` of a joint problem keeps out of ellipses of the size `safety` around vehicle number `from`, each
    /// along the road where that one is predicted.
    pub fn separation(&self, safety: SafetyEllipse, vehicle: usize, from: usize, agent: &Agent) -> Term {
        let ellipses = ellipses(safety, &agent.route, &self.centres(&agent.prediction));
        Term::Separation(Separation { vehicle, from, ellipses, penalty: Penalty::EXACT })
    }

    /// The ellipses around the predictions of others that must not be entered, each along its road (eq. 6.13).
    pub fn exact_keep_outs<'a>(&self, others: impl IntoIterator<Item = &'a Agent>) -> impl Iterator<Item = Term> {
        let minded = others.into_iter().filter(|other| self.minds(other));
        minded.map(|other| Term::KeepOut(self.safety_around(other, Penalty::EXACT)))
    }
}
