//! Plain iterative learning control: repeat yesterday's inputs, corrected by yesterday's errors.
//!
//! With the day as iteration k and stacked signals,
//!
//! ```text
//! U_ff,k+1 = U_k + L Ω E_k [− (D̂_k+1 − D̂_k)],      (L E)(t) = l_p e(t+1) + l_d (e(t+1) − e(t))
//! U_k      = U_ff,k + C E_k                         C a PID controller per zone
//! ```
//!
//! Ω is the identity, or combines the errors of neighbouring zones ([`LearnedErrors`]). P-type means l_d = 0. The error e(t+1) is the
//! first that u(t) influences. With a forecast, the expected change from yesterday to today is compensated; D̂ is the zone heat that has
//! the effect of the forecast, G⁻¹ T_free. While the temperature is free, nothing is learned.
//!
//! If every day were the same, the errors would follow E_k+1 = (I + GC)⁻¹(I − G L Ω) E_k. [`LearningSettings::convergence`]
//! analyses I − G L Ω: its spectral radius decides whether the errors vanish in the end, its largest singular value whether
//! they may grow before. The two differ by orders of magnitude for P-type learning.

use interplay_common::setting;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::cooperative::{Conditions, LearnedErrors, block_radius};
use super::interface::ControllerKind;
use super::pid::{Pid, PidSettings};
use super::powers::largest_singular_value;
use super::{Control, ControlError, DayAhead, DayRecord, Observation};
use crate::discretise::Model;
use crate::lifted::Lifted;

/// Iterative learning of P- or PD-type on top of a PID controller.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct LearningSettings {
    /// Heat that the next day adds per kelvin that the zone was too cold one step later, `l_p` \[kW/K\].
    #[schemars(range(min = 0.0))]
    pub proportional_kw_per_k: f64,
    /// Gain l_d of the change of the error over a step \[kW/K\]; 0 for P-type. It suits one step and capacity.
    #[schemars(range(min = 0.0))]
    pub derivative_kw_per_k: f64,
    /// Which errors a zone learns from. With those of its neighbours the same gains act more strongly: with two neighbours up to
    /// five times.
    pub errors: LearnedErrors,
    /// Whether inputs are corrected for the change of the forecast from yesterday to today.
    pub forecast: bool,
    /// The gains of the feedback C, a PID controller per zone.
    pub feedback: PidSettings,
}

impl Default for LearningSettings {
    /// PD-type l(I − aZ) with l = 0.15 kW/K and a = 0.88, which suits the testbed at half an hour; feedback 0.1 kW/K.
    fn default() -> Self {
        let feedback = PidSettings { proportional_kw_per_k: 0.1, integral_kw_per_k_h: 0.0, derivative_kw_h_per_k: 0.0 };
        Self {
            proportional_kw_per_k: 0.018,
            derivative_kw_per_k: 0.132,
            errors: LearnedErrors::Own,
            forecast: true,
            feedback,
        }
    }
}

impl LearningSettings {
    /// L v, for a stacked v.
    fn learn(&self, zones: usize, errors_k: &[f64]) -> Vec<f64> {
        let Self { proportional_kw_per_k, derivative_kw_per_k, .. } = *self;
        (0..errors_k.len())
            .map(|i| {
                let before_k = if i < zones { 0.0 } else { errors_k[i - zones] };
                proportional_kw_per_k * errors_k[i] + derivative_kw_per_k * (errors_k[i] - before_k)
            })
            .collect()
    }

    /// Lᵀ u, for a stacked u.
    fn learn_transposed(&self, zones: usize, heat_kw: &[f64]) -> Vec<f64> {
        let Self { proportional_kw_per_k, derivative_kw_per_k, .. } = *self;
        (0..heat_kw.len())
            .map(|i| {
                let after_kw = heat_kw.get(i + zones).copied().unwrap_or(0.0);
                proportional_kw_per_k * heat_kw[i] + derivative_kw_per_k * (heat_kw[i] - after_kw)
            })
            .collect()
    }

    /// How errors would change from day to day if all days were equal, all errors had a weight and there were no feedback: analyses
    /// I − G L Ω, from products with sparse matrices.
    pub fn convergence(&self, lifted: &Lifted) -> Conditions {
        let n = lifted.zones();
        // Ω is symmetric.
        let omega = |errors_k: &[f64]| self.errors.of_all(lifted, errors_k);
        let less = |x: &[f64], y: Vec<f64>| x.iter().zip(y).map(|(x, y)| x - y).collect();
        Conditions {
            // I − G L Ω is block lower triangular and Toeplitz: all its eigenvalues are those of the first block.
            spectral_radius: block_radius(lifted, |errors_k| self.learn(n, &omega(errors_k))),
            largest_singular_value: largest_singular_value(
                lifted.size(),
                |x| less(x, lifted.product(&self.learn(n, &omega(x)))),
                |y| less(y, omega(&self.learn_transposed(n, &lifted.transpose_product(y)))),
            ),
        }
    }
}

