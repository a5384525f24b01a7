//! The problem of one zone: its inputs of a day, those of all others as they are (eq. 5.13).
//!
//! ```text
//! min over d, lo ≤ d ≤ hi:   gᵀd + ½ dᵀP d + c Σ_r [ φ(v_r + a_rᵀd) − φ(v_r) − φ'(v_r) a_rᵀd ],     φ(v) = max(v, 0)²
//! ```
//!
//! g is the gradient of the whole J, which came with the neighbours' messages and includes the comfort of all zones. P is the
//! curvature of J in this zone's inputs, known beforehand, with that of the comfort bounds of distant zones as if they were all
//! violated. Rows r are the comfort bounds of the zone and its neighbours, whose temperatures it knows.
//! Rows that are not violated now take part, since they may be after the step: leaving them out breaks the descent.
//!
//! Projected Newton steps find the minimum: the cost is piecewise quadratic, so a few steps reach it exactly.

use nalgebra::{Cholesky, DMatrix, DVector};
use rayon::prelude::*;

use super::messages::Messages;
use crate::comfort::Targets;
use crate::control::BandPenalty;
use crate::lifted::Lifted;

/// Largest number of Newton steps; the best point so far is then returned. Chosen far above the few that are needed.
const MAX_NEWTON_STEPS: usize = 60;

/// A comfort bound: v and the row a, as a kernel that was hit `time` steps after the first input, times a sign.
pub(super) struct Bound<'a> {
    pub value: f64,
    pub sign: f64,
    /// Response of the bound's zone to a kilowatt, k(0) right after it.
    pub kernel: &'a [f64],
    /// The row of the bound: inputs 0 … time act on it.
    pub time: usize,
}

impl Bound<'_> {
    /// aᵀd.
    fn moved(&self, d: &[f64]) -> f64 {
        self.sign * d[..=self.time].iter().zip(self.kernel[..=self.time].iter().rev()).map(|(d, k)| d * k).sum::<f64>()
    }

    /// Adds `weight` a to a vector.
    fn add(&self, weight: f64, vector: &mut [f64]) {
        for (entry, k) in vector[..=self.time].iter_mut().zip(self.kernel[..=self.time].iter().rev()) {
            *entry += weight * self.sign * k;
        }
    }
}

pub(super) struct ZoneProblem<'a> {
    pub gradient: Vec<f64>,
    pub curvature: &'a DMatrix<f64>,
    /// c.
    pub penalty: f64,
    pub bounds: Vec<Bound<'a>>,
    pub low: Vec<f64>,
    pub high: Vec<f64>,
}

