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
    /// Whether the multipliers of a neighbouring problem are a start.
    informed: bool,
}

impl Start {
    /// Nothing is known. (0.01 for both fails now and then.)
    pub(super) const COLD: Start = Start { slack: 0.1, complementarity: 1.0, informed: false };
    /// The multipliers belong to a neighbouring problem.
    pub(super) const WARM: Start = Start { slack: 1e-2, complementarity: 1e-4, informed: true };
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
    /// `η₁ − d₁ e/D`: the multiplier after a step that leaves `z` as it is.
    pub condensed_multiplier: Vec<f64>,
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

/// The smaller of two numbers; the second where the first is NaN.
#[inline(always)]
fn smaller(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// The ratio test of a direction: the largest relative decrease of a number that stays positive, and how complementarity changes
/// with the share `α` of the step: `Σ(s + αΔs)(λ + αΔλ) = Σsλ + α·linear + α²·quadratic`.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct RatioTest {
    pub ratio: f64,
    pub linear: f64,
    pub quadratic: f64,
}

/// Independent running sums, so that the processor need not wait for one addition to begin the next.
const RUNNING_SUMS: usize = 4;

impl RatioTest {
    fn and(self, other: RatioTest) -> RatioTest {
        RatioTest {
            ratio: larger(self.ratio, other.ratio),
            linear: self.linear + other.linear,
            quadratic: self.quadratic + other.quadratic,
        }
    }
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

