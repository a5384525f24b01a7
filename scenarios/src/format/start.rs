//! The start of a vehicle: in a lane, or in world coordinates.

use interplay_planners::State;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::model::traffic::lane_reference::LaneReference;

/// The start of a vehicle, in a lane (`lane`, `along_m`) or in world coordinates (`x_m`, `y_m`), and its speed there.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StartConfig {
    /// Position of the mass centre along the world's x axis \[m\].
    #[schemars(range(min = -100_000_000.0, max = 100_000_000.0), example = 0.0)]
    pub x_m: Option<f64>,
    /// Position of the mass centre along the world's y axis \[m\].
    #[schemars(range(min = -100_000_000.0, max = 100_000_000.0), example = 0.185)]
    pub y_m: Option<f64>,
    /// Yaw angle, counter-clockwise from the x axis; 0 if neither this nor `heading_deg` is stated \[rad\].
    #[schemars(example = 0.0)]
    pub heading_rad: Option<f64>,
    /// Yaw angle, counter-clockwise from the x axis \[deg\].
    #[schemars(example = 0.0, extend("x-excludes" = ["heading_rad"]))]
    pub heading_deg: Option<f64>,
    /// The lane in whose centre it starts, along the lane: its number from the right, 0 being the rightmost, or its name on a
    /// road whose lanes have names.
    #[schemars(example = 1, extend("x-excludes" = ["x_m", "y_m", "heading_rad", "heading_deg"]))]
    pub lane: Option<LaneReference>,
    /// Position along the vehicle's road: x of the world on a road along x, otherwise the distance along the road, or along a
    /// lane with a name \[m\].
    #[schemars(
        range(min = -100_000.0, max = 100_000.0),
        example = 0.0,
        extend("x-excludes" = ["x_m", "y_m", "heading_rad", "heading_deg"])
    )]
    pub along_m: Option<f64>,
    /// Distance from the centre of `lane`, positive to the left; 0 if not stated \[m\].
    #[schemars(example = 0.0, extend("x-excludes" = ["x_m", "y_m", "heading_rad", "heading_deg"]))]
    pub lateral_offset_m: Option<f64>,
    /// Yaw angle less the direction of the road at `along_m`, counter-clockwise; 0 if not stated \[deg\].
    #[schemars(
        range(min = -60.0, max = 60.0),
        example = 0.0,
        extend("x-excludes" = ["x_m", "y_m", "heading_rad", "heading_deg"])
    )]
    pub heading_error_deg: Option<f64>,
    /// Speed of the mass centre \[m/s\].
    #[schemars(example = 1.0)]
    pub speed_mps: f64,
    /// Acceleration just before the start: comfort bounds how fast it may change; 0 if not stated \[m/s²\].
    #[schemars(range(min = -20.0, max = 20.0), example = -0.5)]
    pub acceleration_mps2: Option<f64>,
}

impl StartConfig {
    /// In the centre of a lane, along it \[m\], at a speed \[m/s\].
    pub fn in_lane(lane: impl Into<LaneReference>, along_m: f64, speed_mps: f64) -> StartConfig {
        StartConfig { lane: Some(lane.into()), along_m: Some(along_m), speed_mps, ..StartConfig::default() }
    }
}

/// In world coordinates.
impl From<State> for StartConfig {
    fn from(state: State) -> StartConfig {
        StartConfig {
            x_m: Some(state.x_m),
            y_m: Some(state.y_m),
            heading_rad: Some(state.heading_rad),
            speed_mps: state.speed_mps,
            ..StartConfig::default()
        }
    }
}
