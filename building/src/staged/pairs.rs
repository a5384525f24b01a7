//! Slacks of inequalities with their multipliers.

use super::program::StagedProgram;

/// Slacks and multipliers of a group of inequalities, both positive.
#[derive(Clone, Debug, Default)]
pub(super) struct Pairs {
    /// Slacks.
    pub w: Vec<f64>,
    /// Multipliers.
    pub z: Vec<f64>,
}

/// The groups: lower and upper limits of inputs, soft bounds, their slacks, the power of stages, and the least peak.
#[derive(Clone, Debug, Default)]
pub(super) struct Groups {
    pub lower: Pairs,
    pub upper: Pairs,
    pub soft: Pairs,
    pub slack: Pairs,
    pub power: Pairs,
    pub peak: Pairs,
}

#[derive(Debug)]
pub(super) struct Direction {
    pub v: Vec<f64>,
    pub x: Vec<f64>,
    pub s: Vec<f64>,
    pub p: f64,
}

/// A number for each inequality, group by group.
pub(super) type PerRow = [Vec<f64>; 6];

impl Groups {
    /// All groups in order.
    pub fn all(&self) -> [&Pairs; 6] {
        [&self.lower, &self.upper, &self.soft, &self.slack, &self.power, &self.peak]
    }

    fn all_mut(&mut self) -> [&mut Pairs; 6] {
        [&mut self.lower, &mut self.upper, &mut self.soft, &mut self.slack, &mut self.power, &mut self.peak]
    }

    /// Number of inequalities.
    pub fn count(&self) -> usize {
        self.all().iter().map(|pairs| pairs.w.len()).sum()
    }

    /// The complementarity gap Σ w z.
    pub fn gap(&self) -> f64 {
        self.all().iter().map(|pairs| pairs.w.iter().zip(&pairs.z).map(|(w, z)| w * z).sum::<f64>()).sum()
    }

    /// Sets the multipliers such that every product w z is `mu`.
    pub fn centre(&mut self, mu: f64) {
        for pairs in self.all_mut() {
            pairs.z = pairs.w.iter().map(|w| mu / w).collect();
        }
    }

    /// The changes of the slacks along a direction.
    pub fn slack_steps(program: &StagedProgram, direction: &Direction) -> PerRow {
        let (n, m) = (program.initial_c.len(), program.inputs.len());
        let mut soft = Vec::with_capacity(direction.s.len());
        let mut power = Vec::new();
        for (t, stage) in program.stages.iter().enumerate() {
            for bound in &stage.soft {
                soft.push(direction.s[soft.len()] - bound.sign * direction.x[t * n + bound.node]);
            }
            if program.peak.is_some() {
                let taken: f64 = stage.power.iter().zip(&direction.v[t * m..]).map(|(power, v)| power * v).sum();
                power.push(direction.p - taken);
            }
        }
        let upper = direction.v.iter().map(|v| -v).collect();
        let peak = if program.peak.is_some() { vec![direction.p] } else { Vec::new() };
        [direction.v.clone(), upper, soft, direction.s.clone(), power, peak]
    }

    /// The changes of the multipliers with which, to first order, the products w z reach their target for these changes of the slacks.
    pub fn multiplier_steps(&self, slack_steps: &PerRow, zeta: &PerRow) -> PerRow {
        let groups = self.all();
        std::array::from_fn(|g| {
            let Pairs { w, z } = groups[g];
            (0..w.len()).map(|i| zeta[g][i] - z[i] - z[i] / w[i] * slack_steps[g][i]).collect()
        })
    }

    /// ζ = (μ − correction) / w of each inequality.
    pub fn zeta(&self, mu: f64, correction: Option<(&PerRow, &PerRow)>) -> PerRow {
        let groups = self.all();
        std::array::from_fn(|g| {
            let product = |i: usize| correction.map_or(0.0, |(w, z)| w[g][i] * z[g][i]);
            groups[g].w.iter().enumerate().map(|(i, w)| (mu - product(i)) / w).collect()
        })
    }

    /// The longest step, at most 1, that keeps slacks and multipliers at least zero.
    pub fn longest_step(&self, slack_steps: &PerRow, multiplier_steps: &PerRow) -> f64 {
        let longest = |values: &[f64], steps: &[f64]| -> f64 {
            values.iter().zip(steps).filter(|(_, step)| **step < 0.0).map(|(v, step)| -v / step).fold(1.0, f64::min)
        };
        let groups = self.all().into_iter().enumerate();
        groups
            .map(|(g, pairs)| longest(&pairs.w, &slack_steps[g]).min(longest(&pairs.z, &multiplier_steps[g])))
            .fold(1.0, f64::min)
    }

    /// The complementarity gap Σ w z after a step.
    pub fn gap_after(&self, alpha: f64, slack_steps: &PerRow, multiplier_steps: &PerRow) -> f64 {
        let mut gap = 0.0;
        for (g, Pairs { w, z }) in self.all().into_iter().enumerate() {
            for i in 0..w.len() {
                gap += (w[i] + alpha * slack_steps[g][i]) * (z[i] + alpha * multiplier_steps[g][i]);
            }
        }
        gap
    }

    /// Moves slacks and multipliers by a step.
    pub fn advance(&mut self, alpha: f64, slack_steps: &PerRow, multiplier_steps: &PerRow) {
        for (g, pairs) in self.all_mut().into_iter().enumerate() {
            pairs.w.iter_mut().zip(&slack_steps[g]).for_each(|(w, step)| *w += alpha * step);
            pairs.z.iter_mut().zip(&multiplier_steps[g]).for_each(|(z, step)| *z += alpha * step);
        }
    }
}
