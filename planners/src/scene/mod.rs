//! What a driver knows when it plans: plain values, agents by name.

pub mod driver_estimate;
pub mod duties;
mod indicator;
pub mod inferred_futures;
pub(crate) mod input_record;
pub mod knowledge;
pub(crate) mod lane_order;
mod moment;
mod own_place;
pub(crate) mod record;
pub(crate) mod relation;
pub(crate) mod road_rules;
pub mod trigger;

pub use input_record::InputRecord;
pub use knowledge::Knowledge;
pub use lane_order::LaneOrder;
pub use moment::Moment;
pub use own_place::OwnPlace;

use std::sync::Arc;

use crate::road::centre_line::FrenetPoint;
use crate::scene::road_rules::RoadRules;
use crate::{Axes, Bicycle, Body, Input, Limits, Route, SafetyEllipse, State, Trajectory};

/// A vehicle as the others see it.
#[derive(Clone, Debug, PartialEq)]
pub struct Agent {
    /// Name of the vehicle in the scenario.
    pub name: String,
    /// Present position, heading and speed.
    pub state: State,
    /// The input that it applied last.
    pub previous_input: Input,
    /// Body and axles.
    pub body: Body,
    /// Limits of its inputs and speed.
    pub limits: Limits,
    /// The route that it follows.
    pub route: Arc<Route>,
    /// Predicted motion, beginning at `state`: its current plan where that is known, else what its motion leads one to expect.
    pub prediction: Arc<Trajectory>,
    /// Its goal, if it publishes one, as vehicles do that cooperate.
    pub shared_goal: Option<Goal>,
    /// Whether its driver may give way to a vehicle outside its own lane ([`DriverKind::can_be_asked`](crate::DriverKind::can_be_asked)).
    pub can_be_asked: bool,
    /// Whether it has no driver: a parked car, a cone, a wall. Its body lies along the road.
    pub is_obstacle: bool,
    /// The side on which it indicates; `None` if it does not.
    pub indicator: Option<IndicatorSide>,
    /// What the rules of the road ask of it now; nothing before they are judged.
    pub rules: RoadRules,
    /// How many times harder than is comfortable it has to brake now; 1 where comfort is enough, and before that is judged.
    pub urgency: f64,
    /// Its place on its route, if it was searched.
    pub own_place: OwnPlace,
}

/// The side on which a vehicle indicates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum IndicatorSide {
    /// The vehicle moves to the left.
    Left,
    /// The vehicle moves to the right.
    Right,
}

/// The goal of a vehicle: a desired state, and the weights of its costs.
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

/// What one vehicle knows at a moment: all that a planner is given.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Index of the plan: the number of ticks since the run began.
    pub tick: usize,
    /// Time step of the plan \[s\].
    pub step_s: f64,
    /// Number of steps `N` of the plan.
    pub horizon: usize,
    /// What the driver knows of the others.
    pub knowledge: Knowledge,
    /// The planning vehicle.
    pub ego: Agent,
    /// The goal of the planning vehicle.
    pub goal: Goal,
    /// All other vehicles, in the scenario's order.
    pub others: Vec<Agent>,
}

/// A vehicle that leaves its lane, or goes back to it, weighs its place across the road this many times more.
const SWIFT_RATIO: f64 = 4.0;

impl Goal {
    /// The goal, moved to a lateral coordinate of a route and reached in one motion \[m\].
    pub(crate) fn moved_to(self, route: &Route, across_m: f64) -> Goal {
        let [x_m, y_m] = route.position(route.along(self.target.position()), across_m);
        let [along, across, heading, speed] = self.tracking;
        let tracking = [along, SWIFT_RATIO * across, heading, speed];
        Goal { target: State { x_m, y_m, ..self.target }, tracking, ..self }
    }

    /// The axes along the target's heading, which is that of the road, and across it.
    pub fn axes(&self) -> Axes {
        Axes::along(self.target.heading_rad)
    }
}

impl Scene {
    /// The bicycle model of the planning vehicle, with the plan's time step.
    pub fn model(&self) -> Bicycle {
        Bicycle::new(&self.ego.body, self.step_s)
    }

    /// Lets the planning vehicle drive at a lateral coordinate of its route for now, in place of that of its goal \[m\].
    pub(crate) fn drive_beside_goal(&mut self, across_m: f64) {
        self.ego.rules.drives_at_m = Some(across_m);
        self.goal = self.goal.moved_to(&self.ego.route, across_m);
    }

    /// Beside each position of a motion, the axes along the ego's road and across it, and the goal's position; on a curved road,
    /// where the goal's lateral position is beside it \[m\].
    pub fn goals_beside(&self, positions: &[[f64; 2]]) -> Vec<(Axes, [f64; 2])> {
        let (route, target) = (&self.ego.route, self.goal.target.position());
        if route.straight().is_some() {
            return vec![(self.goal.axes(), target); positions.len()];
        }
        let across_m = route.across(target);
        let beside = |at: FrenetPoint| (Axes::along(at.heading_rad), route.position(at.along_m, across_m));
        route.locate_all(positions).map(beside).collect()
    }

    /// The positions of a predicted motion at `t = 1…N` \[m\]; where it ends early it stays at its end.
    pub fn centres(&self, prediction: &Trajectory) -> Vec<[f64; 2]> {
        let last = prediction.states.last().copied().unwrap_or_default();
        let centre = |t: usize| prediction.states.get(t).unwrap_or(&last).position();
        (1..=self.horizon).map(centre).collect()
    }
}
