//! The predictor-corrector method. All iterates are primal feasible, so only complementarity and the gradient of the
//! Lagrangian remain to be reduced.

use super::pairs::{Direction, Groups, Pairs, PerRow};
use super::program::{Peak, PlanStage, StagedError, StagedProgram, StagedSolution};
use super::recursion::{Curvature, Recursion};

/// Iterations after which the method gives up. Problems of buildings take 10 to 40.
const MAX_ITERATIONS: u32 = 120;
/// Share of the way to the boundary that a step may go.
const STEP_SHARE: f64 = 0.995;
/// Limits of the slack of soft bounds at the start \[K\].
const LEAST_FIRST_SLACK_K: f64 = 0.01;
const MOST_FIRST_SLACK_K: f64 = 10.0;
/// Inputs whose limits are further apart begin where they change the temperature of their zone by this much in a stage \[K\].
const FIRST_REACH_K: f64 = 5.0;
/// The cost of inputs is taken for at least this share of that of a kelvin beyond all soft bounds.
const LEAST_SCALE_SHARE: f64 = 1e-6;
/// What is paid is taken for at least this share of what a change of all zones by [`FIRST_REACH_K`] in all stages costs.
const LEAST_PAID_SHARE: f64 = 1e-2;
/// A shorter step does not count as progress.
const LEAST_STEP: f64 = 1e-8;
/// How much larger than the accepted one the gap may be where rounding ends the iterations.
const STALLED_FACTOR: f64 = 1e3;

struct Iterate<'a> {
    program: &'a StagedProgram,
    v: Vec<f64>,
    x: Vec<f64>,
    s: Vec<f64>,
    p: f64,
    groups: Groups,
}

/// Solves a problem until its cost is certainly above the least one by less than `tolerance` times what is paid in it: for inputs, for
/// soft bounds, for the peak and for the change of temperatures that have a price. Limits of inputs do not belong to that scale.
pub fn solve(program: &StagedProgram, tolerance: f64) -> Result<StagedSolution, StagedError> {
    program.check()?;
    let mut iterate = Iterate::start(program);
    let least = LEAST_PAID_SHARE * cost_scale(program);
    let count = iterate.groups.count().max(1) as f64;
    let mut gap = iterate.groups.gap();
    for iterations in 0..MAX_ITERATIONS {
        let accepted = tolerance * iterate.paid().max(least);
        let (residual, _) = iterate.largest_residual();
        gap = iterate.groups.gap();
        if gap <= accepted && residual <= tolerance.sqrt() * iterate.gradient_scale() {
            return Ok(iterate.solution(gap, iterations));
        }
        let moved = iterate.step(gap / count).is_some_and(|alpha| alpha >= LEAST_STEP);
        if !moved {
            let is_close = gap <= STALLED_FACTOR * accepted;
            return if is_close {
                Ok(iterate.solution(gap, iterations))
            } else {
                Err(StagedError::Unsolved { iterations, gap })
            };
        }
    }
    Err(StagedError::Unsolved { iterations: MAX_ITERATIONS, gap })
}

impl<'a> Iterate<'a> {
    /// Inputs within their limits, in the middle if these are not far apart, and slacks that keep all soft bounds.
    fn start(program: &'a StagedProgram) -> Self {
        let stages = &program.stages;
        let (n, m) = (program.initial_c.len(), program.inputs.len());
        let v: Vec<f64> = stages
            .iter()
            .flat_map(|stage| (0..m).map(move |j| (stage.lower[j], stage.upper[j], reach_kw(program, stage, j))))
            .map(|(lower, upper, reach)| (upper - reach).min(0.0).max(lower + reach))
            .collect();
        let product = cost_scale(program) / v.len().max(1) as f64;
        let x = program.states(&v);
        let mut s = Vec::new();
        let mut groups = Groups::default();
        let mut taken_kw = Vec::new();
        for (t, stage) in stages.iter().enumerate() {
            for (j, v) in v[t * m..(t + 1) * m].iter().enumerate() {
                groups.lower.w.push(v - stage.lower[j]);
                groups.upper.w.push(stage.upper[j] - v);
            }
            for soft in &stage.soft {
                let beyond_k = soft.sign * x[t * n + soft.node] - soft.bound;
                s.push(beyond_k.max(0.0) + first_slack_k(product, soft.linear));
                groups.soft.w.push(s[s.len() - 1] - beyond_k);
            }
            taken_kw.push(stage.power.iter().zip(&v[t * m..]).map(|(power, v)| power * v).sum::<f64>());
        }
        groups.slack.w.clone_from(&s);
        let mut p = 0.0;
        if let Some(peak) = program.peak {
            let highest_kw = taken_kw.iter().copied().fold(peak.least_kw, f64::max);
            p = highest_kw + 0.1 * highest_kw.abs() + 0.1;
            groups.power.w = taken_kw.iter().map(|taken_kw| p - taken_kw).collect();
            groups.peak.w = vec![p - peak.least_kw];
        }
        groups.centre(product);
        let mut iterate = Self { program, v, x, s, p, groups };
        iterate.balance();
        iterate
    }

