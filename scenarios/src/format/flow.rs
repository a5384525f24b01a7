//! Vehicles that come one after another, as a file states them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::json;

use crate::format::vehicle_config::VehicleDefaults;
use crate::model::traffic::lane_reference::LaneReference;
use crate::text::name;

/// Vehicles that come one after another: how many an hour, from which lanes to which, how fast, and of which sorts. Their times are
/// drawn from the scenario's seed before the run; each is a vehicle like any other, named after the flow: `west-1`, `west-2`, …. In a file
/// without a `[[vehicle]]`, the first that comes is the ego, and it is on the road when the run begins.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Flow")]
pub struct FlowConfig {
    /// Its name, unique among flows; its vehicles are named after it.
    #[schemars(extend("pattern" = name::pattern()), example = &"west")]
    pub name: String,
    /// How many vehicles come in an hour, on all its lanes together \[1/h\].
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 100_000.0), example = 1200.0, extend("x-excludes" = ["rates"]), extend("x-unit" = "1/h"))]
    pub vehicles_per_h: Option<f64>,
    /// How many vehicles come in an hour by time, on all its lanes together: pairs of a time \[s\] and the number from then on, in
    /// order of time. Before the first pair no vehicle comes.
    #[serde(default)]
    #[schemars(length(max = 1000), example = json!([[0.0, 600.0], [300.0, 1500.0]]))]
    pub rates: Vec<[f64; 2]>,
    /// The times between two vehicles.
    #[serde(default)]
    pub headways: Headways,
    /// The shortest time between two vehicles of the flow \[s\].
    #[serde(default = "shortest_headway_s")]
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub headway_min_s: f64,
    /// When the first may come; by default when the run begins \[s\].
    #[serde(default)]
    #[schemars(range(min = 0.0), example = 10.0)]
    pub begins_s: f64,
    /// When the last may come; by default when the run ends \[s\].
    #[serde(default)]
    #[schemars(range(min = 0.0), example = 600.0)]
    pub ends_s: Option<f64>,
    /// The lanes on which they come, by name or number; of several, all are equally likely.
    #[schemars(length(min = 1, max = 100), example = json!(["west-1", "west-2"]))]
    pub from: Vec<LaneReference>,
    /// Their first position along the lane \[m\].
    #[serde(default)]
    #[schemars(range(min = -100_000.0, max = 100_000.0), example = 5.0)]
    pub along_m: f64,
    /// The lanes to which they drive, each with its share; by default they follow the only route.
    #[serde(default)]
    #[schemars(length(max = 100), example = json!([{ "lane": "east-1", "share": 0.8 }, { "lane": "exit", "share": 0.2 }]))]
    pub to: Vec<FlowGoal>,
    /// The mean of the speed with which they come, which is also their desired speed \[m/s\],
    #[schemars(range(min = 0.01, max = 200.0), example = 27.0)]
    pub speed_mps: f64,
    /// and its standard deviation; speeds deviate from the mean by at most two of them \[m/s\].
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 50.0), example = 2.0)]
    pub speed_sd_mps: f64,
    /// The common keys of its vehicles. They leave where their routes end, unless this states otherwise.
    #[serde(default)]
    #[schemars(example = json!({ "driver": { "kind": "idm" } }))]
    pub vehicle: Option<VehicleDefaults>,
    /// The sorts of its vehicles, each with its share and its own keys; by default there is one sort.
    #[serde(default)]
    #[schemars(length(max = 100))]
    pub mix: Vec<FlowShare>,
}

/// A lane to which vehicles of a flow drive.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FlowGoal {
    /// The lane, by name or number.
    #[schemars(example = &"exit")]
    pub lane: LaneReference,
    /// The share of the vehicles that drive there, relative to the other shares \[dimensionless\].
    #[schemars(range(min = 0.0, max = 1_000_000.0), example = 0.2, extend("x-unit" = "dimensionless"))]
    pub share: f64,
}

/// A sort of vehicle among those of a flow.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FlowShare {
    /// The share of the vehicles of this sort, relative to the other shares \[dimensionless\].
    #[schemars(range(min = 0.0, max = 1_000_000.0), example = 0.2, extend("x-unit" = "dimensionless"))]
    pub share: f64,
    /// The mean of their speeds; by default that of the flow \[m/s\].
    #[serde(default)]
    #[schemars(range(min = 0.01, max = 200.0), example = 22.0)]
    pub speed_mps: Option<f64>,
    /// The keys that differ from those of the flow.
    #[serde(default)]
    #[schemars(example = json!({ "class": "lorry" }))]
    pub vehicle: Option<VehicleDefaults>,
}

/// How the times between two vehicles are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Headways {
    /// Exponentially distributed, as for independent vehicles, except for the shortest time.
    #[default]
    Exponential,
    /// All equal.
    Even,
}

fn shortest_headway_s() -> f64 {
    1.0
}
