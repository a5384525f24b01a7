//! The rounds by which zones agree on a common plan (Algorithm 1, with two faster step rules).
//!
//! In each round every zone learns the gradient of the common cost from its neighbours ([`super::messages`]), finds its best
//! inputs with those of the others as they are ([`super::zone`], side by side), and the proposals become a step:
//!
//! | scheme | step | sums over all zones in a round |
//! |---|---|---|
//! | Jacobi | d/n | none |
//! | line search | w d, 1/n ≤ w ≤ 1 | one for each try |
//! | momentum | w d + β (the step before), clipped | one for each try |
//!
//! Where messages get lost or come late, the zones take Jacobi steps only, which need no sums, and the later the messages
//! the shorter: a step against a gradient that is some rounds old overshoots.
//!
//! How near they come depends on the scheme: on the grids of the tests momentum is within 0.1 % of the centralised optimum
//! after 40 rounds and line search after 200, while Jacobi's share 1/n leaves up to 0.2 % after 800, and the more zones
//! the slower. A zone whose own problem has no solution keeps its inputs for the round; if that happens to all of them,
//! there is no plan.
//!
//! A convex J does not rise with Jacobi steps (Theorem I), whatever the number of zones: descent, not optimality. The
//! variables are the inputs u_i, so that the limits are those of each zone alone; with the printed u_ff,i they are coupled
//! through the feedback, and the zones stall above the optimum where limits bind.

use nalgebra::DMatrix;
use rayon::prelude::*;

use super::messages::Messages;
use super::settings::Scheme;
use super::zone::{Bound, ZoneProblem};
use crate::comfort::Targets;
use crate::control::{BandPenalty, ControlError};
use crate::lifted::Lifted;

/// Smallest response of a zone that counts in another zone's curvature, as a share of that zone's own response.
const MIN_RESPONSE_RATIO: f64 = 1e-6;
/// Largest number of Newton steps to the best combination of two directions. The cost is piecewise quadratic, so they end after
/// a few.
const MAX_NEWTON_STEPS: usize = 8;

/// What each zone knows beforehand: how a kilowatt of its own acts, and the curvature of the common cost in its inputs.
#[derive(Clone, Debug)]
pub(super) struct ZoneModels {
    zones: Vec<Zone>,
}

#[derive(Clone, Debug)]
struct Zone {
    /// Itself and its neighbours, with their responses to its heat.
    near: Vec<(usize, Vec<f64>)>,
    curvature: DMatrix<f64>,
}

impl ZoneModels {
    /// For the weights of `targets`.
    pub fn new(lifted: &Lifted, targets: &Targets, messages: &Messages) -> Self {
        let (n, steps) = (lifted.zones(), lifted.steps());
        let zone = |i: usize| {
            let mut impulse = vec![0.0; lifted.size()];
            impulse[i] = 1.0;
            let responses = lifted.product(&impulse);
            let kernel = |j: usize| -> Vec<f64> { (0..steps).map(|t| responses[t * n + j]).collect() };
            let size = |kernel: &[f64]| kernel.iter().fold(0.0, |m: f64, k| m.max(k.abs()));
            let own = kernel(i);
            let least = MIN_RESPONSE_RATIO * size(&own);
            let mut curvature = DMatrix::from_diagonal_element(steps, steps, 2.0 * targets.input_weight);
            for j in 0..n {
                let kernel = kernel(j);
                if size(&kernel) > least {
                    add_curvature(&mut curvature, &kernel, |t| targets.error_weight[t * n + j]);
                }
            }
            for s in 0..steps {
                for t in 0..s {
                    curvature[(s, t)] = curvature[(t, s)];
                }
            }
            let mut near: Vec<usize> = messages.neighbours(i).chain([i]).collect();
            near.sort_unstable();
            near.dedup();
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

/// A day to be planned together.
pub(super) struct JointDay<'a> {
    pub lifted: &'a Lifted,
    pub targets: &'a Targets,
    pub penalty: BandPenalty,
    pub zone_models: &'a ZoneModels,
    /// Nodes' temperatures at midnight.
    pub initial_c: &'a [f64],
    /// All heat but that of the equipment, nodes of a step together \[kW\].
    pub driving_kw: &'a [f64],
    /// Temperatures of the zones without equipment, stacked.
    pub free_c: &'a [f64],
    pub silent: Option<usize>,
}

/// Rules of the exchange.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rules {
    pub scheme: Scheme,
    pub tolerance_kw: f64,
    pub rounds: usize,
    /// Rounds by which messages are late.
    pub delay: usize,
}

/// What the zones agreed on.
pub(super) struct Agreement {
    pub heat_kw: Vec<f64>,
    /// True J before the first round and after each.
    pub costs: Vec<f64>,
    /// Sums over all zones.
    pub sums: usize,
}

impl JointDay<'_> {
    /// J of the inputs, with penalties, by simulation.
    pub fn cost(&self, heat_kw: &[f64]) -> f64 {
        let temperatures_c: Vec<f64> =
            self.free_c.iter().zip(self.lifted.product(heat_kw)).map(|(free, risen)| free + risen).collect();
        self.cost_of(&temperatures_c, heat_kw)
    }

