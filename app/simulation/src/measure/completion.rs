//! When a vehicle reaches its goal.

use interplay_planners::{Body, Corridor, State};
use interplay_scenarios::{Road, Vehicle};

/// The share of the lane's width by which the centre of the goal may be missed.
const LATERAL_TOLERANCE_SHARE: f64 = 0.15;

/// On a road of parallel lanes a vehicle has completed its task once its centre is within 15 % of a lane's width of the
/// goal's lateral position; at an intersection, once its rear bumper has left the conflict zone.
///
/// A vehicle that starts there has nothing to complete.
#[derive(Clone, Copy, Debug)]
pub struct Completion {
    corridor: Corridor,
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
}

impl Completion {
    /// The goal of a vehicle.
    pub fn new(vehicle: &Vehicle, road: &Road) -> Self {
        let corridor = road.corridor(vehicle.road);
        let task = match road.conflict_zone_m(vehicle.road) {
            Some([_, end_m]) => Task::Cross { end_m, body: vehicle.body },
            None => Task::Lane {
                lateral_m: corridor.across(vehicle.target(road).position()),
                tolerance_m: LATERAL_TOLERANCE_SHARE * road.lane_width_m(),
            },
        };
        let mut completion = Completion { corridor, task, has_task: false, completed_s: None };
        completion.has_task = !completion.is_there(&vehicle.start);
        completion
    }

    fn is_there(&self, state: &State) -> bool {
        let position = state.position();
        match self.task {
            Task::Lane { lateral_m, tolerance_m } => (self.corridor.across(position) - lateral_m).abs() <= tolerance_m,
            Task::Cross { end_m, body } => self.corridor.along(position) - body.rear_m > end_m,
        }
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
