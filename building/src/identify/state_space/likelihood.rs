//! The log-likelihood of measurements under a linear model, by the Kalman filter:
//!
//! ```text
//! ℓ(θ) = −½ Σ (ln 2π S + v²/S)        v = y − x[output],   S = P[output, output] + r
//! ∂ℓ/∂θ_j  = −Σ v ∂v/S + ½ Σ (v²/S − 1) ∂S/S
//! I_jk     = Σ ∂_j v ∂_k v/S + ½ Σ ∂_j S ∂_k S/S²            (Fisher information, from the innovations)
//! ```
//!
//! Derivatives of the matrices are exact, by complex steps ([`super::exponential`]). Those of the states follow the filter's own
//! recursion.

use std::f64::consts::TAU;
use std::ops::Range;

use nalgebra::DMatrix;

use super::exponential::{INFINITESIMAL, Number, real};
use super::gains::{CovarianceModel, Gains, Measured, RowKind, Schedule, schedule};
use super::heat_rows::HeatRows;
use super::heat_timing::row_effects;
use super::linear_model::ContinuousModel;
use super::tangents::{StepMatrices, Tangents, derivative, value};

/// Measurements in rows. Each row has p outputs and m inputs.
#[derive(Debug, Clone)]
pub(super) struct Observations {
    /// Sampling time \[s\].
    pub step_s: f64,
    /// Rows that follow each other at the sampling time.
    pub segments: Vec<Range<usize>>,
    /// Outputs \[row · p + output\]; not a number (NaN) where one is missing.
    pub outputs: Vec<f64>,
    /// Inputs at each row \[row · m + input\].
    pub inputs: Vec<f64>,
    /// Their rates of change until the next row \[1/s\]; zero for inputs that are held.
    pub slopes: Vec<f64>,
    /// What is known of the timing of heat within each row.
    pub heat: HeatRows,
    /// p and m.
    pub widths: (usize, usize),
}

impl Observations {
    /// About the first `rows` rows of these observations.
    pub fn beginning(&self, rows: usize) -> Self {
        let mut left = rows;
        let mut segments = Vec::new();
        for segment in &self.segments {
            if left == 0 {
                break;
            }
            let end = segment.end.min(segment.start + left);
            left -= end - segment.start;
            segments.push(segment.start..end);
        }
        Self { segments, ..self.clone() }
    }

    /// All of these observations except about the first `rows` rows; a segment begins where all outputs are measured.
    pub fn ending(&self, rows: usize) -> Self {
        let p = self.widths.0;
        let mut left = rows;
        let mut segments = Vec::new();
        for segment in &self.segments {
            let skipped = left.min(segment.len());
            left -= skipped;
            let is_complete = |row: &usize| self.outputs[row * p..(row + 1) * p].iter().all(|y| y.is_finite());
            let first = (segment.start + skipped..segment.end).find(is_complete);
            segments.extend(first.filter(|first| first + 2 <= segment.end).map(|first| first..segment.end));
        }
        Self { segments, ..self.clone() }
    }
}

/// Log-likelihood with derivatives.
#[derive(Debug, Clone)]
pub(super) struct Evaluation {
    pub log_likelihood: f64,
    pub gradient: Vec<f64>,
    pub information: DMatrix<f64>,
}

/// What the filter found at each row.
#[derive(Debug, Clone, Default)]
pub(super) struct Filtered {
    /// Innovations v \[row · p + output\] \[K\]; NaN where there is none.
    pub innovations: Vec<f64>,
    /// The same divided by √S.
    pub standardised: Vec<f64>,
    /// States after the row's measurements \[row · n + state\].
    pub states: Vec<f64>,
}

/// From parameters to a model.
pub(super) type Parametrisation<'a> = dyn Fn(&[Number]) -> ContinuousModel + 'a;

