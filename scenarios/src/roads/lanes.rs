//! A straight road with parallel lanes.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A straight road along x with parallel lanes. The default is that of a 1/10 scale car.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Lanes {
    /// How many lanes there are.
    #[schemars(range(min = 1, max = 16))]
    pub lane_count: usize,
    /// Width of each lane \[m\].
    #[schemars(range(min = 0.001, max = 40.0))]
    pub lane_width_m: f64,
}

impl Default for Lanes {
    fn default() -> Self {
        Lanes { lane_count: 2, lane_width_m: 0.37 }
    }
}

/// Two roads that cross. The main one runs along x with its right edge at y = 0; the middles of both meet at x = 0. The
/// default is that of a 1/10 scale car.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Intersection {
    /// How many lanes each road has.
    #[schemars(range(min = 1, max = 16))]
    pub lane_count: usize,
    /// Width of each lane \[m\].
    #[schemars(range(min = 0.001, max = 40.0))]
    pub lane_width_m: f64,
    /// Direction of the crossing road, counter-clockwise from x: its vehicles come from the right of the main one, or, if
    /// it is negative, from its left. From 20 to 160 to either side \[deg\].
    pub angle_deg: f64,
}

impl Default for Intersection {
    fn default() -> Self {
        Intersection { lane_count: 1, lane_width_m: 0.37, angle_deg: 90.0 }
    }
}

/// A straight road along x of which lane 0 ends. The default is that of a 1/10 scale car.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct RampMerge {
    /// How many lanes there are before the end, the ramp included.
    #[schemars(range(min = 2, max = 16))]
    pub lane_count: usize,
    /// Width of each lane \[m\].
    #[schemars(range(min = 0.001, max = 40.0))]
    pub lane_width_m: f64,
    /// The end of lane 0, along x \[m\].
    pub ramp_end_m: f64,
    /// Length scale `w` of the taper: the edge moves by the lane's width between about `4w` before the end and the end,
    /// as `½ (1 + tanh((x − (ramp_end_m − 2w))/w))` \[m\].
    #[schemars(range(min = 0.001))]
    pub taper_m: f64,
}

impl Default for RampMerge {
    fn default() -> Self {
        RampMerge { lane_count: 2, lane_width_m: 0.37, ramp_end_m: 3.5, taper_m: 0.3 }
    }
}