impl ZoneProblem<'_> {
    /// The minimising d, up to rounding. `None` if d is not unique: a number is not finite, or the cost is not strictly
    /// convex in the inputs that are not at a limit.
    pub fn solve(&self) -> Option<Vec<f64>> {
        let n = self.gradient.len();
        if !self.gradient.iter().all(|slope| slope.is_finite()) {
            return None;
        }
        let mut d = vec![0.0; n];
        for _ in 0..MAX_NEWTON_STEPS {
            let gradient = self.gradient_at(&d);
            let free: Vec<usize> = (0..n)
                .filter(|&i| !(d[i] <= self.low[i] && gradient[i] > 0.0 || d[i] >= self.high[i] && gradient[i] < 0.0))
                .collect();
            let largest = free.iter().map(|&i| gradient[i].abs()).fold(0.0, f64::max);
            if largest <= 1e-10 * (1.0 + self.gradient.iter().fold(0.0, |m, g| f64::max(m, g.abs()))) {
                break;
            }
            let step = self.newton(&d, &gradient, &free)?;
            if !self.advance(&mut d, &gradient, &free, &step) {
                break;
            }
        }
        Some(d)
    }

    fn gradient_at(&self, d: &[f64]) -> Vec<f64> {
        let mut gradient = DVector::from_column_slice(&self.gradient);
        for (column, &d) in self.curvature.column_iter().zip(d) {
            if d != 0.0 {
                gradient.axpy(d, &column, 1.0);
            }
        }
        for bound in &self.bounds {
            let change = (bound.value + bound.moved(d)).max(0.0) - bound.value.max(0.0);
            if change != 0.0 {
                bound.add(2.0 * self.penalty * change, gradient.as_mut_slice());
            }
        }
        gradient.data.into()
    }

    fn value(&self, d: &[f64]) -> f64 {
        let mut curved = DVector::zeros(d.len());
        for (column, &d) in self.curvature.column_iter().zip(d) {
            curved.axpy(d, &column, 1.0);
        }
        let quadratic: f64 = d.iter().zip(&curved).zip(&self.gradient).map(|((d, c), g)| d * (0.5 * c + g)).sum();
        let beyond = |bound: &Bound<'_>| {
            let (moved, now) = (bound.moved(d), bound.value.max(0.0));
            let after = (bound.value + moved).max(0.0);
            after * after - now * now - 2.0 * now * moved
        };
        quadratic + self.penalty * self.bounds.iter().map(beyond).sum::<f64>()
    }

    /// −H⁻¹ gradient over the free inputs.
    fn newton(&self, d: &[f64], gradient: &[f64], free: &[usize]) -> Option<Vec<f64>> {
        let mut hessian = self.curvature.clone();
        let mut row = vec![0.0; d.len()];
        for bound in self.bounds.iter().filter(|bound| bound.value + bound.moved(d) > 0.0) {
            row.fill(0.0);
            bound.add(1.0, &mut row);
            for j in 0..=bound.time {
                let weight = 2.0 * self.penalty * row[j];
                for (entry, a) in hessian.column_mut(j).iter_mut().zip(&row[..=bound.time]) {
                    *entry += weight * a;
                }
            }
        }
        let selected = DMatrix::from_fn(free.len(), free.len(), |i, j| hessian[(free[i], free[j])]);
        let right = DVector::from_fn(free.len(), |i, _| -gradient[free[i]]);
        Some(Cholesky::new(selected)?.solve(&right).data.into())
    }

    /// Goes along a step as far as the value falls enough, staying within the box. False if it cannot fall.
    fn advance(&self, d: &mut Vec<f64>, gradient: &[f64], free: &[usize], step: &[f64]) -> bool {
        let before = self.value(d);
        let mut length = 1.0;
        for _ in 0..30 {
            let mut trial = d.clone();
            for (&i, step) in free.iter().zip(step) {
                trial[i] = (d[i] + length * step).clamp(self.low[i], self.high[i]);
            }
            let expected: f64 = trial.iter().zip(d.iter()).zip(gradient).map(|((t, d), g)| (t - d) * g).sum();
            if expected < 0.0 && self.value(&trial) <= before + 1e-4 * expected {
                *d = trial;
                return true;
            }
            length *= 0.5;
        }
        false
    }
}

/// Smallest response of a zone that counts in another zone's curvature, as a share of that zone's own response.
const MIN_RESPONSE_RATIO: f64 = 1e-6;
/// The models of all zones: the effect of a kilowatt of each zone, and the largest curvature of the common cost in its
/// inputs, without the bounds near it.
#[derive(Clone, Debug)]
pub(super) struct ZoneModels {
    pub zones: Vec<Zone>,
}

#[derive(Clone, Debug)]
pub(super) struct Zone {
    /// Itself and its neighbours, with their responses to its heat.
    pub near: Vec<(usize, Vec<f64>)>,
    /// The largest curvature of the common cost in its inputs, but for the bounds near it.
    pub curvature: DMatrix<f64>,
}

impl ZoneModels {
    /// Builds the model of each zone for the weights of `targets` and `penalty`.
    pub fn new(lifted: &Lifted, targets: &Targets, penalty: BandPenalty, messages: &Messages) -> Self {
        let (n, steps) = (lifted.zones(), lifted.steps());
        let zone = |i: usize| {
            let mut impulse = vec![0.0; lifted.size()];
            impulse[i] = 1.0;
            let responses = lifted.product(&impulse);
            let kernel = |j: usize| -> Vec<f64> { (0..steps).map(|t| responses[t * n + j]).collect() };
            let size = |kernel: &[f64]| kernel.iter().fold(0.0, |m: f64, k| m.max(k.abs()));
            let own = kernel(i);
            let least = MIN_RESPONSE_RATIO * size(&own);
            let mut near: Vec<usize> = messages.neighbours(i).chain([i]).collect();
            near.sort_unstable();
            near.dedup();
            let weight = |t: usize| 2.0 * targets.input_weight[t * n + i];
            let mut curvature = DMatrix::from_diagonal(&DVector::from_fn(steps, |t, _| weight(t)));
            for j in 0..n {
                let kernel = kernel(j);
                if size(&kernel) > least {
                    // Comfort bounds of zones that send no messages to this one count as if all were violated.
                    let bent = if near.binary_search(&j).is_ok() { 0.0 } else { penalty.quadratic };
                    let bend = |t: usize| if targets.occupied[t * n + j] { bent } else { 0.0 };
                    add_curvature(&mut curvature, &kernel, |t| targets.error_weight[t * n + j] + bend(t));
                }
            }
            for s in 0..steps {
                for t in 0..s {
                    curvature[(s, t)] = curvature[(t, s)];
                }
            }
            Zone { near: near.into_iter().map(|j| (j, kernel(j))).collect(), curvature }
        };
        Self { zones: (0..n).into_par_iter().map(zone).collect() }
    }
}

