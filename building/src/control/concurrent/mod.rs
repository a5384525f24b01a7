//! Feedforward and feedback of any causal form, found without a projection (chapter 4).
//!
//! ```text
//! C = (I − QG)⁻¹ Q                                                  [`youla`]
//! Q: taps of least expected cost within robust bounds               [`taps`]
//! Û: least nominal cost, |Û| ≤ limit − Φ⁻¹(η) σ_u, temperatures within the band less Φ⁻¹(η) σ_T, at a cost beyond it
//! u(t) = û(t) + C (T̂ − T)(t)                                        by the state-space form (4.18), (4.19)
//! ```
//!
//! As printed, the problem (4.27) separates into the two lines: Q enters the bounds only, and X E_k is a free vector. With
//! the expected cost they are coupled through the margins only. Where comfort is not at its bound, solving them in turn is
//! optimal.

pub mod filter;
mod settings;
pub mod youla;

pub use settings::ConcurrentSettings;

use super::disturbance_estimate::{DisturbanceEstimator, PredictionError};
use super::interface::{Control, ControllerKind};
use super::iterative::rows;
use super::optimum::{ConstraintTightening, margins_kw, plan};
use super::planning::{DayPlan, PlanHistory, PlanningDesign};
use super::uncertainty::{Uncertainty, factor, normal_quantile};
use super::{ControlError, DayAhead, Design, Observation};
use crate::comfort::Targets;
use crate::discretise::Model;
use crate::lifted::Lifted;
use filter::FilterDesign;
use youla::StateSpace;

/// The controller of the concurrent design (chapter 4) with its state.
#[derive(Clone, Debug)]
pub struct Concurrent {
    settings: ConcurrentSettings,
    estimator: DisturbanceEstimator,
    uncertainty: Uncertainty,
    history: PlanHistory,
    /// The feedback for these targets, as long as Σ stays the same.
    feedback: Option<(Targets, FilterFeedback)>,
    /// The state of today's feedback.
    state: Option<StateSpace>,
    targets: Option<Targets>,
}

/// A designed feedback, and the standard deviations that remain under it.
#[derive(Clone, Debug)]
pub struct FilterFeedback {
    /// The filter Q and its cost.
    pub design: FilterDesign,
    /// Standard deviations of the inputs \[kW\], stacked.
    pub input_deviation_kw: Vec<f64>,
    /// Standard deviations of the temperatures \[K\], stacked.
    pub temperature_deviation_k: Vec<f64>,
}

impl Concurrent {
    /// A controller before its first day. `lifted` is its model of a day.
    ///
    /// # Errors
    /// [`ControlError::Setting`] if a setting is out of range; [`ControlError::TooManyUnknowns`] if the building is too large
    /// for its matrices; [`ControlError::BelowFloor`] if no feedback satisfies a stated γ₂.
    pub fn new(settings: ConcurrentSettings, lifted: Lifted) -> Result<Self, ControlError> {
        settings.check()?;
        filter::check(&settings, &lifted)?;
        Ok(Self {
            settings,
            uncertainty: Uncertainty::new(settings.uncertainty)?,
            estimator: DisturbanceEstimator::new(lifted, settings.prediction, settings.learning_rate),
            history: PlanHistory::default(),
            feedback: None,
            state: None,
            targets: None,
        })
    }

    /// The feedback for the targets, designed anew when something has changed.
    fn feedback(&mut self, targets: &Targets) -> Result<FilterFeedback, ControlError> {
        if let Some((known, feedback)) = &self.feedback
            && known == targets
        {
            return Ok(feedback.clone());
        }
        let lifted = self.estimator.lifted();
        let design = filter::design(&self.settings, lifted, targets, &self.uncertainty)?;
        let response = design.filter.response(lifted, &factor(self.uncertainty.covariance(targets))?);
        let feedback = FilterFeedback {
            design,
            input_deviation_kw: response.input_deviation_kw(),
            temperature_deviation_k: response.temperature_deviation_k(),
        };
        self.feedback = Some((targets.clone(), feedback.clone()));
        Ok(feedback)
    }
}

