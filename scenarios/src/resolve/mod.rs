//! From the file to the scenario: flows become vehicles (`flows`), defaults are added (`defaults`), the keys are read, the road is
//! built, the vehicles are placed on it, and the result is checked (`check`, `budget`).

pub(crate) mod budget;
pub(crate) mod check;
pub(crate) mod defaults;
pub(crate) mod flows;
mod gains_file;
pub(crate) mod local_origin;
mod measured_drivers;
pub(crate) mod placement;
pub(crate) mod records;
mod series_file;
pub(crate) mod tariff_file;
mod unit_file;
pub(crate) mod weather_file;

use std::sync::Arc;

use serde::de::DeserializeOwned;

use interplay_building::control::Controller;
use interplay_planners::Driver;
use interplay_planners::road::network::RoadNetwork;

use crate::format::read::tree::TomlNode;
use crate::format::registry::Registry;
use crate::format::scenario_file::{self, ScenarioFile};
use crate::format::stated::Stated;
use crate::format::vehicle_config::{VehicleConfig, default_driver};
use crate::format::weather::WeatherConfig;
use crate::model::building::gains::GainsConfig;
use crate::model::building::plant::BuildingPlant;
use crate::model::building::weather::WeatherSource;
use crate::model::remark::{ScenarioRemark, ScenarioRemarks};
use crate::model::scenario::{Scenario, Vehicle};
use crate::resolve::check::{consistency, remarks};
use crate::resolve::placement::{KnownRoads, Placed, Start, obstacles, place};
use crate::roads::Road;
use crate::text::error::Fault;
use crate::text::readable::readable;

/// The scenario of a file whose size-dependent keys are all stated, without the scenarios of its counterfactuals.
/// `tree` holds the places of its values.
///
/// # Errors
/// All reasons why it cannot be run.
pub(crate) fn resolve(
    registry: &Registry,
    file: ScenarioFile,
    tree: &TomlNode,
    known_roads: &KnownRoads,
) -> Result<Scenario, Vec<Fault>> {
    let ReadScenario { scenario, is_placed, mut faults } = read(registry, file, tree, known_roads)?;
    if is_placed {
        faults.extend(consistency::check(&scenario, tree, registry.complete()));
    } else {
        // Without its vehicles, no further check is possible.
        faults.extend(consistency::check_times(&scenario, tree));
        return Err(faults);
    }
    let remarks = remarks::collect(&scenario, tree, registry.complete());
    if !faults.is_empty() {
        return Err(faults);
    }
    let remarks = ScenarioRemarks(scenario.remarks.0.iter().cloned().chain(remarks.0).collect());
    Ok(Scenario { remarks, ..scenario })
}

/// A scenario as far as it could be read.
struct ReadScenario {
    /// Unchecked. Parts that could not be read have defaults.
    scenario: Scenario,
    /// Whether its vehicles are on its road; otherwise it has none.
    is_placed: bool,
    /// The faults of the parts that could not be read.
    faults: Vec<Fault>,
}

/// The road of a scenario, with its vehicles.
#[derive(Default)]
struct PlacedVehicles {
    road: Road,
    network: Option<Arc<RoadNetwork>>,
    vehicles: Vec<Vehicle>,
    /// The remark if everything was moved near the origin.
    moved: Option<Fault>,
}

impl Reader<'_> {
    /// Builds the road and places vehicles and obstacles on it.
    fn placed(&self, file: &mut ScenarioFile, known_roads: &KnownRoads) -> Result<PlacedVehicles, Vec<Fault>> {
        let written = serde_json::to_string(&(&file.road, &file.lights)).unwrap_or_default();
        let road = file.road.take().map(|stated| self.registry.road(stated)).transpose();
        let mut road = road.map_err(|error| self.refused("road", &error))?.unwrap_or_default();
        records::read(&mut file.vehicles, self.tree)?;
        let origin = local_origin::move_near_origin(&mut road, &mut file.vehicles, &mut file.obstacles);
        let schema = self.registry.complete();
        let Placed { network, starts } =
            place(&file.vehicles, &road, &file.lights, written, self.tree, schema, known_roads)?;
        let mut vehicles = self.vehicles(std::mem::take(&mut file.vehicles), starts)?;
        vehicles.extend(obstacles(
            &file.obstacles,
            self.registry.obstacles(),
            &road,
            network.as_deref(),
            self.tree,
            &vehicles,
        )?);
        let moved = origin.map(|origin| local_origin::remark(origin, self.tree));
        Ok(PlacedVehicles { road, network, vehicles, moved })
    }
}

