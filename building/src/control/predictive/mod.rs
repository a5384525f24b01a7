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
//!
//! The controller's estimate of the building's state, and of heat that its model does not explain.
//!
//! ```text
//! T⁻(t+1) = A T(t) + B (k T₀ + u + w + d)        the step that the model expects
//! d ← d + λ h₁⁻¹ (T_measured − E T⁻)             heat of the step that it does not
//! T(t+1) = T⁻(t+1), with the zones as measured
//! ```
//!
//! The temperatures of walls are not measured after midnight and follow the model. In the steady state no innovation is left,
//! whatever constant heat the forecast misses: control without offset (Pannocchia and Rawlings, "Disturbance models for
//! offset-free model-predictive control", 2003).

use interplay_common::setting::{self, SettingError};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::interface::ControllerKind;
use super::optimum::{ConstraintTightening, plan};
use super::planning::RecedingPlan;
use super::{Control, ControlError, DayAhead, DayRecord, Design, Disturbance, Observation};
use crate::comfort::Targets;
use crate::control::BandPenalty;
use crate::discretise::Model;
use crate::lifted::Lifted;

/// Most inputs of a plan (zones times steps of the horizon): a programme of that size takes some tenths of a second, and a day
/// has one for each step.
const MOST_INPUTS: usize = 1024;

/// A model predictive controller with its estimate.
#[derive(Clone, Debug)]
pub struct Predictive {
    settings: PredictiveSettings,
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

/// Model predictive control: a new plan at every step, from what is measured and forecast.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct PredictiveSettings {
    /// How far each plan looks ahead \[h\]. Beyond midnight the targets and the forecast of today are taken once more.
    #[schemars(range(min = 0.25, max = 48.0))]
    pub horizon_h: f64,
    /// Cost of a kelvin beyond the comfort band, per step.
    #[schemars(range(min = 0.0), extend("x-unit" = "1/K"))]
    pub discomfort_linear: f64,
    /// Cost of a squared kelvin beyond the comfort band, per step.
    #[schemars(range(min = 0.0), extend("x-unit" = "1/K²"))]
    pub discomfort_quadratic: f64,
    /// λ: the share of a step's unexplained heat that is expected to go on.
    #[schemars(range(min = 0.0, max = 1.0), extend("x-unit" = "dimensionless"))]
    pub learning_rate: f64,
}

impl Default for PredictiveSettings {
    /// Half a day, and the weights of the concurrent design.
    fn default() -> Self {
        Self { horizon_h: 12.0, discomfort_linear: 50.0, discomfort_quadratic: 50.0, learning_rate: 0.3 }
    }
}

impl PredictiveSettings {
    /// Refuses settings that are out of range.
    fn check(&self) -> Result<(), SettingError> {
        setting::check(self)
    }

    /// The number of steps of `step_s` in a plan, at least one.
    pub fn horizon(&self, step_s: f64) -> usize {
        ((self.horizon_h * 3600.0 / step_s).round() as usize).max(1)
    }

    /// Cost of leaving the comfort band.
    fn penalty(&self) -> BandPenalty {
        BandPenalty { linear: self.discomfort_linear, quadratic: self.discomfort_quadratic }
    }
}

/// The state of the building as the controller believes it.
#[derive(Clone, Debug)]
struct Estimate {
    /// A single step, to tell heat from temperatures.
    one_step: Lifted,
    rate: f64,
    /// Temperatures of the nodes \[°C\], zones first; none before the first midnight.
    pub nodes_c: Vec<f64>,
    /// d: heat that the forecast misses, one number per zone \[kW\].
    pub missed_kw: Vec<f64>,
    /// Whether `nodes_c` is a prediction that a measurement can correct.
    is_predicted: bool,
}

impl Estimate {
    /// Begins without an estimate. `rate` is λ.
    pub fn new(model: &Model, rate: f64) -> Self {
        let missed_kw = vec![0.0; model.network().zone_count()];
        Self { one_step: Lifted::new(model, 1), rate, nodes_c: Vec::new(), missed_kw, is_predicted: false }
    }

    /// Begins a day with the temperatures of all nodes. They also correct the prediction that was made for them.
    pub fn begin_day(&mut self, nodes_c: &[f64]) {
        self.measure(&nodes_c[..self.missed_kw.len()]);
        self.nodes_c = nodes_c.to_vec();
    }

    /// Corrects the prediction by measured temperatures of the zones \[°C\].
    pub fn measure(&mut self, zones_c: &[f64]) {
        if !zones_c.iter().all(|temperature_c| temperature_c.is_finite()) {
            return;
        }
        if self.is_predicted {
            let unexplained_k: Vec<f64> = zones_c.iter().zip(&self.nodes_c).map(|(t, expected)| t - expected).collect();
            for (missed_kw, more_kw) in self.missed_kw.iter_mut().zip(self.one_step.solve(&unexplained_k)) {
                *missed_kw += self.rate * more_kw;
            }
            self.is_predicted = false;
        }
        for (node_c, measured_c) in self.nodes_c.iter_mut().zip(zones_c) {
            *node_c = *measured_c;
        }
    }

    /// Forecast gains of the nodes, plus the heat of the zones that the forecast misses \[kW\].
    pub fn with_missed_kw(&self, gains_kw: &[f64]) -> Vec<f64> {
        let mut gains_kw = gains_kw.to_vec();
        gains_kw.iter_mut().zip(&self.missed_kw).for_each(|(gain, missed)| *gain += missed);
        gains_kw
    }

    /// Predicts the temperatures at the end of a step with this heat, outdoor temperature and forecast gains. If a
    /// number is not finite, it predicts nothing: the temperatures stay until they are measured.
    pub fn predict(&mut self, heat_kw: &[f64], ambient_c: f64, gains_kw: &[f64]) {
        let gains_kw = self.with_missed_kw(gains_kw);
        if !ambient_c.is_finite() || !gains_kw.iter().all(|gain| gain.is_finite()) {
            return;
        }
        self.one_step.model().step(&mut self.nodes_c, heat_kw, ambient_c, &gains_kw);
        self.is_predicted = true;
    }
}
