//! The nouns of a scenario file: what is simulated, on which road, by which vehicles.
//!
//! Everything here is plain data in SI units, already checked: a [`Scenario`] that came from [`load`](crate::load) keeps
//! every promise that the descriptions below make.

use std::sync::Arc;

use interplay_building::calendar::Calendar;
use interplay_building::comfort::Setpoints;
use interplay_building::control::Controller;
use interplay_building::control::pid::PidSettings;
use interplay_building::energy::{HeatPump, Tariff};
use interplay_building::occupancy::Occupancy;
use interplay_building::schedule::ZoneSchedule;
use interplay_common::random::SplitMix64;
use interplay_planners::road::network::RoadNetwork;
use interplay_planners::sensing::{self, Sensor};
use interplay_planners::{Body, Corridor, Driver, Limits, Planner, Route, SafetyEllipse, State, belief, human};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::json;

use crate::budget_limits::BudgetLimits;
use crate::building::BuildingConfig;
use crate::classes::{ScenarioScale, VehicleClass};
use crate::counterfactual::Counterfactual;
use crate::expect::Expect;
use crate::lane_reference::LaneReference;
use crate::name;
use crate::plant::Plant;
use crate::real_time::RealTime;
use crate::remark::ScenarioRemarks;
use crate::road::{Branch, Road};
use crate::start::StartConfig;
use crate::start_jitter::StartJitter;
use crate::vehicle_defaults::VehicleDefaults;
use crate::weather::WeatherConfig;
use crate::weights::Weights;

