//! The plant that moves the vehicles.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The plant that moves the vehicles; `kind` chooses.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Plant {
    /// The bicycle model of the planners, exactly (eq. 6.1-6.4). A collision is recorded and does not change the motion.
    Kinematic(Kinematic),
    /// Rigid bodies with tyre forces and lagging actuators, which differ from the planners' model. A collision has an
    /// impulse, and the vehicles involved brake to a standstill.
    Dynamic(Dynamic),
}

/// The longest sub-step of the dynamic plant \[s\].
const MAX_SUB_STEP_S: f64 = 1e-3;

impl Plant {
    /// The number of sub-steps of the dynamic plant in a tick of `step_s`.
    pub fn sub_steps(step_s: f64) -> usize {
        (step_s / MAX_SUB_STEP_S).ceil().max(1.0) as usize
    }
}

impl Default for Plant {
    fn default() -> Self {
        Plant::Kinematic(Kinematic {})
    }
}

/// The bicycle model has no settings of its own.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Kinematic {}

/// Tyres and actuators, the same for every vehicle. The default is a 1/10 scale car.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Dynamic {
    /// Friction coefficient between tyres and road: no axle transmits more than this share of its load.
    #[schemars(extend("exclusiveMinimum" = 0.0, "maximum" = 3.0), extend("x-unit" = "dimensionless"))]
    pub friction: f64,
    /// Lateral force of the front axle per slip angle, as a share of its load \[1/rad\].
    #[schemars(extend("exclusiveMinimum" = 0.0, "maximum" = 1000.0))]
    pub front_stiffness_per_rad: f64,
    /// Lateral force of the rear axle per slip angle, as a share of its load; stiffer than the front, so that the vehicle
    /// understeers \[1/rad\].
    #[schemars(extend("exclusiveMinimum" = 0.0, "maximum" = 1000.0))]
    pub rear_stiffness_per_rad: f64,
    /// Time constant of the lag of the acceleration behind its command; 0 for none \[s\].
    #[schemars(range(min = 0.0))]
    pub acceleration_lag_s: f64,
    /// The fastest change of the acceleration \[m/s³\].
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub jerk_max_mps3: f64,
    /// Time constant of the lag of the steering angle behind its command; 0 for none \[s\].
    #[schemars(range(min = 0.0))]
    pub steering_lag_s: f64,
    /// The fastest change of the steering angle \[rad/s\].
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub steering_rate_max_radps: f64,
    /// Coefficient of restitution: the share of the closing speed at which bodies separate after a collision.
    #[schemars(range(min = 0.0, max = 1.0), extend("x-unit" = "dimensionless"))]
    pub restitution: f64,
}

impl Default for Dynamic {
    fn default() -> Self {
        Dynamic {
            friction: 0.9,
            front_stiffness_per_rad: 10.0,
            rear_stiffness_per_rad: 12.0,
            acceleration_lag_s: 0.05,
            jerk_max_mps3: 20.0,
            steering_lag_s: 0.05,
            steering_rate_max_radps: 6.0,
            restitution: 0.1,
        }
    }
}
