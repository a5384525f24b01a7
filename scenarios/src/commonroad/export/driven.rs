//! The exported files, and the parts of a run that they contain.

use interplay_planners::{Body, State};

use crate::model::classes::VehicleClass;

/// The version of the format that is written.
pub(super) const VERSION: &str = "2020a";

/// The motion of a vehicle.
#[derive(Clone, Debug, PartialEq)]
pub struct DrivenVehicle {
    /// Its name.
    pub name: String,
    /// Its class of vehicle, if known.
    pub class: Option<VehicleClass>,
    /// Its size and axles.
    pub body: Body,
    /// The tick at which it entered the road.
    pub first_step: usize,
    /// Its states at the start of each tick from then on, and at the end of its last tick; empty if it never entered.
    pub states: Vec<State>,
    /// Its steering angle during each tick \[rad\].
    pub steering_rad: Vec<f64>,
}

/// The exported texts of a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Exported {
    /// The scenario as it was driven: all vehicles but the ego are obstacles.
    pub scenario: String,
    /// The motion of the ego as a solution.
    pub solution: String,
    /// Whether that motion reaches the goal of the planning problem; the solution ends there.
    pub reaches_goal: bool,
}
