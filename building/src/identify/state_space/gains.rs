//! The covariances of a Kalman filter, which depend on which outputs are measured and on how heat is timed, but not on values.
//!
//! Rows of the same kind usually follow each other, and then the covariance converges. So the filter's covariances form a
//! graph: from each covariance, a kind of row leads to the next. A covariance that no longer changes leads to itself. The
//! graph is built once for the current parameters; the derivatives by the parameters follow its arrows in the same order
//! ([`super::gain_tangents`]).

use std::collections::BTreeMap;

use nalgebra::DMatrix;

use super::exponential::Number;
use super::heat_rows;
use super::heat_timing::RowEffect;
use super::linear_model::{ContinuousModel, SampledModel};
use crate::staged::dense::dot;

/// A covariance has converged if no entry changes by more than this share of its scale √(P_ii P_jj) in a step.
const CONVERGED: f64 = 1e-12;

/// Which outputs of a row are measured, one bit each.
pub(super) type Measured = u32;

/// The most outputs that a [`Measured`] can tell apart.
pub(super) const MOST_OUTPUTS: usize = 31;

/// What the covariance of a row depends on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct RowKind {
    pub measured: Measured,
    /// Class of the timing of its heat ([`heat_rows::HeatRows`]).
    pub heat: usize,
}

/// What the filter does along each arrow: a gain and a variance for each output, in order; outputs that are missing have a gain
/// of zero.
#[derive(Debug, Clone, Default)]
pub(super) struct Gains {
    /// K, n numbers an output, one output after the other, one arrow after the other.
    pub gains: Vec<f64>,
    /// S, the variance of each innovation, p numbers an arrow \[K²\].
    pub variances: Vec<f64>,
}

/// One arrow of the graph: from the covariance before a row to that before the next.
#[derive(Debug, Clone, Copy)]
pub(super) struct Arrow {
    pub from: usize,
    pub kind: RowKind,
    /// The covariance that it makes; `None` if it leads to one that was there.
    pub made: Option<usize>,
}

/// The order of all arrows, which one each row follows, and the covariances between them.
#[derive(Debug, Clone)]
pub(super) struct Schedule {
    pub arrows: Vec<Arrow>,
    pub of_row: Vec<usize>,
    /// All covariances, n × n each, one after the other \[K²\].
    pub covariances: Vec<f64>,
}

impl Schedule {
    pub fn arrow_count(&self) -> usize {
        self.arrows.len()
    }
}

/// What the covariances of a model are made of. Matrices are n × n, row by row.
#[derive(Debug, Clone)]
pub(super) struct CovarianceModel {
    pub n: usize,
    /// Φ.
    pub transition: Vec<f64>,
    /// The covariance of the random part of a step, for each class of heat.
    pub noise: Vec<Vec<f64>>,
    /// Which state each output measures, and its variance.
    pub outputs: Vec<(usize, f64)>,
    pub initial: Vec<f64>,
    unknown_heat: Vec<f64>,
}

impl CovarianceModel {
    pub fn new(model: &ContinuousModel, sampled: &SampledModel, effects: &[RowEffect]) -> Self {
        let n = model.dynamics.nrows();
        let parts = |numbers: &[Number]| numbers.iter().map(|entry| entry.re).collect::<Vec<f64>>();
        let by_rows = |matrix: &DMatrix<Number>| matrix.transpose().iter().map(|entry| entry.re).collect();
        let mut initial = vec![0.0; n * n];
        model.initial.variance.iter().enumerate().for_each(|(i, variance)| initial[i * n + i] = variance.re);
        Self {
            n,
            transition: by_rows(&sampled.transition),
            noise: effects.iter().map(|effect| parts(&effect.noise)).collect(),
            outputs: model.outputs.iter().copied().zip(parts(&model.sensor_variance)).collect(),
            initial,
            unknown_heat: model.unknown_heat_variance.clone(),
        }
    }

    /// Adds to a covariance what a row of unknown heat adds, if it is one.
    pub fn add_unknown_heat(&self, kind: RowKind, covariance: &mut [f64]) {
        if kind.heat == heat_rows::UNKNOWN {
            self.unknown_heat.iter().enumerate().for_each(|(i, variance)| covariance[i * self.n + i] += variance);
        }
    }

    /// The gain by a measurement of `state`, and its variance; the covariance is updated. `None` if the variance is not positive.
    pub fn update(covariance: &mut [f64], (state, sensor): (usize, f64), gain: &mut [f64]) -> Option<f64> {
        let n = gain.len();
        let variance = covariance[state * n + state] + sensor;
        if !variance.is_finite() || variance <= 0.0 {
            return None;
        }
        for (i, gain) in gain.iter_mut().enumerate() {
            *gain = covariance[i * n + state] / variance;
        }
        // Column `state` of the covariance is the gain times the variance.
        for j in 0..n {
            let weight = gain[j] * variance;
            for i in 0..=j {
                covariance[i * n + j] -= gain[i] * weight;
                covariance[j * n + i] = covariance[i * n + j];
            }
        }
        Some(variance)
    }
}

