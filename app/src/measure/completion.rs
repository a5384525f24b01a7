//! When a vehicle reaches its goal.

use interplay_planners::State;
use interplay_scenarios::{Road, Vehicle};

/// The share of the lane's width by which the centre of the goal may be missed.
const TOLERANCE: f64 = 0.15;

/// A vehicle has completed its task once its centre is within 15 % of a lane's width of the goal's lateral position.
///
/// A vehicle that starts there has nothing to complete.
#[derive(Clone, Copy, Debug)]
pub struct Completion {
    lateral_m: f64,
    tolerance_m: f64,
    heading: [f64; 2],
    /// Whether it started elsewhere.
    has_task: bool,
    /// When it was reached first \[s\].
    pub completed_s: Option<f64>,
}

impl Completion {
    /// The goal of a vehicle.
    pub fn new(vehicle: &Vehicle, road: &Road) -> Self {
        let (target, corridor) = (vehicle.target(road), road.corridor());
        let (sin, cos) = libm::sincos(corridor.heading_rad);
        let mut completion = Completion {
            lateral_m: corridor.across(target.position()),
            tolerance_m: TOLERANCE * road.lane_width_m(),
            heading: [-sin, cos],
            has_task: false,
            completed_s: None,
        };
        completion.has_task = !completion.is_there(&vehicle.start);
        completion
    }

    fn is_there(&self, state: &State) -> bool {
        let lateral = self.heading[0] * state.x_m + self.heading[1] * state.y_m;
        (lateral - self.lateral_m).abs() <= self.tolerance_m
    }

    /// Looks at one moment.
    pub fn observe(&mut self, state: &State, time_s: f64) {
        if self.has_task && self.completed_s.is_none() && self.is_there(state) {
            self.completed_s = Some(time_s);
        }
    }
}
