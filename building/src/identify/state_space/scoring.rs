//! Maximum likelihood within bounds, by the method of scoring with Levenberg and Marquardt's damping.
//!
//! ```text
//! (I + λ diag I) Δθ = ∂ℓ/∂θ        over the parameters that no bound holds
//! ```
//!
//! with the Fisher information I in place of the Hessian (Harvey, *Forecasting, Structural Time Series Models and the Kalman
//! Filter*, 1989, section 3.4). A parameter at a bound is held there while the gradient points outwards.
//!
//! Standard errors that hold where the innovations are not white: the sandwich I⁻¹ J I⁻¹, with the long-run variance J of the rows'
//! scores in place of the information (Newey and West, *Econometrica* 55, 1987).
//!
//! ```text
//! Var f = dᵀ J d,   d = I⁻¹ ∇f;       aₜ = d · ∂ℓₜ,   dᵀ J d = Σ aₜ² + 2 Σ_l (1 − l/(L+1)) Σ aₜ aₜ₋ₗ
//! ```

use nalgebra::{DMatrix, DVector};

use super::likelihood::{Evaluation, Observations, Parametrisation, evaluate, log_likelihood};

/// The largest change of a parameter in one step; all are logarithms or a few kelvin.
const LARGEST_STEP: f64 = 2.0;
const FIRST_DAMPING: f64 = 1e-2;
const LEAST_DAMPING: f64 = 1e-9;
/// With more damping than this, no step improves the likelihood any more.
const MOST_DAMPING: f64 = 1e8;
/// A full ascent ends when a step promises less than this gain of the log-likelihood.
pub(super) const LEAST_GAIN: f64 = 1e-5;
/// Smallest share of the largest diagonal entry of I that a parameter counts for in the damping.
const LEAST_DIAGONAL: f64 = 1e-12;

/// A function of the parameters with its gradient.
pub(super) type ParameterFunction<'a> = dyn Fn(&[f64]) -> (f64, Vec<f64>) + 'a;

/// Where a function of the parameters is held: (f(θ) − target)²/2ε² is subtracted from the log-likelihood.
pub(super) struct Constraint<'a> {
    /// f and its gradient.
    pub function: &'a ParameterFunction<'a>,
    pub target: f64,
    /// ε.
    pub tolerance: f64,
}

pub(super) struct Ascent<'a> {
    pub model: &'a Parametrisation<'a>,
    pub observations: &'a Observations,
    /// Least and greatest value of each parameter.
    pub bounds: &'a [(f64, f64)],
    pub constraint: Option<Constraint<'a>>,
    /// The ascent ends when a step promises less than this gain of the log-likelihood.
    pub least_gain: f64,
}

#[derive(Debug, Clone)]
pub(super) struct Maximum {
    pub theta: Vec<f64>,
    /// Log-likelihood and derivatives, without the constraint.
    pub evaluation: Evaluation,
    /// Whether no step promised more, as opposed to too many steps.
    pub converged: bool,
}