/// Builds the schedule of rows of these kinds, whose segments begin at `starts`, and the gains of each arrow.
///
/// `None` if a variance is not positive.
pub(super) fn schedule(model: &CovarianceModel, kinds: &[RowKind], starts: &[bool]) -> Option<(Schedule, Gains)> {
    let mut recursion = Recursion::new(model);
    let mut arrows: Vec<Arrow> = Vec::new();
    let mut known: BTreeMap<(usize, RowKind), (usize, usize)> = BTreeMap::new();
    let mut of_row = Vec::with_capacity(kinds.len());
    let (mut at, mut steady): (usize, Option<usize>) = (0, None);
    for (&kind, &start) in kinds.iter().zip(starts) {
        if start {
            at = 0;
        }
        if let Some(&(arrow, next)) = known.get(&(at, kind)) {
            of_row.push(arrow);
            at = next;
            continue;
        }
        recursion.step(at, kind)?;
        let same = [Some(at), steady].into_iter().flatten().find(|&other| recursion.is_next(other));
        let made = match same {
            Some(_) => None,
            None => Some(recursion.keep()),
        };
        let to = same.or(made).unwrap_or(at);
        if to == at {
            steady = Some(at);
        }
        known.insert((at, kind), (arrows.len(), to));
        of_row.push(arrows.len());
        arrows.push(Arrow { from: at, kind, made });
        at = to;
    }
    Some((Schedule { arrows, of_row, covariances: recursion.covariances }, recursion.found))
}

/// The recursion of the covariance.
struct Recursion<'a> {
    model: &'a CovarianceModel,
    /// All covariances that were kept, one after the other.
    covariances: Vec<f64>,
    /// The covariance after the updates of the last step, its product with Φ, and the next covariance.
    updated: Vec<f64>,
    half: Vec<f64>,
    next: Vec<f64>,
    found: Gains,
}

impl<'a> Recursion<'a> {
    /// At the covariance with which segments begin.
    fn new(model: &'a CovarianceModel) -> Self {
        let zeros = vec![0.0; model.n * model.n];
        Self {
            model,
            covariances: model.initial.clone(),
            updated: zeros.clone(),
            half: zeros.clone(),
            next: zeros,
            found: Gains::default(),
        }
    }

    /// Keeps the next covariance. Returns its index.
    fn keep(&mut self) -> usize {
        self.covariances.extend_from_slice(&self.next);
        self.covariances.len() / self.next.len() - 1
    }

    /// Whether the next covariance is one that was kept.
    fn is_next(&self, other: usize) -> bool {
        let n = self.model.n;
        let kept = &self.covariances[other * n * n..(other + 1) * n * n];
        (0..n).all(|i| {
            (0..n).all(|j| {
                let scale = libm::sqrt((self.next[i * n + i] * self.next[j * n + j]).max(0.0));
                (self.next[i * n + j] - kept[i * n + j]).abs() <= CONVERGED * scale
            })
        })
    }

    /// The updates of one row, one output after the other, and the prediction of the next covariance.
    fn step(&mut self, from: usize, kind: RowKind) -> Option<()> {
        let n = self.model.n;
        let size = n * n;
        self.updated.copy_from_slice(&self.covariances[from * size..(from + 1) * size]);
        for (output, &sensor) in self.model.outputs.iter().enumerate() {
            let first = self.found.gains.len();
            self.found.gains.resize(first + n, 0.0);
            let variance = match kind.measured >> output & 1 {
                0 => 1.0,
                _ => CovarianceModel::update(&mut self.updated, sensor, &mut self.found.gains[first..])?,
            };
            self.found.variances.push(variance);
        }
        self.model.add_unknown_heat(kind, &mut self.updated);
        self.predict(kind.heat);
        Some(())
    }

    /// The next covariance Φ P Φᵀ + Q of symmetric P and Q.
    fn predict(&mut self, heat: usize) {
        let n = self.model.n;
        for (half, row) in self.half.chunks_mut(n).zip(self.model.transition.chunks(n)) {
            // P is symmetric: its rows are its columns.
            for (half, column) in half.iter_mut().zip(self.updated.chunks(n)) {
                *half = dot(row, column);
            }
        }
        for i in 0..n {
            for j in i..n {
                let row = &self.half[i * n..(i + 1) * n];
                let entry = self.model.noise[heat][i * n + j] + dot(row, &self.model.transition[j * n..(j + 1) * n]);
                (self.next[i * n + j], self.next[j * n + i]) = (entry, entry);
            }
        }
    }
}