/// Adds 2 Σ_τ W(τ) k(τ − s) k(τ − t) to the upper triangle.
fn add_curvature(curvature: &mut DMatrix<f64>, kernel: &[f64], weight: impl Fn(usize) -> f64) {
    let steps = kernel.len();
    let weights: Vec<f64> = (0..steps).map(|t| 2.0 * weight(t)).collect();
    for t in 0..steps {
        for s in 0..=t {
            let sum: f64 = weights[t..]
                .iter()
                .zip(kernel)
                .zip(&kernel[t - s..])
                .map(|((weight, now), then)| weight * now * then)
                .sum();
            curvature[(s, t)] += sum;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The conditions of the minimum: the projected gradient vanishes.
    #[test]
    fn the_projected_gradient_vanishes() {
        let n = 12;
        let wave = |i: usize, f: f64| libm::sin(f * (i + 1) as f64);
        let root = DMatrix::from_fn(n, n, |i, j| wave(i * n + j, 1.7));
        let curvature = root.tr_mul(&root) + DMatrix::identity(n, n);
        let kernel: Vec<f64> = (0..n).map(|t| libm::exp(-0.3 * t as f64)).collect();
        let bounds = |limit: f64| -> Vec<Bound<'_>> {
            (0..n)
                .flat_map(|time| {
                    [1.0, -1.0].map(|sign| Bound { value: sign * wave(time, 2.3) - limit, sign, kernel: &kernel, time })
                })
                .collect()
        };
        for (penalty, limit) in [(0.0, 0.0), (5.0, 0.2), (500.0, 0.6)] {
            let problem = ZoneProblem {
                gradient: (0..n).map(|i| 6.0 * wave(i, 0.9)).collect(),
                curvature: &curvature,
                penalty,
                bounds: bounds(limit),
                low: vec![-0.4; n],
                high: vec![0.3; n],
            };
            let d = problem.solve().expect("strictly convex");
            let gradient = problem.gradient_at(&d);
            for i in 0..n {
                let projected = d[i] - (d[i] - gradient[i]).clamp(-0.4, 0.3);
                assert!(projected.abs() < 1e-8, "{penalty} {limit} {i}: {projected}");
            }
            assert!(d.iter().any(|&d| d <= -0.4 || d >= 0.3), "the box binds");
            // The gradient is that of the value.
            for i in 0..n {
                let mut moved = [d.clone(), d.clone()];
                moved[0][i] += 1e-6;
                moved[1][i] -= 1e-6;
                let slope = (problem.value(&moved[0]) - problem.value(&moved[1])) / 2e-6;
                assert!((slope - gradient[i]).abs() < 1e-4, "{slope} {}", gradient[i]);
            }
        }
    }
    #[test]
    fn a_problem_without_a_unique_minimum_returns_none() {
        let flat = DMatrix::zeros(2, 2);
        let problem = |curvature, gradient| ZoneProblem {
            gradient,
            curvature,
            penalty: 0.0,
            bounds: Vec::new(),
            low: vec![-1.0; 2],
            high: vec![1.0; 2],
        };
        assert_eq!(problem(&flat, vec![1.0, -1.0]).solve(), None);
        let round = DMatrix::identity(2, 2);
        assert_eq!(problem(&round, vec![f64::NAN, 0.0]).solve(), None);
        assert_eq!(problem(&round, vec![0.5, 3.0]).solve(), Some(vec![-0.5, -1.0]));
    }
}