/// The filter at one set of parameters.
struct Filter<'a> {
    observations: &'a Observations,
    model: ContinuousModel,
    matrices: StepMatrices,
    covariances: CovarianceModel,
    schedule: Schedule,
    gains: Gains,
    /// Logarithms of 2π S.
    logarithms: Vec<f64>,
    measured: Vec<Measured>,
}

impl<'a> Filter<'a> {
    fn new(model: ContinuousModel, observations: &'a Observations) -> Option<Self> {
        let sampled = model.sampled(observations.step_s)?;
        let measured = measured(observations, &model);
        let mut starts = vec![false; measured.len()];
        observations.segments.iter().for_each(|segment| starts[segment.start] = true);
        let effects = row_effects(&model, &sampled, &observations.heat, observations.step_s)?;
        let covariances = CovarianceModel::new(&model, &sampled, &effects);
        let rows: Vec<usize> = observations.segments.iter().flat_map(Clone::clone).collect();
        let kind = |row: usize| RowKind { measured: measured[row], heat: observations.heat.of_row[row] };
        let (kinds, starts): (Vec<_>, Vec<_>) = rows.iter().map(|&row| (kind(row), starts[row])).unzip();
        let (schedule, gains) = schedule(&covariances, &kinds, &starts)?;
        let logarithms = gains.variances.iter().map(|&variance| libm::log(TAU * variance)).collect();
        let matrices = StepMatrices::new(&sampled, &effects);
        Some(Self { observations, model, matrices, covariances, schedule, gains, logarithms, measured })
    }

    /// The derivatives by parameters, from one model with an infinitesimal change of each.
    fn tangents(&self, models: Vec<ContinuousModel>) -> Option<Tangents> {
        let Observations { step_s, heat, widths, .. } = self.observations;
        Tangents::new(models, (widths.1, *step_s), heat, &self.covariances, &self.schedule)
    }

    /// The state at the start of a segment, as `part` of the numbers of `model`.
    fn initial(&self, model: &ContinuousModel, start: usize, part: fn(Number) -> f64) -> Vec<f64> {
        let (p, m) = self.observations.widths;
        let initial = &model.initial;
        let outputs = &self.observations.outputs[start * p..(start + 1) * p];
        let inputs = &self.observations.inputs[start * m..(start + 1) * m];
        let state = |i: usize| {
            let measured = outputs.iter().enumerate().filter(|(_, y)| y.is_finite());
            let from_outputs = measured.fold(real(0.0), |sum, (k, &y)| sum + initial.from_outputs[(i, k)] * y);
            let from_inputs =
                inputs.iter().enumerate().fold(real(0.0), |sum, (k, &u)| sum + initial.from_inputs[(i, k)] * u);
            part(initial.offset[i] + from_outputs + from_inputs)
        };
        (0..self.matrices.n).map(state).collect()
    }

    /// Runs over all rows; the derivatives by the parameters of `tangents` are summed into `sums`.
    fn run(&self, tangents: &mut Tangents, sums: &mut Sums, mut visit: impl FnMut(usize, &[f64], &[(f64, f64)])) {
        let (p, m) = self.observations.widths;
        let mut arrows = self.schedule.of_row.iter();
        let mut found = vec![(f64::NAN, f64::NAN); p];
        let mut next = vec![0.0; self.matrices.n];
        for segment in &self.observations.segments {
            let mut x = self.initial(&self.model, segment.start, value);
            tangents.begin(|model| self.initial(model, segment.start, derivative));
            for row in segment.clone() {
                let Some(&arrow) = arrows.next() else { return };
                found.fill((f64::NAN, f64::NAN));
                for output in (0..p).filter(|output| self.measured[row] >> output & 1 == 1) {
                    found[output] = self.update((row, arrow, output), &mut x, tangents, sums);
                }
                if sums.keeps_rows {
                    let Sums { rows, gradient, .. } = &mut *sums;
                    rows.extend_from_slice(gradient);
                }
                visit(row, &x, &found);
                let u = &self.observations.inputs[row * m..(row + 1) * m];
                let slope = &self.observations.slopes[row * m..(row + 1) * m];
                let heat = self.observations.heat.of_row[row];
                tangents.advance(&self.matrices, &x, (u, slope), heat);
                next.copy_from_slice(self.matrices.shift(heat));
                self.matrices.add_states(&mut next, &x);
                self.matrices.add_inputs(&mut next, u, slope);
                x.copy_from_slice(&next);
            }
        }
    }

