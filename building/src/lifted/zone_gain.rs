//! The first block of G, h₁: the effect of a kilowatt into each zone on the zones within a step.

use nalgebra::{Cholesky, DVector, Dyn};

use crate::discretise::{Gain, Model};

/// Solves with the symmetric positive definite h₁.
#[derive(Clone, Debug)]
pub(super) enum ZoneGain {
    Diagonal(Vec<f64>),
    Factor(Cholesky<f64, Dyn>),
    /// By conjugate gradients: h₁ is known by its products only.
    Products,
}

impl ZoneGain {
    pub(super) fn compute(model: &Model) -> Self {
        let zones = model.network().zone_count();
        match model.gain() {
            Gain::Diagonal(diagonal) => Self::Diagonal(diagonal[..zones].to_vec()),
            Gain::Dense(matrix) => {
                let block = matrix.view((0, 0), (zones, zones)).into_owned();
                Cholesky::new(block).map_or(Self::Products, Self::Factor)
            }
            Gain::Series(_) => Self::Products,
        }
    }

    pub(super) fn solve(&self, model: &Model, y: &[f64]) -> Vec<f64> {
        match self {
            Self::Diagonal(diagonal) => y.iter().zip(diagonal).map(|(y, d)| y / d).collect(),
            Self::Factor(factor) => factor.solve(&DVector::from_column_slice(y)).data.into(),
            Self::Products => conjugate_gradients(model, y),
        }
    }
}

/// Solves h₁ x = y to rounding error. h₁ is h/c for a zone left alone, and that times φ₁(h·rate) otherwise, so it is well
/// conditioned for any step that a controller would use.
fn conjugate_gradients(model: &Model, y: &[f64]) -> Vec<f64> {
    const RELATIVE_RESIDUAL: f64 = 1e-14;
    let nodes = model.network().node_count();
    let product = |x: &[f64]| {
        let mut padded = vec![0.0; nodes];
        padded[..x.len()].copy_from_slice(x);
        model.gain_product(&padded)
    };
    let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
    let mut x = vec![0.0; y.len()];
    let mut residual = y.to_vec();
    let mut direction = residual.clone();
    let mut squared = dot(&residual, &residual);
    let enough = RELATIVE_RESIDUAL * RELATIVE_RESIDUAL * squared;
    for _ in 0..2 * y.len() + 10 {
        if squared <= enough {
            break;
        }
        let image = product(&direction);
        let length = squared / dot(&direction, &image);
        for i in 0..x.len() {
            x[i] += length * direction[i];
            residual[i] -= length * image[i];
        }
        let before = std::mem::replace(&mut squared, dot(&residual, &residual));
        for (direction, residual) in direction.iter_mut().zip(&residual) {
            *direction = residual + squared / before * *direction;
        }
    }
    x
}
