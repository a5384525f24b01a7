//! Model predictive control: at every step the cheapest inputs over a horizon, of which the first is applied.
//!
//! ```text
//! minimise    Σ W_e (r − T)² + W_u u² + c₁ s + c₂ s²          over the next N_h steps, as in [`super::optimum()`]
//! from        T(t) as estimated, under the forecast and the heat d that it missed so far
//! ```
//!
//! It is the usual controller in the literature, and the baseline of the designs that plan once a day. It needs the same model and
//! forecast, but solves a programme at every step. It corrects errors within a step, but learns only `d` from one day to the next.
//!
//! In a step without a plan (because a number is not finite, or the solver has no result), the controller follows its
//! last plan and reports this.

mod estimate;
mod settings;

pub use settings::PredictiveSettings;

use super::interface::ControllerKind;
use super::optimum::{ConstraintTightening, plan};
use super::receding_plan::RecedingPlan;
use super::{Control, ControlError, DayAhead, DayRecord, Design, Disturbance, Observation};
use crate::comfort::Targets;
use crate::discretise::Model;
use crate::lifted::Lifted;
use estimate::Estimate;

/// Most inputs of a plan (zones times steps of the horizon): a programme of that size takes some tenths of a second, and a day
/// has one for each step.
const MOST_INPUTS: usize = 1024;

/// A model predictive controller with its estimate.
#[derive(Clone, Debug)]
pub struct Predictive {
    settings: PredictiveSettings,
    /// The model over the horizon.
    lifted: Lifted,
    estimate: Estimate,
    forecast: Disturbance,
    plan: RecedingPlan,
}

impl Predictive {
    /// A controller before its first day.
    ///
    /// # Errors
    /// [`ControlError::Setting`], and [`ControlError::TooManyUnknowns`] if a plan has more than `MOST_INPUTS` inputs.
    pub fn new(settings: PredictiveSettings, model: &Model) -> Result<Self, ControlError> {
        settings.check()?;
        let lifted = Lifted::new(model, settings.horizon(model.step_s()));
        if lifted.size() > MOST_INPUTS {
            let (design, found, most) = ("model-predictive", lifted.size(), MOST_INPUTS);
            return Err(ControlError::TooManyUnknowns { design, found, most });
        }
        Ok(Self {
            settings,
            estimate: Estimate::new(model, settings.learning_rate),
            lifted,
            forecast: Disturbance { ambient_c: Vec::new(), gains_kw: Vec::new() },
            plan: RecedingPlan::default(),
        })
    }

    /// The cheapest inputs from step `step` of the day on \[kW\], stacked.
    fn plan(&self, step: usize, targets: &Targets) -> Result<Vec<f64>, ControlError> {
        let expected = self.expected(step, targets.steps());
        ControlError::check_finite("the temperatures", &self.estimate.nodes_c)?;
        expected.check_finite()?;
        let free_c = self.lifted.free_response(&self.estimate.nodes_c, &expected.ambient_c, &expected.gains_kw);
        let ahead = targets.ahead(step, self.lifted.steps());
        let penalty = Some(self.settings.penalty());
        Ok(plan(&self.lifted, &free_c, &ahead, penalty, &ConstraintTightening::default())?.heat_kw)
    }

    /// What is expected over the horizon: the forecast and the heat that it missed so far; beyond midnight, today's once more.
    fn expected(&self, step: usize, steps: usize) -> Disturbance {
        let hours = (step..step + self.lifted.steps()).map(|t| t % steps);
        let ambient_c = hours.clone().map(|t| self.forecast.ambient_c[t]).collect();
        let gains_kw = hours.flat_map(|t| self.estimate.with_missed_kw(self.gains_kw(t))).collect();
        Disturbance { ambient_c, gains_kw }
    }

    /// Forecast gains of the nodes in step `t` of the day \[kW\].
    fn gains_kw(&self, t: usize) -> &[f64] {
        let count = self.lifted.model().network().gain_count();
        &self.forecast.gains_kw[t * count..(t + 1) * count]
    }
}

impl ControllerKind for PredictiveSettings {
    fn kind(&self) -> &'static str {
        "model-predictive"
    }

    fn look_for(&self) -> &'static str {
        "it heats or cools before people come, and what the forecast missed is corrected within hours"
    }

    fn controller(&self, model: &Model, _steps: usize) -> Result<Box<dyn Control>, ControlError> {
        Ok(Box::new(Predictive::new(*self, model)?))
    }

    fn operations_per_day(&self, zones: f64, steps: f64) -> f64 {
        // A plan of 1024 inputs takes some tenths of a second, a small one more than a millisecond; every step needs a plan.
        let horizon = self.horizon(86_400.0 / steps) as f64;
        steps * (0.15 * (zones * horizon).powi(3) + 1.5e6)
    }
}

impl Control for Predictive {
    fn start_of_day(&mut self, day_ahead: &DayAhead<'_>) -> Result<(), ControlError> {
        let model = self.lifted.model();
        ControlError::check_length("a row of targets", day_ahead.targets.zones, self.lifted.zones())?;
        let nodes = model.network().node_count();
        ControlError::check_length("the temperatures at midnight", day_ahead.initial_c.len(), nodes)?;
        day_ahead.forecast.check(day_ahead.targets, model.network())?;
        self.estimate.begin_day(day_ahead.initial_c);
        self.forecast = day_ahead.forecast.clone();
        Ok(())
    }

    fn act(&mut self, observation: &Observation<'_>) -> Vec<f64> {
        let step = observation.step;
        if step > 0 {
            self.estimate.measure(observation.temperatures_c);
        }
        let outcome = self.plan(step, observation.targets);
        let heat_kw = self.plan.adopt(step, self.lifted.zones(), outcome);
        let (ambient_c, gains_kw) = (self.forecast.ambient_c[step], self.gains_kw(step).to_vec());
        self.estimate.predict(&heat_kw, ambient_c, &gains_kw);
        heat_kw
    }

    fn end_of_day(&mut self, record: &DayRecord) -> Result<(), ControlError> {
        self.plan.days_with_failures = record.design.fallbacks;
        Ok(())
    }

    fn design(&self) -> Design {
        Design { fallbacks: self.plan.days_with_failures, ..Design::default() }
    }

    fn trouble(&self) -> Option<&ControlError> {
        self.plan.failure.as_ref()
    }

    fn fork(&self) -> Option<Box<dyn Control>> {
        Some(Box::new(self.clone()))
    }
}
