//! Counterfactuals: second runs with one change.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value as Json, json};

use crate::model::expectations::expect::CounterfactualExpect;

/// A second run of the scenario with a change, and its own expectations.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Counterfactual")]
pub struct CounterfactualConfig {
    /// Its claim, in a few words; unique in the file.
    #[schemars(length(min = 1), example = &"Without a proposal the ego goes second")]
    pub name: String,
    /// The driver of the ego in it, as with `--planner`: settings that this kind of driver does not know are dropped.
    #[serde(default)]
    #[schemars(example = &"conservative", extend("x-concerns" = "vehicles"))]
    pub planner: Option<String>,
    /// Its changes: paths as in `--set`, each with its new value.
    #[serde(default)]
    #[schemars(example = json!({ "vehicle.front.driver.style": "tough" }), extend("x-paths" = true))]
    pub set: Map<String, Json>,
    /// The conditions under which it passes. It has none of the scenario's own.
    #[serde(default)]
    #[schemars(example = json!({ "order_differs": true }))]
    pub expect: CounterfactualExpect,
}
