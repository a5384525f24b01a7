//! Feedforward and feedback designed in turn (chapter 3).
//!
//! ```text
//! U = U_ff + C E        minimise  E[ Eᵀ W_e E + Uᵀ W_u U ],   D ~ N(D̂ + bias, Σ)
//! 1. the causal feedback of least expected cost                     [`feedback`]
//! 2. the stabilising gain K that is closest to it                   [`projection`]
//! 3. the nominal inputs Û, |Û| ≤ limit − Φ⁻¹(η) σ_u                 (eqs. 3.21, 3.29)
//! u(t) = û(t) + K (T̂(t) − T(t))
//! ```
//!
//! The dissertation's unknowns X and Y are (nN)² each, but the nominal cost depends on X E_k + Y z alone, which is nN numbers:
//! the nominal inputs. They are found as a sparse problem with temperatures as variables. The last line is U_ff = Û − K Ê.
//!
//! Where limits bind, feedback and plan compete for them. [`joint`] designs both together, by designing each several
//! times in turn. Designing each only once costs a few percent more there.
//!
//! The feedback is redesigned when Σ or the targets change; with a constant Σ it is a constant gain.

pub mod decay;
pub mod feedback;
pub mod guard;
pub mod joint;
pub mod projection;
mod settings;
mod static_feedback;

use nalgebra::DMatrix;

pub use settings::{Chance, Coordination, ErrorGrowth, IterativeSettings, Objective, Stability};
pub use static_feedback::StaticFeedback;

use super::disturbance_estimate::{DisturbanceEstimator, PredictionError};
use super::interface::{Control, ControllerKind};
use super::optimum::{ConstraintTightening, ErrorBound, margins_kw, plan};
use super::planning::{DayPlan, PlanHistory, PlanningDesign};
use super::uncertainty::{Uncertainty, factor, normal_quantile};
use super::{ControlError, DayAhead, Design, Observation};
use crate::comfort::Targets;
use crate::discretise::Model;
use crate::lifted::Lifted;
use guard::AlternationGuard;
use joint::Joint;

/// Cost of a kelvin by which errors grow from day to day (eq. 3.8), where growth is soft. Chosen large beside the weights of
/// temperatures and heat, so that errors grow only where they must.
const ERROR_GROWTH_COST_PER_K: f64 = 1e3;

/// The controller of the iterative design (chapter 3) with its state.
#[derive(Clone, Debug)]
pub struct Iterative {
    settings: IterativeSettings,
    estimator: DisturbanceEstimator,
    uncertainty: Uncertainty,
    history: PlanHistory,
    gain: DMatrix<f64>,
    /// The feedback for these targets, as long as Σ stays the same.
    feedback: Option<(Targets, StaticFeedback)>,
    /// The targets of the day in progress.
    targets: Option<Targets>,
    guard: AlternationGuard,
    /// Why the gain was weakened in the last step; `None` if it was not.
    trouble: Option<ControlError>,
}

impl Iterative {
    /// A controller before its first day. `lifted` is its model of a day.
    ///
    /// # Errors
    /// [`ControlError::Setting`] if a setting is out of range; [`ControlError::TooManyUnknowns`] or
    /// [`ControlError::TooManyTemperatures`] if the building is too large for its matrices;
    /// [`ControlError::DecayBelowFloor`] if no feedback has the stated decay rate.
    pub fn new(settings: IterativeSettings, lifted: Lifted) -> Result<Self, ControlError> {
        settings.check()?;
        if settings.objective == Objective::Expected {
            settings.check_size(&lifted)?;
            decay::chosen(&settings, lifted.model())?;
        }
        let n = lifted.zones();
        let limits = lifted.model().network().limits();
        let powers_kw = limits.heating_kw.iter().zip(&limits.cooling_kw).map(|(heating, cooling)| heating + cooling);
        Ok(Self {
            settings,
            // A gain without a certificate is applied as it is.
            guard: match settings.stability {
                Stability::Lmi | Stability::Linear => AlternationGuard::new(powers_kw),
                Stability::LeastSquares | Stability::Fixed => AlternationGuard::new(powers_kw.map(|_| f64::INFINITY)),
            },
            trouble: None,
            uncertainty: Uncertainty::new(settings.uncertainty)?,
            estimator: DisturbanceEstimator::new(lifted, settings.prediction, settings.learning_rate),
            history: PlanHistory::default(),
            gain: DMatrix::from_diagonal_element(n, n, settings.initial_gain_kw_per_k),
            feedback: None,
            targets: None,
        })
    }

