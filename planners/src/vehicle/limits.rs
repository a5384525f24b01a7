//! What a vehicle can do: bounds on its input and speed.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Hard bounds on input and speed (eq. 6.9). The default is Table 6.2.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Limits {
    /// Smallest acceleration (the strongest braking), negative \[m/s²\].
    #[schemars(extend("exclusiveMaximum" = 0.0))]
    pub acceleration_min_mps2: f64,
    /// Largest acceleration \[m/s²\].
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub acceleration_max_mps2: f64,
    /// Largest steering angle to either side \[rad\].
    #[schemars(range(max = 1.5), extend("exclusiveMinimum" = 0.0))]
    pub steering_max_rad: f64,
    /// Smallest speed \[m/s\].
    #[schemars(range(min = 0.0))]
    pub speed_min_mps: f64,
    /// Largest speed \[m/s\].
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub speed_max_mps: f64,
}

impl Default for Limits {
    fn default() -> Self {
        Limits {
            acceleration_min_mps2: -1.0,
            acceleration_max_mps2: 1.0,
            steering_max_rad: std::f64::consts::FRAC_PI_3,
            speed_min_mps: 0.0,
            speed_max_mps: 1.5,
        }
    }
}
