//! The parts of a scenario that is ready to run: agents, road, vehicles and building.
//!
//! Everything here is plain data in SI units. A [`Scenario`] that came from [`load`](crate::load) or
//! [`ScenarioFile::resolve`](crate::ScenarioFile::resolve) has been checked and satisfies all rules of the format.

use std::sync::Arc;

use interplay_building::calendar::Calendar;
use interplay_building::comfort::Setpoints;
use interplay_building::control::Controller;
use interplay_building::control::pid::PidSettings;
use interplay_building::energy::{HeatPump, Tariff};
use interplay_building::occupancy::Occupancy;
use interplay_building::schedule::ZoneSchedule;
use interplay_common::random::SplitMix64;
use interplay_planners::perception::belief;
use interplay_planners::perception::sensing::{self, Sensor};
use interplay_planners::road::network::RoadNetwork;
use interplay_planners::rules::RuleKeeping;
pub use interplay_planners::traffic::Stay;
use interplay_planners::{Body, Corridor, Driver, Limits, Planner, Route, SafetyEllipse, State};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::model::building::config::BuildingConfig;
use crate::model::building::gains::RecordedGainsFile;
use crate::model::building::weather::WeatherSource;
use crate::model::classes::{ScenarioScale, VehicleClass};
use crate::model::expectations::counterfactual::CounterfactualConfig;
use crate::model::expectations::expect::Expect;
use crate::model::metric::RegisteredMetrics;
use crate::model::remark::ScenarioRemarks;
use crate::model::traffic::conduct::Conduct;
use crate::model::traffic::flows::ScenarioFlows;
use crate::model::traffic::goal::GoalConfig;
use crate::model::traffic::lane_reference::DetectorConfig;
use crate::model::traffic::light::LightConfig;
use crate::model::traffic::obstacle::{ObstacleForm, Outline};
use crate::model::traffic::plant::Plant;
use crate::model::traffic::real_time::{Detail, RealTime};
use crate::model::traffic::weights::{StartJitter, Weights};
use crate::roads::{Branch, Road};
use crate::text::name::EGO;

/// The most vehicles that are not yet a crowd.
pub(crate) const MOST_TOLD: usize = 40;

/// A scenario that is ready to run: agents, their world, and the expectations of the run.
#[derive(Clone, Debug, PartialEq)]
pub struct Scenario {
    /// The title of the scenario, in a few words.
    pub title: String,
    /// What it shows, in one sentence.
    pub shows: String,
    /// The figure of the dissertation that it reproduces.
    pub figure: Option<String>,
    /// The size to which its defaults are scaled; `None` for the unscaled defaults of 1/10 scale.
    pub scale: Option<ScenarioScale>,
    /// The default behaviour of drivers, if the file states it.
    pub conduct: Option<Conduct>,
    /// Simulated time of the vehicles \[s\].
    pub duration_s: f64,
    /// Time from one tick of the vehicles to the next \[s\].
    pub step_s: f64,
    /// The number of ticks from one plan to the next.
    pub ticks_per_plan: usize,
    /// Horizon of every plan, in ticks.
    pub horizon_steps: usize,
    /// Seed of all random numbers.
    pub seed: u64,
    /// The time limit of a plan; `None` if there is none.
    pub real_time: Option<RealTime>,
    /// The plant that moves the vehicles.
    pub plant: Plant,
    /// The road.
    pub road: Road,
    /// The lanes of the road, if they have names.
    pub network: Option<Arc<RoadNetwork>>,
    /// Its traffic lights; the lanes of the network hold them.
    pub lights: Vec<LightConfig>,
    /// The lines at which traffic is counted.
    pub detectors: Vec<DetectorConfig>,
    /// The level of detail of traffic far from the ego; without it, that of all other traffic.
    pub detail: Option<Detail>,
    /// Random change of every start, drawn from the seed.
    pub start_jitter: StartJitter,
    /// The vehicles, in the order of the file, and after them the obstacles.
    pub vehicles: Vec<Vehicle>,
    /// The flows of which some of the vehicles come.
    pub flows: ScenarioFlows,
    /// The building, if there is one.
    pub building: Option<BuildingConfig>,
    /// The weather around the building.
    pub weather: WeatherSource,
    /// The people in the building; by default office hours with real deviations.
    pub occupancy: Option<Occupancy>,
    /// Recorded heat of people and machines.
    pub gains: Vec<RecordedGainsFile>,
    /// Wanted temperatures and the cost of missing them; by default those of chapter 3, free at night.
    pub setpoints: Option<Setpoints>,
    /// Schedules of zones whose hours, wanted temperatures or people differ from the others'.
    pub schedules: Vec<ZoneSchedule>,
    /// The date of the first day and the holidays.
    pub calendar: Option<Calendar>,
    /// The price of electricity by the hour; without it energy costs no money. Prices from a file are among them.
    pub tariff: Option<Tariff>,
    /// The heat pump or chiller that supplies all zones; without it a kilowatt-hour of heat takes one of electricity.
    pub heat_pump: Option<HeatPump>,
    /// The controller of the building; by default PID control in each zone.
    pub controller: Option<Controller>,
    /// How many days of the building are simulated; by default 10.
    pub iterations: Option<usize>,
    /// The limits on the work of the run, including its counterfactuals.
    pub budget: BudgetLimits,
    /// The conditions under which the run passes.
    pub expect: Expect,
    /// Runs beside this one with a change, each with the scenario that is run.
    pub counterfactuals: Vec<Counterfactual>,
    /// Counterfactuals that flags have made impossible, each with the reason: a setting that another planner does not have.
    pub left_out: Vec<[String; 2]>,
    /// Remarks on keys that are allowed but probably not intended.
    pub remarks: ScenarioRemarks,
    /// The metrics of the registry that it was loaded with; a run measures them besides those of Interplay.
    pub metrics: RegisteredMetrics,
}

