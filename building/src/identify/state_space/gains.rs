//! The covariances of a Kalman filter, which depend on which outputs are there and not on their values.
//!
//! Rows of which the same outputs are measured follow each other for long, and then the covariance converges. So the filter's
//! covariances form a graph: from each one, a set of measured outputs leads to the next. A covariance that no longer changes
//! leads to itself. The graph is built once for the parameters at hand; the derivatives by each parameter follow its arrows
//! in the same order.

use std::collections::BTreeMap;

use nalgebra::DMatrix;

use super::exponential::{Number, product, real};
use super::linear_model::{ContinuousModel, SampledModel};

/// A covariance has converged if no entry changes by more than this share of its scale √(P_ii P_jj) in a step.
const CONVERGED: f64 = 1e-12;

/// Which outputs of a row are measured, one bit each.
pub(super) type Measured = u32;

/// The most outputs that a [`Measured`] can tell apart.
pub(super) const MOST_OUTPUTS: usize = 32;

/// What the filter does with one row: a gain and a variance for each output, in order; outputs that are missing have a gain of
/// zero.
#[derive(Debug, Clone)]
pub(super) struct RowGain {
    /// K, n numbers an output, one output after the other.
    pub gains: Vec<Number>,
    /// S, variance of each innovation \[K²\].
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
    /// The arrow of each row.
    pub of_row: Vec<usize>,
}

/// Builds the schedule of the rows `measured`, whose segments begin at `starts`, and the gain of each arrow.
///
/// `None` if a variance is not positive.
pub(super) fn schedule(
    model: &ContinuousModel,
    sampled: &SampledModel,
    measured: &[Measured],
    starts: &[bool],
) -> Option<(Schedule, Vec<RowGain>)> {
    let mut covariances = vec![initial(model)];
    let (mut arrows, mut gains): (Vec<Arrow>, Vec<RowGain>) = (Vec::new(), Vec::new());
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
        let (gain, next) = step(model, sampled, &covariances[at], outputs)?;
        let same = [Some(at), steady].into_iter().flatten().find(|&other| is_same(&next, &covariances[other]));
        let made = match same {
            Some(_) => None,
            None => {
                covariances.push(next);
                Some(covariances.len() - 1)
            }
        };
        let to = same.or(made).unwrap_or(at);
        if to == at {
            steady = Some(at);
        }
        known.insert((at, outputs), (arrows.len(), to));
        of_row.push(arrows.len());
        arrows.push(Arrow { from: at, measured: outputs, made });
        gains.push(gain);
        at = to;
    }
    Some((Schedule { arrows, of_row }, gains))
}

/// The gains of the same arrows for another model, such as one with an infinitesimal change of a parameter.
pub(super) fn follow(schedule: &Schedule, model: &ContinuousModel, sampled: &SampledModel) -> Option<Vec<RowGain>> {
    let mut covariances = Vec::with_capacity(schedule.arrows.len() + 1);
    covariances.push(initial(model));
    let mut gains = Vec::with_capacity(schedule.arrows.len());
    for arrow in &schedule.arrows {
        let (gain, next) = step(model, sampled, &covariances[arrow.from], arrow.measured)?;
        if arrow.made.is_some() {
            covariances.push(next);
        }
        gains.push(gain);
    }
    Some(gains)
}

fn initial(model: &ContinuousModel) -> DMatrix<Number> {
    DMatrix::from_diagonal(&model.initial.variance.clone().into())
}

fn is_same(one: &DMatrix<Number>, other: &DMatrix<Number>) -> bool {
    let n = one.nrows();
    (0..n).all(|i| {
        (0..n).all(|j| {
            let scale = libm::sqrt((one[(i, i)].re * one[(j, j)].re).max(0.0));
            (one[(i, j)].re - other[(i, j)].re).abs() <= CONVERGED * scale
        })
    })
}

/// The updates of one row, one output after the other, and the prediction of the next covariance.
fn step(
    model: &ContinuousModel,
    sampled: &SampledModel,
    before: &DMatrix<Number>,
    measured: Measured,
) -> Option<(RowGain, DMatrix<Number>)> {
    let n = before.nrows();
    let mut covariance = before.clone();
    let mut row =
        RowGain { gains: vec![real(0.0); n * model.outputs.len()], variances: vec![real(1.0); model.outputs.len()] };
    for (index, &state) in model.outputs.iter().enumerate().filter(|(index, _)| measured >> index & 1 == 1) {
        let variance = covariance[(state, state)] + model.sensor_variance[index];
        if !variance.re.is_finite() || variance.re <= 0.0 {
            return None;
        }
        let inverse = real(1.0) / variance;
        let gain = &mut row.gains[index * n..(index + 1) * n];
        for i in 0..n {
            gain[i] = covariance[(i, state)] * inverse;
        }
        // Column `state` of the covariance is the gain times the variance.
        for j in 0..n {
            let weight = gain[j] * variance;
            for i in 0..=j {
                covariance[(i, j)] -= gain[i] * weight;
            }
        }
        mirror(&mut covariance);
        row.variances[index] = variance;
    }
    Some((row, predicted(&sampled.transition, &covariance, &sampled.noise)))
}

/// Φ P Φᵀ + Q of symmetric P and Q.
fn predicted(transition: &DMatrix<Number>, covariance: &DMatrix<Number>, noise: &DMatrix<Number>) -> DMatrix<Number> {
    let n = covariance.nrows();
    let half = product(transition, covariance);
    let mut next = noise.clone();
    for j in 0..n {
        for i in 0..=j {
            for k in 0..n {
                next[(i, j)] += half[(i, k)] * transition[(j, k)];
            }
        }
    }
    mirror(&mut next);
    next
}

/// Copies the upper triangle to the lower one.
fn mirror(matrix: &mut DMatrix<Number>) {
    for j in 0..matrix.ncols() {
        for i in 0..j {
            matrix[(j, i)] = matrix[(i, j)];
        }
    }
}
