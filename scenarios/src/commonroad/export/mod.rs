//! Exports a run to CommonRoad: the scenario as it was driven, and the motion of the ego as the solution of its planning problem.
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

use crate::model::scenario::Scenario;
use crate::text::error::LoadError;
use base::Base;
pub use base::{DrivenVehicle, Exported};

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