impl Scenario {
    /// Index of the ego in [`Scenario::vehicles`]: the vehicle called `ego` if there is one, otherwise the first.
    pub fn ego_index(&self) -> usize {
        self.index_of(EGO).unwrap_or(0)
    }

    /// The scenario without its counterfactuals: they are claims about its own planner and do not apply to another driver.
    pub fn without_counterfactuals(self) -> Scenario {
        Scenario { counterfactuals: Vec::new(), left_out: Vec::new(), ..self }
    }

    /// The scenario's traffic alone, without its building and the keys about it.
    pub fn without_building(self) -> Scenario {
        Scenario {
            building: None,
            weather: WeatherSource::default(),
            occupancy: None,
            gains: Vec::new(),
            setpoints: None,
            schedules: Vec::new(),
            calendar: None,
            tariff: None,
            heat_pump: None,
            controller: None,
            iterations: None,
            ..self
        }
    }

    /// Whether no vehicle stands out, because the ego is only the first of a flow.
    pub fn is_flow_alone(&self) -> bool {
        self.ego().is_some_and(|ego| self.flows.of(&ego.name).is_some())
    }

    /// Whether recordings and pictures show only the vehicles near the ego, because there are too many.
    pub fn is_crowd(&self) -> bool {
        self.vehicles.len() > MOST_TOLD
    }

    /// The level of detail of a vehicle: for humans other than the ego; `None` for all others.
    pub fn detail_of(&self, index: usize) -> Option<Detail> {
        let is_concerned = index != self.ego_index() && matches!(self.vehicles[index].driver, Driver::Human(_));
        self.detail.filter(|_| is_concerned)
    }

    /// Index in [`Scenario::vehicles`] of the vehicle of that name.
    pub fn index_of(&self, name: &str) -> Option<usize> {
        self.vehicles.iter().position(|vehicle| vehicle.name == name)
    }

    /// The ego: the vehicle called `ego` if there is one, otherwise the first; `None` only without vehicles.
    pub fn ego(&self) -> Option<&Vehicle> {
        self.vehicles.get(self.ego_index())
    }

    /// The vehicle of that name.
    pub fn vehicle(&self, name: &str) -> Option<&Vehicle> {
        self.vehicles.iter().find(|vehicle| vehicle.name == name)
    }

    /// A vehicle whose driver needs inputs from outside during the run.
    pub fn awaiting_inputs(&self) -> Option<&Vehicle> {
        self.vehicles.iter().find(|vehicle| vehicle.driver.awaits_inputs())
    }

    /// The number of ticks of the vehicles: `duration_s / step_s`, rounded; 0 without vehicles.
    pub fn tick_count(&self) -> usize {
        if self.vehicles.is_empty() {
            return 0;
        }
        (self.duration_s / self.step_s).round() as usize
    }

