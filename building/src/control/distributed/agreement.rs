//! The rounds by which zones agree on a common plan (Algorithm 1, with two faster step rules).
//!
//! In each round every zone receives the gradient of the common cost from its neighbours ([`super::messages`]), finds its best inputs
//! while those of the others stay as they are ([`super::zone`], in parallel), and the proposals become a step:
//!
//! | scheme | step | sums over all zones in a round |
//! |---|---|---|
//! | Jacobi | d/n | none |
//! | line search | w d, 1/n ≤ w ≤ 1 | one for each try |
//! | momentum | w d + Σ β_j (the j-th step before), clipped | one for each try |
//!
//! Momentum excludes inputs from earlier steps that are at a limit and stay there. If messages arrive late, the zones
//! take only Jacobi steps, which are shorter the later the messages are: a step against a gradient that is some rounds
//! old overshoots. The same applies to a zone that did not receive a message at all.
//!
//! # Descent
//!
//! J does not rise with Jacobi steps (Theorem I) if each zone's own step does not raise it: J is convex, and d/n is the mean of the steps
//! of the single zones. Therefore the cost of a zone's problem must not be below J for any of its inputs. With only the comfort bounds of
//! its neighbours, as printed in (5.13), it can be below J: where bounds of more distant zones bind, the cost rose, up to 180 % above the
//! optimum on random networks. Here the curvature of a zone's problem includes *all* bounds that its heat can affect: those of its
//! neighbours as they are, and those of more distant zones as if they were violated, which is the most that they can add. So a zone needs
//! only the messages of its neighbours and its response to its own heat, which is part of its model. The gradient includes all bounds
//! exactly, so the common optimum is the only fixed point.
//!
//! # Distance from the optimum
//!
//! Momentum is within 0.1 % of the centralised optimum after 40 rounds on the grids of the tests, and after 400 on 50 random networks
//! where limits and comfort bounds bind. Line search needs 200 on the grids. Jacobi's share 1/n leaves up to 1 % after 800 rounds, and
//! several tens of percent where bounds bind: it guarantees descent, not optimality. A zone whose own problem has no solution keeps its
//! inputs for the round; if this happens to all zones, the exchange fails.
//!
//! The variables are the inputs u_i, so that the limits are those of each zone alone; with the printed u_ff,i they are coupled
//! through the feedback, and the zones stall above the optimum where limits bind.

use std::collections::VecDeque;

use rayon::prelude::*;

use super::messages::Messages;
use super::settings::Scheme;
use super::step_space::{Direction, JointDay, StepSpace};
use super::zone::{Bound, Zone, ZoneProblem};
use crate::control::ControlError;

/// How many earlier steps are combined with the proposals. Chosen: with one, a third of the random networks of the tests with
/// binding bounds end more than 0.1 % above the optimum after 200 rounds; more than six save few rounds.
const MEMORY: usize = 6;
/// In how many rounds in a row steps must be small for the zones to agree, with schemes that choose the length of a step: one
/// short step does not mean that they are near the optimum.
const SMALL_STEPS: usize = 10;

#[derive(Clone, Copy, Debug)]
pub(super) struct Rules {
    pub scheme: Scheme,
    pub tolerance_kw: f64,
    pub rounds: usize,
    /// Rounds by which messages are late.
    pub delay: usize,
}

pub(super) struct Agreement {
    pub heat_kw: Vec<f64>,
    /// True J before the first round and after each.
    pub costs: Vec<f64>,
    /// Sums over all zones.
    pub sums: usize,
}

