//! What a driver knows when it plans: plain values, agents by name.

use std::sync::Arc;

use crate::road::centre_line::RoadPoint;
use crate::trajectory::terms::{Comfort, KeepOut, RoadEdge, RoadTarget, RoadTracking, Separation, StopLine, Tracking};
use crate::trajectory::{Participant, Penalty, RouteStart, Term};
use crate::vehicle::Bicycle;
use crate::vehicle::{OrientedEllipse, slip_on_curve_rad};
use crate::{Axes, Body, Input, Limits, Route, SafetyEllipse, State, Trajectory};

/// Drivers brake for a speed limit with this share of their strongest braking.
const COMFORTABLE_BRAKING_SHARE: f64 = 0.4;

/// Drivers take curves with this share of their largest lateral acceleration.
const COMFORTABLE_LATERAL_SHARE: f64 = 0.5;

/// Drivers come up to a line with this share of their strongest acceleration.
const COMFORTABLE_ACCELERATION_SHARE: f64 = 0.5;

/// A vehicle as anyone sees it.
#[derive(Clone, Debug, PartialEq)]
pub struct Agent {
    /// Its name in the scenario.
    pub name: String,
    /// Where it is.
    pub state: State,
    /// What it did last.
    pub previous_input: Input,
    /// What it covers.
    pub body: Body,
    /// What it can do.
    pub limits: Limits,
    /// The road it uses.
    pub route: Arc<Route>,
    /// What it is expected to do: its current plan where that is known, else constant velocity. Starts at `state`.
    pub prediction: Trajectory,
    /// What it wants, if it tells: vehicles that cooperate share their goals.
    pub shared_goal: Option<Goal>,
    /// Whether its driver may give way to somebody outside its own lane ([`DriverKind::can_be_asked`](crate::DriverKind::can_be_asked)).
    pub can_be_asked: bool,
}

/// What a vehicle wants and how it weighs it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Goal {
    /// Desired state, `x_des` of eq. 6.6.
    pub target: State,
    /// Diagonal of `Q` on (position along the target's heading, across it, θ, v).
    pub tracking: [f64; 4],
    /// Diagonal of `R` on (Δa, Δδ).
    pub comfort: [f64; 2],
    /// The ellipse around others that this vehicle keeps out of.
    pub safety: SafetyEllipse,
}

/// A moment, seen by one vehicle.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// How many plans were made before.
    pub tick: usize,
    /// Time step of the plan \[s\].
    pub step_s: f64,
    /// Number of steps `N` of the plan.
    pub horizon: usize,
    /// The planning vehicle.
    pub ego: Agent,
    /// What it wants.
    pub goal: Goal,
    /// Everybody else, in the scenario's order.
    pub others: Vec<Agent>,
}

impl Agent {
    /// Corners that stay on the road, of this agent as number `vehicle` of a trajectory problem.
    pub fn road_edge(&self, vehicle: usize) -> RoadEdge {
        let (route, penalty) = (Arc::clone(&self.route), Penalty::road_edge(self.body.scale));
        RoadEdge { vehicle, body: self.body, route, penalty }
    }

    /// Arc lengths that it would reach at `t = 1…N` at its present speed \[m\]; empty on a straight road, where nobody needs them.
    fn expected_along_m(&self, horizon: usize, step_s: f64) -> Vec<f64> {
        if self.route.straight().is_some() {
            return Vec::new();
        }
        let here_m = self.route.along(self.state.position());
        (1..=horizon).map(|t| here_m + self.state.speed_mps * step_s * t as f64).collect()
    }
}

impl Agent {
    /// The highest permitted speeds at arc lengths of its route, braking comfortably for lower limits and curves ahead; infinite
    /// where nothing limits it, and empty if nothing does anywhere \[m/s\].
    fn permitted_speeds_mps(&self, along_m: &[f64]) -> Vec<f64> {
        let permitted = |along_m: &f64| self.permitted_speed_mps(*along_m).unwrap_or(f64::INFINITY);
        let permitted: Vec<f64> = along_m.iter().map(permitted).collect();
        if permitted.iter().any(|speed_mps| speed_mps.is_finite()) { permitted } else { Vec::new() }
    }

    /// The highest permitted speed at an arc length of its route, braking comfortably for lower limits and curves ahead; none
    /// without limits \[m/s\].
    pub(crate) fn permitted_speed_mps(&self, along_m: f64) -> Option<f64> {
        let braking_mps2 = self.comfortable_braking_mps2();
        let permitted_mps = self.route.permitted_speed_mps(along_m, braking_mps2);
        let lateral_mps2 = self.limits.lateral_acceleration_max_mps2.map(|most| COMFORTABLE_LATERAL_SHARE * most);
        let in_curves_mps = lateral_mps2.and_then(|most| self.route.curve_speed_mps(along_m, most, braking_mps2));
        permitted_mps.into_iter().chain(in_curves_mps).min_by(f64::total_cmp)
    }

