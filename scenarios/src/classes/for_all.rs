//! `[defaults]`: what a file says of all its vehicles at once.

use interplay_planners::{Body, Driver, Limits, SafetyEllipse};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::json;

use super::VehicleClass;
use crate::error::Fault;
use crate::merge::merge_tables;
use crate::scenario::Weights;
use crate::schema::{self, SchemaNode};
use crate::schema_check;
use crate::tree::{Table, TomlNode, TomlValue};

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
    pub weights: Option<Weights>,
    /// Size and axles.
    #[schemars(example = json!({ "width_m": 0.19 }))]
    pub body: Option<Body>,
    /// The bounds of inputs and speed.
    #[schemars(example = json!({ "speed_max_mps": 1.5 }))]
    pub limits: Option<Limits>,
    /// The ellipse around each other vehicle that a vehicle keeps out of.
    #[schemars(example = json!({ "along_m": 0.75 }))]
    pub safety: Option<SafetyEllipse>,
    /// The driver. A vehicle with a driver of another `kind` takes nothing from it.
    #[schemars(example = json!({ "kind": "human", "style": "nice" }))]
    pub driver: Option<Driver>,
}

/// What the goals of vehicles have in common.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct GoalDefaults {
    /// The speed that a vehicle aims at \[m/s\].
    #[schemars(example = 13.9)]
    pub speed_mps: Option<f64>,
}

/// The tree with `[defaults]` laid under every vehicle. The table itself stays.
///
/// # Errors
/// What is wrong with `[defaults]`, once instead of once for every vehicle.
pub(crate) fn with_defaults(mut tree: TomlNode) -> Result<TomlNode, Vec<Fault>> {
    let TomlValue::Table(root) = &mut tree.value else { return Ok(tree) };
    let Some(defaults) = root.get("defaults").map(|entry| entry.node.clone()) else { return Ok(tree) };
    let faults = schema_check::check_table(&defaults, "defaults");
    if !faults.is_empty() {
        return Err(faults);
    }
    let TomlValue::Table(defaults) = defaults.value else { return Ok(tree) };
    let schema = schema::complete().property("vehicle").and_then(SchemaNode::entries);
    let Some(TomlValue::Array(vehicles)) = root.get_mut("vehicle").map(|entry| &mut entry.node.value) else {
        return Ok(tree);
    };
    for vehicle in vehicles {
        if let TomlValue::Table(own) = &mut vehicle.value {
            let under = fitting(defaults.clone(), own);
            *own = merge_tables(schema, under, std::mem::take(own));
        }
    }
    Ok(tree)
}

/// The defaults for a vehicle: without a driver of another kind than its own.
fn fitting(mut defaults: Table, vehicle: &Table) -> Table {
    let kind = |table: &Table| Some(table.get("driver")?.node.table()?.get("kind")?.node.text()?.to_owned());
    if kind(vehicle).is_some_and(|own| kind(&defaults).is_some_and(|other| other != own)) {
        defaults.remove("driver");
    }
    defaults
}
