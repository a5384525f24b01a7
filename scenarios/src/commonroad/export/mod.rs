//! From a run to CommonRoad: the scenario as it was driven, and the motion of the ego as the solution of its planning problem.
//!
//! ```text
//! scenario, or the XML that it was imported from -> what stays (`Base`) -> with what was driven: two texts of XML
//! ```
//!
//! The roads and the planning problem of an imported scenario stay as they were written, in their own coordinates. The lanes of
//! any other scenario become lanelets.

mod base;
mod goal;
mod lanelets;
mod solution;
mod source;
mod xml_text;

use std::path::Path;

use interplay_planners::{Body, State};

use crate::model::classes::VehicleClass;
use crate::model::scenario::Scenario;
use crate::text::error::LoadError;
use base::Base;

/// A scenario whose run can be written as CommonRoad.
#[derive(Clone, Debug)]
pub struct CommonRoadExport {
    base: Base,
    /// Which vehicle is the ego.
    ego: usize,
}

impl CommonRoadExport {
    /// Reads the parts that are the same in every run: roads and planning problem. `name_or_path` is the source of the scenario.
    ///
    /// # Errors
    /// If the XML cannot be read, or the run has a different time step.
    pub fn new(scenario: &Scenario, name_or_path: &str) -> Result<CommonRoadExport, LoadError> {
        let path = Path::new(name_or_path);
        let base = if super::is_commonroad(path) {
            source::base(scenario, path).map_err(|fault| LoadError::new(name_or_path, vec![fault]))?
        } else {
            lanelets::base(scenario, name_or_path)
        };
        Ok(CommonRoadExport { base, ego: scenario.ego_index() })
    }

    /// Writes the driven motion; `vehicles` are in the order of the scenario.
    pub fn export(&self, vehicles: &[DrivenVehicle]) -> Exported {
        let mut others = vehicles.to_vec();
        let ego = (self.ego < others.len()).then(|| others.remove(self.ego));
        let base = lanelets::around(&self.base, vehicles);
        let scenario = base.scenario(&others, ego.as_ref());
        let solved = ego.map(|ego| solution::of(&base, &ego));
        let (solution, reaches_goal) = solved.unwrap_or_default();
        Exported { scenario, solution, reaches_goal }
    }
}

/// The version of the format that is written.
const VERSION: &str = "2020a";

/// The motion of a vehicle.
#[derive(Clone, Debug, PartialEq)]
pub struct DrivenVehicle {
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
