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
    /// K, one vector of n an output.
    pub gains: Vec<Vec<Number>>,
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
    let mut covariances = vec![initial(model)];
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
    let mut row = RowGain { gains: Vec::new(), variances: Vec::new() };
    for (index, &state) in model.outputs.iter().enumerate() {
        if measured >> index & 1 == 0 {
            row.gains.push(vec![real(0.0); n]);
            row.variances.push(real(1.0));
            continue;
        }
        let variance = covariance[(state, state)] + model.sensor_variance[index];
        if !(variance.re > 0.0) || !variance.re.is_finite() {
            return None;
        }
        let column: Vec<Number> = (0..n).map(|i| covariance[(i, state)]).collect();
        let gain: Vec<Number> = column.iter().map(|entry| entry / variance).collect();
        for i in 0..n {
            for j in 0..n {
                covariance[(i, j)] -= gain[i] * column[j];
            }
        }
        row.gains.push(gain);
        row.variances.push(variance);
    }
    let transition = &sampled.transition;
    let next = product(&product(transition, &covariance), &transition.transpose()) + &sampled.noise;
    Some((row, next))
}
