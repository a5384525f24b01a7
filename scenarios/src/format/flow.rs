//! Vehicles that come one after another, as a file states them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::json;

use crate::format::vehicle_config::VehicleDefaults;
use crate::model::traffic::lane_reference::LaneReference;
use crate::text::name;

/// Vehicles that come one after another: how many an hour, where from and where to, how fast, and of which sorts. Which come when is
/// drawn from the scenario's seed before the run; each is a vehicle like any other, called after the flow: `west-1`, `west-2`, …. In a file
/// without a `[[vehicle]]` the first that comes is the ego, and is there when the run begins.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Flow")]
pub struct FlowConfig {
    /// Its name, unique among flows; its vehicles are called after it.
    #[schemars(extend("pattern" = name::pattern()), example = &"west")]
    pub name: String,
    /// How many vehicles come in an hour \[1/h\].
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 100_000.0), example = 1200.0, extend("x-excludes" = ["rates"]), extend("x-unit" = "1/h"))]
    pub vehicles_per_h: Option<f64>,
    /// How many vehicles come in an hour by time: pairs of a time \[s\] and the number from then on, in order of time. Before the first
    /// pair no vehicle comes.
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
    /// The lanes on which they come, by name or number; of several, each is as likely.
    #[schemars(length(min = 1, max = 100), example = json!(["west-1", "west-2"]))]
    pub from: Vec<LaneReference>,
    /// Where on the lane they come \[m\].
    #[serde(default)]
    #[schemars(range(min = -100_000.0, max = 100_000.0), example = 5.0)]
    pub along_m: f64,
    /// The lanes to which they drive, each with its share; by default they follow the only way there is.
    #[serde(default)]
    #[schemars(length(max = 100), example = json!([{ "lane": "east-1", "share": 0.8 }, { "lane": "exit", "share": 0.2 }]))]
    pub to: Vec<FlowGoal>,
    /// The speed with which they come and at which they aim: its mean \[m/s\],
    #[schemars(range(min = 0.01, max = 200.0), example = 27.0)]
    pub speed_mps: f64,
    /// and its standard deviation; no speed is further than two of them from the mean \[m/s\].
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 50.0), example = 2.0)]
    pub speed_sd_mps: f64,
    /// What its vehicles have in common. They leave where their routes end, unless this says otherwise.
    #[serde(default)]
    #[schemars(example = json!({ "driver": { "kind": "idm" } }))]
    pub vehicle: Option<VehicleDefaults>,
    /// The sorts of its vehicles, each with its share and what is different of it; by default there is one.
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
    /// How many of the vehicles drive there, beside the shares of the others \[dimensionless\].
    #[schemars(range(min = 0.0, max = 1_000_000.0), example = 0.2, extend("x-unit" = "dimensionless"))]
    pub share: f64,
}

/// A sort of vehicle among those of a flow.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FlowShare {
    /// How many of the vehicles are of this sort, beside the shares of the others \[dimensionless\].
    #[schemars(range(min = 0.0, max = 1_000_000.0), example = 0.2, extend("x-unit" = "dimensionless"))]
    pub share: f64,
    /// The mean of their speeds; by default that of the flow \[m/s\].
    #[serde(default)]
    #[schemars(range(min = 0.01, max = 200.0), example = 22.0)]
    pub speed_mps: Option<f64>,
    /// What is different of them.
    #[serde(default)]
    #[schemars(example = json!({ "class": "lorry" }))]
    pub vehicle: Option<VehicleDefaults>,
}

/// How the times between two vehicles are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Headways {
    /// As if each came on its own: exponentially distributed, but for the shortest.
    #[default]
    Exponential,
    /// All alike.
    Even,
}

fn shortest_headway_s() -> f64 {
    1.0
}