    fn cost_of(&self, temperatures_c: &[f64], heat_kw: &[f64]) -> f64 {
        self.targets.cost(temperatures_c, heat_kw) + self.penalty.of(self.targets, temperatures_c)
    }

    /// ∂J/∂T and, without the parts of bounds that are kept now, ∂²J/∂T² of an entry.
    fn slope(&self, i: usize, temperature_c: f64) -> (f64, f64) {
        let targets = self.targets;
        let error_k = targets.reference_c[i] - temperature_c;
        let weight = targets.error_weight[i];
        let beyond_k =
            if targets.occupied[i / targets.zones] { (error_k.abs() - targets.band_k).max(0.0) } else { 0.0 };
        let c = self.penalty.quadratic;
        let bent = if beyond_k > 0.0 { 2.0 * c } else { 0.0 };
        (-2.0 * weight * error_k - 2.0 * c * beyond_k * error_k.signum(), 2.0 * weight + bent)
    }

    /// Plans from a first guess, within the limits.
    ///
    /// # Errors
    /// [`ControlError::NoZonePlans`] if no zone can solve its problem.
    pub fn agree(&self, messages: &mut Messages, rules: Rules, first_kw: Vec<f64>) -> Result<Agreement, ControlError> {
        let n = self.targets.zones;
        let mut heat_kw = first_kw;
        let mut costs = vec![self.cost(&heat_kw)];
        let mut sums = 0;
        let mut before: Option<(Vec<f64>, Vec<f64>)> = None;
        for round in 1..=rules.rounds {
            let nodes_c = messages.temperatures(self.initial_c, &heat_kw, self.driving_kw);
            let known_c = stacked(&nodes_c, n);
            let slope: Vec<f64> = known_c.iter().enumerate().map(|(i, t)| self.slope(i, *t).0).collect();
            let mut gradient = messages.sensitivities(&slope);
            for (gradient, u) in gradient.iter_mut().zip(&heat_kw) {
                *gradient += 2.0 * self.targets.input_weight * u;
            }
            let proposal = self.proposals(&heat_kw, &gradient, &known_c);
            let proposal = proposal.ok_or(ControlError::NoZonePlans { zones: n, round })?;
            let past = before.take().map(|(step, base_c)| {
                let moved: Vec<f64> = known_c.iter().zip(&base_c).map(|(now, then)| now - then).collect();
                (step, moved)
            });
            let next = match rules.scheme {
                Scheme::Jacobi => {
                    let share = 1.0 / (n * (1 + 2 * rules.delay)) as f64;
                    self.moved(&heat_kw, &proposal, share, None)
                }
                Scheme::LineSearch | Scheme::Momentum => {
                    let past = past.filter(|_| rules.scheme == Scheme::Momentum);
                    self.best_step(messages, &heat_kw, &proposal, &known_c, past, &mut sums)
                }
            };
            let step: Vec<f64> = next.iter().zip(&heat_kw).map(|(next, now)| next - now).collect();
            heat_kw = next;
            costs.push(self.cost(&heat_kw));
            let largest_kw = (0..n)
                .map(|zone| step.iter().skip(zone).step_by(n).map(|s| s * s).sum::<f64>().sqrt())
                .fold(0.0, f64::max);
            before = Some((step, known_c));
            if largest_kw <= rules.tolerance_kw {
                break;
            }
        }
        Ok(Agreement { heat_kw, costs, sums })
    }

