//! The goal of a vehicle.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::model::traffic::lane_reference::LaneReference;

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
    /// The desired speed \[m/s\].
    #[schemars(example = 1.0)]
    pub speed_mps: Option<f64>,
}