impl Ascent<'_> {
    /// Ascends from `start`, at most `most_steps`; `None` if the likelihood does not exist there.
    pub fn run(&self, start: &[f64], most_steps: usize) -> Option<Maximum> {
        let clipped = |theta: &[f64]| -> Vec<f64> {
            theta.iter().zip(self.bounds).map(|(value, &(low, high))| value.clamp(low, high)).collect()
        };
        let mut theta = clipped(start);
        let mut plain = evaluate(self.model, &theta, self.observations)?;
        let mut current = self.constrained(&theta, &plain);
        let mut damping = FIRST_DAMPING;
        let mut converged = false;
        for _ in 0..most_steps {
            let (candidate, promised) = loop {
                let step = self.step(&theta, &current, damping);
                let candidate = clipped(&theta.iter().zip(&step).map(|(value, step)| value + step).collect::<Vec<_>>());
                let promised: f64 =
                    current.gradient.iter().zip(&candidate).zip(&theta).map(|((g, c), t)| g * (c - t)).sum();
                if promised.is_nan() || promised <= self.least_gain {
                    break (None, promised);
                }
                let gain = self.value(&candidate).map(|value| value - current.log_likelihood);
                match gain {
                    Some(gain) if gain > 0.1 * 0.5 * promised => {
                        damping = (damping * 0.2).max(LEAST_DAMPING);
                        break (Some(candidate), promised);
                    }
                    Some(gain) if gain > 0.0 && damping > 1.0 => break (Some(candidate), promised),
                    _ => damping *= 5.0,
                }
                if damping > MOST_DAMPING {
                    break (None, promised);
                }
            };
            let Some(candidate) = candidate else {
                converged = promised <= self.least_gain || damping > MOST_DAMPING;
                break;
            };
            theta = candidate;
            plain = evaluate(self.model, &theta, self.observations)?;
            current = self.constrained(&theta, &plain);
        }
        Some(Maximum { theta, evaluation: plain, converged })
    }

    /// The log-likelihood less the constraint's penalty.
    fn value(&self, theta: &[f64]) -> Option<f64> {
        let plain = log_likelihood(self.model, theta, self.observations)?;
        let penalty = self.constraint.as_ref().map_or(0.0, |constraint| {
            let error = ((constraint.function)(theta).0 - constraint.target) / constraint.tolerance;
            0.5 * error * error
        });
        Some(plain - penalty)
    }

    fn constrained(&self, theta: &[f64], plain: &Evaluation) -> Evaluation {
        let mut evaluation = plain.clone();
        if let Some(constraint) = &self.constraint {
            let (value, gradient) = (constraint.function)(theta);
            let error = (value - constraint.target) / constraint.tolerance;
            evaluation.log_likelihood -= 0.5 * error * error;
            for (j, dj) in gradient.iter().enumerate() {
                evaluation.gradient[j] -= error * dj / constraint.tolerance;
                for (k, dk) in gradient.iter().enumerate() {
                    evaluation.information[(j, k)] += dj * dk / (constraint.tolerance * constraint.tolerance);
                }
            }
        }
        evaluation
    }

    /// The damped step of the parameters that no bound holds; zero for the others.
    fn step(&self, theta: &[f64], current: &Evaluation, damping: f64) -> Vec<f64> {
        let free: Vec<usize> = free_parameters(theta, self.bounds, &current.gradient);
        let mut step = vec![0.0; theta.len()];
        let largest = free.iter().map(|&j| current.information[(j, j)]).fold(0.0, f64::max).max(f64::MIN_POSITIVE);
        let matrix = DMatrix::from_fn(free.len(), free.len(), |a, b| {
            let entry = current.information[(free[a], free[b])];
            if a == b {
                entry + damping * entry.max(LEAST_DIAGONAL * largest) + LEAST_DIAGONAL * largest
            } else {
                entry
            }
        });
        let gradient = DVector::from_iterator(free.len(), free.iter().map(|&j| current.gradient[j]));
        let Some(factor) = matrix.cholesky() else { return step };
        let solution = factor.solve(&gradient);
        let longest = solution.iter().fold(0.0_f64, |longest, change| longest.max(change.abs()));
        let scale = (LARGEST_STEP / longest).min(1.0);
        free.iter().zip(solution.iter()).for_each(|(&j, change)| step[j] = change * scale);
        step
    }
}

/// The parameters that are not held at a bound by the gradient.
pub(super) fn free_parameters(theta: &[f64], bounds: &[(f64, f64)], gradient: &[f64]) -> Vec<usize> {
    let is_free = |&j: &usize| {
        let (low, high) = bounds[j];
        let is_held = (theta[j] <= low && gradient[j] <= 0.0) || (theta[j] >= high && gradient[j] >= 0.0);
        low < high && !is_held
    };
    (0..theta.len()).filter(is_free).collect()
}
