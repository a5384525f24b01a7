//! When a vehicle reaches its goal.

use std::sync::Arc;

use interplay_planners::{Body, Route, State};
use interplay_scenarios::{Road, Vehicle};

/// The share of the lane's width by which the centre of the goal may be missed.
const LATERAL_TOLERANCE_SHARE: f64 = 0.15;

/// On a road of parallel lanes a vehicle has completed its task once its centre is within 15 % of a lane's width of the
/// goal's lateral position; at an intersection, once its rear bumper has left the conflict zone; on a network, once its rear
/// bumper is on the last lane of its route.
///
/// A vehicle that starts there has nothing to complete.
#[derive(Clone, Debug)]
pub struct Completion {
    route: Arc<Route>,
    task: Task,
    /// Whether it started elsewhere.
    has_task: bool,
    /// When it was reached first \[s\].
    pub completed_s: Option<f64>,
}

/// What is to be reached.
#[derive(Clone, Copy, Debug)]
enum Task {
    /// A lateral position.
    Lane { lateral_m: f64, tolerance_m: f64 },
    /// The far side of the other road, with the whole body.
    Cross { end_m: f64, body: Body },
    /// The last lane of the route, with the whole body.
    LastLane { from_m: f64, body: Body },
}

impl Completion {
    /// The goal of a vehicle.
    pub fn new(vehicle: &Vehicle, road: &Road) -> Self {
        let route = Arc::clone(&vehicle.route);
        let last = route.legs.last().filter(|_| road.parallel_lanes().is_none() && route.legs.len() > 1);
        let task = match (road.conflict_zone_m(vehicle.road), last) {
            (Some([_, end_m]), _) => Task::Cross { end_m, body: vehicle.body },
            (None, Some(leg)) => Task::LastLane { from_m: leg.from_m, body: vehicle.body },
            (None, None) => Task::Lane {
                lateral_m: route.across(vehicle.target(road).position()),
                tolerance_m: LATERAL_TOLERANCE_SHARE * road.lane_width_m(),
            },
        };
        let mut completion = Completion { route, task, has_task: false, completed_s: None };
        completion.has_task = !completion.is_there(&vehicle.start);
        completion
    }

    fn is_there(&self, state: &State) -> bool {
        let position = state.position();
        match self.task {
            Task::Lane { lateral_m, tolerance_m } => (self.route.across(position) - lateral_m).abs() <= tolerance_m,
            Task::Cross { end_m: place_m, body } | Task::LastLane { from_m: place_m, body } => {
                self.route.along(position) - body.rear_m > place_m
            }
        }
    }

    /// How far along its road a position is \[m\].
    pub fn along_m(&self, position: [f64; 2]) -> f64 {
        self.route.along(position)
    }

    /// Whether it started elsewhere, so that there is something to complete.
    pub fn has_task(&self) -> bool {
        self.has_task
    }

    /// Whether it is the other road that is to be crossed.
    pub fn crosses(&self) -> bool {
        matches!(self.task, Task::Cross { .. })
    }

    /// Looks at one time; returns whether the goal is reached then.
    pub fn observe(&mut self, state: &State, time_s: f64) -> bool {
        let reached = self.has_task && self.completed_s.is_none() && self.is_there(state);
        if reached {
            self.completed_s = Some(time_s);
        }
        reached
    }
}