    /// Multipliers with which the costs of slacks and of the peak have no gradient.
    fn balance(&mut self) {
        let bounds = self.program.stages.iter().flat_map(|stage| &stage.soft);
        let Groups { soft, slack, power, peak, .. } = &mut self.groups;
        for (k, bound) in bounds.enumerate() {
            let slope = bound.linear + bound.quadratic * self.s[k];
            if slope > 0.0 {
                soft.z[k] = soft.z[k].min(0.5 * slope);
                slack.z[k] = slope - soft.z[k];
            }
        }
        if let Some(Peak { price, .. }) = self.program.peak.filter(|peak| peak.price > 0.0) {
            let share = 0.5 * price / power.z.iter().sum::<f64>();
            power.z.iter_mut().for_each(|z| *z *= share);
            peak.z = vec![0.5 * price];
        }
    }
    /// The largest cost of a unit of an input or slack.
    fn gradient_scale(&self) -> f64 {
        let of_stage = |stage: &PlanStage| {
            let soft = stage.soft.iter().map(|soft| soft.linear);
            stage.linear.iter().map(|q| q.abs()).chain(soft).chain(stage.quadratic.iter().copied()).fold(0.0, f64::max)
        };
        self.program.stages.iter().map(of_stage).fold(1e-9, f64::max)
    }

    /// What is paid: the sizes of all parts of the cost, without those that no input changes.
    fn paid(&self) -> f64 {
        let program = self.program;
        let (n, m) = (program.initial_c.len(), program.inputs.len());
        let mut paid = program.peak.map_or(0.0, |peak| (peak.price * self.p).abs());
        let mut k = 0;
        for (t, stage) in program.stages.iter().enumerate() {
            for (j, v) in self.v[t * m..(t + 1) * m].iter().enumerate() {
                paid += (stage.linear[j] * v).abs() + 0.5 * stage.quadratic[j] * v * v;
            }
            for &(node, linear, quadratic) in &stage.nodes {
                let x = self.x[t * n + node];
                // A quadratic cost is that of the distance from its minimum, and a price that of the change from the start.
                paid += match quadratic > 0.0 {
                    true => 0.5 * quadratic * (x + linear / quadratic) * (x + linear / quadratic),
                    false => (linear * (x - program.initial_c[node])).abs(),
                };
            }
            for soft in &stage.soft {
                paid += soft.linear * self.s[k] + 0.5 * soft.quadratic * self.s[k] * self.s[k];
                k += 1;
            }
        }
        paid
    }

    fn objective(&self) -> f64 {
        self.program.evaluate(&self.v)
    }

    fn solution(self, gap: f64, iterations: u32) -> StagedSolution {
        let (objective, states_c) = (self.objective(), self.program.states(&self.v));
        let (_, initial_value) = self.largest_residual();
        let (inputs, slack_k, peak_kw) = (self.v, self.s, self.p);
        StagedSolution { inputs, states_c, slack_k, peak_kw, initial_value, objective, gap, iterations }
    }

    /// The largest entry of the gradient of the Lagrangian, with the multipliers of the dynamics from their recursion, and the
    /// multipliers of the initial state.
    fn largest_residual(&self) -> (f64, Vec<f64>) {
        let program = self.program;
        let (n, m) = (program.initial_c.len(), program.inputs.len());
        let rows = self.groups.all().map(|pairs| pairs.z.clone());
        let (f, h) = self.gradients(&rows, false);
        let mut largest: f64 = 0.0;
        let mut lambda = vec![0.0; n];
        for (t, stage) in program.stages.iter().enumerate().rev() {
            lambda.iter_mut().zip(&h[t * n..(t + 1) * n]).for_each(|(lambda, h)| *lambda += h);
            let (back, driven) = program.maps[stage.map].transposed(&program.inputs, &lambda);
            for j in 0..m {
                largest = largest.max((f[t * m + j] + driven[j]).abs());
            }
            lambda = back;
        }
        (largest, lambda)
    }