    /// Makes room for `hard` inequalities and one soft one for each `(ℓ, q)`.
    pub(super) fn shape(&mut self, hard: usize, weights: impl ExactSizeIterator<Item = [f64; 2]>) {
        let soft = weights.len();
        for column in [
            &mut self.value,
            &mut self.slope,
            &mut self.slack,
            &mut self.multiplier,
            &mut self.residual,
            &mut self.weight,
            &mut self.condensed_multiplier,
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
    }

    /// Slacks and multipliers at the start, from `value` and the multipliers `known` of a neighbouring problem: a multiplier
    /// begins there, its slack where the two are as complementary as all others. Where nothing is known, `ℓ` belongs to `ν` at
    /// a soft inequality that holds, and half of it to each of `λ` and `ν` at one that is violated: so `ℓ + q σ − λ − ν` is
    /// small from the beginning.
    pub(super) fn initialize(&mut self, start: Start, known: &[f64]) {
        let Start { slack, complementarity, informed } = start;
        let apart =
            |multiplier: f64, most: f64| if informed { smaller(complementarity / multiplier, most) } else { slack };
        let first = self.first_soft();
        for (i, known) in known.iter().enumerate() {
            let is_violated = i >= first && self.value[i] < 0.0;
            let known = match informed {
                true => *known,
                false if is_violated => 0.5 * self.soft.linear[i - first],
                false => 0.0,
            };
            let mut violation = 0.0;
            if i >= first {
                let (j, soft) = (i - first, &mut self.soft);
                let excess = known - soft.linear[j];
                violation = if excess > 0.0 && soft.curvature[j] > 0.0 { excess / soft.curvature[j] } else { 0.0 };
                soft.multiplier[j] = 0.0;
                if soft.linear[j] > 0.0 {
                    let price = larger(soft.curvature[j] * violation - excess, 0.0);
                    let (priced, needed) = (complementarity / price, -self.value[i]);
                    let least = if informed { smaller(priced, larger(slack, needed)) } else { larger(priced, needed) };
                    violation = larger(violation, least);
                    soft.multiplier[j] = larger(price, complementarity / violation);
                } else {
                    violation = larger(-self.value[i], 0.0);
                }
                soft.violation[j] = violation;
            }
            self.slack[i] = larger(self.value[i] + violation, apart(known, slack));
            self.multiplier[i] = larger(known, complementarity / self.slack[i]);
        }
    }

    /// Refreshes the residuals from `value`; returns mean complementarity and the largest residual.
    pub(super) fn update_residuals(&mut self) -> (f64, f64) {
        let (first, count) = (self.first_soft(), self.pairs().max(1) as f64);
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

    /// Refreshes the scaling: `d₁`, `d₂`, `D` and `ω`.
    pub(super) fn update_scaling(&mut self) {
        let first = self.first_soft();
        let numbers = self.slack.iter().zip(&self.multiplier).zip(&mut self.inverse_slack);
        for (d1, ((slack, multiplier), inverse)) in self.d1.iter_mut().zip(numbers) {
            *inverse = 1.0 / slack;
            *d1 = multiplier * *inverse;
        }
        self.weight.copy_from_slice(&self.d1);
        let m = self.soft.violation.len();
        let (weight, d1) = (&mut self.weight[first..][..m], &self.d1[first..][..m]);
        let soft = &mut self.soft;
        let (linear, curvature, violation) = (&soft.linear[..m], &soft.curvature[..m], &soft.violation[..m]);
        let (multiplier, d2) = (&soft.multiplier[..m], &mut soft.d2[..m]);
        let (inverse, total) = (&mut soft.inverse_violation[..m], &mut soft.inverse_total[..m]);
        for j in 0..m {
            inverse[j] = if linear[j] > 0.0 { 1.0 / violation[j] } else { 0.0 };
            d2[j] = multiplier[j] * inverse[j];
            total[j] = 1.0 / (curvature[j] + d1[j] + d2[j]);
            weight[j] = d1[j] * (curvature[j] + d2[j]) * total[j];
        }
    }

    /// Sets the targets `η₁` and `η₂`: complementarity `mu` everywhere, less the second-order error `Δs Δλ` of the predictor's
    /// direction where that is `corrected`.
    pub(super) fn set_targets(&mut self, mu: f64, corrected: bool) {
        let error = if corrected { 1.0 } else { 0.0 };
        let steps = self.slack_step.iter().zip(&self.multiplier_step);
        let numbers = steps.zip(self.inverse_slack.iter().zip(&self.d1).zip(&self.residual));
        for (eta1, ((slack, multiplier), ((inverse, d1), residual))) in self.eta1.iter_mut().zip(numbers) {
            *eta1 = (mu - error * slack * multiplier) * inverse - d1 * residual;
        }
        self.condensed_multiplier.copy_from_slice(&self.eta1);
        let (first, m) = (self.first_soft(), self.soft.violation.len());
        let (condensed, d1) = (&mut self.condensed_multiplier[first..][..m], &self.d1[first..][..m]);
        let soft = &mut self.soft;
        let (linear, curvature, violation) = (&soft.linear[..m], &soft.curvature[..m], &soft.violation[..m]);
        let (violation_step, multiplier_step) = (&soft.violation_step[..m], &soft.multiplier_step[..m]);
        let (inverse, total, eta2) = (&soft.inverse_violation[..m], &soft.inverse_total[..m], &mut soft.eta2[..m]);
        for j in 0..m {
            eta2[j] = (mu - error * violation_step[j] * multiplier_step[j]) * inverse[j];
            let pressure = condensed[j] + eta2[j] - linear[j] - curvature[j] * violation[j];
            condensed[j] -= d1[j] * pressure * total[j];
        }
    }

    /// The direction of slacks, violations and multipliers for the `slope`s, and its ratio test.
    pub(super) fn fill_direction(&mut self) -> RatioTest {
        let soft = self.fill_soft_direction();
        let n = self.len();
        // Slices of one length let the compiler drop the bounds checks.
        let (slope, residual, eta1, d1) = (&self.slope[..n], &self.residual[..n], &self.eta1[..n], &self.d1[..n]);
        let multiplier = &self.multiplier[..n];
        let (slack_step, multiplier_step) = (&mut self.slack_step[..n], &mut self.multiplier_step[..n]);
        for i in 0..n {
            slack_step[i] = slope[i] + residual[i];
            multiplier_step[i] = eta1[i] - d1[i] * slope[i] - multiplier[i];
        }
        soft.and(self.ratio_test())
    }

    /// The ratio test over slacks and multipliers.
    fn ratio_test(&self) -> RatioTest {
        let (slack, slack_rest) = self.slack.as_chunks::<RUNNING_SUMS>();
        let (slack_step, slack_step_rest) = self.slack_step.as_chunks::<RUNNING_SUMS>();
        let (inverse, inverse_rest) = self.inverse_slack.as_chunks::<RUNNING_SUMS>();
        let (multiplier, multiplier_rest) = self.multiplier.as_chunks::<RUNNING_SUMS>();
        let (multiplier_step, multiplier_step_rest) = self.multiplier_step.as_chunks::<RUNNING_SUMS>();
        let (mut linear, mut quadratic, mut ratio) = ([0.0; RUNNING_SUMS], [0.0; RUNNING_SUMS], [0.0; RUNNING_SUMS]);
        let whole = slack.iter().zip(slack_step).zip(inverse).zip(multiplier.iter().zip(multiplier_step));
        for (((s, ds), inverse), (m, dm)) in whole {
            for i in 0..RUNNING_SUMS {
                linear[i] += s[i] * dm[i] + m[i] * ds[i];
                quadratic[i] += ds[i] * dm[i];
                ratio[i] = larger(larger(-ds[i] * inverse[i], -dm[i] / m[i]), ratio[i]);
            }
        }
        let rest = slack_rest.iter().zip(slack_step_rest).zip(inverse_rest);
        for (((s, ds), inverse), (m, dm)) in rest.zip(multiplier_rest.iter().zip(multiplier_step_rest)) {
            linear[0] += s * dm + m * ds;
            quadratic[0] += ds * dm;
            ratio[0] = larger(larger(-ds * inverse, -dm / m), ratio[0]);
        }
        let sum = |lanes: [f64; RUNNING_SUMS]| (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]);
        RatioTest { ratio: ratio.into_iter().fold(0.0, larger), linear: sum(linear), quadratic: sum(quadratic) }
    }

    /// The part of the violations; turns `slope` from `g·Δz` into `g·Δz + Δσ`.
    fn fill_soft_direction(&mut self) -> RatioTest {
        let (first, m) = (self.first_soft(), self.soft.violation.len());
        let (slope, d1, eta1) = (&mut self.slope[first..][..m], &self.d1[first..][..m], &self.eta1[first..][..m]);
        let soft = &mut self.soft;
        let (linear, curvature, violation) = (&soft.linear[..m], &soft.curvature[..m], &soft.violation[..m]);
        let (multiplier, d2, eta2) = (&soft.multiplier[..m], &soft.d2[..m], &soft.eta2[..m]);
        let (inverse, total) = (&soft.inverse_violation[..m], &soft.inverse_total[..m]);
        let (violation_step, multiplier_step) = (&mut soft.violation_step[..m], &mut soft.multiplier_step[..m]);
        let mut test = RatioTest::default();
        for j in 0..m {
            let pressure = eta1[j] + eta2[j] - linear[j] - curvature[j] * violation[j];
            let step = (pressure - d1[j] * slope[j]) * total[j];
            slope[j] += step;
            violation_step[j] = step;
            if linear[j] > 0.0 {
                let change = eta2[j] - d2[j] * step - multiplier[j];
                multiplier_step[j] = change;
                test.ratio = larger(larger(-step * inverse[j], -change / multiplier[j]), test.ratio);
                test.linear += violation[j] * change + multiplier[j] * step;
                test.quadratic += step * change;
            } else {
                multiplier_step[j] = 0.0;
            }
        }
        test
    }

    /// Takes a share of the step.
    pub(super) fn take_step(&mut self, share: f64) {
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