    /// The update of the state and its derivatives by one output. Returns innovation and variance.
    fn update(
        &self,
        (row, arrow, output): (usize, usize, usize),
        x: &mut [f64],
        tangents: &mut Tangents,
        sums: &mut Sums,
    ) -> (f64, f64) {
        let n = self.matrices.n;
        let state = self.model.outputs[output];
        let innovation = self.observations.outputs[row * self.observations.widths.0 + output] - x[state];
        let which = arrow * self.observations.widths.0 + output;
        let variance = self.gains.variances[which];
        let gain = &self.gains.gains[which * n..(which + 1) * n];
        sums.log_likelihood -= 0.5 * (self.logarithms[which] + innovation * innovation / variance);
        let (of_innovation, of_variance) = tangents.update(which, state, gain, innovation);
        sums.add((innovation, variance), of_innovation, of_variance);
        x.iter_mut().zip(gain).for_each(|(x, gain)| *x += gain * innovation);
        (innovation, variance)
    }
}

/// Which outputs count at each row.
fn measured(observations: &Observations, model: &ContinuousModel) -> Vec<Measured> {
    let (p, _) = observations.widths;
    let there = |row: &[f64]| {
        row.iter().enumerate().filter(|(_, y)| y.is_finite()).fold(0, |bits, (output, _)| bits | 1 << output)
    };
    let mut measured: Vec<Measured> = observations.outputs.chunks(p).map(there).collect();
    if model.initial.contains_first_outputs {
        observations.segments.iter().for_each(|segment| measured[segment.start] = 0);
    }
    measured
}

struct Sums {
    log_likelihood: f64,
    gradient: Vec<f64>,
    /// Lower triangle of the information, row by row.
    information: Vec<f64>,
    /// ∂S/S of the innovation at hand.
    relative: Vec<f64>,
    /// Whether the gradient is kept after each row, and what was kept.
    keeps_rows: bool,
    rows: Vec<f64>,
}

impl Sums {
    fn new(parameters: usize) -> Self {
        Self {
            log_likelihood: 0.0,
            gradient: vec![0.0; parameters],
            information: vec![0.0; parameters * parameters],
            relative: vec![0.0; parameters],
            keeps_rows: false,
            rows: Vec::new(),
        }
    }

    /// Adds an innovation v of variance S, with ∂v and ∂S.
    fn add(&mut self, (innovation, variance): (f64, f64), of_innovation: &[f64], of_variance: &[f64]) {
        let (weight, excess) = (1.0 / variance, innovation * innovation / variance - 1.0);
        self.relative.iter_mut().zip(of_variance).for_each(|(relative, ds)| *relative = ds * weight);
        let parameters = self.gradient.len();
        for (j, gradient) in self.gradient.iter_mut().enumerate() {
            let (dv, relative) = (of_innovation[j] * weight, self.relative[j]);
            *gradient += 0.5 * excess * relative - innovation * dv;
            let row = &mut self.information[j * parameters..j * parameters + j + 1];
            for ((entry, other_dv), other_relative) in row.iter_mut().zip(of_innovation).zip(&self.relative) {
                *entry += dv * other_dv + 0.5 * relative * other_relative;
            }
        }
    }

    /// The information, both triangles.
    fn information(&self) -> DMatrix<f64> {
        let parameters = self.gradient.len();
        DMatrix::from_fn(parameters, parameters, |j, k| self.information[j.max(k) * parameters + j.min(k)])
    }
}

