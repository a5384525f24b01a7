//! Builds the zones of a scenario.

use interplay_building::comfort::{Agenda, SetpointsError};
use interplay_building::control::{ControlError, Disturbance};
use interplay_building::day::{Day, Surroundings};
use interplay_building::discretise::{Model, ModelError};
use interplay_building::network::{Network, NetworkError};
use interplay_building::occupancy::{People, RecordedGains};
use interplay_scenarios::{BuildingConfig, BuildingPlant, Scenario, TimetableError};
use thiserror::Error;

use super::{Building, Equipment, Gains, Node, NodeState, Temperature};
use crate::plants::{BoptestPlant, NetworkPlant, PlantError, SocketPlant, SocketPlantStart, ThermalPlant};

/// Bits that are flipped in the seed, so that weather, occupancy and forecasts with one seed are independent.
const OCCUPANCY_SEED_BIT: u64 = 1 << 40;
const FORECAST_SEED_BIT: u64 = 2 << 40;

/// Why a building cannot be built. A loaded scenario has been checked for all of these errors.
#[derive(Debug, Error)]
pub enum BuildingError {
    /// Zones and walls do not form a network.
    #[error(transparent)]
    Network(#[from] NetworkError),
    /// The network cannot be simulated at this step.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// The setpoints are out of range.
    #[error(transparent)]
    Setpoints(#[from] SetpointsError),
    /// Schedules are contradictory.
    #[error(transparent)]
    Timetable(#[from] TimetableError),
    /// The controller cannot be started.
    #[error(transparent)]
    Control(#[from] ControlError),
    /// The program that simulates the building cannot be reached.
    #[error(transparent)]
    Plant(#[from] PlantError),
}

/// A building and its temperatures at the first midnight.
#[derive(Debug)]
pub struct ClimateState {
    /// The building.
    pub building: Building,
    /// Every node of its network, in order.
    pub nodes: Vec<NodeState>,
}

impl ClimateState {
    /// The building of a scenario, if it has one.
    ///
    /// # Errors
    /// [`BuildingError`], if the scenario was not loaded, or if a plant behind a socket does not answer.
    pub fn initial(scenario: &Scenario) -> Result<Option<Self>, BuildingError> {
        let Some(described) = &scenario.building else { return Ok(None) };
        let (network, steps) = (described.network()?, described.steps_per_day());
        let model = Model::new(&network, described.method, described.step_s)?;
        let believed = Model::new(&described.believed_network()?, described.method, described.step_s)?;
        let zones = network.zone_count();
        let surroundings = surroundings_of(scenario, &network);
        let controller = scenario.controller().controller(&believed, steps)?;
        let mut plant = plant(scenario, described, [&model, &believed], &surroundings)?;
        let started_c = plant.start()?;
        let nodes = started_c.into_iter().enumerate().map(|(index, initial_c)| NodeState {
            node: Node { index },
            temperature: Temperature(initial_c),
            zone: (index < zones).then_some((Equipment { requested_kw: 0.0, heat_kw: 0.0 }, Gains(0.0))),
        });
        let nodes = nodes.collect();
        let timetable = scenario.timetable()?;
        let setpoints = scenario.setpoints.clone().unwrap_or_default();
        let agenda = Agenda::new(setpoints, zones, described.step_s, steps)?;
        let agenda = agenda.following(timetable).supplied(scenario.tariff.clone(), scenario.heat_pump.clone());
        let (agenda, surroundings) = match plant.foreseen() {
            Some(foreseen) => (foreseen.wanted(agenda), foreseen.around(surroundings)),
            None => (agenda, surroundings),
        };
        let nothing = || Disturbance { ambient_c: Vec::new(), gains_kw: Vec::new() };
        let building = Building {
            targets: agenda.of_day(0),
            agenda,
            surroundings,
            controller,
            step: 0,
            today: Day::new(Vec::new(), nothing(), nothing()),
            design_s: 0.0,
            handed_in_kw: None,
            failure: None,
            plant,
            model,
            believed,
        };
        Ok(Some(Self { building, nodes }))
    }
}

/// Weather, people and recorded gains around a scenario's network.
pub fn surroundings_of(scenario: &Scenario, network: &Network) -> Surroundings {
    let weather = scenario.weather.days(scenario.days(), scenario.seed);
    let forecast = (scenario.weather.forecast(), scenario.seed ^ FORECAST_SEED_BIT);
    let records = scenario.gains.iter().flat_map(|gains| gains.zones.iter().cloned());
    Surroundings {
        recorded: RecordedGains { zones: records.collect() },
        ..Surroundings::new(weather, forecast, people(scenario, network.zone_count()), network)
    }
}

/// The plant on which the equipment's heat acts. `models` are the network and the controller's model of it.
fn plant(
    scenario: &Scenario,
    described: &BuildingConfig,
    [model, believed]: [&Model; 2],
    surroundings: &Surroundings,
) -> Result<Box<dyn ThermalPlant>, PlantError> {
    let initial_c = described.initial_c;
    match &described.plant {
        BuildingPlant::Network(_) => Ok(Box::new(NetworkPlant { model: model.clone(), initial_c })),
        BuildingPlant::Socket(config) => {
            let (steps_per_day, days) = (described.steps_per_day(), scenario.days());
            let told = SocketPlantStart { scenario: scenario.title.clone(), steps_per_day, days, initial_c };
            Ok(Box::new(SocketPlant::connect(config, believed.clone(), surroundings.clone(), told)?))
        }
        BuildingPlant::Boptest(config) => {
            let steps = described.steps_per_day() * scenario.days();
            let outdoor_c = surroundings.weather.ambient_steps_c(0.0, believed.step_s(), described.steps_per_day());
            Ok(Box::new(BoptestPlant::new(config, believed.clone(), steps, &outdoor_c)))
        }
    }
}

/// Returns the people of a scenario with `zones` zones.
pub fn people(scenario: &Scenario, zones: usize) -> People {
    let people = scenario.occupancy.unwrap_or_default().people(zones, scenario.seed ^ OCCUPANCY_SEED_BIT);
    // A scenario with contradictory schedules is refused before it runs.
    people.following(scenario.timetable().unwrap_or_default())
}
