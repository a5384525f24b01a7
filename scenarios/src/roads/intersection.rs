//! Two straight roads that cross.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

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