/// The same, unchecked; and the faults of its vehicles and of the files that it names.
fn read(
    registry: &Registry,
    mut file: ScenarioFile,
    tree: &TomlNode,
    known_roads: &KnownRoads,
) -> Result<ReadScenario, Vec<Fault>> {
    let reader = Reader { registry, tree };
    let mut faults = Vec::new();
    let placed = reader.placed(&mut file, known_roads).map_err(|found| faults = found).ok();
    let is_placed = placed.is_some();
    let PlacedVehicles { road, network, vehicles, moved } = placed.unwrap_or_default();
    let mut scenario = Scenario {
        vehicles,
        flows: flows::stated(&file.flows),
        road,
        network,
        title: file.title,
        shows: file.shows,
        figure: file.figure,
        scale: file.scale,
        conduct: file.conduct,
        duration_s: file.duration_s.unwrap_or_else(scenario_file::defaults::duration_s),
        step_s: file.step_s.unwrap_or_else(scenario_file::defaults::step_s),
        ticks_per_plan: 1,
        horizon_steps: file.horizon_steps.unwrap_or_else(scenario_file::defaults::horizon_steps),
        seed: file.seed.unwrap_or_else(scenario_file::defaults::seed),
        real_time: reader.optional("real_time", file.real_time)?,
        plant: reader.or_default("plant", file.plant)?,
        lights: file.lights,
        detectors: file.detectors,
        detail: reader.optional("detail", file.detail)?,
        start_jitter: reader.or_default("start_jitter", file.start_jitter)?,
        building: reader.optional("building", file.building)?,
        weather: WeatherSource::default(),
        occupancy: reader.optional("occupancy", file.occupancy)?,
        gains: Vec::new(),
        setpoints: reader.optional("setpoints", file.setpoints)?,
        schedules: reader.list("schedule", file.schedules)?,
        calendar: reader.optional("calendar", file.calendar)?,
        tariff: reader.optional("tariff", file.tariff)?,
        heat_pump: reader.optional("heat_pump", file.heat_pump)?,
        controller: reader.controller(file.controller)?,
        iterations: file.iterations,
        budget: reader.or_default("budget", file.budget)?,
        expect: file.expect,
        counterfactuals: Vec::new(),
        left_out: Vec::new(),
        remarks: ScenarioRemarks::default(),
        metrics: registry.metrics().clone(),
    };
    measured_drivers::draw(&mut scenario.vehicles, scenario.seed);
    let ticks = ticks_per_plan(file.planning_period_s, scenario.step_s, tree).map_err(|fault| faults.push(fault));
    scenario.ticks_per_plan = ticks.unwrap_or(1);
    scenario.remarks.0.extend(moved.map(ScenarioRemark));
    let (weather, gains) = (reader.or_default("weather", file.weather)?, reader.list("gains", file.gains)?);
    let (scenario, unread) = with_named_files(scenario, weather, gains, tree);
    faults.extend(unread);
    Ok(ReadScenario { scenario, is_placed, faults })
}

/// The number of ticks from one plan to the next.
fn ticks_per_plan(stated_s: Option<f64>, step_s: f64, tree: &TomlNode) -> Result<usize, Fault> {
    let Some(period_s) = stated_s else { return Ok(1) };
    let ticks = (period_s / step_s).round();
    if ticks >= 1.0 && (ticks * step_s - period_s).abs() <= 1e-6 * period_s {
        return Ok(ticks as usize);
    }
    let message =
        format!("`planning_period_s` ({}) is not a multiple of `step_s` ({})", readable(period_s), readable(step_s));
    let help = format!("{} works", readable(step_s * ticks.max(1.0)));
    Err(Fault::at(tree.place_of("planning_period_s"), "no multiple", message).help(help))
}