    /// The largest acceleration of a step at an arc length of its route after which it is not faster than permitted where it then
    /// is; none without limits \[m/s²\].
    ///
    /// At a speed `v` above the permitted `v_p` it is at least `−b (v/v_p)²`, with the comfortable braking `b` that `v_p` is made of.
    pub(crate) fn permitted_acceleration_mps2(&self, along_m: f64, speed_mps: f64, step_s: f64) -> Option<f64> {
        let permitted_mps = self.permitted_speed_mps(along_m + speed_mps * step_s)?;
        let excess = (speed_mps / permitted_mps).max(1.0);
        Some(((permitted_mps - speed_mps) / step_s).max(-self.comfortable_braking_mps2() * excess * excess))
    }

    /// With what it brakes for a speed limit \[m/s²\].
    fn comfortable_braking_mps2(&self) -> f64 {
        COMFORTABLE_BRAKING_SHARE * self.limits.acceleration_min_mps2.abs()
    }

    /// The largest steering angles at `t = 0…N−1`, at the speeds that it is expected to have; empty where they do not depend on
    /// the speed \[rad\].
    pub(crate) fn steering_bounds_rad(&self, horizon: usize) -> Vec<f64> {
        if self.limits.lateral_acceleration_max_mps2.is_none() {
            return Vec::new();
        }
        let expected = self.prediction.states.iter().skip(1).map(|state| state.speed_mps);
        let last_mps = self.prediction.states.last().unwrap_or(&self.state).speed_mps;
        let speeds = std::iter::once(self.state.speed_mps).chain(expected).chain(std::iter::repeat(last_mps));
        speeds.take(horizon).map(|speed_mps| self.limits.steering_max_at_rad(&self.body, speed_mps)).collect()
    }

    /// The slip angles with which it follows its route at arc lengths \[rad\].
    fn slips_rad(&self, along_m: &[f64]) -> Vec<f64> {
        let curvature_1pm = |along_m: &f64| self.route.centre.at(*along_m).curvature_1pm;
        along_m.iter().map(|along_m| slip_on_curve_rad(self.body.rear_axle_m, curvature_1pm(along_m))).collect()
    }

    /// The speeds at `t = 1…N` of a comfortable approach to a line at which its front stops, from its present speed on \[m/s\].
    pub(crate) fn approach_speeds_mps(&self, line_m: f64, wanted_mps: f64, horizon: usize, step_s: f64) -> Vec<f64> {
        let Limits { acceleration_min_mps2, acceleration_max_mps2, .. } = self.limits;
        let braking_mps2 = COMFORTABLE_BRAKING_SHARE * acceleration_min_mps2.abs();
        let mut speed_mps = self.state.speed_mps;
        let mut room_m = line_m - self.body.front_m - self.route.along(self.state.position());
        let speeds = (0..horizon).map(|_| {
            let permitted_mps = (2.0 * braking_mps2 * room_m.max(0.0)).sqrt().min(wanted_mps);
            let (low, high) =
                (acceleration_min_mps2 * step_s, COMFORTABLE_ACCELERATION_SHARE * acceleration_max_mps2 * step_s);
            speed_mps = (speed_mps + (permitted_mps - speed_mps).clamp(low, high)).max(0.0);
            room_m -= step_s * speed_mps;
            speed_mps
        });
        speeds.collect()
    }

    /// A line that its front stays before, as number `vehicle` of a trajectory problem.
    pub(crate) fn stop_line(&self, vehicle: usize, line_m: f64) -> StopLine {
        StopLine {
            vehicle,
            front_m: self.body.front_m,
            route: Arc::clone(&self.route),
            line_m,
            penalty: Penalty::ROAD_EDGE,
        }
    }
}

/// A safety ellipse around each centre, along a road.
pub(crate) fn ellipses(safety: SafetyEllipse, route: &Route, centres: &[[f64; 2]]) -> Vec<OrientedEllipse> {
    match route.straight() {
        Some(corridor) => vec![safety.oriented(corridor.heading_rad); centres.len()],
        None => route.locate_all(centres).map(|at| safety.oriented(at.heading_rad)).collect(),
    }
}

impl Goal {
    /// Along the target's heading, which is that of the road, and across.
    pub fn axes(&self) -> Axes {
        Axes::along(self.target.heading_rad)
    }
}

impl Scene {
    /// The bicycle of the planning vehicle.
    pub fn model(&self) -> Bicycle {
        Bicycle::new(&self.ego.body, self.step_s)
    }

    /// The planning vehicle as a participant of a trajectory problem.
    pub fn participant(&self) -> Participant {
        Participant {
            model: self.model(),
            limits: self.ego.limits,
            steering_bounds_rad: self.ego.steering_bounds_rad(self.horizon),
            start: self.ego.state,
            previous_input: self.ego.previous_input,
            known_inputs: Vec::new(),
            route_start: RouteStart::new(&self.ego.route, &self.ego.state),
        }
    }

