//! The conditions that a plan may violate; [`certificate`](crate::plan::certificate) checks them.

use std::fmt;

/// A condition that a plan violates, with the first stage at which it does.
#[derive(Clone, Debug, PartialEq)]
pub struct PlanViolation {
    /// The violated condition.
    pub condition: PlanCondition,
    /// The first stage at which it is violated \[steps from the present\].
    pub stage: usize,
}

/// A condition that a plan must keep.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PlanCondition {
    /// Its states are numbers and follow from its inputs.
    Dynamics,
    /// Its inputs are within the vehicle's limits.
    InputLimits,
    /// Its speeds are within the vehicle's limits.
    SpeedLimits,
    /// The body stays on the road.
    Road,
    /// The body stays clear of where this vehicle is expected to be.
    Clear(String),
}

impl fmt::Display for PlanViolation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let stage = self.stage;
        match &self.condition {
            PlanCondition::Dynamics => write!(f, "its states do not follow from its inputs from step {stage} on"),
            PlanCondition::InputLimits => write!(f, "its input at step {stage} is beyond the vehicle's limits"),
            PlanCondition::SpeedLimits => write!(f, "its speed at step {stage} is beyond the vehicle's limits"),
            PlanCondition::Road => write!(f, "it leaves the road at step {stage}"),
            PlanCondition::Clear(other) => write!(f, "it touches {other} at step {stage}"),
        }
    }
}

impl PlanViolation {
    /// Whether the plan is wrong in itself, whatever the others do.
    pub fn is_fault(&self) -> bool {
        matches!(self.condition, PlanCondition::Dynamics | PlanCondition::InputLimits | PlanCondition::SpeedLimits)
    }
}
