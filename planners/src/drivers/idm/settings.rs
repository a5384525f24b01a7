//! What a scenario file may say about drivers that follow the intelligent driver model.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::prediction::Prediction;

/// The intelligent driver model with MOBIL; the defaults suit 1/10 scale cars.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    /// Time gap to the vehicle ahead, `T` \[s\].
    #[schemars(range(min = 0.0))]
    pub headway_s: f64,
    /// Gap at standstill, `s₀` \[m\].
    #[schemars(range(min = 0.001))]
    pub gap_m: f64,
    /// Acceleration on a free road, `a_max` \[m/s²\].
    #[schemars(range(min = 0.001))]
    pub acceleration_mps2: f64,
    /// Comfortable braking, `b`, positive \[m/s²\].
    #[schemars(range(min = 0.001))]
    pub braking_mps2: f64,
    /// How sharply acceleration ends at the wanted speed, `δ`.
    #[schemars(range(min = 0.1), extend("x-unit" = "dimensionless"))]
    pub exponent: f64,
    /// When the driver changes lanes (MOBIL).
    pub mobil: Mobil,
    /// What the others are expected to do.
    pub prediction: Prediction,
}

impl Default for Settings {
    fn default() -> Self {
        Settings {
            headway_s: 0.8,
            gap_m: 0.2,
            acceleration_mps2: 0.5,
            braking_mps2: 0.6,
            exponent: 4.0,
            mobil: Mobil::default(),
            prediction: Prediction::ConstantVelocity,
        }
    }
}

impl Settings {
    /// The values of the literature for real cars: 1.5 s, 2 m, 1.4 and 2.0 m/s² (Treiber, Hennecke and Helbing, 2000).
    pub fn literature() -> Settings {
        Settings { headway_s: 1.5, gap_m: 2.0, acceleration_mps2: 1.4, braking_mps2: 2.0, ..Settings::default() }
    }

    /// The same for vehicles that are `ratio` times as large, by Froude's law: times grow with its root, accelerations stay.
    pub fn scaled(self, ratio: f64) -> Settings {
        Settings { headway_s: self.headway_s * ratio.sqrt(), gap_m: self.gap_m * ratio, ..self }
    }
}

/// When the driver changes lanes (MOBIL).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Mobil {
    /// Width of the lanes, which are counted from the right edge of the road; by default that of the road's lanes \[m\].
    #[schemars(range(min = 0.001), example = 0.37)]
    pub lane_width_m: Option<f64>,
    /// What others' accelerations count against the own, `p`.
    #[schemars(range(min = 0.0), extend("x-unit" = "dimensionless"))]
    pub politeness: f64,
    /// Least advantage that a change must bring \[m/s²\].
    #[schemars(range(min = 0.0))]
    pub threshold_mps2: f64,
    /// How hard the new follower, or the vehicle itself, may have to brake, `b_safe`, positive \[m/s²\].
    #[schemars(range(min = 0.0))]
    pub safe_braking_mps2: f64,
    /// The wish for the lane of the goal \[m/s²\].
    #[schemars(range(min = 0.0))]
    pub bias_mps2: f64,
}

impl Default for Mobil {
    fn default() -> Self {
        Mobil { lane_width_m: None, politeness: 0.2, threshold_mps2: 0.05, safe_braking_mps2: 0.6, bias_mps2: 1.0 }
    }
}
