//! The loop of the designs that plan each day, and their fallback when no plan is found.

use std::fmt;

use super::design::Design;
use super::disturbance_estimate::{DisturbanceEstimator, PredictionError};
use super::{Control, ControlError, DayAhead, DayOptimum, DayRecord, Observation};
use crate::network::Network;

/// Planned inputs, and the temperatures that are expected under them.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct DayPlan {
    /// Stacked \[kW\].
    pub heat_kw: Vec<f64>,
    /// Stacked \[°C\].
    pub temperatures_c: Vec<f64>,
}

impl From<&DayOptimum> for DayPlan {
    fn from(optimum: &DayOptimum) -> Self {
        Self { heat_kw: optimum.heat_kw.clone(), temperatures_c: optimum.temperatures_c.clone() }
    }
}

impl DayPlan {
    /// The planned heat û(t) of each zone.
    pub fn heat_at(&self, step: usize, zones: usize) -> &[f64] {
        &self.heat_kw[step * zones..(step + 1) * zones]
    }

    /// The deviation T̂(t) − T(t), which is e(t) − ê(t); `None` at t = 0.
    pub fn deviation_k(&self, step: usize, temperatures_c: &[f64]) -> Option<Vec<f64>> {
        let n = temperatures_c.len();
        let before = step.checked_sub(1)?;
        let planned_c = &self.temperatures_c[before * n..(before + 1) * n];
        Some(planned_c.iter().zip(temperatures_c).map(|(planned, actual)| planned - actual).collect())
    }
}

/// The plan of today and the record of yesterday.
#[derive(Clone, Debug, Default)]
pub(super) struct PlanHistory {
    plan: Option<DayPlan>,
    yesterday: Option<DayPlan>,
    design: Design,
}

impl PlanHistory {
    /// The plan of today; `None` before the first day has ended.
    pub fn plan(&self) -> Option<&DayPlan> {
        self.plan.as_ref()
    }

    /// Recorded inputs and temperatures of yesterday.
    pub fn yesterday(&self) -> Option<&DayPlan> {
        self.yesterday.as_ref()
    }

    /// The description of today's plan.
    pub fn design(&self) -> &Design {
        &self.design
    }

    /// Adopts the plan of a design; if the design failed, adopts the inputs and temperatures of yesterday (Remark 1 of chapter 3).
    pub fn start_day(&mut self, outcome: Result<(Option<DayPlan>, Design), ControlError>) {
        let fallbacks = self.design.fallbacks;
        match outcome {
            Ok((plan, design)) => {
                self.plan = plan;
                self.design = Design { fallbacks, ..design };
            }
            Err(error) => {
                self.plan.clone_from(&self.yesterday);
                self.design.exchange = None;
                self.design.objective = None;
                self.design.fallback = Some(error);
                self.design.fallbacks = fallbacks + 1;
            }
        }
        let plan = self.plan.as_ref();
        self.design.planned_kw = plan.map_or(Vec::new(), |plan| plan.heat_kw.clone());
        self.design.planned_c = plan.map_or(Vec::new(), |plan| plan.temperatures_c.clone());
    }

    /// Keeps the record of the day, unless it holds a number that is not finite.
    pub fn end_day(&mut self, record: &DayRecord) {
        if record.temperatures_c.iter().chain(&record.heat_kw).all(|value| value.is_finite()) {
            let (heat_kw, temperatures_c) = (record.heat_kw.clone(), record.temperatures_c.clone());
            self.yesterday = Some(DayPlan { heat_kw, temperatures_c });
        }
    }
}

/// Refuses series of another building or day.
fn check_shapes(day_ahead: &DayAhead<'_>, network: &Network, size: usize) -> Result<(), ControlError> {
    ControlError::check_length("the day", day_ahead.targets.reference_c.len(), size)?;
    ControlError::check_length("the temperatures at midnight", day_ahead.initial_c.len(), network.node_count())?;
    day_ahead.forecast.check(day_ahead.targets, network)
}

/// A design that plans each day from the estimated disturbance, and follows the plan with feedback.
pub(super) trait PlanningDesign: Clone + fmt::Debug + Send + Sync + 'static {
    /// The estimator of the disturbance, and the plans.
    fn parts(&mut self) -> (&mut DisturbanceEstimator, &mut PlanHistory);

    fn history(&self) -> &PlanHistory;

    /// Plans the day; returns no plan before the first day has ended.
    ///
    /// # Errors
    /// [`ControlError`] if the design fails.
    fn plan(&mut self, day_ahead: &DayAhead<'_>) -> Result<(Option<DayPlan>, Design), ControlError>;

    /// The heat of each zone \[kW\].
    fn follow(&mut self, observation: &Observation<'_>) -> Vec<f64>;

    /// Why the last step deviated from the design; `None` if it did not.
    fn trouble(&self) -> Option<&ControlError> {
        None
    }

    /// Updates the uncertainty of the disturbance with the error of a day's prediction.
    fn update_uncertainty(&mut self, _lesson: &PredictionError) {}
}

impl<L: PlanningDesign> Control for L {
    fn start_of_day(&mut self, day_ahead: &DayAhead<'_>) -> Result<(), ControlError> {
        let lifted = self.parts().0.lifted();
        check_shapes(day_ahead, lifted.model().network(), lifted.size())?;
        let outcome = self.plan(day_ahead);
        self.parts().1.start_day(outcome);
        Ok(())
    }

    fn act(&mut self, observation: &Observation<'_>) -> Vec<f64> {
        self.follow(observation)
    }

    fn end_of_day(&mut self, record: &DayRecord) -> Result<(), ControlError> {
        let (estimator, history) = self.parts();
        let prediction_error = estimator.learn(record)?;
        history.end_day(record);
        if let Some(prediction_error) = &prediction_error {
            self.update_uncertainty(prediction_error);
        }
        Ok(())
    }

    fn design(&self) -> Design {
        self.history().design().clone()
    }

    fn trouble(&self) -> Option<&ControlError> {
        PlanningDesign::trouble(self)
    }

    fn fork(&self) -> Option<Box<dyn Control>> {
        Some(Box::new(self.clone()))
    }
}

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
