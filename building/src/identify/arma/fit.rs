//! Conditional sum of squares: min over β, α, μ of Σ e_t² by Levenberg and Marquardt's method.
//!
//! e is linear in β, and its derivatives are filters of the same kind as e:
//!
//! ```text
//! (1 + μB) ∂e/∂β_j = −(1 − Σα_k Bᵏ) z_j,    (1 + μB) ∂e/∂α_k = −Bᵏ v,    (1 + μB) ∂e/∂μ = −B e
//! ```
//!
//! with the backshift B. The sum has several minima when α and μ nearly cancel, so descents start from several α and μ, each
//! with the β that is best for them; the lowest wins. The covariance at the minimum allows for innovations that are not quite
//! white.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};

use super::{Arma, is_stable, moving_average_inverted, whitened};
use crate::identify::IdentifyError;
use crate::identify::normal::{positive_definite, robust_covariance};
use crate::staged::dense::dot;

/// The largest moving-average coefficient. Beyond it, the inverse filter does not decay.
const MAX_MOVING_AVERAGE: f64 = 0.98;
const MAX_STEPS: usize = 200;
/// A descent ends when a step lowers the sum of squares by at most this share of it: far below what changes an estimate by a
/// noticeable part of its standard error.
const MAX_FINAL_GAIN_RATIO: f64 = 1e-12;
/// First autoregressive coefficient and moving average at the starts.
const STARTS: [(f64, f64); 4] = [(0.0, 0.0), (0.7, 0.0), (0.9, -0.5), (0.5, 0.5)];

/// A regression with ARMA(r,1) errors, fitted.
#[derive(Debug, Clone)]
pub(in crate::identify) struct ArmaFit {
    /// β.
    pub regression: Vec<f64>,
    pub arma: Arma,
    /// Covariance of (β, α, μ); the variance of what the data do not determine is infinite.
    pub covariance: DMatrix<f64>,
}

/// Fits `target` = `columns`·β + v with v an ARMA(`order`, 1), `order` at least 1, over segments.
///
/// # Errors
/// [`IdentifyError::TooFewRows`] when there are not at least three rows a parameter.
pub(in crate::identify) fn fit(
    columns: &[Vec<f64>],
    target: &[f64],
    segments: &[Range<usize>],
    order: usize,
) -> Result<ArmaFit, IdentifyError> {
    let count = segments.iter().map(|segment| segment.len().saturating_sub(order)).sum();
    let parameters = columns.len() + order + 1;
    if count < 3 * parameters {
        return Err(IdentifyError::TooFewRows { rows: count, parameters, wanted: 3 * parameters });
    }
    let problem = Problem::new(columns, target, segments, order);
    let descents = STARTS.iter().map(|&(alpha, mu)| problem.descend(problem.start(alpha, mu)));
    let best = descents.min_by(|a, b| a.cost.total_cmp(&b.cost)).ok_or(IdentifyError::NotFinite)?;
    if !best.cost.is_finite() {
        return Err(IdentifyError::NotFinite);
    }
    Ok(problem.finish(best, count))
}

/// The sum of squares as a function of (β, α, μ), with columns scaled to length one.
struct Problem<'a> {
    columns: Vec<Vec<f64>>,
    length: Vec<f64>,
    target: &'a [f64],
    segments: Vec<Range<usize>>,
    order: usize,
}

#[derive(Clone)]
struct Point {
    parameters: DVector<f64>,
    /// v_t.
    errors: Vec<f64>,
    /// e_t.
    innovations: Vec<f64>,
    cost: f64,
}

impl<'a> Problem<'a> {
    fn new(columns: &[Vec<f64>], target: &'a [f64], segments: &[Range<usize>], order: usize) -> Self {
        let length: Vec<f64> = columns.iter().map(|column| dot(column, column).sqrt()).collect();
        let scaled = |(column, length): (&Vec<f64>, &f64)| {
            column.iter().map(|value| if *length > 0.0 { value / length } else { 0.0 }).collect()
        };
        let columns = columns.iter().zip(&length).map(scaled).collect();
        let segments = segments.iter().filter(|segment| segment.len() > order).cloned().collect();
        Self { columns, length, target, segments, order }
    }

