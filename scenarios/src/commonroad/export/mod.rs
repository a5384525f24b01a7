//! From a run to CommonRoad: the scenario as it was driven, and the motion of the ego as the solution of its planning problem.
//!
//! ```text
//! scenario, or the XML that it was imported from -> what stays (`Base`) -> with what was driven: two texts of XML
//! ```
//!
//! Of a scenario that was imported, the roads and the planning problem stay as they were written, in their own coordinates. Of
//! another one, the lanes of its road become lanelets.

mod base;
mod goal;
mod ids;
mod lanelets;
mod parallel;
mod solution;
mod source;
mod xml_text;

use std::path::Path;

use interplay_planners::{Body, State};

use crate::classes::VehicleClass;
use crate::error::LoadError;
use crate::scenario::Scenario;
use base::Base;

/// The version of the format that is written.
const VERSION: &str = "2020a";

/// What a vehicle did.
#[derive(Clone, Debug, PartialEq)]
pub struct DrivenVehicle {
    /// Its name.
    pub name: String,
    /// What sort of vehicle it is, if that is known.
    pub class: Option<VehicleClass>,
    /// Its size and axles.
    pub body: Body,
    /// Its states at the begin of each tick, and at the end of the last.
    pub states: Vec<State>,
    /// Its steering angle during each tick \[rad\].
    pub steering_rad: Vec<f64>,
}

/// What is written of a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Exported {
    /// The scenario as it was driven: all vehicles but the ego are obstacles.
    pub scenario: String,
    /// The motion of the ego as a solution.
    pub solution: String,
    /// Whether that motion reaches the goal of the planning problem; the solution ends there.
    pub reaches_goal: bool,
}

/// A scenario whose run can be written as CommonRoad.
#[derive(Clone, Debug)]
pub struct CommonRoadExport {
    base: Base,
    /// Which vehicle is the ego.
    ego: usize,
}

impl CommonRoadExport {
    /// Looks at what stays the same in every run: roads and planning problem. `name_or_path` is what the scenario was loaded from.
    ///
    /// # Errors
    /// Where the XML cannot be read, or the run has another step of time than it.
    pub fn new(scenario: &Scenario, name_or_path: &str) -> Result<CommonRoadExport, LoadError> {
        let path = Path::new(name_or_path);
        let base = if super::is_commonroad(path) {
            source::base(scenario, path).map_err(|fault| LoadError::new(name_or_path, vec![fault]))?
        } else {
            Base::of_road(scenario, name_or_path)
        };
        Ok(CommonRoadExport { base, ego: scenario.ego_index() })
    }

    /// Writes what was driven; vehicles in the order of the scenario.
    pub fn export(&self, vehicles: &[DrivenVehicle]) -> Exported {
        let mut others = vehicles.to_vec();
        let ego = (self.ego < others.len()).then(|| others.remove(self.ego));
        let base = self.base.around(vehicles);
        let scenario = base.scenario(&others, ego.as_ref());
        let solved = ego.map(|ego| solution::of(&base, &ego));
        let (solution, reaches_goal) = solved.unwrap_or_default();
        Exported { scenario, solution, reaches_goal }
    }
}
