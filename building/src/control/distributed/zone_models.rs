//! The model that each zone has before the first message: its responses and the curvature of the common cost.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::messages::Messages;
use crate::comfort::Targets;
use crate::control::BandPenalty;
use crate::lifted::Lifted;

/// Smallest response of a zone that counts in another zone's curvature, as a share of that zone's own response.
const MIN_RESPONSE_RATIO: f64 = 1e-6;
/// The models of all zones: the effect of a kilowatt of each zone, and the largest curvature of the common cost in its
/// inputs, without the bounds near it.
#[derive(Clone, Debug)]
pub(super) struct ZoneModels {
    pub zones: Vec<Zone>,
}

/// What one zone knows beforehand.
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
