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
