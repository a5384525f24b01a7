//! The covariances of a Kalman filter, which depend on which outputs are measured but not on their values.
//!
//! The same outputs are usually measured in many consecutive rows, and then the covariance converges. So the filter's covariances form a
//! graph: from each covariance, a set of measured outputs leads to the next. A covariance that no longer changes leads to itself. The
//! graph is built once for the current parameters; the derivatives with respect to each parameter follow its arrows in the same order.

use std::collections::BTreeMap;

use nalgebra::DMatrix;

use super::exponential::{Number, real};
use super::linear_model::{ContinuousModel, SampledModel};

/// A covariance has converged if no entry changes by more than this share of its scale √(P_ii P_jj) in a step.
const CONVERGED: f64 = 1e-12;

/// Which outputs of a row are measured, one bit each.
pub(super) type Measured = u32;

/// The most outputs that a [`Measured`] can tell apart.
pub(super) const MOST_OUTPUTS: usize = 31;

/// The bit of a row from which on the heat is unknown until the next row.
pub(super) const UNKNOWN_HEAT: Measured = 1 << 31;

/// What the filter does along each arrow: a gain and a variance for each output, in order; outputs that are missing have a gain
/// of zero.
#[derive(Debug, Clone, Default)]
pub(super) struct Gains {
    /// K, n numbers an output, one output after the other, one arrow after the other.
    pub gains: Vec<Number>,
    /// S, the variance of each innovation, p numbers an arrow \[K²\].
    pub variances: Vec<Number>,
}

/// One arrow of the graph: from the covariance before a row to that before the next.
#[derive(Debug, Clone, Copy)]
struct Arrow {
    from: usize,
    measured: Measured,
    /// The covariance that it makes; `None` if it leads to one that was there.
    made: Option<usize>,
}

/// The order of all arrows, and which one each row follows.
#[derive(Debug, Clone)]
pub(super) struct Schedule {
    arrows: Vec<Arrow>,
    pub of_row: Vec<usize>,
}

impl Schedule {
    pub fn arrow_count(&self) -> usize {
        self.arrows.len()
    }
}

/// Builds the schedule of the rows `measured`, whose segments begin at `starts`, and the gains of each arrow.
///
/// `None` if a variance is not positive.
pub(super) fn schedule(
    model: &ContinuousModel,
    sampled: &SampledModel,
    measured: &[Measured],
    starts: &[bool],
) -> Option<(Schedule, Gains)> {
    let mut recursion = Recursion::new(model, sampled);
    let mut arrows: Vec<Arrow> = Vec::new();
    let mut known: BTreeMap<(usize, Measured), (usize, usize)> = BTreeMap::new();
    let mut of_row = Vec::with_capacity(measured.len());
    let (mut at, mut steady): (usize, Option<usize>) = (0, None);
    for (&outputs, &start) in measured.iter().zip(starts) {
        if start {
            at = 0;
        }
        if let Some(&(arrow, next)) = known.get(&(at, outputs)) {
            of_row.push(arrow);
            at = next;
            continue;
        }
        recursion.step(at, outputs)?;
        let same = [Some(at), steady].into_iter().flatten().find(|&other| recursion.is_next(other));
        let made = match same {
            Some(_) => None,
            None => Some(recursion.keep()),
        };
        let to = same.or(made).unwrap_or(at);
        if to == at {
            steady = Some(at);
        }
        known.insert((at, outputs), (arrows.len(), to));
        of_row.push(arrows.len());
        arrows.push(Arrow { from: at, measured: outputs, made });
        at = to;
    }
    Some((Schedule { arrows, of_row }, recursion.found))
}

/// The gains of the same arrows for another model, such as one with an infinitesimal change of a parameter.
pub(super) fn follow(schedule: &Schedule, model: &ContinuousModel, sampled: &SampledModel) -> Option<Gains> {
    let mut recursion = Recursion::new(model, sampled);
    for arrow in &schedule.arrows {
        recursion.step(arrow.from, arrow.measured)?;
        if arrow.made.is_some() {
            recursion.keep();
        }
    }
    Some(recursion.found)
}