    /// The feedback for the targets, designed anew when something has changed; with the joint design, every day.
    fn feedback(&mut self, targets: &Targets, free_c: &[f64]) -> Result<StaticFeedback, ControlError> {
        let price = match self.settings.coordination {
            Coordination::TwoStage => Vec::new(),
            Coordination::Joint => {
                self.feedback = None;
                self.joint(targets, free_c)?.price
            }
        };
        if let Some((known, feedback)) = &self.feedback
            && known == targets
        {
            return Ok(feedback.clone());
        }
        let covariance = self.uncertainty.covariance(targets);
        let feedback = StaticFeedback::design(&self.settings, self.estimator.lifted(), targets, covariance, &price)?;
        self.feedback = Some((targets.clone(), feedback.clone()));
        Ok(feedback)
    }

    /// Feedback and plan together, as if the optimal causal feedback were used.
    fn joint(&self, targets: &Targets, free_c: &[f64]) -> Result<Joint, ControlError> {
        let lifted = self.estimator.lifted();
        let factor = factor(self.uncertainty.covariance(targets))?;
        joint::design(lifted, targets, free_c, &factor, self.quantile())
    }

    /// Φ⁻¹(η) of eq. 3.21.
    fn quantile(&self) -> f64 {
        let count = self.estimator.lifted().size() as f64;
        normal_quantile(match self.settings.chance {
            Chance::EachInput => self.settings.confidence,
            Chance::WholeDay => 1.0 - (1.0 - self.settings.confidence) / count,
        })
    }

    /// Φ⁻¹(η) σ_u (eq. 3.21).
    fn margins_kw(&self, feedback: &StaticFeedback) -> Vec<f64> {
        margins_kw(&feedback.input_deviation_kw, self.quantile())
    }

    /// ‖E_k+1‖ ≤ ‖E_k‖ over the errors that have a weight (eq. 3.8).
    fn error_bound(&self, targets: &Targets) -> Option<ErrorBound> {
        let slack_cost = match self.settings.convergence {
            ErrorGrowth::Off => return None,
            ErrorGrowth::Soft => Some(ERROR_GROWTH_COST_PER_K),
            ErrorGrowth::Hard => None,
        };
        let yesterday_c = &self.history.yesterday()?.temperatures_c;
        let squares = (0..yesterday_c.len()).filter(|&i| targets.error_weight[i] > 0.0).map(|i| {
            let error_k = targets.reference_c[i] - yesterday_c[i];
            error_k * error_k
        });
        Some(ErrorBound { norm_k: squares.sum::<f64>().sqrt(), slack_cost })
    }

    fn describe(&self, feedback: Option<&StaticFeedback>, objective: Option<f64>) -> Design {
        Design {
            objective,
            bias_kw: self.estimator.bias_kw().to_vec(),
            gain_kw_per_k: rows(&self.gain),
            spectral_radius: feedback.map(|feedback| feedback.spectral_radius),
            weaker_feedback: (self.guard.weakest())
                .map(|share| ControlError::AlternatingInputs { share })
                .or_else(|| feedback.and_then(|feedback| feedback.weaker.clone())),
            ..Design::default()
        }
    }
}

pub(super) fn rows(matrix: &DMatrix<f64>) -> Vec<Vec<f64>> {
    matrix.row_iter().map(|row| row.iter().copied().collect()).collect()
}

