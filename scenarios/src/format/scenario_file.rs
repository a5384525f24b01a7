//! A scenario as a file states it.

use interplay_building::calendar::Calendar;
use interplay_building::comfort::Setpoints;
use interplay_building::control::Controller;
use interplay_building::energy::{HeatPump, Tariff};
use interplay_building::occupancy::Occupancy;
use interplay_building::schedule::ZoneSchedule;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::json;

use crate::format::flow::FlowConfig;
use crate::format::obstacle::ObstacleConfig;
use crate::format::stated::Stated;
use crate::format::vehicle_config::{VehicleConfig, VehicleDefaults};
use crate::format::weather::WeatherConfig;
use crate::model::building::config::BuildingConfig;
use crate::model::building::gains::GainsConfig;
use crate::model::classes::ScenarioScale;
use crate::model::expectations::counterfactual::CounterfactualConfig;
use crate::model::expectations::expect::Expect;
use crate::model::scenario::BudgetLimits;
use crate::model::traffic::conduct::Conduct;
use crate::model::traffic::lane_reference::DetectorConfig;
use crate::model::traffic::light::LightConfig;
use crate::model::traffic::plant::Plant;
use crate::model::traffic::real_time::{Detail, RealTime};
use crate::model::traffic::weights::StartJitter;
use crate::roads::Road;

