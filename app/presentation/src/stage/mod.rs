//! The data from which a page in a browser draws a world: shapes, and the frames of a run.
//!
//! The shapes are those of the animations (`body`, `road_shapes`, `palette`).

mod frame;
mod road;
mod vehicle;

pub use frame::{StageFrame, StageObserver};

use interplay_scenarios::Scenario;
use serde::Serialize;

use crate::camera::car_m;
use crate::palette::{GRASS, css, vehicle_colours};

use self::road::{RoadShape, StageLight};
use self::vehicle::StageVehicle;

/// A world as a page draws it; lengths in metres.
#[derive(Clone, Debug, Serialize)]
pub struct Stage {
    /// Title of the scenario.
    pub title: String,
    /// What the scenario shows.
    pub shows: String,
    /// Length of a tick \[s\].
    pub step_s: f64,
    /// Duration of the scenario \[s\].
    pub duration_s: f64,
    /// Length of a car, which determines the zoom.
    pub car_m: f64,
    /// The vehicles, in the scenario's order.
    pub vehicles: Vec<StageVehicle>,
    /// The road, in the order in which it is painted.
    pub road: Vec<RoadShape>,
    /// Traffic lights.
    pub lights: Vec<StageLight>,
    /// The colour beside the road.
    pub grass: String,
}

impl Stage {
    /// The world of a scenario with vehicles.
    pub fn of(scenario: &Scenario) -> Stage {
        let colours = vehicle_colours(scenario);
        let vehicles = scenario.vehicles.iter().zip(&colours);
        let (road, lights) = road::shapes(scenario);
        Stage {
            title: scenario.title.clone(),
            shows: scenario.shows.clone(),
            step_s: scenario.step_s,
            duration_s: scenario.duration_s,
            car_m: car_m(scenario),
            vehicles: vehicles.map(|(vehicle, colour)| StageVehicle::of(vehicle, colour.rgb)).collect(),
            road,
            lights,
            grass: css(GRASS),
        }
    }
}