impl JointDay<'_> {
    /// Agrees on a plan within the limits, starting from a first guess.
    ///
    /// # Errors
    /// [`ControlError::NoZonePlans`] if no zone can solve its problem.
    pub fn agree(&self, messages: &mut Messages, rules: Rules, first_kw: Vec<f64>) -> Result<Agreement, ControlError> {
        let n = self.targets.zones;
        let mut heat_kw = first_kw;
        let mut costs = vec![self.cost(&heat_kw)];
        let mut sums = 0;
        let mut base_c: Option<Vec<f64>> = None;
        let mut past: VecDeque<Direction> = VecDeque::new();
        let mut small = 0;
        for round in 1..=rules.rounds {
            let nodes_c = messages.temperatures(self.initial_c, &heat_kw, self.driving_kw);
            let known_c = stacked(&nodes_c, n);
            let slope: Vec<f64> = known_c.iter().enumerate().map(|(i, t)| self.slope(i, *t).0).collect();
            let mut gradient = messages.sensitivities(&slope);
            for ((gradient, u), weight) in gradient.iter_mut().zip(&heat_kw).zip(&self.targets.input_weight) {
                *gradient += 2.0 * weight * u;
            }
            let proposal = self.proposals(&heat_kw, &gradient, &known_c);
            let proposal = proposal.ok_or(ControlError::NoZonePlans { zones: n, round })?;
            if let (Some(base_c), Some(last)) = (base_c.replace(known_c.clone()), past.front_mut()) {
                last.risen_k = known_c.iter().zip(&base_c).map(|(now, then)| now - then).collect();
            }
            let next = match rules.scheme {
                Scheme::Jacobi => {
                    let stale = messages.staleness();
                    let share = |zone: usize| 1.0 / (n * (1 + 2 * (rules.delay + stale[zone]))) as f64;
                    self.limited(&heat_kw, |k| share(k % n) * proposal[k])
                }
                Scheme::LineSearch | Scheme::Momentum => {
                    self.best_step(messages, &heat_kw, &proposal, &known_c, &past, &mut sums)
                }
            };
            let step: Vec<f64> = next.iter().zip(&heat_kw).map(|(next, now)| next - now).collect();
            heat_kw = next;
            costs.push(self.cost(&heat_kw));
            small = if self.largest_kw(&step) <= rules.tolerance_kw { small + 1 } else { 0 };
            if rules.scheme == Scheme::Momentum {
                past.truncate(MEMORY - 1);
                past.push_front(Direction { heat_kw: step, risen_k: Vec::new() });
            }
            let enough = if rules.scheme == Scheme::Jacobi { 1 } else { SMALL_STEPS };
            if small >= enough || self.largest_kw(&proposal) <= rules.tolerance_kw {
                break;
            }
        }
        Ok(Agreement { heat_kw, costs, sums })
    }

    /// The largest Euclidean norm over the day of a zone's part of a step.
    fn largest_kw(&self, step: &[f64]) -> f64 {
        let n = self.targets.zones;
        let norm = |zone: usize| step.iter().skip(zone).step_by(n).map(|s| s * s).sum::<f64>().sqrt();
        (0..n).map(norm).fold(0.0, f64::max)
    }

    /// The step that each zone proposes for its inputs, stacked; `None` if no zone that answers can solve its problem.
    fn proposals(&self, heat_kw: &[f64], gradient: &[f64], known_c: &[f64]) -> Option<Vec<f64>> {
        let (n, steps) = (self.targets.zones, self.targets.steps());
        let limits = self.lifted.model().network().limits();
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
                low: u.iter().map(|u| -limits.cooling_kw[i] - u).collect(),
                high: u.iter().map(|u| limits.heating_kw[i] - u).collect(),
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
            let entry = |time: usize| time * targets.zones + j;
            for time in (0..targets.steps()).filter(|&t| targets.occupied[entry(t)]) {
                let error_k = targets.reference_c[entry(time)] - known_c[entry(time)];
                for sign in [1.0, -1.0] {
                    bounds.push(Bound { value: -sign * error_k - targets.band_k[entry(time)], sign, kernel, time });
                }
            }
        }
        bounds
    }

    /// u + step within the limits.
    fn limited(&self, heat_kw: &[f64], step_kw: impl Fn(usize) -> f64) -> Vec<f64> {
        let limits = self.lifted.model().network().limits();
        let n = limits.zones();
        let moved = |k: usize| limits.limited(k % n, heat_kw[k] + step_kw(k));
        (0..heat_kw.len()).map(|k| if self.silent == Some(k % n) { heat_kw[k] } else { moved(k) }).collect()
    }

    /// The best combination of the proposals and earlier steps; by the zones' knowledge never worse than d/n.
    fn best_step(
        &self,
        messages: &mut Messages,
        heat_kw: &[f64],
        d: &[f64],
        known_c: &[f64],
        past: &VecDeque<Direction>,
        sums: &mut usize,
    ) -> Vec<f64> {
        let n = self.targets.zones;
        let proposed = Direction { heat_kw: d.to_vec(), risen_k: stacked(&messages.directions(d), n) };
        let mut space = StepSpace { day: self, heat_kw, known_c, directions: vec![proposed], sums };
        let line = space.minimum()[0].clamp(1.0 / n as f64, 1.0);
        let cautious = self.limited(heat_kw, |k| line * d[k]);
        let cautious_cost = space.cost(&[line]);
        if past.is_empty() {
            return cautious;
        }
        space.directions.extend(past.iter().map(|direction| self.masked(messages, heat_kw, d, direction)));
        let x = space.minimum();
        let bold = self.limited(heat_kw, |k| space.step_kw(&x, k));
        // The limits may have changed the step: compute its actual effect.
        let change: Vec<f64> = bold.iter().zip(heat_kw).map(|(next, now)| next - now).collect();
        let risen_k = stacked(&messages.directions(&change), n);
        let bold_c: Vec<f64> = known_c.iter().zip(&risen_k).map(|(t, r)| t + r).collect();
        *space.sums += 1;
        if self.cost_of(&bold_c, &bold) <= cautious_cost { bold } else { cautious }
    }

    /// An earlier step without the inputs that are at a limit and stay there.
    fn masked(&self, messages: &mut Messages, heat_kw: &[f64], d: &[f64], direction: &Direction) -> Direction {
        let limits = self.lifted.model().network().limits();
        let n = limits.zones();
        let stays = |k: usize| d[k] == 0.0 && limits.excess_kw(k % n, heat_kw[k]) >= 0.0;
        if (0..heat_kw.len()).all(|k| direction.heat_kw[k] == 0.0 || !stays(k)) {
            return direction.clone();
        }
        let heat_kw: Vec<f64> =
            direction.heat_kw.iter().enumerate().map(|(k, step)| if stays(k) { 0.0 } else { *step }).collect();
        let risen_k = stacked(&messages.directions(&heat_kw), n);
        Direction { heat_kw, risen_k }
    }
}

/// Temperatures of the zones at the ends of the steps, stacked, from the nodes' series.
fn stacked(series: &[Vec<f64>], zones: usize) -> Vec<f64> {
    let steps = series.first().map_or(0, |series| series.len() - 1);
    (0..steps * zones).map(|k| series[k % zones][k / zones + 1]).collect()
}