/// One scenario: agents, their world, and the expectations of the run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ScenarioFile {
    /// The title of the scenario, in a few words.
    #[schemars(length(min = 1), example = &"Lane change, front driver nice")]
    pub title: String,
    /// What it shows, in one sentence.
    #[schemars(length(min = 1), example = &"The ego cuts in ahead of a driver who yields")]
    pub shows: String,
    /// The figure of the dissertation that it reproduces.
    #[schemars(example = &"6.1")]
    pub figure: Option<String>,
    /// The size of everything: `"tenth"` for 1/10 scale cars, `"full"` for real ones, or a ratio of lengths to 1/10 scale. What
    /// the file does not state is scaled by it, by Froude's law: lengths by `λ`, times and speeds by `√λ`, and accelerations
    /// stay. By default the size of the vehicles' classes. Where no vehicle states a class or a body, lanes at least 2 m wide mean full
    /// size; networks of lanes do unless all their lanes begin narrower than 1 m. Otherwise it is 1/10 scale.
    #[schemars(extend("x-concerns" = "vehicles"), example = &"full")]
    pub scale: Option<ScenarioScale>,
    /// The default behaviour of drivers: `"people"` keep within comfort and to time gaps and rules, need 0.6 s to
    /// react, and move in steps of 0.1 s with a plan of 8 s every 0.2 s; `"source"` are the drivers of the dissertation. By default
    /// `"people"` at full size if no `figure` is reproduced.
    #[schemars(extend("x-concerns" = "vehicles"), example = &"people")]
    pub conduct: Option<Conduct>,
    /// Simulated time; 12 s at 1/10 scale, and `√λ` times as long at another `scale` \[s\].
    #[schemars(range(min = 0.001), extend("x-concerns" = "vehicles"), default = "defaults::duration_s")]
    pub duration_s: Option<f64>,
    /// Time from one tick to the next; all vehicles move once a tick. It is 0.1 s at 1/10 scale, and `√λ` times as
    /// long at another `scale`, so that a horizon of as many ticks covers the same motion \[s\].
    #[schemars(range(min = 0.001), extend("x-concerns" = "vehicles"), default = "defaults::step_s")]
    pub step_s: Option<f64>,
    /// Time from one plan to the next, and length of a stage of a plan: a multiple of `step_s`, by default `step_s` itself. Between two
    /// plans inputs change linearly from one to the next \[s\].
    #[schemars(range(min = 0.001), extend("x-concerns" = "vehicles"), example = 0.3)]
    pub planning_period_s: Option<f64>,
    /// Horizon of every plan, in stages.
    #[schemars(range(min = 2, max = 200), extend("x-concerns" = "vehicles"), default = "defaults::horizon_steps")]
    pub horizon_steps: Option<usize>,
    /// Seed of all random numbers.
    #[schemars(default = "defaults::seed")]
    pub seed: Option<u64>,
    /// The time limit of a plan; without the table there is none.
    #[schemars(extend("x-concerns" = "vehicles"), example = json!({ "plan_budget_ms": 10.0, "deadline": "enforced" }))]
    pub real_time: Option<Stated<RealTime>>,
    /// The plant that moves the vehicles; `kind` chooses. By default exactly the model of the planners.
    #[schemars(extend("x-concerns" = "vehicles"), with = "Plant", default = "Plant::default")]
    pub plant: Option<Stated<Plant>>,
    /// The road; `kind` chooses. By default two lanes for 1/10 scale cars.
    #[schemars(extend("x-concerns" = "vehicles"), with = "Road", default = "Road::default")]
    pub road: Option<Stated<Road>>,
    /// Random change of every start, drawn from the seed; none by default.
    #[schemars(extend("x-concerns" = "vehicles"), with = "StartJitter", default = "StartJitter::default")]
    pub start_jitter: Option<Stated<StartJitter>>,
    /// The vehicles, one `[[vehicle]]` each.
    #[serde(rename = "vehicle", default)]
    #[schemars(length(max = 10_000), extend("x-concerns" = "vehicles"), extend("x-merge-by" = "name"))]
    pub vehicles: Vec<VehicleConfig>,
    /// Vehicles that come one after another, one `[[flow]]` each.
    #[serde(rename = "flow", default)]
    #[schemars(length(max = 100), extend("x-concerns" = "vehicles"), extend("x-merge-by" = "name"))]
    pub flows: Vec<FlowConfig>,
    /// The objects without a driver on the road or beside it, one `[[obstacle]]` each.
    #[serde(rename = "obstacle", default)]
    #[schemars(length(max = 256), extend("x-concerns" = "vehicles"), extend("x-merge-by" = "name"))]
    pub obstacles: Vec<ObstacleConfig>,
    /// The lines at which traffic is counted, one `[[detector]]` each.
    #[serde(rename = "detector", default)]
    #[schemars(length(max = 1000), extend("x-concerns" = "vehicles"), extend("x-merge-by" = "name"))]
    pub detectors: Vec<DetectorConfig>,
    /// The level of detail of traffic far from the ego; by default that of all other traffic.
    #[schemars(extend("x-concerns" = "vehicles"), example = json!({ "within_m": 150.0 }))]
    pub detail: Option<Stated<Detail>>,
    /// Traffic lights at the ends of lanes with names, one `[[light]]` each.
    #[serde(rename = "light", default)]
    #[schemars(length(max = 100), extend("x-concerns" = "vehicles"), extend("x-merge-by" = "name"))]
    pub lights: Vec<LightConfig>,
    /// Keys for all vehicles that do not state them. Each key of a table counts separately.
    #[schemars(extend("x-concerns" = "vehicles"), example = json!({ "class": "car" }))]
    pub defaults: Option<VehicleDefaults>,
    /// The building; without the table the scenario has none.
    #[schemars(extend("x-concerns" = "building"), example = json!({ "preset": "testbed" }))]
    pub building: Option<Stated<BuildingConfig>>,
    /// The weather around the building; by default synthetic and tropical, forecast without error.
    #[schemars(extend("x-concerns" = "building"), example = json!({ "kind": "synthetic" }))]
    pub weather: Option<Stated<WeatherConfig>>,
    /// The people in the building; by default office hours with real deviations.
    #[schemars(extend("x-concerns" = "building"), example = json!({}))]
    pub occupancy: Option<Stated<Occupancy>>,
    /// Recorded heat of people and machines, one `[[gains]]` for each table; without it all heat of people follows the schedules.
    #[serde(default)]
    #[schemars(length(max = 100), extend("x-concerns" = "building"))]
    pub gains: Vec<Stated<GainsConfig>>,
    /// Wanted temperatures and the cost of missing them; by default those of chapter 3, free at night.
    #[schemars(extend("x-concerns" = "building"), example = json!({ "occupied_c": [24.0] }))]
    pub setpoints: Option<Stated<Setpoints>>,
    /// Schedules of zones whose hours, wanted temperatures or people differ from the others', one `[[schedule]]` each. A zone
    /// that a schedule names follows only the schedules that name it.
    #[serde(rename = "schedule", default)]
    #[schemars(length(max = 1000), extend("x-concerns" = "building"))]
    pub schedules: Vec<Stated<ZoneSchedule>>,
    /// The date of the first day and the holidays, for schedules by weekday; by default the first day is a Monday, or the weekday
    /// that the weather file states.
    #[schemars(extend("x-concerns" = "building"), example = json!({ "first_day": "2026-07-06" }))]
    pub calendar: Option<Stated<Calendar>>,
    /// The price of electricity by the hour; without it energy costs no money.
    #[schemars(extend("x-concerns" = "building"), example = json!({ "prices_per_kwh": [0.3] }))]
    pub tariff: Option<Stated<Tariff>>,
    /// The heat pump or chiller that supplies all zones; without it a kilowatt-hour of heat takes one of electricity.
    #[schemars(extend("x-concerns" = "building"), example = json!({ "heating": [{ "outdoor_c": 7.0, "cop": 3.5 }] }))]
    pub heat_pump: Option<Stated<HeatPump>>,
    /// The controller of the building; by default PID control in each zone.
    #[schemars(extend("x-concerns" = "building"), example = json!({ "kind": "pid" }))]
    pub controller: Option<Stated<Controller>>,
    /// How many days of the building are simulated; by default 10.
    #[schemars(range(min = 1, max = 10000), extend("x-concerns" = "building"), example = 10)]
    pub iterations: Option<usize>,
    /// The limits on the work of the run, including its counterfactuals.
    #[schemars(with = "BudgetLimits", default = "BudgetLimits::default")]
    pub budget: Option<Stated<BudgetLimits>>,
    /// The conditions under which the run passes; none by default.
    #[serde(default)]
    pub expect: Expect,
    /// Runs beside this one with a change, one `[[counterfactual]]` each. A variant does not inherit them.
    #[serde(rename = "counterfactual", default)]
    #[schemars(length(max = 64))]
    pub counterfactuals: Vec<CounterfactualConfig>,
}

impl ScenarioFile {
    /// A file with a title and a sentence on what it shows, and no other keys.
    pub fn new(title: &str, shows: &str) -> ScenarioFile {
        ScenarioFile { title: title.to_owned(), shows: shows.to_owned(), ..ScenarioFile::default() }
    }
}

pub(crate) mod defaults {
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