    /// The number of plans that each vehicle makes.
    pub fn plan_count(&self) -> usize {
        self.tick_count().div_ceil(self.ticks_per_plan)
    }

    /// Time between two plans, which is also the length of a stage of a plan \[s\].
    pub fn planning_period_s(&self) -> f64 {
        self.step_s * self.ticks_per_plan as f64
    }

    /// The number of simulated days of the building; 0 without a building.
    pub fn days(&self) -> usize {
        if self.building.is_some() { self.iterations.unwrap_or(10) } else { 0 }
    }

    /// The controller of the building; by default a PID controller in each zone.
    pub fn controller(&self) -> Controller {
        self.controller.clone().unwrap_or(Controller::Pid(PidSettings::default()))
    }

    /// The route along which positions on the whole road are measured: that of the main road, or on a network that of the ego.
    pub fn main_route(&self) -> Arc<Route> {
        let on_main = || self.vehicles.iter().find(|vehicle| vehicle.road == Branch::Main);
        let vehicle = if self.network.is_some() { self.ego() } else { on_main() };
        let route = vehicle.map(|vehicle| Arc::clone(&vehicle.route));
        route.or_else(|| self.road.route(Branch::Main)).unwrap_or_else(straight_route)
    }

    /// The state in which each vehicle starts: as written, plus the random change by `start_jitter`. The
    /// same seed gives the same starts. A recorded vehicle starts where its record begins.
    pub fn starts(&self) -> Vec<State> {
        let mut random = SplitMix64::new(self.seed);
        let jitter = self.start_jitter;
        let start = |vehicle: &Vehicle| {
            let changed = jitter.changed(vehicle.start, &vehicle.limits, &mut random);
            if vehicle.driver.record().is_some() { vehicle.start } else { changed }
        };
        self.vehicles.iter().map(start).collect()
    }
}

/// The x axis, without width.
fn straight_route() -> Arc<Route> {
    Arc::new(Route::from(Corridor { heading_rad: 0.0, right_m: 0.0, left_m: 0.0, end: None }))
}

/// One vehicle: start, route, goal, body, limits and driver.
#[derive(Clone, Debug, PartialEq)]
pub struct Vehicle {
    /// Its name, unique in the scenario; it becomes part of paths in the recording.
    pub name: String,
    /// Its class, if stated.
    pub class: Option<VehicleClass>,
    /// The road it drives on; only intersections have another than the main one.
    pub road: Branch,
    /// Its start in world coordinates, and its speed there.
    pub start: State,
    /// Its acceleration just before the start \[m/s²\].
    pub start_acceleration_mps2: f64,
    /// Its route along the road.
    pub route: Arc<Route>,
    /// Its goal; what is not stated stays as at the start.
    pub goal: GoalConfig,
    /// Weights of deviations from its goal and of changes of its inputs.
    pub weights: Weights,
    /// Its size and axles.
    pub body: Body,
    /// The bounds of its inputs and its speed.
    pub limits: Limits,
    /// The ellipse around each other vehicle that it keeps out of.
    pub safety: SafetyEllipse,
    /// Its driver.
    pub driver: Driver,
    /// Whether it keeps the rules of the road, if stated; otherwise its kind of driver decides.
    pub rules: Option<RuleKeeping>,
    /// Whether it tells its plan to those that know plans; `None` if it does.
    pub tells_plan: Option<bool>,
    /// Whether it knows the plans of those that tell them, if its driver does; `None` if so.
    pub knows_plans: Option<bool>,
    /// When it is on the road.
    pub stay: Stay,
    /// The obstacle that it is, if it has no driver.
    pub obstacle: Option<ObstacleForm>,
    /// Its sensing of the other vehicles; without it, it sees the exact states.
    pub sensing: Option<sensing::Settings>,
    /// How it infers the others' plans from their motion, if its driver does.
    pub inference: Option<belief::Settings>,
}

impl Vehicle {
    /// Whether its driver receives the plans of others: the vehicle is told of them, and the driver's kind makes use of them.
    pub fn knows_plans(&self) -> bool {
        self.knows_plans.unwrap_or(true) && self.driver.knows_plans()
    }