    /// The step that each zone proposes for its inputs, stacked; `None` if no zone that answers can solve its problem.
    fn proposals(&self, heat_kw: &[f64], gradient: &[f64], known_c: &[f64]) -> Option<Vec<f64>> {
        let (n, steps) = (self.targets.zones, self.targets.steps());
        let limits_kw = self.lifted.model().network().limits_kw();
        let solve = |i: usize| -> Option<Vec<f64>> {
            if self.silent == Some(i) {
                return None;
            }
            let zone = &self.zone_models.zones[i];
            let of = |series: &[f64]| -> Vec<f64> { series.iter().skip(i).step_by(n).copied().collect() };
            let u = of(heat_kw);
            let problem = ZoneProblem {
                gradient: of(gradient),
                curvature: &zone.curvature,
                penalty: self.penalty.quadratic,
                bounds: self.bounds(zone, known_c),
                low: u.iter().map(|u| -limits_kw[i] - u).collect(),
                high: u.iter().map(|u| limits_kw[i] - u).collect(),
            };
            problem.solve()
        };
        let solved: Vec<Option<Vec<f64>>> = (0..n).into_par_iter().map(solve).collect();
        let some = solved.iter().any(Option::is_some) || self.silent.is_some_and(|_| n == 1);
        some.then(|| (0..n * steps).map(|k| solved[k % n].as_ref().map_or(0.0, |zone| zone[k / n])).collect())
    }

    /// The comfort bounds of a zone and its neighbours.
    fn bounds<'b>(&self, zone: &'b Zone, known_c: &[f64]) -> Vec<Bound<'b>> {
        let targets = self.targets;
        let mut bounds = Vec::new();
        if self.penalty.quadratic == 0.0 {
            return bounds;
        }
        for (j, kernel) in &zone.near {
            for time in (0..targets.steps()).filter(|&t| targets.occupied[t]) {
                let error_k = targets.reference_c[time * targets.zones + j] - known_c[time * targets.zones + j];
                for sign in [1.0, -1.0] {
                    bounds.push(Bound { value: -sign * error_k - targets.band_k, sign, kernel, time });
                }
            }
        }
        bounds
    }

    /// u + w d + β p within the limits.
    fn moved(&self, heat_kw: &[f64], d: &[f64], w: f64, past: Option<(&[f64], f64)>) -> Vec<f64> {
        let limits_kw = self.lifted.model().network().limits_kw();
        let n = limits_kw.len();
        (0..heat_kw.len())
            .map(|k| {
                let further = past.map_or(0.0, |(step, beta)| beta * step[k]);
                if self.silent == Some(k % n) {
                    heat_kw[k]
                } else {
                    (heat_kw[k] + w * d[k] + further).clamp(-limits_kw[k % n], limits_kw[k % n])
                }
            })
            .collect()
    }

    /// The best combination of the proposals and the previous step; by the zones' knowledge never worse than d/n.
    fn best_step(
        &self,
        messages: &mut Messages,
        heat_kw: &[f64],
        d: &[f64],
        known_c: &[f64],
        past: Option<(Vec<f64>, Vec<f64>)>,
        sums: &mut usize,
    ) -> Vec<f64> {
        let n = self.targets.zones;
        let risen = stacked(&messages.directions(d), n);
        let plane = Plane { day: self, heat_kw, known_c, inputs: [d, &[]], rises: [&risen, &[]] };
        let line = plane.minimum(sums)[0].clamp(1.0 / n as f64, 1.0);
        let cautious = self.moved(heat_kw, d, line, None);
        let Some((step, moved)) = past else { return cautious };
        let plane = Plane { inputs: [d, &step], rises: [&risen, &moved], ..plane };
        let [w, beta] = plane.minimum(sums);
        let bold = self.moved(heat_kw, d, w, Some((&step, beta)));
        // The limits may have changed the step: compute its actual effect.
        let change: Vec<f64> = bold.iter().zip(heat_kw).map(|(next, now)| next - now).collect();
        let bent = stacked(&messages.directions(&change), n);
        let known =
            |rise: &[f64], scale: f64| -> Vec<f64> { known_c.iter().zip(rise).map(|(t, r)| t + scale * r).collect() };
        *sums += 1;
        let better = self.cost_of(&known(&bent, 1.0), &bold) <= self.cost_of(&known(&risen, line), &cautious);
        if better { bold } else { cautious }
    }
}