/// One scenario: agents, their world, and the expectations of the run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scenario {
    /// What the scenario is called, in a few words.
    #[schemars(length(min = 1), example = &"Lane change, front driver nice")]
    pub title: String,
    /// What it shows, in one sentence.
    #[schemars(length(min = 1), example = &"The ego cuts in ahead of a driver who yields")]
    pub shows: String,
    /// The figure of the dissertation that it reproduces.
    #[serde(default)]
    #[schemars(example = &"6.1")]
    pub figure: Option<String>,
    /// The size of everything: `"tenth"` for 1/10 scale cars, `"full"` for real ones, or a ratio of lengths to 1/10 scale. What
    /// the file does not state is scaled by it, by Froude's law: lengths by `λ`, times and speeds by `√λ`, and accelerations
    /// stay. By default the size of the vehicles' classes. Where no vehicle states a class or a body, lanes at least 2 m wide mean full
    /// size; networks of lanes do unless all their lanes begin narrower than 1 m. Otherwise it is 1/10 scale.
    #[serde(default)]
    #[schemars(extend("x-concerns" = "vehicles"), example = &"full")]
    pub scale: Option<ScenarioScale>,
    /// Simulated time; 12 s at 1/10 scale, and `√λ` times as long at another `scale` \[s\].
    #[serde(default = "defaults::duration_s")]
    #[schemars(range(min = 0.001), extend("x-concerns" = "vehicles"))]
    pub duration_s: f64,
    /// Time from one tick to the next; all vehicles plan and move once a tick. It is 0.1 s at 1/10 scale, and `√λ` times as
    /// long at another `scale`, so that a horizon of as many ticks covers the same motion \[s\].
    #[serde(default = "defaults::step_s")]
    #[schemars(range(min = 0.001), extend("x-concerns" = "vehicles"))]
    pub step_s: f64,
    /// Horizon of every plan, in ticks.
    #[serde(default = "defaults::horizon_steps")]
    #[schemars(range(min = 2, max = 200), extend("x-concerns" = "vehicles"))]
    pub horizon_steps: usize,
    /// Seed of all random numbers.
    #[serde(default = "defaults::seed")]
    pub seed: u64,
    /// How long a plan may take; without the table there is no limit.
    #[serde(default)]
    #[schemars(extend("x-concerns" = "vehicles"), example = json!({ "plan_budget_ms": 10.0, "deadline": "enforced" }))]
    pub real_time: Option<RealTime>,
    /// What moves the vehicles, `kind` choosing; by default exactly the model that planners use.
    #[serde(default)]
    #[schemars(extend("x-concerns" = "vehicles"))]
    pub plant: Plant,
    /// Where vehicles may drive, `kind` choosing; by default two lanes for 1/10 scale cars.
    #[serde(default)]
    #[schemars(extend("x-concerns" = "vehicles"))]
    pub road: Road,
    /// The lanes of the road once the file is loaded, if they have names.
    #[serde(skip)]
    pub network: Option<Arc<RoadNetwork>>,
    /// Random change of every start, drawn from the seed; none by default.
    #[serde(default)]
    #[schemars(extend("x-concerns" = "vehicles"))]
    pub start_jitter: StartJitter,
    /// The vehicles, one `[[vehicle]]` each.
    #[serde(rename = "vehicle", default)]
    #[schemars(length(max = 64), extend("x-concerns" = "vehicles"), extend("x-merge-by" = "name"))]
    pub vehicles: Vec<Vehicle>,
    /// What holds for every vehicle that does not state it. Each key of a table counts for itself.
    #[serde(default)]
    #[schemars(extend("x-concerns" = "vehicles"), example = json!({ "class": "car" }))]
    pub defaults: Option<VehicleDefaults>,
    /// The building; without the table there is none.
    #[serde(default)]
    #[schemars(extend("x-concerns" = "building"), example = json!({ "preset": "testbed" }))]
    pub building: Option<BuildingConfig>,
    /// The weather around the building; by default synthetic and tropical, forecast without error.
    #[serde(default)]
    #[schemars(extend("x-concerns" = "building"), example = json!({ "kind": "synthetic" }))]
    pub weather: Option<WeatherConfig>,
    /// The people in the building; by default office hours with real deviations.
    #[serde(default)]
    #[schemars(extend("x-concerns" = "building"), example = json!({}))]
    pub occupancy: Option<Occupancy>,
    /// Wanted temperatures and what it costs to miss them; by default those of chapter 3, free at night.
    #[serde(default)]
    #[schemars(extend("x-concerns" = "building"), example = json!({ "occupied_c": [24.0] }))]
    pub setpoints: Option<Setpoints>,
    /// Schedules of zones that have other hours, wanted temperatures or people than the others, one `[[schedule]]` each. A zone
    /// that is named in one follows its schedules alone.
    #[serde(rename = "schedule", default)]
    #[schemars(length(max = 1000), extend("x-concerns" = "building"))]
    pub schedules: Vec<ZoneSchedule>,
    /// The date of the first day and the holidays, for schedules by weekday; by default the first day is a Monday, or the weekday
    /// that the weather file states.
    #[serde(default)]
    #[schemars(extend("x-concerns" = "building"), example = json!({ "first_day": "2026-07-06" }))]
    pub calendar: Option<Calendar>,
    /// The price of electricity by the hour; without it energy costs no money.
    #[serde(default)]
    #[schemars(extend("x-concerns" = "building"), example = json!({ "prices_per_kwh": [0.3] }))]
    pub tariff: Option<Tariff>,
    /// The heat pump or chiller that supplies all zones; without it a kilowatt-hour of heat takes one of electricity.
    #[serde(default)]
    #[schemars(extend("x-concerns" = "building"), example = json!({ "heating": [{ "outdoor_c": 7.0, "cop": 3.5 }] }))]
    pub heat_pump: Option<HeatPump>,
    /// The controller of the building; by default PID control in each zone.
    #[serde(default)]
    #[schemars(extend("x-concerns" = "building"), example = json!({ "kind": "pid" }))]
    pub controller: Option<Controller>,
    /// How many days of the building are simulated; by default 10.
    #[serde(default)]
    #[schemars(range(min = 1, max = 10000), extend("x-concerns" = "building"), example = 10)]
    pub iterations: Option<usize>,
    /// How much work the run may be, its counterfactuals included.
    #[serde(default)]
    pub budget: BudgetLimits,
    /// The conditions under which the run passes; none by default.
    #[serde(default)]
    pub expect: Expect,
    /// Runs beside this one in which something is changed, one `[[counterfactual]]` each. A variant does not inherit them.
    #[serde(rename = "counterfactual", default)]
    #[schemars(length(max = 64))]
    pub counterfactuals: Vec<Counterfactual>,
    /// The changed scenario of each counterfactual, once the file is loaded; its expectations are the counterfactual's.
    #[serde(skip)]
    pub changed: Vec<Scenario>,
    /// What is allowed and may not have been meant, once the file is loaded.
    #[serde(skip)]
    pub remarks: ScenarioRemarks,
    /// Counterfactuals that flags have made impossible, each with the reason: a setting that another planner does not have.
    #[serde(skip)]
    pub left_out: Vec<[String; 2]>,
}