/// The scenario with the contents of the weather file and of the tables of prices and gains in place of their names; and their faults.
fn with_named_files(
    mut scenario: Scenario,
    weather: WeatherConfig,
    gains: Vec<GainsConfig>,
    tree: &TomlNode,
) -> (Scenario, Vec<Fault>) {
    let mut unread = Vec::new();
    let read = match weather {
        WeatherConfig::Synthetic(synthetic) => Ok((WeatherSource::Synthetic(synthetic), Vec::new())),
        WeatherConfig::Epw(stated) => {
            weather_file::read(stated, &scenario, tree).map(|(weather, remarks)| (WeatherSource::Epw(weather), remarks))
        }
        WeatherConfig::Csv(stated) => weather_file::read_table(stated, &scenario, tree)
            .map(|(weather, remarks)| (WeatherSource::Csv(weather), remarks)),
    };
    match read {
        Ok((weather, remarks)) => {
            scenario.weather = weather;
            scenario.remarks.0.extend(remarks);
        }
        Err(fault) => unread.push(fault),
    }
    if let Some(BuildingPlant::Boptest(plant)) = scenario.building.as_mut().map(|building| &mut building.plant)
        && let Some(fmu) = &mut plant.fmu
    {
        match unit_file::find(fmu, tree) {
            Ok(found) => *fmu = found,
            Err(fault) => unread.push(fault),
        }
    }
    match scenario.tariff.as_ref().map(|tariff| tariff_file::read(tariff, &scenario, tree)).transpose() {
        Ok(read) => {
            let (tariff, remark) = read.unzip();
            scenario.tariff = tariff;
            scenario.remarks.0.extend(remark.flatten().map(ScenarioRemark));
        }
        Err(fault) => unread.push(fault),
    }
    for (index, stated) in gains.into_iter().enumerate() {
        match gains_file::read(stated, index, &scenario, tree) {
            Ok((gains, remark)) => {
                scenario.gains.push(gains);
                scenario.remarks.0.extend(remark.map(ScenarioRemark));
            }
            Err(fault) => unread.push(fault),
        }
    }
    (scenario, unread)
}

struct Reader<'a> {
    registry: &'a Registry,
    tree: &'a TomlNode,
}

impl Reader<'_> {
    fn required<T: DeserializeOwned>(&self, path: &str, stated: Stated<T>) -> Result<T, Fault> {
        stated.settings().map_err(|error| self.refused(path, &error))
    }

    /// The schema has admitted the table, so this happens only if it is less strict than the type.
    fn refused(&self, path: &str, error: &serde_json::Error) -> Fault {
        Fault::at(self.tree.place_of(path), "in this table", error.to_string())
    }

    fn optional<T: DeserializeOwned>(&self, path: &str, stated: Option<Stated<T>>) -> Result<Option<T>, Fault> {
        stated.map(|stated| self.required(path, stated)).transpose()
    }

    fn or_default<T: DeserializeOwned + Default>(&self, path: &str, stated: Option<Stated<T>>) -> Result<T, Fault> {
        Ok(self.optional(path, stated)?.unwrap_or_default())
    }

    fn list<T: DeserializeOwned>(&self, path: &str, stated: Vec<Stated<T>>) -> Result<Vec<T>, Fault> {
        let entries = stated.into_iter().enumerate();
        entries.map(|(index, entry)| self.required(&format!("{path}.{index}"), entry)).collect()
    }

    fn driver(&self, path: &str, stated: Option<Stated<Driver>>) -> Result<Driver, Fault> {
        let Some(stated) = stated else { return Ok(default_driver()) };
        self.registry.driver(stated).map_err(|error| self.refused(path, &error))
    }

    fn controller(&self, stated: Option<Stated<Controller>>) -> Result<Option<Controller>, Fault> {
        let read = stated.map(|stated| self.registry.controller(stated)).transpose();
        read.map_err(|error| self.refused("controller", &error))
    }

    fn vehicles(&self, stated: Vec<VehicleConfig>, starts: Vec<Start>) -> Result<Vec<Vehicle>, Fault> {
        let placed = stated.into_iter().zip(starts).enumerate();
        placed.map(|(index, (vehicle, start))| self.vehicle(index, vehicle, start)).collect()
    }

    fn vehicle(&self, index: usize, mut stated: VehicleConfig, (start, route): Start) -> Result<Vehicle, Fault> {
        let path = |key: &str| format!("vehicle.{index}.{key}");
        let driver = self.driver(&path("driver"), stated.driver.take())?;
        let start_acceleration_mps2 = stated.start.acceleration_mps2.unwrap_or(0.0);
        let mut vehicle = Vehicle { start_acceleration_mps2, ..Vehicle::new(start, route, driver) };
        stated.settle_in(&mut vehicle).map_err(|(key, error)| self.refused(&path(key), &error))?;
        Ok(vehicle)
    }
}
