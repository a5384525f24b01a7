//! What a file may say of all its vehicles at once.

use interplay_planners::rules::RuleKeeping;
use interplay_planners::{Body, Driver, Limits, SafetyEllipse};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::json;

use crate::format::stated::Stated;
use crate::model::classes::VehicleClass;
use crate::model::traffic::weights::Weights;

/// What holds for every vehicle that does not state it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct VehicleDefaults {
    /// The class of each vehicle that states none.
    #[schemars(example = &"car")]
    pub class: Option<VehicleClass>,
    /// What the goals of vehicles have in common.
    #[schemars(example = json!({ "speed_mps": 13.9 }))]
    pub goal: Option<GoalDefaults>,
    /// Weights of deviations from the goal and of changes of the inputs.
    #[schemars(example = json!({ "y": 1.0 }))]
    pub weights: Option<Stated<Weights>>,
    /// Size and axles.
    #[schemars(example = json!({ "width_m": 0.19 }))]
    pub body: Option<Stated<Body>>,
    /// The bounds of inputs and speed.
    #[schemars(example = json!({ "speed_max_mps": 1.5 }))]
    pub limits: Option<Stated<Limits>>,
    /// The ellipse around each other vehicle that a vehicle keeps out of.
    #[schemars(example = json!({ "along_m": 0.75 }))]
    pub safety: Option<Stated<SafetyEllipse>>,
    /// Whether vehicles keep the rules of the road.
    #[schemars(example = json!("kept"))]
    pub rules: Option<RuleKeeping>,
    /// Whether vehicles leave the road where their routes end.
    #[schemars(example = true)]
    pub leaves_at_end: Option<bool>,
    /// The driver. A vehicle with a driver of another `kind` takes nothing from it.
    #[schemars(example = json!({ "kind": "human", "style": "nice" }))]
    pub driver: Option<Stated<Driver>>,
}

/// What the goals of vehicles have in common.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct GoalDefaults {
    /// The speed that a vehicle aims at \[m/s\].
    #[schemars(example = 13.9)]
    pub speed_mps: Option<f64>,
}
