//! Counterfactuals: what would have happened had one thing been different.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value as Json, json};

use crate::model::expectations::expect::CounterfactualExpect;

/// A second run of the scenario in which something is changed, and what is then expected.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Counterfactual")]
pub struct CounterfactualConfig {
    /// What it claims, in a few words; unique in the file.
    #[schemars(length(min = 1), example = &"Without a proposal the ego goes second")]
    pub name: String,
    /// Who drives the ego instead, as `--planner` has it: settings that this kind of driver does not know are dropped.
    #[serde(default)]
    #[schemars(example = &"conservative", extend("x-concerns" = "vehicles"))]
    pub planner: Option<String>,
    /// What is changed: paths as `--set` has them, each with its new value.
    #[serde(default)]
    #[schemars(example = json!({ "vehicle.front.driver.style": "tough" }), extend("x-paths" = true))]
    pub set: Map<String, Json>,
    /// The conditions under which it passes. It has none of the scenario's own.
    #[serde(default)]
    #[schemars(example = json!({ "order_differs": true }))]
    pub expect: CounterfactualExpect,
}