/// J over the plane u + x₀ d + x₁ p, temperatures moving in proportion; the second direction may be missing.
struct Plane<'a> {
    day: &'a JointDay<'a>,
    heat_kw: &'a [f64],
    known_c: &'a [f64],
    inputs: [&'a [f64]; 2],
    rises: [&'a [f64]; 2],
}

impl Plane<'_> {
    /// The minimum by Newton's method: J is piecewise quadratic there.
    fn minimum(&self, sums: &mut usize) -> [f64; 2] {
        let mut x = [0.0, 0.0];
        for _ in 0..MAX_NEWTON_STEPS {
            *sums += 1;
            let (gradient, [a, b, c]) = self.expansion(x);
            let flat = self.inputs[1].is_empty();
            let determinant = a * c - b * b;
            let step = if flat || determinant <= 1e-12 * a * c {
                if a > 0.0 { [-gradient[0] / a, 0.0] } else { return x }
            } else {
                [(b * gradient[1] - c * gradient[0]) / determinant, (b * gradient[0] - a * gradient[1]) / determinant]
            };
            x = [x[0] + step[0], x[1] + step[1]];
            if step[0].abs() + step[1].abs() < 1e-9 {
                break;
            }
        }
        x
    }

    /// Gradient and the entries (00, 01, 11) of the Hessian.
    fn expansion(&self, x: [f64; 2]) -> ([f64; 2], [f64; 3]) {
        let part = |series: [&[f64]; 2], k: usize| [series[0][k], series[1].get(k).copied().unwrap_or(0.0)];
        let (mut gradient, mut hessian) = ([0.0; 2], [0.0; 3]);
        let weight = 2.0 * self.day.targets.input_weight;
        for k in 0..self.heat_kw.len() {
            let (du, dt) = (part(self.inputs, k), part(self.rises, k));
            let u = self.heat_kw[k] + x[0] * du[0] + x[1] * du[1];
            let (slope, bend) = self.day.slope(k, self.known_c[k] + x[0] * dt[0] + x[1] * dt[1]);
            for side in 0..2 {
                gradient[side] += slope * dt[side] + weight * u * du[side];
            }
            for (entry, (i, j)) in hessian.iter_mut().zip([(0, 0), (0, 1), (1, 1)]) {
                *entry += bend * dt[i] * dt[j] + weight * du[i] * du[j];
            }
        }
        (gradient, hessian)
    }
}

/// Temperatures of the zones at the ends of the steps, stacked, from the nodes' series.
fn stacked(series: &[Vec<f64>], zones: usize) -> Vec<f64> {
    let steps = series.first().map_or(0, |series| series.len() - 1);
    (0..steps * zones).map(|k| series[k % zones][k / zones + 1]).collect()
}
