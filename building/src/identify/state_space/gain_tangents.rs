//! The derivatives of a filter's gains by all parameters, side by side: the parameter is the last index of every array.
//!
//! ```text
//! update      dS = dP_ss + dr,   dK = (dP_s − K dS)/S,   dP_ij ← dP_ij − dP_is K_j − K_i dP_js + K_i K_j dS
//! prediction  dP ← Φ dP Φᵀ + dΦ P Φᵀ + Φ P dΦᵀ + dQ
//! ```

use super::gains::{Arrow, CovarianceModel, Schedule};
use super::tangents::add;

/// The derivatives by k parameters of what the covariances are made of. Arrays end with k numbers for each entry.
pub(super) struct CovarianceTangents {
    pub count: usize,
    /// ∂Φ, row by row.
    pub transition: Vec<f64>,
    /// ∂ of the covariance of the random part of a step, for each class of heat.
    pub noise: Vec<Vec<f64>>,
    /// ∂r of each output.
    pub sensor: Vec<f64>,
    /// ∂ of the variance of each state at the start of a segment.
    pub initial: Vec<f64>,
}

/// The derivatives of gains and variances along each arrow, in the order of [`super::gains::Gains`].
pub(super) fn follow(
    schedule: &Schedule,
    model: &CovarianceModel,
    tangents: &CovarianceTangents,
) -> (Vec<f64>, Vec<f64>) {
    let (n, k) = (model.n, tangents.count);
    let mut follower = Follower::new(model, tangents);
    let arrows = schedule.arrow_count();
    let (mut gains, mut variances) = (vec![0.0; arrows * model.outputs.len() * n * k], Vec::new());
    variances.resize(arrows * model.outputs.len() * k, 0.0);
    let of_arrow = gains
        .chunks_mut((model.outputs.len() * n * k).max(1))
        .zip(variances.chunks_mut((model.outputs.len() * k).max(1)));
    for (arrow, (gains, variances)) in schedule.arrows.iter().zip(of_arrow) {
        follower.step(schedule, arrow, gains, variances);
    }
    (gains, variances)
}

struct Follower<'a> {
    model: &'a CovarianceModel,
    tangents: &'a CovarianceTangents,
    /// Derivatives of all covariances that were kept, one after the other.
    kept: Vec<f64>,
    /// P and ∂P after the updates of the arrow at hand.
    covariance: Vec<f64>,
    change: Vec<f64>,
    /// Φ P, and its derivative.
    half: Vec<f64>,
    half_change: Vec<f64>,
    gain: Vec<f64>,
    column: Vec<f64>,
}

impl<'a> Follower<'a> {
    fn new(model: &'a CovarianceModel, tangents: &'a CovarianceTangents) -> Self {
        let (n, k) = (model.n, tangents.count);
        let mut kept = vec![0.0; n * n * k];
        for i in 0..n {
            let entry = (i * n + i) * k;
            kept[entry..entry + k].copy_from_slice(&tangents.initial[i * k..(i + 1) * k]);
        }
        Self {
            model,
            tangents,
            kept,
            covariance: vec![0.0; n * n],
            change: vec![0.0; n * n * k],
            half: vec![0.0; n * n],
            half_change: vec![0.0; n * n * k],
            gain: vec![0.0; n],
            column: vec![0.0; n * k],
        }
    }

    fn step(&mut self, schedule: &Schedule, arrow: &Arrow, gains: &mut [f64], variances: &mut [f64]) {
        let (n, k) = (self.model.n, self.tangents.count);
        let size = n * n;
        self.covariance.copy_from_slice(&schedule.covariances[arrow.from * size..(arrow.from + 1) * size]);
        self.change.copy_from_slice(&self.kept[arrow.from * size * k..(arrow.from + 1) * size * k]);
        for output in (0..self.model.outputs.len()).filter(|output| arrow.kind.measured >> output & 1 == 1) {
            let variance = &mut variances[output * k..(output + 1) * k];
            self.update(output, &mut gains[output * n * k..(output + 1) * n * k], variance);
        }
        if arrow.made.is_some() {
            self.model.add_unknown_heat(arrow.kind, &mut self.covariance);
            self.predict(arrow.kind.heat);
        }
    }

    /// The update by one output, with the derivatives of its gain and variance.
    fn update(&mut self, output: usize, of_gain: &mut [f64], of_variance: &mut [f64]) {
        let (n, k) = (self.model.n, self.tangents.count);
        let (state, sensor) = self.model.outputs[output];
        let change = &mut self.change;
        for i in 0..n {
            let entry = (i * n + state) * k;
            self.column[i * k..(i + 1) * k].copy_from_slice(&change[entry..entry + k]);
        }
        // The schedule of these arrows was built, so their variances are positive.
        let variance =
            CovarianceModel::update(&mut self.covariance, (state, sensor), &mut self.gain).unwrap_or(f64::INFINITY);
        of_variance.copy_from_slice(&self.tangents.sensor[output * k..(output + 1) * k]);
        add(of_variance, 1.0, &self.column[state * k..(state + 1) * k]);
        for i in 0..n {
            let slot = &mut of_gain[i * k..(i + 1) * k];
            add(slot, 1.0 / variance, &self.column[i * k..(i + 1) * k]);
            add(slot, -self.gain[i] / variance, of_variance);
        }
        for i in 0..n {
            for j in i..n {
                let slot = &mut change[(i * n + j) * k..(i * n + j + 1) * k];
                add(slot, -self.gain[j], &self.column[i * k..(i + 1) * k]);
                add(slot, -self.gain[i], &self.column[j * k..(j + 1) * k]);
                add(slot, self.gain[i] * self.gain[j], of_variance);
                if i != j {
                    change.copy_within((i * n + j) * k..(i * n + j + 1) * k, (j * n + i) * k);
                }
            }
        }
    }

    /// The derivative of the next covariance, which is kept.
    fn predict(&mut self, heat: usize) {
        let (n, k) = (self.model.n, self.tangents.count);
        let entry = |matrix: usize, i: usize, j: usize| matrix + (i * n + j) * k..matrix + (i * n + j + 1) * k;
        self.half_change.fill(0.0);
        for i in 0..n {
            for j in 0..n {
                let slot = &mut self.half_change[entry(0, i, j)];
                let mut half = 0.0;
                for l in 0..n {
                    let transition = self.model.transition[i * n + l];
                    half += transition * self.covariance[l * n + j];
                    add(slot, transition, &self.change[entry(0, l, j)]);
                    add(slot, self.covariance[l * n + j], &self.tangents.transition[entry(0, i, l)]);
                }
                self.half[i * n + j] = half;
            }
        }
        let first = self.kept.len();
        self.kept.extend_from_slice(&self.tangents.noise[heat]);
        for i in 0..n {
            for j in i..n {
                let slot = &mut self.kept[entry(first, i, j)];
                for l in 0..n {
                    add(slot, self.model.transition[j * n + l], &self.half_change[entry(0, i, l)]);
                    add(slot, self.half[i * n + l], &self.tangents.transition[entry(0, j, l)]);
                }
                if i != j {
                    self.kept.copy_within(entry(first, i, j), entry(first, j, i).start);
                }
            }
        }
    }
}