    /// Whether its plan, its goal and its wishes are told to drivers that know plans.
    pub fn tells_plan(&self) -> bool {
        self.tells_plan.unwrap_or(true)
    }

    /// A vehicle without a name, with the defaults of 1/10 scale cars.
    pub(crate) fn new(start: State, route: Arc<Route>, driver: Driver) -> Vehicle {
        Vehicle {
            name: String::new(),
            class: None,
            road: Branch::Main,
            start,
            start_acceleration_mps2: 0.0,
            route,
            goal: GoalConfig::default(),
            weights: Weights::default(),
            body: Body::default(),
            limits: Limits::default(),
            safety: SafetyEllipse::default(),
            driver,
            rules: None,
            tells_plan: None,
            knows_plans: None,
            stay: Stay::default(),
            obstacle: None,
            sensing: None,
            inference: None,
        }
    }

    /// The desired state of the vehicle: its desired speed along the road, at the lateral position of its goal (without one, of its start; after
    /// a record, in the lane where that ends; on a network, in the middle). The coordinate along the road is that of the start.
    pub fn target(&self, road: &Road) -> State {
        let route = &self.route;
        let start = route.locate(self.start.position(), None);
        let stated_m = self.goal_lane_centre_m(road).or(self.goal.y_m);
        let start_m = if road.parallel_lanes().is_some() { start.across_m } else { 0.0 };
        let end = self.driver.record().and_then(|record| record.state_at(record.span_s()[1]));
        let stated_m = stated_m.or_else(|| road.nearest_lane_m(self.road, route.across(end?.position())));
        let [x_m, y_m] = route.centre.position(start.along_m, stated_m.unwrap_or(start_m));
        State {
            x_m,
            y_m,
            heading_rad: start.heading_rad,
            speed_mps: self.goal.speed_mps.unwrap_or(self.start.speed_mps),
        }
    }
}

impl Vehicle {
    /// The outline of an obstacle; `None` for other vehicles.
    pub fn outline(&self) -> Option<&Outline> {
        self.obstacle.as_ref().map(|obstacle| &obstacle.outline)
    }

    /// Whether the vehicle keeps all rules of the road.
    pub fn keeps_rules(&self) -> bool {
        self.rules == Some(RuleKeeping::Kept)
    }

    /// The planner of the vehicle, before its first plan.
    pub fn planner(&self) -> Planner {
        self.driver.planner_believing(&self.inference.unwrap_or_default())
    }

    /// The sensor of the vehicle, with errors from a seed; `None` if it sees the exact states.
    pub fn sensor(&self, seed: u64) -> Option<Sensor> {
        self.sensing.map(|settings| Sensor::new(settings, seed))
    }

    /// Lateral coordinate of the goal lane, on parallel lanes \[m\].
    pub(crate) fn goal_lane_centre_m(&self, road: &Road) -> Option<f64> {
        road.lane_centre_m(self.road, self.goal.lane.as_ref()?.number()?)
    }
}

/// A counterfactual with the scenario that is run for it.
#[derive(Clone, Debug, PartialEq)]
pub struct Counterfactual {
    /// Its claim, its changes, and its expectations.
    pub stated: CounterfactualConfig,
    /// The changed scenario; its expectations are the counterfactual's.
    pub scenario: Scenario,
}

/// The limits on the work of a run; a run above them is refused before it begins. The defaults allow some minutes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct BudgetLimits {
    /// The most plans: one for each vehicle at each tick.
    #[schemars(range(min = 1))]
    pub plans: u64,
    /// The most steps: of each vehicle and each pair of vehicles in each sub-step of the plant, and of each zone of a building.
    #[schemars(range(min = 1))]
    pub steps: u64,
    /// The most operations of the designs of the building's days, estimated, in thousands of millions.
    #[schemars(range(min = 1))]
    pub design_gop: u64,
    /// The longest estimated time on one core of the reference machine \[s\].
    #[schemars(range(min = 1))]
    pub processor_s: u64,
    /// The largest estimated size of the recording \[MB\].
    #[schemars(range(min = 1))]
    pub recorded_mb: u64,
}

impl Default for BudgetLimits {
    fn default() -> Self {
        BudgetLimits { plans: 200_000, steps: 20_000_000, design_gop: 200, processor_s: 1800, recorded_mb: 500 }
    }
}