    fn autoregressive<'p>(&self, parameters: &'p DVector<f64>) -> &'p [f64] {
        &parameters.as_slice()[self.columns.len()..self.columns.len() + self.order]
    }

    fn moving_average(&self, parameters: &DVector<f64>) -> f64 {
        parameters[self.columns.len() + self.order]
    }

    /// The start with these α_1 and μ and the β that is best for them.
    fn start(&self, alpha: f64, mu: f64) -> Point {
        let count = self.columns.len();
        let mut parameters = DVector::zeros(count + self.order + 1);
        parameters[count] = alpha;
        parameters[count + self.order] = mu;
        let filter = |series: &[f64]| whitened(series, self.autoregressive(&parameters), mu, &self.segments);
        let filtered: Vec<_> = self.columns.iter().map(|column| filter(column)).collect();
        let target = filter(self.target);
        let gram = gram(&filtered);
        let moment = DVector::from_fn(count, |i, _| dot(&filtered[i], &target));
        if let Some(step) = damped_solution(&gram, &moment, 1e-9) {
            parameters.rows_mut(0, count).copy_from(&step);
        }
        self.at(parameters)
    }

    fn at(&self, parameters: DVector<f64>) -> Point {
        let mut errors = self.target.to_vec();
        for (column, coefficient) in self.columns.iter().zip(&parameters) {
            errors.iter_mut().zip(column).for_each(|(error, value)| *error -= coefficient * value);
        }
        let (alpha, mu) = (self.autoregressive(&parameters), self.moving_average(&parameters));
        let innovations = whitened(&errors, alpha, mu, &self.segments);
        let admissible = mu.abs() <= MAX_MOVING_AVERAGE && is_stable(alpha);
        let cost = if admissible { dot(&innovations, &innovations) } else { f64::INFINITY };
        Point { parameters, errors, innovations, cost }
    }

    /// ∂e/∂(β, α, μ), one vector a parameter.
    fn jacobian(&self, point: &Point) -> Vec<Vec<f64>> {
        let (alpha, mu) = (self.autoregressive(&point.parameters), self.moving_average(&point.parameters));
        let inverted = |input: &dyn Fn(usize) -> f64| {
            moving_average_inverted(input, self.order, mu, &self.segments, self.target.len())
        };
        let mut jacobian: Vec<Vec<f64>> = (self.columns.iter())
            .map(|column| whitened(column, alpha, mu, &self.segments).iter().map(|value| -value).collect())
            .collect();
        jacobian.extend((1..=self.order).map(|lag| inverted(&|t| -point.errors[t - lag])));
        // Because r is at least one, the first e_{t−1} of a segment is one of its initial zeros.
        jacobian.push(inverted(&|t| -point.innovations[t - 1]));
        jacobian
    }

    fn descend(&self, start: Point) -> Point {
        let mut point = start;
        let mut damping = 1e-3;
        for _ in 0..MAX_STEPS {
            let jacobian = self.jacobian(&point);
            let gram = gram(&jacobian);
            let gradient = DVector::from_fn(jacobian.len(), |i, _| -dot(&jacobian[i], &point.innovations));
            let Some(next) = self.lower(&point, &gram, &gradient, &mut damping) else { break };
            let gain = point.cost - next.cost;
            let done = gain <= MAX_FINAL_GAIN_RATIO * point.cost;
            point = next;
            if done {
                break;
            }
        }
        point
    }

    /// A point that is lower than `point`, found by raising the damping until there is one.
    fn lower(&self, point: &Point, gram: &DMatrix<f64>, gradient: &DVector<f64>, damping: &mut f64) -> Option<Point> {
        while *damping < 1e10 {
            let next = damped_solution(gram, gradient, *damping).map(|step| self.at(&point.parameters + step));
            match next {
                Some(next) if next.cost < point.cost => {
                    *damping = (*damping * 0.1).max(1e-12);
                    return Some(next);
                }
                _ => *damping *= 10.0,
            }
        }
        None
    }

    fn finish(&self, point: Point, count: usize) -> ArmaFit {
        let variance = point.cost / (count - point.parameters.len()) as f64;
        let unscaled = |i: usize| match self.length.get(i) {
            Some(&length) if length > 0.0 => 1.0 / length,
            _ => 1.0,
        };
        // Innovations of an imperfect model are not quite white; their correlation decays within n^⅓ steps.
        let lags = libm::cbrt(count as f64) as usize;
        let scaled = robust_covariance(&self.jacobian(&point), &point.innovations, &self.segments, lags);
        let covariance =
            DMatrix::from_fn(scaled.nrows(), scaled.ncols(), |i, j| scaled[(i, j)] * unscaled(i) * unscaled(j));
        ArmaFit {
            regression: (0..self.columns.len()).map(|i| point.parameters[i] * unscaled(i)).collect(),
            arma: Arma {
                autoregressive: self.autoregressive(&point.parameters).to_vec(),
                moving_average: self.moving_average(&point.parameters),
                innovation_sd: variance.sqrt(),
            },
            covariance,
        }
    }
}

/// JᵀJ.
fn gram(columns: &[Vec<f64>]) -> DMatrix<f64> {
    let mut gram = DMatrix::zeros(columns.len(), columns.len());
    for i in 0..columns.len() {
        for j in 0..=i {
            gram[(i, j)] = dot(&columns[i], &columns[j]);
            gram[(j, i)] = gram[(i, j)];
        }
    }
    gram
}

/// The solution of (G + λ diag G) x = g.
fn damped_solution(gram: &DMatrix<f64>, right: &DVector<f64>, damping: f64) -> Option<DVector<f64>> {
    let diagonal = gram.diagonal().map(|entry| if entry > 0.0 { entry.sqrt() } else { 1.0 });
    let scaled = DMatrix::from_fn(gram.nrows(), gram.ncols(), |i, j| {
        gram[(i, j)] / (diagonal[i] * diagonal[j]) + if i == j { damping } else { 0.0 }
    });
    let scaled_right = right.component_div(&diagonal);
    Some(positive_definite(scaled)?.solve(&scaled_right).component_div(&diagonal))
}
