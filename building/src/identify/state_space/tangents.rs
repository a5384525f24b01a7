//! The derivatives of a filter by all parameters, side by side: the parameter is the last index of every array, so that a loop over
//! the parameters goes straight through memory.

use nalgebra::DMatrix;

use super::exponential::{INFINITESIMAL, Number};
use super::gain_tangents::{CovarianceTangents, add, follow};
use super::gains::{CovarianceModel, Schedule};
use super::heat_rows::HeatRows;
use super::heat_timing::{RowEffect, row_effects};
use super::linear_model::{ContinuousModel, SampledModel};
use crate::staged::dense::dot;

/// The real part.
pub(super) fn value(number: Number) -> f64 {
    number.re
}

/// The infinitesimal part, per unit.
pub(super) fn derivative(number: Number) -> f64 {
    number.im / INFINITESIMAL
}

/// Real matrices of a step, row by row.
pub(super) struct StepMatrices {
    pub n: usize,
    m: usize,
    transition: Vec<f64>,
    gain: Vec<f64>,
    slope_gain: Vec<f64>,
    /// The shift of the states by each class of heat, n numbers a class.
    shifts: Vec<f64>,
}

impl StepMatrices {
    pub fn new(sampled: &SampledModel, effects: &[RowEffect]) -> Self {
        let rows = |matrix: &DMatrix<Number>| matrix.transpose().iter().map(|entry| value(*entry)).collect();
        Self {
            n: sampled.transition.nrows(),
            m: sampled.gain.ncols(),
            transition: rows(&sampled.transition),
            gain: rows(&sampled.gain),
            slope_gain: rows(&sampled.slope_gain),
            shifts: effects.iter().flat_map(|effect| &effect.shift).map(|entry| value(*entry)).collect(),
        }
    }

    /// The shift of the states by a class of heat.
    pub fn shift(&self, heat: usize) -> &[f64] {
        &self.shifts[heat * self.n..(heat + 1) * self.n]
    }

    /// Adds the effect of the states: out += Φ x.
    pub fn add_states(&self, out: &mut [f64], x: &[f64]) {
        for (out, row) in out.iter_mut().zip(self.transition.chunks(self.n)) {
            *out += dot(row, x);
        }
    }

    /// Adds the effect of the inputs: out += Γ₀ u + Γ₁ u'.
    pub fn add_inputs(&self, out: &mut [f64], u: &[f64], slope: &[f64]) {
        if self.m > 0 {
            let rows = self.gain.chunks(self.m).zip(self.slope_gain.chunks(self.m));
            for (out, (gain, slope_gain)) in out.iter_mut().zip(rows) {
                *out += dot(gain, u) + dot(slope_gain, slope);
            }
        }
    }
}

/// The derivatives by k parameters. Arrays end with k numbers for each entry.
pub(super) struct Tangents {
    count: usize,
    /// Of each parameter, the model with an infinitesimal change of it.
    models: Vec<ContinuousModel>,
    /// ∂Φ, ∂Γ₀ and ∂Γ₁, row by row.
    transition: Vec<f64>,
    gain: Vec<f64>,
    slope_gain: Vec<f64>,
    /// Derivatives of the shifts by each class of heat.
    shifts: Vec<f64>,
    /// ∂K and ∂S along each arrow, as in [`super::gains::Gains`].
    gains: Vec<f64>,
    variances: Vec<f64>,
    /// ∂x, and ∂x of the next row.
    states: Vec<f64>,
    next: Vec<f64>,
    /// ∂v of the innovation at hand.
    innovation: Vec<f64>,
}

