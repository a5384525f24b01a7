//! Writes a scenario back to a file that states every key and reads back to the same scenario.

pub(crate) mod commented;
pub(crate) mod reference;

use interplay_planners::Driver;
use serde_json::{Map, Value as Json};

use crate::format::obstacle::ObstacleConfig;
use crate::format::read::degrees;
use crate::format::registry::Registry;
use crate::format::scenario_file::ScenarioFile;
use crate::format::start::StartConfig;
use crate::format::stated::Stated;
use crate::format::vehicle_config::VehicleConfig;
use crate::model::scenario::Counterfactual;
use crate::model::scenario::{Scenario, Vehicle};
use crate::model::traffic::obstacle::{ObstacleForm, Outline};
use crate::write::commented::plain;

impl Scenario {
    /// A file that states every key of this scenario. It reads back to the same scenario, and so to the same runs.
    ///
    /// The file names other files by absolute paths, and contains the prices of a tariff.
    pub fn to_file(&self) -> ScenarioFile {
        let drives = !self.vehicles.is_empty();
        let weather = self.building.as_ref().map(|_| self.weather.config().into());
        ScenarioFile {
            title: self.title.clone(),
            shows: self.shows.clone(),
            figure: self.figure.clone(),
            scale: self.scale.filter(|_| drives),
            conduct: self.conduct.filter(|_| drives),
            duration_s: drives.then_some(self.duration_s),
            step_s: drives.then_some(self.step_s),
            planning_period_s: (drives && self.ticks_per_plan > 1).then(|| self.planning_period_s()),
            horizon_steps: drives.then_some(self.horizon_steps),
            seed: Some(self.seed),
            real_time: self.real_time.map(Stated::from),
            plant: drives.then(|| self.plant.clone().into()),
            road: drives.then(|| self.road.clone().into()),
            start_jitter: drives.then(|| self.start_jitter.into()),
            vehicles: self
                .vehicles
                .iter()
                .filter(|vehicle| vehicle.obstacle.is_none())
                .map(Vehicle::to_config)
                .collect(),
            // The vehicles of flows are already among the other vehicles.
            flows: Vec::new(),
            detectors: self.detectors.clone(),
            detail: self.detail.map(Stated::from),
            lights: self.lights.clone(),
            obstacles: self.vehicles.iter().filter_map(Vehicle::to_obstacle).collect(),
            defaults: None,
            building: self.building.clone().map(Stated::from),
            weather,
            occupancy: self.occupancy.map(Stated::from),
            gains: self.gains.iter().map(|gains| gains.config().into()).collect(),
            setpoints: self.setpoints.clone().map(Stated::from),
            schedules: self.schedules.iter().cloned().map(Stated::from).collect(),
            calendar: self.calendar.clone().map(Stated::from),
            tariff: self.tariff.clone().map(Stated::from),
            heat_pump: self.heat_pump.clone().map(Stated::from),
            controller: self.controller.clone().map(Stated::from),
            iterations: self.iterations,
            budget: Some(self.budget.into()),
            expect: self.expect.clone(),
            counterfactuals: self.counterfactuals.iter().map(|Counterfactual { stated, .. }| stated.clone()).collect(),
        }
    }
}

impl ScenarioFile {
    /// The file as a text, which reads back to the same file.
    pub fn to_toml(&self) -> String {
        plain(&self.stated())
    }

    pub(crate) fn stated(&self) -> Map<String, Json> {
        // TOML cannot represent the largest seeds as whole numbers.
        let mut keys = Stated::<ScenarioFile>::from(ScenarioFile { seed: None, ..self.clone() }).into_keys();
        keys.extend(self.seed.map(|seed| ("seed".to_owned(), seed.into())));
        degrees::to_degrees(Registry::standard().complete(), &mut keys);
        keys
    }
}

impl Vehicle {
    /// What a file states of the vehicle.
    fn to_config(&self) -> VehicleConfig {
        let lanes = self.route.legs.iter().filter(|_| self.route.is_in_network());
        VehicleConfig {
            start: StartConfig {
                acceleration_mps2: Some(self.start_acceleration_mps2).filter(|stated| *stated != 0.0),
                ..self.start.into()
            },
            route: lanes.map(|leg| leg.lane.clone()).collect(),
            driver: Some(self.driver.clone().into()),
            ..VehicleConfig::of_settled(self)
        }
    }

    /// What a file states about an obstacle; `None` for a vehicle with a driver.
    fn to_obstacle(&self) -> Option<ObstacleConfig> {
        let ObstacleForm { kind, outline } = self.obstacle.clone()?;
        let Driver::Recorded(record) = &self.driver else { return None };
        let mut stated = ObstacleConfig { name: self.name.clone(), kind, ..ObstacleConfig::default() };
        match record.points.as_slice() {
            [_] => {
                (stated.x_m, stated.y_m) = (Some(self.start.x_m), Some(self.start.y_m));
                stated.heading_rad = Some(self.start.heading_rad);
            }
            points => stated.timetable = points.iter().map(|[t, x, y, heading, _]| [*t, *x, *y, *heading]).collect(),
        }
        match outline {
            Outline::Box { length_m, width_m } => (stated.length_m, stated.width_m) = (Some(length_m), Some(width_m)),
            Outline::Circle { radius_m } => stated.radius_m = Some(radius_m),
            Outline::Polygon { corners_m } => stated.corners_m = corners_m,
        }
        Some(stated)
    }
}
