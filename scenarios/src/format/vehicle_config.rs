//! A vehicle as a file states it.

use interplay_planners::drivers::human;
use interplay_planners::perception::{belief, sensing};
use interplay_planners::rules::RuleKeeping;
use interplay_planners::{Body, Driver, Limits, SafetyEllipse};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::json;

use crate::format::start::StartConfig;
use crate::format::stated::Stated;
use crate::model::classes::VehicleClass;
use crate::model::traffic::goal::GoalConfig;
use crate::model::traffic::weights::Weights;
use crate::roads::Branch;
use crate::text::name;

/// One vehicle: start, goal, body, limits and driver.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Vehicle")]
pub struct VehicleConfig {
    /// Its name, unique in the file; it becomes part of paths in the recording.
    #[schemars(extend("pattern" = name::pattern()), example = &"ego")]
    pub name: String,
    /// What sort of vehicle it is: the default of `body`, `limits` and `safety`, and the size to which the defaults of its
    /// weights and of its driver's settings are scaled. By default a car of the scenario's `scale`, which the width of the lanes
    /// may say.
    #[schemars(example = &"car")]
    pub class: Option<VehicleClass>,
    /// The road it drives on; by default the one along x, and there is another at intersections only.
    #[serde(default)]
    pub road: Branch,
    /// Where it starts, in a lane or in world coordinates, and its speed there.
    #[schemars(example = json!({ "x_m": 0.0, "y_m": 0.185, "speed_mps": 1.0 }))]
    pub start: StartConfig,
    /// The names of the lanes on which it drives, from that of its start on, each a successor of the one before or a lane
    /// beside it. By default the shortest way to the lane of its goal, or without one the only way there is.
    #[serde(default)]
    #[schemars(length(max = 1000), example = vec!["west-in", "west-to-north", "north-out"])]
    pub route: Vec<String>,
    /// Its goal; by default to keep its lateral position and its speed.
    #[serde(default)]
    pub goal: GoalConfig,
    /// Weights of deviations from its goal and of changes of its inputs. With a `class` of real vehicles, those of angles grow by
    /// default with the speed at the start or of the goal.
    #[schemars(with = "Weights", default = "Weights::default")]
    pub weights: Option<Stated<Weights>>,
    /// Its size and axles; by default those of its class, or Table 6.1.
    #[schemars(with = "Body", default = "Body::default")]
    pub body: Option<Stated<Body>>,
    /// The bounds of its inputs and its speed; by default those of its class, or Table 6.2.
    #[schemars(with = "Limits", default = "Limits::default")]
    pub limits: Option<Stated<Limits>>,
    /// The ellipse around each other vehicle that it keeps out of; by default that of its class, or Table 6.2.
    #[schemars(with = "SafetyEllipse", default = "SafetyEllipse::default")]
    pub safety: Option<Stated<SafetyEllipse>>,
    /// Its driver, `kind` choosing; by default a nice human.
    #[schemars(with = "Driver", default = "default_driver")]
    pub driver: Option<Stated<Driver>>,
    /// Whether it keeps all rules of roads whose lanes have names, whoever drives it: speed limits, stop signs and right of way. It then
    /// drives no faster than it wants, and a human or a driver after the intelligent driver model passes what stands in its way. Without
    /// it these two keep right of way and signs, and planners settle the order themselves.
    #[schemars(example = json!("kept"))]
    pub rules: Option<RuleKeeping>,
    /// When it comes on the road; by default it is there from the start. It comes once there is room: nobody stands or drives so near
    /// before it that it would have to brake at once \[s\].
    #[schemars(range(min = 0.0), example = 12.0)]
    pub enters_s: Option<f64>,
    /// When it leaves the road; by default never \[s\].
    #[schemars(range(min = 0.0), example = 30.0)]
    pub leaves_s: Option<f64>,
    /// Whether it leaves the road where its route ends; by default it drives on straight ahead.
    #[schemars(example = true)]
    pub leaves_at_end: Option<bool>,
    /// What it senses of the others; without it, it sees every state as it is.
    #[schemars(example = json!({ "speed_sd_mps": 0.05, "delay_s": 0.3 }))]
    pub sensing: Option<Stated<sensing::Settings>>,
    /// How it learns from the others' motion what they will do, where its driver says `prediction = "inferred"`.
    #[schemars(example = json!({ "prior": "tough" }))]
    pub inference: Option<Stated<belief::Settings>>,
}

impl VehicleConfig {
    /// A vehicle that keeps its lane and its speed, of the size of the scenario, with a nice human as driver.
    pub fn new(name: &str, start: StartConfig) -> VehicleConfig {
        VehicleConfig { name: name.to_owned(), start, ..VehicleConfig::default() }
    }
}

/// Who drives a vehicle that states no driver.
pub(crate) fn default_driver() -> Driver {
    Driver::Human(human::Settings::default())
}