/// The log-likelihood at θ; `None` where the model has none.
pub(super) fn log_likelihood(model: &Parametrisation, theta: &[f64], observations: &Observations) -> Option<f64> {
    let filter = Filter::new(model(&numbers(theta)), observations)?;
    let mut sums = Sums::new(0);
    filter.run(&mut filter.tangents(Vec::new())?, &mut sums, |_, _, _| {});
    Some(sums.log_likelihood).filter(|sum| sum.is_finite())
}

/// The log-likelihood at θ with gradient and Fisher information; `None` where the model has none.
pub(super) fn evaluate(model: &Parametrisation, theta: &[f64], observations: &Observations) -> Option<Evaluation> {
    let filter = Filter::new(model(&numbers(theta)), observations)?;
    let mut tangents =
        filter.tangents((0..theta.len()).map(|parameter| model(&changed(theta, parameter))).collect())?;
    let mut sums = Sums::new(theta.len());
    filter.run(&mut tangents, &mut sums, |_, _, _| {});
    let information = sums.information();
    let is_finite = sums.log_likelihood.is_finite() && information.iter().all(|entry| entry.is_finite());
    let (log_likelihood, gradient) = (sums.log_likelihood, sums.gradient);
    is_finite.then_some(Evaluation { log_likelihood, gradient, information })
}

/// ∂ℓ/∂θ of each row \[row · k + parameter\] at θ, with k parameters; zero where nothing is measured. `None` where the model has
/// none.
pub(super) fn scores(model: &Parametrisation, theta: &[f64], observations: &Observations) -> Option<Vec<f64>> {
    let filter = Filter::new(model(&numbers(theta)), observations)?;
    let mut tangents =
        filter.tangents((0..theta.len()).map(|parameter| model(&changed(theta, parameter))).collect())?;
    let count = theta.len();
    let mut sums = Sums { keeps_rows: true, ..Sums::new(count) };
    let mut rows = vec![0.0; observations.outputs.len() / observations.widths.0 * count];
    let mut order = Vec::new();
    filter.run(&mut tangents, &mut sums, |row, _, _| order.push(row));
    let mut before = vec![0.0; count];
    for (row, after) in order.into_iter().zip(sums.rows.chunks_exact(count)) {
        for (j, slot) in rows[row * count..(row + 1) * count].iter_mut().enumerate() {
            *slot = after[j] - before[j];
        }
        before.copy_from_slice(after);
    }
    Some(rows)
}

/// Innovations and states at θ; `None` where the model has none.
pub(super) fn filter(model: &Parametrisation, theta: &[f64], observations: &Observations) -> Option<Filtered> {
    let filter = Filter::new(model(&numbers(theta)), observations)?;
    let (p, _) = observations.widths;
    let n = filter.matrices.n;
    let rows = observations.outputs.len() / p;
    let mut filtered = Filtered {
        innovations: vec![f64::NAN; rows * p],
        standardised: vec![f64::NAN; rows * p],
        states: vec![f64::NAN; rows * n],
    };
    filter.run(&mut filter.tangents(Vec::new())?, &mut Sums::new(0), |row, x, found| {
        filtered.states[row * n..(row + 1) * n].copy_from_slice(x);
        for (output, &(innovation, variance)) in found.iter().enumerate() {
            filtered.innovations[row * p + output] = innovation;
            filtered.standardised[row * p + output] = innovation / libm::sqrt(variance);
        }
    });
    Some(filtered)
}

/// θ as numbers without infinitesimal parts.
pub(super) fn numbers(theta: &[f64]) -> Vec<Number> {
    theta.iter().map(|&value| real(value)).collect()
}

/// θ with an infinitesimal change of one parameter.
pub(super) fn changed(theta: &[f64], parameter: usize) -> Vec<Number> {
    let mut numbers = numbers(theta);
    numbers[parameter].im = INFINITESIMAL;
    numbers
}
