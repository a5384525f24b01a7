//! The scalars of all inequalities, one column a quantity (see the parent module for the equations).
//!
//! Columns rather than rows: an iteration passes over all inequalities several times and needs few quantities at once, so
//! that columns stay in the processor's first cache and their arithmetic is done several at a time.
//!
//! Hard inequalities come first. The columns of violations hold the soft ones only.

/// Where the iteration starts: floor of the slacks, and complementarity there.
#[derive(Clone, Copy)]
pub(super) struct Start {
    slack: f64,
    complementarity: f64,
}

impl Start {
    /// Nothing is known. (0.01 for both fails now and then.)
    pub(super) const COLD: Start = Start { slack: 0.1, complementarity: 1.0 };
    /// The multipliers belong to a neighbouring problem.
    pub(super) const WARM: Start = Start { slack: 1e-3, complementarity: 1e-4 };
}

/// All inequalities `c + g·z + σ − s = 0` with `s ≥ 0`, multiplier `λ`.
#[derive(Clone, Debug, Default)]
pub(super) struct Columns {
    /// `c + g·z` at the point.
    pub value: Vec<f64>,
    /// `g·Δz` of the step.
    pub slope: Vec<f64>,
    /// `s`.
    pub slack: Vec<f64>,
    /// `λ`.
    pub multiplier: Vec<f64>,
    /// `r`.
    pub residual: Vec<f64>,
    /// `ω`: what the inequality adds to the Hessian.
    pub weight: Vec<f64>,
    /// The multiplier that it would take if nothing else moved.
    pub pull: Vec<f64>,
    d1: Vec<f64>,
    eta1: Vec<f64>,
    inverse_slack: Vec<f64>,
    slack_step: Vec<f64>,
    multiplier_step: Vec<f64>,
    soft: Soft,
}

/// Violations `σ` with weights `ℓ` and `q`; `ν` is the multiplier of `σ ≥ 0` where that is imposed (`ℓ > 0`).
#[derive(Clone, Debug, Default)]
struct Soft {
    linear: Vec<f64>,
    curvature: Vec<f64>,
    violation: Vec<f64>,
    multiplier: Vec<f64>,
    d2: Vec<f64>,
    eta2: Vec<f64>,
    inverse_violation: Vec<f64>,
    inverse_total: Vec<f64>,
    violation_step: Vec<f64>,
    multiplier_step: Vec<f64>,
}

/// The larger of two numbers that are not NaN; compiles to one instruction.
#[inline(always)]
pub(super) fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// What a step would do: the largest relative decrease of a positive number, and how complementarity changes with the
/// share `α` of the step: `Σ(s + αΔs)(λ + αΔλ) = Σsλ + α·linear + α²·quadratic`.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Prospect {
    pub ratio: f64,
    pub linear: f64,
    pub quadratic: f64,
}

impl Columns {
    /// How many inequalities there are.
    pub(super) fn len(&self) -> usize {
        self.slack.len()
    }

    fn first_soft(&self) -> usize {
        self.len() - self.soft.violation.len()
    }

    /// How many complementarity products there are.
    pub(super) fn pairs(&self) -> usize {
        self.len() + self.soft.linear.iter().filter(|linear| **linear > 0.0).count()
    }

    /// Makes room for `hard` inequalities and one soft one for each `(ℓ, q)`. Returns whether the shape was the same
    /// before, so that slacks and multipliers may be kept.
    pub(super) fn shape(&mut self, hard: usize, weights: impl ExactSizeIterator<Item = [f64; 2]>) -> bool {
        let soft = weights.len();
        let same = self.len() == hard + soft && self.soft.violation.len() == soft;
        for column in [
            &mut self.value,
            &mut self.slope,
            &mut self.slack,
            &mut self.multiplier,
            &mut self.residual,
            &mut self.weight,
            &mut self.pull,
            &mut self.d1,
            &mut self.eta1,
            &mut self.inverse_slack,
            &mut self.slack_step,
            &mut self.multiplier_step,
        ] {
            column.resize(hard + soft, 0.0);
        }
        let s = &mut self.soft;
        for column in [
            &mut s.linear,
            &mut s.curvature,
            &mut s.violation,
            &mut s.multiplier,
            &mut s.d2,
            &mut s.eta2,
            &mut s.inverse_violation,
            &mut s.inverse_total,
            &mut s.violation_step,
            &mut s.multiplier_step,
        ] {
            column.resize(soft, 0.0);
        }
        for (j, [linear, curvature]) in weights.enumerate() {
            (s.linear[j], s.curvature[j]) = (linear, curvature);
        }
        same
    }

