//! The derivatives of a filter's gains by all parameters, side by side: the parameter is the last index of every array.
//!
//! ```text
//! update      dS = dP_ss + dr,   dK = (dP_s − K dS)/S,   dP_ij ← dP_ij − dP_is K_j − K_i dP_js + K_i K_j dS
//! prediction  dP ← Φ dP Φᵀ + dΦ P Φᵀ + Φ P dΦᵀ + dQ
//! ```

use super::gains::{Arrow, CovarianceModel, Schedule};

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
    let last_use = last_uses(schedule);
    for (index, (arrow, (gains, variances))) in schedule.arrows.iter().zip(of_arrow).enumerate() {
        follower.step(schedule, arrow, gains, variances);
        if last_use[arrow.from] == index {
            follower.kept[arrow.from] = Vec::new();
        }
    }
    (gains, variances)
}

/// The last arrow that begins at each covariance: its derivatives are needed no longer afterwards.
fn last_uses(schedule: &Schedule) -> Vec<usize> {
    let made = schedule.arrows.iter().filter_map(|arrow| arrow.made).max().map_or(1, |last| last + 1);
    let mut last = vec![usize::MAX; made];
    schedule.arrows.iter().enumerate().for_each(|(index, arrow)| last[arrow.from] = index);
    last
}

/// out += factor · numbers.
pub(super) fn add(out: &mut [f64], factor: f64, numbers: &[f64]) {
    out.iter_mut().zip(numbers).for_each(|(out, number)| *out += factor * number);
}

struct Follower<'a> {
    model: &'a CovarianceModel,
    tangents: &'a CovarianceTangents,
    /// Derivatives of each covariance that was kept; empty where they are needed no longer.
    kept: Vec<Vec<f64>>,
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
        let mut first = vec![0.0; n * n * k];
        for i in 0..n {
            let entry = (i * n + i) * k;
            first[entry..entry + k].copy_from_slice(&tangents.initial[i * k..(i + 1) * k]);
        }
        Self {
            model,
            tangents,
            kept: vec![first],
            covariance: vec![0.0; n * n],
            change: vec![0.0; n * n * k],
            half: vec![0.0; n * n],
            half_change: vec![0.0; n * n * k],
            gain: vec![0.0; n],
            column: vec![0.0; n * k],
        }
    }

    fn step(&mut self, schedule: &Schedule, arrow: &Arrow, gains: &mut [f64], variances: &mut [f64]) {
        let (n, k, size) = (self.model.n, self.tangents.count, self.model.n * self.model.n);
        self.covariance.copy_from_slice(&schedule.covariances[arrow.from * size..(arrow.from + 1) * size]);
        self.change.copy_from_slice(&self.kept[arrow.from]);
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
        let entry = |i: usize, j: usize| (i * n + j) * k..(i * n + j + 1) * k;
        self.half_change.fill(0.0);
        for i in 0..n {
            for j in 0..n {
                let slot = &mut self.half_change[entry(i, j)];
                let mut half = 0.0;
                for l in 0..n {
                    let transition = self.model.transition[i * n + l];
                    half += transition * self.covariance[l * n + j];
                    add(slot, transition, &self.change[entry(l, j)]);
                    add(slot, self.covariance[l * n + j], &self.tangents.transition[entry(i, l)]);
                }
                self.half[i * n + j] = half;
            }
        }
        let mut next = self.tangents.noise[heat].clone();
        for i in 0..n {
            for j in i..n {
                let slot = &mut next[entry(i, j)];
                for l in 0..n {
                    add(slot, self.model.transition[j * n + l], &self.half_change[entry(i, l)]);
                    add(slot, self.half[i * n + l], &self.tangents.transition[entry(j, l)]);
                }
                if i != j {
                    next.copy_within(entry(i, j), entry(j, i).start);
                }
            }
        }
        self.kept.push(next);
    }
}

#[cfg(test)]
mod tests {
    use crate::identify::state_space::elements::{Extension, HiddenNode};
    use crate::identify::state_space::exponential::Number;
    use crate::identify::state_space::likelihood::{evaluate, log_likelihood};
    use crate::identify::state_space::observations::{InputLayout, observations};
    use crate::identify::state_space::starts::Guess;
    use crate::identify::state_space::structure::Structure;
    use crate::identify::synthetic_classroom::Classroom;
    use crate::identify::telemetry::Hold;

    /// Heat that switches inside of rows, a missing measurement and a row of unknown heat: the gradient is that of the likelihood.
    #[test]
    fn the_gradient_is_the_central_difference_of_the_likelihood() {
        let mut telemetry = Classroom { days: 3, ..Classroom::default() }.simulate();
        let zone = &mut telemetry.zones[0];
        zone.supply_air.clear();
        zone.power_hold = Hold::ZeroOrder;
        let pattern = [0.0, 0.5, 2.0, 1.5, 0.0, 0.0, 1.0, 0.0, 0.7, 2.0, 0.3, 1.1, 0.6];
        (0..zone.power_kw.len()).for_each(|row| zone.power_kw[row] = pattern[row % pattern.len()]);
        zone.temperature_c[40] = f64::NAN;
        let layout = InputLayout::new(&telemetry);
        assert!(layout.switches[0]);
        let rows = observations(&telemetry, &layout, &telemetry.segments, &[60]).expect("one zone");
        let structure = Structure::new(&telemetry, &[Extension::Node(HiddenNode::Interior)]);
        let model = |theta: &[Number]| structure.model(theta);
        let guess = Guess::new(&telemetry);
        let theta = guess.of_smallest(&telemetry, &structure)[1].clone();
        let found = evaluate(&model, &theta, &rows).expect("a likelihood").gradient;
        for (j, found) in found.iter().enumerate() {
            let at = |change: f64| {
                let mut moved = theta.clone();
                moved[j] += change;
                log_likelihood(&model, &moved, &rows).expect("a likelihood")
            };
            let difference = (at(1e-5) - at(-1e-5)) / 2e-5;
            let close = (found - difference).abs() <= 1e-4 * (1.0 + difference.abs());
            assert!(close, "{:?}: {found} and {difference}", structure.parameters[j]);
        }
    }
}