    /// What a goal and the road ask of the planning vehicle as number `vehicle` of a trajectory problem: comfort, tracking
    /// (eq. 6.6) and road edges (eq. 6.7).
    pub fn own_terms(&self, vehicle: usize, goal: &Goal) -> Vec<Term> {
        let comfort = Term::Comfort(Comfort { vehicle, weights: goal.comfort });
        vec![comfort, self.tracking(vehicle, goal), Term::RoadEdge(self.ego.road_edge(vehicle))]
    }

    /// What the planning vehicle pays for deviations from a goal: in road coordinates where its road is curved.
    fn tracking(&self, vehicle: usize, goal: &Goal) -> Term {
        let route = &self.ego.route;
        if route.straight().is_some() {
            let targets = vec![goal.target; self.horizon];
            return Term::Tracking(Tracking { vehicle, weights: goal.tracking, axes: goal.axes(), targets });
        }
        let wanted = route.locate(goal.target.position(), None);
        let near_m = self.ego.expected_along_m(self.horizon, self.step_s);
        let permitted_mps = self.ego.permitted_speeds_mps(&near_m);
        Term::RoadTracking(RoadTracking {
            vehicle,
            weights: goal.tracking,
            target: RoadTarget { along_m: wanted.along_m, across_m: wanted.across_m, speed_mps: goal.target.speed_mps },
            permitted_mps,
            slips_rad: self.ego.slips_rad(&near_m),
        })
    }

    /// An ellipse of the planning vehicle's safety distance around a predicted motion; the vehicle is number 0.
    /// Each ellipse lies along `route`.
    pub fn keep_out(&self, prediction: &Trajectory, route: &Route, penalty: Penalty) -> KeepOut {
        let centres = self.centres(prediction);
        KeepOut { vehicle: 0, ellipses: ellipses(self.goal.safety, route, &centres), centres, penalty }
    }

    /// Vehicle number `vehicle` of a joint problem keeps out of ellipses of the size `safety` around vehicle number `from`, each
    /// along the road where that one is predicted.
    pub fn separation(&self, safety: SafetyEllipse, vehicle: usize, (from, agent): (usize, &Agent)) -> Term {
        let ellipses = ellipses(safety, &agent.route, &self.centres(&agent.prediction));
        Term::Separation(Separation { vehicle, from, ellipses, penalty: Penalty::EXACT })
    }

    /// The ellipses around the predictions of others that must not be entered, each along its road (eq. 6.13).
    pub fn exact_keep_outs<'a>(&self, others: impl IntoIterator<Item = &'a Agent>) -> impl Iterator<Item = Term> {
        others.into_iter().map(|other| Term::KeepOut(self.keep_out(&other.prediction, &other.route, Penalty::EXACT)))
    }

    /// Beside each position of a motion, the axes along the ego's road and across it, and the goal's position; on a curved road,
    /// where the goal's lateral position is beside it \[m\].
    pub fn goals_beside(&self, positions: &[[f64; 2]]) -> Vec<(Axes, [f64; 2])> {
        let (route, target) = (&self.ego.route, self.goal.target.position());
        if route.straight().is_some() {
            return vec![(self.goal.axes(), target); positions.len()];
        }
        let across_m = route.across(target);
        let beside = |at: RoadPoint| (Axes::along(at.heading_rad), route.position(at.along_m, across_m));
        route.locate_all(positions).map(beside).collect()
    }

    /// The positions of a predicted motion at `t = 1…N` \[m\]; where it ends early it stays at its end.
    pub fn centres(&self, prediction: &Trajectory) -> Vec<[f64; 2]> {
        let last = prediction.states.last().copied().unwrap_or_default();
        let centre = |t: usize| prediction.states.get(t).unwrap_or(&last).position();
        (1..=self.horizon).map(centre).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::road::centre_line::Piece;
    use crate::{CentreLine, Profile, fixture};

    /// A plan that reaches beyond the last curve of a road without speed limits keeps the speeds of the curve.
    #[test]
    fn a_curve_limits_the_speed_although_nothing_does_behind_it() {
        let pieces = [
            Piece::Straight { length_m: 10.0 },
            Piece::Arc { length_m: 5.0, curvature_1pm: 0.25 },
            Piece::Straight { length_m: 30.0 },
        ];
        let pieces = crate::road::centre_line::smooth(&pieces, 1.0).expect("room for transitions");
        let line = CentreLine::from_pieces([0.0, 0.0], 0.0, &pieces).expect("a line");
        let edge = Profile::constant;
        let mut agent = fixture::agent(0.0, 0.0, 0.0, 5.0);
        agent.route = Arc::new(Route::curved(line, edge(-1.0), edge(1.0), edge(1.0)));
        agent.limits.lateral_acceleration_max_mps2 = Some(2.0);
        let speeds = agent.permitted_speeds_mps(&[12.0, 14.0, 40.0]);
        // Half of 2 m/s² at a radius of 4 m.
        assert!(speeds[..2].iter().all(|speed| (speed - 2.0).abs() < 0.2), "{speeds:?}");
        assert_eq!(speeds[2], f64::INFINITY);
        assert!(agent.permitted_speeds_mps(&[40.0, 41.0]).is_empty());
    }
}