    /// Slacks and multipliers at the start, from `value`; with `warm`, not below those that are there.
    pub(super) fn begin(&mut self, start: Start, warm: bool) {
        let floor = |kept: f64, least: f64| if warm { larger(kept, least) } else { least };
        let first = self.first_soft();
        for i in 0..self.len() {
            let mut violation = 0.0;
            if i >= first {
                let (j, soft) = (i - first, &mut self.soft);
                if soft.linear[j] > 0.0 {
                    violation = floor(soft.violation[j], start.slack);
                    soft.multiplier[j] = floor(soft.multiplier[j], start.complementarity / violation);
                } else {
                    violation = larger(-self.value[i], 0.0);
                    soft.multiplier[j] = 0.0;
                }
                soft.violation[j] = violation;
            }
            self.slack[i] = larger(self.value[i] + violation, start.slack);
            self.multiplier[i] = floor(self.multiplier[i], start.complementarity / self.slack[i]);
        }
    }

    /// Refreshes the residuals from `value`; returns mean complementarity and the largest residual.
    pub(super) fn measure(&mut self) -> (f64, f64) {
        let (first, count) = (self.first_soft(), self.pairs() as f64);
        let numbers = self.value.iter().zip(&self.slack).zip(&self.multiplier);
        let mut complementarity = 0.0;
        for (residual, ((value, slack), multiplier)) in self.residual.iter_mut().zip(numbers) {
            *residual = value - slack;
            complementarity += slack * multiplier;
        }
        let violations = self.soft.violation.iter().zip(&self.soft.multiplier);
        for (residual, (violation, multiplier)) in self.residual[first..].iter_mut().zip(violations) {
            *residual += violation;
            complementarity += violation * multiplier;
        }
        let primal = self.residual.iter().fold(0.0, |largest, residual| larger(residual.abs(), largest));
        (complementarity / count, primal)
    }

    /// Refreshes `d₁`, `d₂`, `D` and `ω`.
    pub(super) fn weigh(&mut self) {
        let first = self.first_soft();
        let numbers = self.slack.iter().zip(&self.multiplier).zip(&mut self.inverse_slack);
        for (d1, ((slack, multiplier), inverse)) in self.d1.iter_mut().zip(numbers) {
            *inverse = 1.0 / slack;
            *d1 = multiplier * *inverse;
        }
        self.weight.copy_from_slice(&self.d1);
        let soft = &mut self.soft;
        for (j, (weight, d1)) in self.weight[first..].iter_mut().zip(&self.d1[first..]).enumerate() {
            let inverse = if soft.linear[j] > 0.0 { 1.0 / soft.violation[j] } else { 0.0 };
            let d2 = soft.multiplier[j] * inverse;
            let total = 1.0 / (soft.curvature[j] + d1 + d2);
            *weight = d1 * (soft.curvature[j] + d2) * total;
            (soft.inverse_violation[j], soft.d2[j], soft.inverse_total[j]) = (inverse, d2, total);
        }
    }

