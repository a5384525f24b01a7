//! What a scenario file may say about what a driver senses.

use std::f64::consts::TAU;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What a driver senses of the other vehicles. The defaults are perfect sight: every state is seen as it is, at once.
///
/// Each measurement has independent normal errors. Behind it stands a filter that assumes a constant acceleration along the
/// road; the driver is shown its estimate, driven on to the present. The driver's own state is always known.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    /// Age of a measurement when the driver gets it \[s\], rounded to ticks. What is measured first is known at once.
    #[schemars(range(min = 0.0))]
    pub delay_s: f64,
    /// Standard deviation of a measured coordinate \[m\].
    #[schemars(range(min = 0.0))]
    pub position_sd_m: f64,
    /// Standard deviation of a measured speed \[m/s\].
    #[schemars(range(min = 0.0))]
    pub speed_sd_mps: f64,
    /// Standard deviation of a measured heading \[rad\].
    #[schemars(range(min = 0.0))]
    pub heading_sd_rad: f64,
    /// Largest distance between the centres at which another vehicle is measured; unlimited if not stated \[m\].
    #[schemars(extend("exclusiveMinimum" = 0.0), example = 5.0)]
    pub range_m: Option<f64>,
    /// Width of the sector about the driver's heading in which others are measured \[rad\]; a full circle sees behind, too.
    #[schemars(range(max = 6.283185307179587), extend("exclusiveMinimum" = 0.0))]
    pub field_of_view_rad: f64,
    /// Whether a vehicle is hidden whose centre and corners all lie behind other vehicles.
    pub occlusion: bool,
    /// Probability that a measurement is missing.
    #[schemars(range(min = 0.0, max = 1.0), extend("x-unit" = "dimensionless"))]
    pub drop_rate: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Settings {
            delay_s: 0.0,
            position_sd_m: 0.0,
            speed_sd_mps: 0.0,
            heading_sd_rad: 0.0,
            range_m: None,
            field_of_view_rad: TAU,
            occlusion: false,
            drop_rate: 0.0,
        }
    }
}

impl Settings {
    /// Whether measurements have no errors.
    pub fn is_exact(&self) -> bool {
        self.position_sd_m == 0.0 && self.speed_sd_mps == 0.0 && self.heading_sd_rad == 0.0
    }
}