    /// Gradients of inputs and temperatures where the multipliers become `zeta`; with `reduced`, slacks have been eliminated.
    fn gradients(&self, zeta: &PerRow, reduced: bool) -> (Vec<f64>, Vec<f64>) {
        let [lower, upper, soft, slack, power, _] = zeta;
        let (n, m) = (self.program.initial_c.len(), self.program.inputs.len());
        let (mut f, mut h) = (vec![0.0; self.v.len()], vec![0.0; self.x.len()]);
        let mut k = 0;
        for (t, stage) in self.program.stages.iter().enumerate() {
            for j in 0..m {
                let i = t * m + j;
                f[i] = stage.linear[j] + stage.quadratic[j] * self.v[i] - lower[i] + upper[i];
                if let Some(power) = power.get(t) {
                    f[i] += stage.power[j] * power;
                }
            }
            for &(node, linear, quadratic) in &stage.nodes {
                h[t * n + node] += linear + quadratic * self.x[t * n + node];
            }
            for bound in &stage.soft {
                let mut pull = soft[k];
                if reduced {
                    let (theta, curvature) = self.slack_curvature(k, bound.quadratic);
                    let slope = bound.linear + bound.quadratic * self.s[k] - soft[k] - slack[k];
                    pull += theta * slope / curvature;
                }
                h[t * n + bound.node] += bound.sign * pull;
                k += 1;
            }
        }
        (f, h)
    }

    /// θ of a soft bound, and the curvature of its slack.
    fn slack_curvature(&self, k: usize, quadratic: f64) -> (f64, f64) {
        let Groups { soft, slack, .. } = &self.groups;
        let theta = soft.z[k] / soft.w[k];
        (theta, quadratic + theta + slack.z[k] / slack.w[k])
    }

    fn curvature(&self) -> Curvature {
        let ratio = |Pairs { w, z }: &Pairs, i: usize| z[i] / w[i];
        let Groups { lower, upper, slack, power, .. } = &self.groups;
        let (n, m) = (self.program.initial_c.len(), self.program.inputs.len());
        let mut nodes = vec![0.0; self.x.len()];
        let mut inputs = Vec::with_capacity(self.v.len());
        let mut k = 0;
        for (t, stage) in self.program.stages.iter().enumerate() {
            for j in 0..m {
                inputs.push(stage.quadratic[j] + ratio(lower, t * m + j) + ratio(upper, t * m + j));
            }
            for &(node, _, quadratic) in &stage.nodes {
                nodes[t * n + node] += quadratic;
            }
            for bound in &stage.soft {
                let (theta, curvature) = self.slack_curvature(k, bound.quadratic);
                nodes[t * n + bound.node] += theta * (bound.quadratic + ratio(slack, k)) / curvature;
                k += 1;
            }
        }
        Curvature { inputs, nodes, power: (0..power.w.len()).map(|t| ratio(power, t)).collect() }
    }

    /// One iteration with the mean product `mu`; the length of its step, or `None` if the system has no factors.
    fn step(&mut self, mu: f64) -> Option<f64> {
        let curvature = self.curvature();
        let recursion = Recursion::factor(self.program, &curvature)?;
        let peak = self.program.peak.map(|_| self.peak_response(&recursion, &curvature));
        let zeta = self.groups.zeta(0.0, None);
        let direction = self.direction(&recursion, &curvature, peak.as_ref(), &zeta);
        let slack_steps = Groups::slack_steps(self.program, &direction);
        let multiplier_steps = self.groups.multiplier_steps(&slack_steps, &zeta);
        let alpha = self.groups.longest_step(&slack_steps, &multiplier_steps);
        let count = self.groups.count() as f64;
        let predicted = self.groups.gap_after(alpha, &slack_steps, &multiplier_steps) / count;
        let ratio = (predicted / mu).clamp(0.0, 1.0);
        let centring = ratio * ratio * ratio;
        let zeta = self.groups.zeta(centring * mu, Some((&slack_steps, &multiplier_steps)));
        let direction = self.direction(&recursion, &curvature, peak.as_ref(), &zeta);
        let slack_steps = Groups::slack_steps(self.program, &direction);
        let multiplier_steps = self.groups.multiplier_steps(&slack_steps, &zeta);
        let alpha = (STEP_SHARE * self.groups.longest_step(&slack_steps, &multiplier_steps)).min(1.0);
        if !alpha.is_finite() || direction.v.iter().any(|v| !v.is_finite()) {
            return None;
        }
        self.groups.advance(alpha, &slack_steps, &multiplier_steps);
        let add = |values: &mut [f64], steps: &[f64]| values.iter_mut().zip(steps).for_each(|(v, d)| *v += alpha * d);
        add(&mut self.v, &direction.v);
        add(&mut self.x, &direction.x);
        add(&mut self.s, &direction.s);
        self.p += alpha * direction.p;
        Some(alpha)
    }