    /// Targets: complementarity `mu` everywhere, less the second-order error of the step if it is `corrected`.
    pub(super) fn aim(&mut self, mu: f64, corrected: bool) {
        let error = if corrected { 1.0 } else { 0.0 };
        let steps = self.slack_step.iter().zip(&self.multiplier_step);
        let numbers = steps.zip(self.inverse_slack.iter().zip(&self.d1).zip(&self.residual));
        for (eta1, ((slack, multiplier), ((inverse, d1), residual))) in self.eta1.iter_mut().zip(numbers) {
            *eta1 = (mu - error * slack * multiplier) * inverse - d1 * residual;
        }
        self.pull.copy_from_slice(&self.eta1);
        let first = self.first_soft();
        let soft = &mut self.soft;
        for (j, (pull, d1)) in self.pull[first..].iter_mut().zip(&self.d1[first..]).enumerate() {
            let target = mu - error * soft.violation_step[j] * soft.multiplier_step[j];
            soft.eta2[j] = target * soft.inverse_violation[j];
            *pull -= d1 * soft.pressure(j, *pull) * soft.inverse_total[j];
        }
    }

    /// The Newton step for the `slope`s.
    pub(super) fn step(&mut self) -> Prospect {
        let mut prospect = self.soft_step();
        let n = self.len();
        // Slices of one length let the compiler drop the bounds checks.
        let (slope, residual, eta1, d1) = (&self.slope[..n], &self.residual[..n], &self.eta1[..n], &self.d1[..n]);
        let (slack, multiplier, inverse) = (&self.slack[..n], &self.multiplier[..n], &self.inverse_slack[..n]);
        let (slack_step, multiplier_step) = (&mut self.slack_step[..n], &mut self.multiplier_step[..n]);
        let (mut linear, mut quadratic) = (0.0, 0.0);
        for i in 0..n {
            let (ds, dm) = (slope[i] + residual[i], eta1[i] - d1[i] * slope[i] - multiplier[i]);
            (slack_step[i], multiplier_step[i]) = (ds, dm);
            linear += slack[i] * dm + multiplier[i] * ds;
            quadratic += ds * dm;
        }
        for i in 0..n {
            let shrink = larger(-slack_step[i] * inverse[i], -multiplier_step[i] / multiplier[i]);
            prospect.ratio = larger(shrink, prospect.ratio);
        }
        prospect.linear += linear;
        prospect.quadratic += quadratic;
        prospect
    }

    /// The part of the violations; turns `slope` from `g·Δz` into `g·Δz + Δσ`.
    fn soft_step(&mut self) -> Prospect {
        let (first, soft) = (self.first_soft(), &mut self.soft);
        let mut prospect = Prospect::default();
        for (j, slope) in self.slope[first..].iter_mut().enumerate() {
            let (d1, eta1) = (self.d1[first + j], self.eta1[first + j]);
            let violation_step = (soft.pressure(j, eta1) - d1 * *slope) * soft.inverse_total[j];
            *slope += violation_step;
            soft.violation_step[j] = violation_step;
            if soft.linear[j] > 0.0 {
                let multiplier_step = soft.eta2[j] - soft.d2[j] * violation_step - soft.multiplier[j];
                soft.multiplier_step[j] = multiplier_step;
                let violation = -violation_step * soft.inverse_violation[j];
                prospect.ratio = larger(larger(violation, -multiplier_step / soft.multiplier[j]), prospect.ratio);
                prospect.linear += soft.violation[j] * multiplier_step + soft.multiplier[j] * violation_step;
                prospect.quadratic += violation_step * multiplier_step;
            } else {
                soft.multiplier_step[j] = 0.0;
            }
        }
        prospect
    }

    /// Takes a share of the step.
    pub(super) fn advance(&mut self, share: f64) {
        let go = |column: &mut [f64], steps: &[f64]| {
            for (value, step) in column.iter_mut().zip(steps) {
                *value += share * step;
            }
        };
        go(&mut self.slack, &self.slack_step);
        go(&mut self.multiplier, &self.multiplier_step);
        go(&mut self.soft.violation, &self.soft.violation_step);
        go(&mut self.soft.multiplier, &self.soft.multiplier_step);
    }
}

impl Soft {
    /// `e = η₁ + η₂ − ℓ − q σ`.
    #[inline(always)]
    fn pressure(&self, j: usize, eta1: f64) -> f64 {
        eta1 + self.eta2[j] - self.linear[j] - self.curvature[j] * self.violation[j]
    }
}