impl ControllerKind for IterativeSettings {
    fn kind(&self) -> &'static str {
        "iterative"
    }

    fn look_for(&self) -> &'static str {
        "after one day temperatures follow their plan; the feedback acts on forecast errors only, and its gain is designed \
         again as their size becomes known"
    }

    fn needs_equal_days(&self) -> Option<(&'static str, &'static str)> {
        self.prediction.needs_equal_days()
    }

    fn plans(&self) -> bool {
        true
    }

    fn controller(&self, model: &Model, steps: usize) -> Result<Box<dyn Control>, ControlError> {
        Ok(Box::new(Iterative::new(*self, Lifted::new(model, steps))?))
    }

    fn operations_per_day(&self, zones: f64, steps: f64) -> f64 {
        10.0 * (zones * steps).powi(3)
    }
}

impl PlanningDesign for Iterative {
    fn parts(&mut self) -> (&mut DisturbanceEstimator, &mut PlanHistory) {
        (&mut self.estimator, &mut self.history)
    }

    fn history(&self) -> &PlanHistory {
        &self.history
    }

    fn plan(&mut self, day_ahead: &DayAhead<'_>) -> Result<(Option<DayPlan>, Design), ControlError> {
        self.targets = Some(day_ahead.targets.clone());
        let free_c = self.estimator.expect(day_ahead)?;
        if self.estimator.is_empty() {
            return Ok((None, self.describe(None, None)));
        }
        let targets = day_ahead.targets;
        let feedback = match self.settings.objective {
            Objective::Expected => Some(self.feedback(targets, &free_c)?),
            Objective::Nominal => None,
        };
        let tightening = ConstraintTightening {
            input_margin_kw: feedback.as_ref().map_or(Vec::new(), |feedback| self.margins_kw(feedback)),
            band_margin_k: Vec::new(),
            error_bound: self.error_bound(targets),
        };
        let optimum = plan(self.estimator.lifted(), &free_c, targets, None, &tightening)?;
        let n = targets.zones;
        self.gain = feedback.as_ref().map_or(DMatrix::zeros(n, n), |feedback| feedback.gain_kw_per_k.clone());
        Ok((Some(DayPlan::from(&optimum)), self.describe(feedback.as_ref(), Some(optimum.objective))))
    }

    fn follow(&mut self, observation: &Observation<'_>) -> Vec<f64> {
        let Observation { step, temperatures_c, .. } = *observation;
        let n = temperatures_c.len();
        let (mut heat_kw, error_k) = match self.history.plan() {
            Some(plan) => (plan.heat_at(step, n).to_vec(), plan.deviation_k(step, temperatures_c)),
            // On the first day, only the initial feedback acts, on the error itself.
            None => (vec![0.0; n], Some(observation.weighted_errors_k())),
        };
        let planned_kw = heat_kw.clone();
        for (j, error_k) in error_k.iter().flatten().enumerate() {
            for (i, (heat_kw, gain)) in heat_kw.iter_mut().zip(&self.gain.column(j)).enumerate() {
                *heat_kw += self.guard.share(i) * gain * error_k;
            }
        }
        let heat_kw = self.estimator.lifted().model().network().limits().limited_all(&heat_kw);
        let feedback_kw: Vec<f64> =
            heat_kw.iter().zip(planned_kw).map(|(heat_kw, planned)| heat_kw - planned).collect();
        let halved = self.guard.observe(&feedback_kw).map(|zone| self.guard.share(zone));
        self.trouble = halved.map(|share| ControlError::AlternatingInputs { share });
        heat_kw
    }

    fn trouble(&self) -> Option<&ControlError> {
        self.trouble.as_ref()
    }

    fn update_uncertainty(&mut self, prediction_error: &PredictionError) {
        if let Some(targets) = &self.targets
            && self.uncertainty.learn(&prediction_error.error_kw, targets)
        {
            self.feedback = None;
        }
    }
}