impl ControllerKind for ConcurrentSettings {
    fn kind(&self) -> &'static str {
        "concurrent"
    }

    fn look_for(&self) -> &'static str {
        "after one day temperatures stay within the comfort band although the forecast is wrong: the feedback is designed for \
         the uncertainty of the forecast"
    }

    fn needs_equal_days(&self) -> Option<(&'static str, &'static str)> {
        self.prediction.needs_equal_days()
    }

    fn plans(&self) -> bool {
        true
    }

    fn controller(&self, model: &Model, steps: usize) -> Result<Box<dyn Control>, ControlError> {
        Ok(Box::new(Concurrent::new(*self, Lifted::new(model, steps))?))
    }

    fn operations_per_day(&self, zones: f64, steps: f64) -> f64 {
        let unknowns = self.taps as f64 * zones * zones;
        20.0 * unknowns.powi(3) + zones * steps * unknowns
    }
}

impl PlanningDesign for Concurrent {
    fn parts(&mut self) -> (&mut DisturbanceEstimator, &mut PlanHistory) {
        (&mut self.estimator, &mut self.history)
    }

    fn history(&self) -> &PlanHistory {
        &self.history
    }

    fn plan(&mut self, day_ahead: &DayAhead<'_>) -> Result<(Option<DayPlan>, Design), ControlError> {
        self.targets = Some(day_ahead.targets.clone());
        // After a failed design, the controller follows yesterday's plan with the last feedback, which starts from rest.
        let last = self.feedback.as_ref().map(|(_, feedback)| feedback.design.filter.clone());
        self.state = last.map(|filter| StateSpace::new(filter, self.estimator.lifted().model()));
        let free_c = self.estimator.expect(day_ahead)?;
        if self.estimator.is_empty() {
            return Ok((None, Design::default()));
        }
        let targets = day_ahead.targets;
        let feedback = self.feedback(targets)?;
        let quantile = normal_quantile(self.settings.confidence);
        let lifted = self.estimator.lifted();
        let tightening = ConstraintTightening {
            input_margin_kw: margins_kw(&feedback.input_deviation_kw, quantile),
            band_margin_k: feedback.temperature_deviation_k.iter().map(|deviation_k| quantile * deviation_k).collect(),
            error_bound: None,
        };
        let optimum = plan(lifted, &free_c, targets, Some(self.settings.penalty()), &tightening)?;
        let design = Design {
            objective: Some(optimum.objective),
            bias_kw: self.estimator.bias_kw().to_vec(),
            taps_kw_per_k: feedback.design.filter.0.iter().map(rows).collect(),
            ..Design::default()
        };
        self.state = Some(StateSpace::new(feedback.design.filter, lifted.model()));
        Ok((Some(DayPlan::from(&optimum)), design))
    }

    fn follow(&mut self, observation: &Observation<'_>) -> Vec<f64> {
        let Observation { step, temperatures_c, .. } = *observation;
        let n = temperatures_c.len();
        let limits = self.estimator.lifted().model().network().limits();
        let limited = |heat_kw: Vec<f64>| -> Vec<f64> { limits.limited_all(&heat_kw) };
        let Some(plan) = self.history.plan() else {
            // On the first day, only the initial feedback acts.
            let gain_kw_per_k = self.settings.initial_gain_kw_per_k;
            return limited(observation.weighted_errors_k().iter().map(|error_k| gain_kw_per_k * error_k).collect());
        };
        let planned_kw = plan.heat_at(step, n);
        let Some(state) = &mut self.state else { return limited(planned_kw.to_vec()) };
        let correction_kw = state.answer(&plan.deviation_k(step, temperatures_c).unwrap_or_else(|| vec![0.0; n]));
        let heat_kw = limited(planned_kw.iter().zip(&correction_kw).map(|(plan, more)| plan + more).collect());
        let applied_kw: Vec<f64> = heat_kw.iter().zip(planned_kw).map(|(all, plan)| all - plan).collect();
        state.advance(&applied_kw);
        heat_kw
    }

    fn update_uncertainty(&mut self, prediction_error: &PredictionError) {
        if let Some(targets) = &self.targets
            && self.uncertainty.learn(&prediction_error.error_kw, targets)
        {
            self.feedback = None;
        }
    }
}
