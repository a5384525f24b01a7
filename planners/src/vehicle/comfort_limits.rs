//! Comfort limits: bounds within which a vehicle is driven unless safety requires more.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Bounds that are kept while no vehicle is in danger; what is measured of people on roads is below them in 95 of 100 cases
/// (`docs/guide/people.md`). The default is that of a real car.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ComfortLimits {
    /// Strongest braking, positive \[m/s²\].
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub braking_mps2: f64,
    /// Largest change of the acceleration per second \[m/s³\].
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub jerk_mps3: f64,
    /// Largest lateral acceleration \[m/s²\].
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub lateral_acceleration_mps2: f64,
    /// Largest change of the steering angle per second; 0.7 rad/s are 40 °/s \[rad/s\].
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub steering_rate_radps: f64,
    /// Time gap to the vehicle ahead, on top of the gap at standstill \[s\].
    #[schemars(range(min = 0.0))]
    pub time_gap_s: f64,
}

/// A vehicle stands still with this share of comfortable braking.
const LEAST_BRAKING_SHARE: f64 = 0.1;

impl ComfortLimits {
    /// Strongest braking of a driver to whom it is that urgent, positive, at a speed that it will have \[m/s²\].
    ///
    /// Brakes are released before the vehicle stands: with the jerk `j` there is time for it from a speed of `b²/2j` on.
    pub(crate) fn braking_at_mps2(&self, urgency: f64, speed_mps: f64) -> f64 {
        let jerk_mps3 = self.jerk_mps3 * urgency * urgency;
        let released_mps2 = (2.0 * jerk_mps3 * speed_mps.max(0.0)).sqrt().max(LEAST_BRAKING_SHARE * self.braking_mps2);
        released_mps2.min(self.braking_mps2 * urgency)
    }
}

impl Default for ComfortLimits {
    fn default() -> Self {
        ComfortLimits {
            braking_mps2: 3.0,
            jerk_mps3: 3.0,
            lateral_acceleration_mps2: 2.5,
            steering_rate_radps: 0.7,
            time_gap_s: 1.15,
        }
    }
}