    /// How inputs and temperatures answer a unit of the peak.
    fn peak_response(&self, recursion: &Recursion<'_>, curvature: &Curvature) -> (Vec<f64>, Vec<f64>) {
        let stages = self.program.stages.iter().zip(&curvature.power);
        let f: Vec<f64> =
            stages.flat_map(|(stage, theta)| stage.power.iter().map(move |power| -theta * power)).collect();
        recursion.solve(&f, &vec![0.0; self.x.len()])
    }

    /// The Newton direction where the multipliers become `zeta`.
    fn direction(
        &self,
        recursion: &Recursion<'_>,
        curvature: &Curvature,
        peak: Option<&(Vec<f64>, Vec<f64>)>,
        zeta: &PerRow,
    ) -> Direction {
        let (f, h) = self.gradients(zeta, true);
        let (mut v, mut x) = recursion.solve(&f, &h);
        let mut p = 0.0;
        if let (Some((by_v, by_x)), Some(peak)) = (peak, self.program.peak) {
            let m = self.program.inputs.len();
            // The sum Σ θ κᵀΔv over the stages.
            let weighed = |v: &[f64]| -> f64 {
                let stages = self.program.stages.iter().zip(&curvature.power).zip(v.chunks_exact(m));
                stages
                    .map(|((stage, theta), v)| theta * stage.power.iter().zip(v).map(|(k, v)| k * v).sum::<f64>())
                    .sum()
            };
            let [.., power, least] = zeta;
            let theta_least = self.groups.peak.z[0] / self.groups.peak.w[0];
            let pull = power.iter().sum::<f64>() + least[0] - peak.price + weighed(&v);
            let stiffness = curvature.power.iter().sum::<f64>() + theta_least - weighed(by_v);
            p = pull / stiffness;
            v.iter_mut().zip(by_v).for_each(|(v, by)| *v += p * by);
            x.iter_mut().zip(by_x).for_each(|(x, by)| *x += p * by);
        }
        let s = self.slack_directions(&x, zeta);
        Direction { v, x, s, p }
    }

    fn slack_directions(&self, x: &[f64], zeta: &PerRow) -> Vec<f64> {
        let [_, _, soft, slack, ..] = zeta;
        let n = self.program.initial_c.len();
        let mut s = Vec::with_capacity(self.s.len());
        for (t, stage) in self.program.stages.iter().enumerate() {
            for bound in &stage.soft {
                let k = s.len();
                let (theta, curvature) = self.slack_curvature(k, bound.quadratic);
                let slope = bound.linear + bound.quadratic * self.s[k] - soft[k] - slack[k];
                s.push((theta * bound.sign * x[t * n + bound.node] - slope) / curvature);
            }
        }
        s
    }
}

/// About how much inputs cost.
fn cost_scale(program: &StagedProgram) -> f64 {
    let mut scale = 0.0;
    for stage in &program.stages {
        for j in 0..stage.linear.len() {
            let reach = reach_kw(program, stage, j);
            scale += stage.linear[j].abs() * reach + stage.quadratic[j] * reach * reach;
        }
    }
    // If heat costs almost nothing, the cost of discomfort determines the scale.
    let discomfort: f64 = program.stages.iter().flat_map(|stage| &stage.soft).map(|soft| soft.linear).sum();
    scale.max(LEAST_SCALE_SHARE * discomfort).max(1e-9)
}

/// Half of the room between the limits of an input, or what changes the temperature of its zone by [`FIRST_REACH_K`] in a stage, if
/// that is less \[kW\].
fn reach_kw(program: &StagedProgram, stage: &PlanStage, j: usize) -> f64 {
    let zone = program.inputs[j].zone;
    let response_k_per_kw = program.maps[stage.map].gain[(zone, zone)].abs();
    (0.5 * (stage.upper[j] - stage.lower[j])).min(FIRST_REACH_K / response_k_per_kw.max(f64::MIN_POSITIVE))
}

/// The slack of a soft bound at the start \[K\], so that its product with half of its cost is `product`.
fn first_slack_k(product: f64, linear: f64) -> f64 {
    (2.0 * product / linear.max(1e-12)).clamp(LEAST_FIRST_SLACK_K, MOST_FIRST_SLACK_K)
}