/// How many days are simulated unless the scenario says so.
const ITERATIONS: usize = 10;

mod defaults {
    pub fn duration_s() -> f64 {
        12.0
    }
    pub fn step_s() -> f64 {
        0.1
    }
    pub fn horizon_steps() -> usize {
        30
    }
    pub fn seed() -> u64 {
        1
    }
}

impl Scenario {
    /// Index of the ego in [`Scenario::vehicles`]: the vehicle called `ego` if there is one, otherwise the first.
    pub fn ego_index(&self) -> usize {
        self.index_of(EGO).unwrap_or(0)
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

    /// How many ticks the vehicles take: `duration_s / step_s`, rounded; 0 without vehicles.
    pub fn tick_count(&self) -> usize {
        if self.vehicles.is_empty() {
            return 0;
        }
        (self.duration_s / self.step_s).round() as usize
    }

    /// The counterfactuals of a loaded scenario, each with the scenario that is run for it.
    pub fn counterfactual_runs(&self) -> impl Iterator<Item = (&Counterfactual, &Scenario)> {
        self.counterfactuals.iter().zip(&self.changed)
    }

    /// How many days of the building are simulated; 0 without a building.
    pub fn days(&self) -> usize {
        if self.building.is_some() { self.iterations.unwrap_or(ITERATIONS) } else { 0 }
    }

    /// Who controls the building; a PID controller in each zone unless the scenario says so.
    pub fn controller(&self) -> Controller {
        self.controller.unwrap_or(Controller::Pid(PidSettings::default()))
    }

    /// The route along which positions on the whole road are measured: that of the main road, and on a network that of the ego.
    pub fn main_route(&self) -> Arc<Route> {
        let on_main = || self.vehicles.iter().find(|vehicle| vehicle.road == Branch::Main);
        let vehicle = if self.network.is_some() { self.ego() } else { on_main() };
        let route = vehicle.map(|vehicle| Arc::clone(&vehicle.route));
        route.or_else(|| self.road.route(Branch::Main)).unwrap_or_else(default_route)
    }

    /// The state in which each vehicle starts: as written, plus the random change that `start_jitter` asks for. The
    /// same seed gives the same starts.
    pub fn starts(&self) -> Vec<State> {
        let mut random = SplitMix64::new(self.seed);
        let jitter = self.start_jitter;
        self.vehicles.iter().map(|vehicle| jitter.changed(vehicle.start, &vehicle.limits, &mut random)).collect()
    }
}

/// The name that makes a vehicle the ego.
pub(crate) const EGO: &str = "ego";

/// One vehicle: start, goal, body, limits and driver.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Vehicle {
    /// Its name, unique in the file; it becomes part of paths in the recording.
    #[schemars(extend("pattern" = name::pattern()), example = &"ego")]
    pub name: String,
    /// What sort of vehicle it is: the default of `body`, `limits` and `safety`, and the size to which the defaults of its
    /// weights and of its driver's settings are scaled. By default a car of the scenario's `scale`, which the width of the lanes
    /// may say.
    #[serde(default)]
    #[schemars(example = &"car")]
    pub class: Option<VehicleClass>,
    /// The road it drives on; by default the one along x, and there is another at intersections only.
    #[serde(default)]
    pub road: Branch,
    // A file says it as `StartConfig` does; loading resolves that.
    /// Where it starts, in a lane or in world coordinates, and its speed there.
    #[schemars(with = "StartConfig", example = json!({ "x_m": 0.0, "y_m": 0.185, "speed_mps": 1.0 }))]
    pub start: State,
    /// The names of the lanes on which it drives, from that of its start on, each a successor of the one before or a lane
    /// beside it. By default the shortest way to the lane of its goal, or without one the only way there is.
    #[serde(rename = "route", default)]
    #[schemars(length(max = 1000), example = vec!["west-in", "west-to-north", "north-out"])]
    pub route_lanes: Vec<String>,
    /// Its goal; by default to keep its lateral position and its speed.
    #[serde(default)]
    pub goal: GoalConfig,
    /// Weights of deviations from its goal and of changes of its inputs. With a `class` of real vehicles, those of angles grow by
    /// default with the speed at the start or of the goal.
    #[serde(default)]
    pub weights: Weights,
    /// Its size and axles; by default those of its class, or Table 6.1.
    #[serde(default)]
    pub body: Body,
    /// The bounds of its inputs and its speed; by default those of its class, or Table 6.2.
    #[serde(default)]
    pub limits: Limits,
    /// The ellipse around each other vehicle that it keeps out of; by default that of its class, or Table 6.2.
    #[serde(default)]
    pub safety: SafetyEllipse,
    /// Its driver, `kind` choosing; by default a nice human.
    #[serde(default = "default_driver")]
    pub driver: Driver,
    /// What it senses of the others; without it, it sees every state as it is.
    #[serde(default)]
    #[schemars(example = json!({ "speed_sd_mps": 0.05, "delay_s": 0.3 }))]
    pub sensing: Option<sensing::Settings>,
    /// How it learns from the others' motion what they will do, where its driver says `prediction = "inferred"`.
    #[serde(default)]
    #[schemars(example = json!({ "prior": "tough" }))]
    pub inference: Option<belief::Settings>,
    /// Its way along the road, once the file is loaded; until then the x axis.
    #[serde(skip, default = "default_route")]
    pub route: Arc<Route>,
}