impl Tangents {
    /// The derivatives of these models with m inputs; `None` if one of the models cannot be sampled.
    pub fn new(
        models: Vec<ContinuousModel>,
        (m, step_s): (usize, f64),
        heat: &HeatRows,
        base: &CovarianceModel,
        schedule: &Schedule,
    ) -> Option<Self> {
        let count = models.len();
        let n = base.n;
        let zeros = |entries: usize| vec![0.0; entries * count];
        let mut tangents = Self {
            count,
            transition: zeros(n * n),
            gain: zeros(n * m),
            slope_gain: zeros(n * m),
            shifts: zeros(n * base.noise.len()),
            gains: Vec::new(),
            variances: Vec::new(),
            states: zeros(n),
            next: zeros(n),
            innovation: zeros(1),
            models: Vec::new(),
        };
        let mut covariances = CovarianceTangents {
            count,
            transition: Vec::new(),
            noise: vec![zeros(n * n); base.noise.len()],
            sensor: zeros(base.outputs.len()),
            initial: zeros(n),
        };
        for (parameter, model) in models.iter().enumerate() {
            let sampled = model.sampled(step_s)?;
            let effects = row_effects(model, &sampled, heat, step_s)?;
            let put = |array: &mut [f64], numbers: &mut dyn Iterator<Item = &Number>| {
                // `skip` instead of a slice: an array without entries has no parameters either.
                array
                    .iter_mut()
                    .skip(parameter)
                    .step_by(count)
                    .zip(numbers)
                    .for_each(|(slot, it)| *slot = derivative(*it));
            };
            put(&mut tangents.transition, &mut sampled.transition.transpose().iter());
            put(&mut tangents.gain, &mut sampled.gain.transpose().iter());
            put(&mut tangents.slope_gain, &mut sampled.slope_gain.transpose().iter());
            put(&mut tangents.shifts, &mut effects.iter().flat_map(|effect| &effect.shift));
            for (noise, effect) in covariances.noise.iter_mut().zip(&effects) {
                put(noise, &mut effect.noise.iter());
            }
            put(&mut covariances.sensor, &mut model.sensor_variance.iter());
            put(&mut covariances.initial, &mut model.initial.variance.iter());
        }
        covariances.transition.clone_from(&tangents.transition);
        if count > 0 {
            (tangents.gains, tangents.variances) = follow(schedule, base, &covariances);
        }
        Some(Self { models, ..tangents })
    }

    /// Begins a segment: `initial` gives ∂x of a model.
    pub fn begin(&mut self, initial: impl Fn(&ContinuousModel) -> Vec<f64>) {
        for (parameter, model) in self.models.iter().enumerate() {
            let slots = self.states[parameter..].iter_mut().step_by(self.count);
            slots.zip(initial(model)).for_each(|(slot, value)| *slot = value);
        }
    }

    /// Advances the derivatives of the states by a step with inputs u and u', and a class of heat: ∂x ← Φ ∂x + ∂Φ x + ∂Γ₀ u +
    /// ∂Γ₁ u' + the derivative of the class's shift.
    pub fn advance(&mut self, matrices: &StepMatrices, x: &[f64], (u, slope): (&[f64], &[f64]), heat: usize) {
        let (n, m, count) = (matrices.n, u.len(), self.count);
        if count == 0 {
            return;
        }
        let of = |entry: usize| entry * count..(entry + 1) * count;
        for (i, next) in self.next.chunks_exact_mut(count).enumerate() {
            next.copy_from_slice(&self.shifts[of(heat * n + i)]);
            for j in 0..n {
                add(next, matrices.transition[i * n + j], &self.states[of(j)]);
                add(next, x[j], &self.transition[of(i * n + j)]);
            }
            for j in 0..m {
                add(next, u[j], &self.gain[of(i * m + j)]);
                add(next, slope[j], &self.slope_gain[of(i * m + j)]);
            }
        }
        std::mem::swap(&mut self.states, &mut self.next);
    }

    /// Updates ∂x with the innovation of a measured state, and its gain. `which` is the index of the innovation in ∂S. Returns ∂v and ∂S.
    pub fn update(&mut self, which: usize, state: usize, gain: &[f64], innovation: f64) -> (&[f64], &[f64]) {
        let (n, count) = (gain.len(), self.count);
        let observed = &self.states[state * count..(state + 1) * count];
        self.innovation.iter_mut().zip(observed).for_each(|(dv, dx)| *dv = -dx);
        for (i, gain) in gain.iter().enumerate() {
            let dx = &mut self.states[i * count..(i + 1) * count];
            add(dx, *gain, &self.innovation);
            let entry = which * n + i;
            add(dx, innovation, &self.gains[entry * count..(entry + 1) * count]);
        }
        (&self.innovation, &self.variances[which * count..(which + 1) * count])
    }
}