/// The recursion of the covariance. Matrices are n × n, row by row.
struct Recursion<'a> {
    n: usize,
    model: &'a ContinuousModel,
    transition: Vec<Number>,
    noise: Vec<Number>,
    /// All covariances that were kept, one after the other.
    covariances: Vec<Number>,
    /// The covariance after the updates of the last step, its product with Φ, and the next covariance.
    updated: Vec<Number>,
    half: Vec<Number>,
    next: Vec<Number>,
    found: Gains,
}

impl<'a> Recursion<'a> {
    /// At the covariance with which segments begin.
    fn new(model: &'a ContinuousModel, sampled: &SampledModel) -> Self {
        let n = model.dynamics.nrows();
        let by_rows = |matrix: &DMatrix<Number>| matrix.transpose().iter().copied().collect();
        let mut covariances = vec![real(0.0); n * n];
        model.initial.variance.iter().enumerate().for_each(|(i, variance)| covariances[i * n + i] = *variance);
        let zeros = vec![real(0.0); n * n];
        Self {
            n,
            model,
            transition: by_rows(&sampled.transition),
            noise: by_rows(&sampled.noise),
            covariances,
            updated: zeros.clone(),
            half: zeros.clone(),
            next: zeros,
            found: Gains::default(),
        }
    }

    fn kept(&self, index: usize) -> &[Number] {
        let size = self.n * self.n;
        &self.covariances[index * size..(index + 1) * size]
    }

    /// Keeps the next covariance. Returns its index.
    fn keep(&mut self) -> usize {
        self.covariances.extend_from_slice(&self.next);
        self.covariances.len() / self.next.len() - 1
    }

    /// Whether the next covariance is one that was kept.
    fn is_next(&self, other: usize) -> bool {
        let (n, kept) = (self.n, self.kept(other));
        (0..n).all(|i| {
            (0..n).all(|j| {
                let scale = libm::sqrt((self.next[i * n + i].re * self.next[j * n + j].re).max(0.0));
                (self.next[i * n + j].re - kept[i * n + j].re).abs() <= CONVERGED * scale
            })
        })
    }

    /// The updates of one row, one output after the other, and the prediction of the next covariance.
    fn step(&mut self, from: usize, measured: Measured) -> Option<()> {
        let n = self.n;
        let size = n * n;
        self.updated.copy_from_slice(&self.covariances[from * size..(from + 1) * size]);
        for (output, &state) in self.model.outputs.iter().enumerate() {
            let first = self.found.gains.len();
            self.found.gains.resize(first + n, real(0.0));
            if measured >> output & 1 == 0 {
                self.found.variances.push(real(1.0));
                continue;
            }
            let covariance = &mut self.updated;
            let variance = covariance[state * n + state] + self.model.sensor_variance[output];
            if !variance.re.is_finite() || variance.re <= 0.0 {
                return None;
            }
            let inverse = real(1.0) / variance;
            let gain = &mut self.found.gains[first..];
            for i in 0..n {
                gain[i] = covariance[i * n + state] * inverse;
            }
            // Column `state` of the covariance is the gain times the variance.
            for j in 0..n {
                let weight = gain[j] * variance;
                for i in 0..=j {
                    covariance[i * n + j] -= gain[i] * weight;
                    covariance[j * n + i] = covariance[i * n + j];
                }
            }
            self.found.variances.push(variance);
        }
        if measured & UNKNOWN_HEAT != 0 {
            let variances = self.model.unknown_heat_variance.iter().enumerate();
            variances.for_each(|(i, variance)| self.updated[i * n + i] += real(*variance));
        }
        self.predict();
        Some(())
    }

    /// The next covariance Φ P Φᵀ + Q of symmetric P and Q.
    fn predict(&mut self) {
        let n = self.n;
        for (half, row) in self.half.chunks_mut(n).zip(self.transition.chunks(n)) {
            // P is symmetric: its rows are its columns.
            for (half, column) in half.iter_mut().zip(self.updated.chunks(n)) {
                *half = dot(real(0.0), row, column);
            }
        }
        for i in 0..n {
            for j in i..n {
                let row = &self.half[i * n..(i + 1) * n];
                let entry = dot(self.noise[i * n + j], row, &self.transition[j * n..(j + 1) * n]);
                (self.next[i * n + j], self.next[j * n + i]) = (entry, entry);
            }
        }
    }
}

/// first + Σ aₖ bₖ.
fn dot(first: Number, a: &[Number], b: &[Number]) -> Number {
    a.iter().zip(b).fold(first, |sum, (a, b)| sum + a * b)
}