fn default_route() -> Arc<Route> {
    let straight = Corridor { heading_rad: 0.0, right_m: 0.0, left_m: 0.0, end: None };
    Arc::new(Route::from(straight))
}

fn default_driver() -> Driver {
    Driver::Human(human::Settings::default())
}

impl Vehicle {
    /// The state that the vehicle wants: the lateral position of its goal (that of its start without one, and on a network the
    /// middle of its route), along the road, at the wanted speed. The coordinate along the road is that of the start and nobody
    /// tracks it.
    pub fn target(&self, road: &Road) -> State {
        let route = &self.route;
        let start = route.locate(self.start.position(), None);
        let stated_m = self.goal_lane_centre_m(road).or(self.goal.y_m);
        let start_m = if road.parallel_lanes().is_some() { start.across_m } else { 0.0 };
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
    /// Its planner, which has not planned yet.
    pub fn planner(&self) -> Planner {
        self.driver.planner_believing(&self.inference.unwrap_or_default())
    }

    /// Its sensor with the errors of a seed; none where it sees everybody as it is.
    pub fn sensor(&self, seed: u64) -> Option<Sensor> {
        self.sensing.map(|settings| Sensor::new(settings, seed))
    }

    /// Lateral coordinate of the lane that is the goal, if parallel lanes have one \[m\].
    pub(crate) fn goal_lane_centre_m(&self, road: &Road) -> Option<f64> {
        road.lane_centre_m(self.road, self.goal.lane.as_ref()?.number()?)
    }
}

/// The goal of a vehicle. What is not stated stays as at the start.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct GoalConfig {
    /// The lane whose centre it aims at: its number from the right, 0 being the rightmost. On a road whose lanes have names, the
    /// name of the lane to which it drives, by the shortest way.
    #[schemars(example = 1, extend("x-excludes" = ["y_m"]))]
    pub lane: Option<LaneReference>,
    /// The lateral position that it aims at, on the road along x \[m\].
    #[schemars(example = 0.555)]
    pub y_m: Option<f64>,
    /// The speed that it aims at \[m/s\].
    #[schemars(example = 1.0)]
    pub speed_mps: Option<f64>,
}
