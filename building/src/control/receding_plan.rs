//! The last plan of a controller that plans at every step, which it follows in a step without a plan.

use super::ControlError;

/// Follows the latest plan; a step for which no plan was found follows the plan before it.
#[derive(Clone, Debug, Default)]
pub(super) struct RecedingPlan {
    /// Heat of the latest plan \[kW\], stacked.
    planned_kw: Vec<f64>,
    steps_since_plan: usize,
    /// Why the current step has no plan of its own.
    pub failure: Option<ControlError>,
    /// Number of past days with such a step.
    pub days_with_failures: usize,
}

impl RecedingPlan {
    /// Adopts the outcome of planning in step `step`, and returns the heat of each zone for this step \[kW\]; zero beyond the end of
    /// the plan.
    pub fn adopt(&mut self, step: usize, zones: usize, outcome: Result<Vec<f64>, ControlError>) -> Vec<f64> {
        self.steps_since_plan += 1;
        self.failure = match outcome {
            Ok(planned_kw) => {
                (self.planned_kw, self.steps_since_plan) = (planned_kw, 0);
                None
            }
            Err(why) => Some(ControlError::StepWithoutPlan { step, why: Box::new(why) }),
        };
        let from = self.steps_since_plan * zones;
        self.planned_kw.get(from..from + zones).map_or_else(|| vec![0.0; zones], <[f64]>::to_vec)
    }
}