/// A controller that learns iteratively.
#[derive(Clone, Debug)]
pub struct Learning {
    settings: LearningSettings,
    lifted: Lifted,
    feedback: Pid,
    /// U_ff of the day, stacked \[kW\].
    planned_kw: Vec<f64>,
    /// U_k + L E_k; none before the first day.
    learned_kw: Option<Vec<f64>>,
    /// D̂ of the day before, stacked \[kW\].
    expected_kw: Option<Vec<f64>>,
    /// The reference temperatures of today, where they have a weight \[°C\], stacked.
    wanted: Vec<Option<f64>>,
}

impl Learning {
    /// The controller before its first day. `lifted` is its model of a day.
    ///
    /// # Errors
    /// [`ControlError::Setting`].
    pub fn new(settings: LearningSettings, lifted: Lifted) -> Result<Self, ControlError> {
        setting::check(&settings)?;
        let model = lifted.model();
        let feedback = Pid::new(settings.feedback, model.network().limits(), model.step_s())?;
        let planned_kw = vec![0.0; lifted.size()];
        let wanted = vec![None; lifted.size()];
        Ok(Self { settings, lifted, feedback, planned_kw, learned_kw: None, expected_kw: None, wanted })
    }

    /// D̂ = G⁻¹ T_free from rest at 0 °C: zone heat with the effect of the expected weather and occupancy.
    fn expected_kw(&self, day_ahead: &DayAhead<'_>) -> Vec<f64> {
        let at_rest_c = vec![0.0; self.lifted.model().network().node_count()];
        let forecast = day_ahead.forecast;
        self.lifted.solve(&self.lifted.free_response(&at_rest_c, &forecast.ambient_c, &forecast.gains_kw))
    }
}

impl ControllerKind for LearningSettings {
    fn kind(&self) -> &'static str {
        "iterative-learning"
    }

    fn look_for(&self) -> &'static str {
        "day by day the temperatures come closer to the wanted ones when people arrive, and the cost falls"
    }

    fn needs_equal_days(&self) -> Option<(&'static str, &'static str)> {
        Some(("kind", "plain learning repeats the inputs of the day before"))
    }

    fn spectral_radius(&self, lifted: &Lifted) -> Option<f64> {
        Some(self.convergence(lifted).spectral_radius)
    }

    fn controller(&self, model: &Model, steps: usize) -> Result<Box<dyn Control>, ControlError> {
        Ok(Box::new(Learning::new(*self, Lifted::new(model, steps))?))
    }
}

impl Control for Learning {
    fn start_of_day(&mut self, day_ahead: &DayAhead<'_>) -> Result<(), ControlError> {
        let targets = day_ahead.targets;
        ControlError::check_length("the day", targets.reference_c.len(), self.lifted.size())?;
        day_ahead.forecast.check(targets, self.lifted.model().network())?;
        self.wanted = (targets.reference_c.iter().zip(&targets.error_weight))
            .map(|(&reference_c, &weight)| (weight > 0.0).then_some(reference_c))
            .collect();
        if let Some(learned_kw) = &self.learned_kw {
            self.planned_kw.clone_from(learned_kw);
        }
        if self.settings.forecast {
            let today_kw = self.expected_kw(day_ahead);
            if let Some(yesterday_kw) = self.expected_kw.replace(today_kw.clone()) {
                for (i, planned_kw) in self.planned_kw.iter_mut().enumerate() {
                    *planned_kw -= today_kw[i] - yesterday_kw[i];
                }
            }
        }
        let limits = self.lifted.model().network().limits();
        for (i, planned_kw) in self.planned_kw.iter_mut().enumerate() {
            *planned_kw = limits.limited(i % limits.zones(), *planned_kw);
        }
        Ok(())
    }

    fn act(&mut self, observation: &Observation<'_>) -> Vec<f64> {
        let n = self.lifted.zones();
        let planned_kw = self.planned_kw[observation.step * n..(observation.step + 1) * n].to_vec();
        self.feedback.act_on_top(&planned_kw, observation)
    }

    fn end_of_day(&mut self, record: &DayRecord) -> Result<(), ControlError> {
        ControlError::check_length("the day's temperatures", record.temperatures_c.len(), self.lifted.size())?;
        ControlError::check_length("the day's inputs", record.heat_kw.len(), self.lifted.size())?;
        let errors_k: Vec<Option<f64>> = (self.wanted.iter().zip(&record.temperatures_c))
            .map(|(wanted_c, temperature_c)| wanted_c.map(|wanted_c| wanted_c - temperature_c))
            .collect();
        let learned_k = self.settings.errors.combine(&self.lifted, &errors_k);
        let correction_kw = self.settings.learn(self.lifted.zones(), &learned_k);
        self.learned_kw =
            Some(record.heat_kw.iter().zip(&correction_kw).map(|(u, correction)| u + correction).collect());
        Ok(())
    }

    fn fork(&self) -> Option<Box<dyn Control>> {
        Some(Box::new(self.clone()))
    }
}
