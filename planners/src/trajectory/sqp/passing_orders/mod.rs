//! Passing orders: which classes of motion a problem has, and which of them holds the cheapest plan.
//!
//! A descent ends in the optimum of the class where it began: before or behind another vehicle, to its left or to its right.
//! Which class is the cheapest no descent can tell. So before a plan is made the classes are enumerated:
//!
//! 1. A plan that touches no ellipse and violates nothing has no rival: without ellipses the problem has one optimum.
//! 2. Otherwise simple motions ([`motions`]) are rolled out and sorted into classes ([`PassingClass`]). The cheapest of each other
//!    class represents it; classes out of reach have no representative. A plan that violates something is compared with
//!    the representative of its own class, too.
//! 3. Each class is bounded by what one Gauss-Newton step from its representative promises. Where that is less than the plan
//!    at hand costs, a descent begins there. It is given up as soon as it enters a class whose optimum is known and its steps
//!    promise nothing cheaper: most descents that fail end in the plan at hand.
//! 4. The cheapest optimum wins if it saves at least [`MIN_COST_ADVANTAGE`] of `1 + cost`: the hysteresis between plans that
//!    are equally good.
//!
//! After a comparison that changed nothing the next few plans go without one, more of them where every other class is far
//! dearer: an order that becomes cheaper is taken two plans later at most, four where it was far from it.

mod motions;

use super::exploration::{Exploration, GivesUp};
use super::optimiser::Optimiser;
use super::optimum::{DescentError, Optimum, Tolerances};
use super::passing_class::PassingClass;
use crate::Input;
use crate::trajectory::iterate::Iterate;
use crate::trajectory::problem::Problem;
use crate::trajectory::stage::{ACTIVE_MULTIPLIER, StageSolver};
use motions::for_each_motion;

/// Another class replaces the plan at hand if it saves this share of `1 + cost`.
const MIN_COST_ADVANTAGE: f64 = 1e-3;
/// Most classes that are examined for one plan, the cheapest representatives first.
const MAX_CLASSES: usize = 4;
/// Most quadratic programmes of an exploration while there is a safe plan to fall back on.
const EXPLORATION_LIMIT: usize = 40;
/// A plan that costs this multiple of the one before is compared at once: somebody did what was not expected.
const MAX_COST_GROWTH: f64 = 1.1;
/// With every other class dearer than this multiple of the plan, the comparison rests longer.
const FAR_COST_RATIO: f64 = 2.0;
/// Number of plans without a comparison after one that changed nothing, and after one that found all others far dearer.
const PLANS_AT_REST: [usize; 2] = [2, 4];

/// The cheapest motion of a class.
struct Representative {
    class: PassingClass,
    cost: f64,
    iterate: Iterate,
}

impl<S: StageSolver> Optimiser<S> {
    /// The cheapest plan: descends from a guess (per participant, inputs), which decides a first class of motion, then compares it
    /// with the other classes unless [`Optimiser::compares_passing_orders`] is off.
    ///
    /// # Errors
    /// That of the descent from the guess, if no class has an optimum.
    pub fn optimise(&mut self, problem: &Problem, guess: &[Vec<Input>]) -> Result<Optimum, DescentError> {
        let found = self.descend(problem, guess);
        let trusted = self.tolerances.trust(&found);
        if trusted && !(self.compares_passing_orders && self.has_rivals(problem)) {
            return found;
        }
        let cost = found.as_ref().map_or(f64::INFINITY, |optimum| optimum.cost.total);
        let has_jumped = cost > MAX_COST_GROWTH * self.warm_start.last_cost;
        self.warm_start.last_cost = cost;
        if trusted && !has_jumped && self.warm_start.plans_at_rest > 0 {
            self.warm_start.plans_at_rest -= 1;
            return found;
        }
        self.compare_classes(problem, found)
    }

    /// Whether the optimum of the last descent touches an ellipse.
    fn has_rivals(&self, problem: &Problem) -> bool {
        let mut block = 0;
        for rows in problem.row_terms() {
            let multipliers = self.warm_start.multipliers.row_multipliers.get(block);
            let touches = |row: &Vec<f64>| row.iter().any(|multiplier| *multiplier > ACTIVE_MULTIPLIER);
            if rows.ellipse().is_some() && multipliers.is_some_and(touches) {
                return true;
            }
            block += rows.rows_per_stage();
        }
        false
    }

    /// The cheapest of what a descent found and the optima of other classes.
    fn compare_classes(
        &mut self,
        problem: &Problem,
        mut best: Result<Optimum, DescentError>,
    ) -> Result<Optimum, DescentError> {
        // The class of a plan that violates something may hold a better one.
        let trusted = best.as_ref().ok().filter(|_| self.tolerances.trust(&best));
        let own_class = trusted.map(|optimum| PassingClass::of(problem, &optimum.iterate));
        let planned = best.as_ref().ok().map(|optimum| &optimum.iterate);
        let mut settled: Vec<PassingClass> = own_class.into_iter().collect();
        let (mut nearest, mut has_changed) = (f64::INFINITY, best.is_err());
        for Representative { iterate, .. } in representatives(problem, planned, own_class).into_iter().take(MAX_CLASSES)
        {
            let bar = self.bar(&best);
            if bar <= 0.0 {
                // The plan cannot be beaten by more than the hysteresis: costs are not negative, but with the exact value
                // of Bayesian replies, which is not compared then.
                break;
            }
            let gives_up = GivesUp { above: bar, settled: &settled };
            let explored = self.explore_class(problem, iterate, gives_up, &self.exploration_tolerances(&best));
            if let Ok(Exploration::Cheaper(found) | Exploration::Dearer(found)) = &explored {
                settled.push(PassingClass::of(problem, &found.iterate));
            }
            match (explored, &mut best) {
                (Ok(Exploration::Cheaper(found)), best) => {
                    has_changed = true;
                    match best {
                        Ok(held) => held.give_way(found),
                        Err(_) => *best = Ok(found),
                    }
                }
                (Ok(Exploration::Dearer(found)), Ok(held)) => {
                    nearest = nearest.min(found.cost.total);
                    held.note_rival(&found);
                }
                (Err(DescentError::NotBelow { statistics, expected, .. }), Ok(held)) => {
                    nearest = nearest.min(expected);
                    held.add_work(&statistics);
                }
                (Err(DescentError::Settled(statistics) | DescentError::NotConverged(statistics)), Ok(held)) => {
                    held.add_work(&statistics);
                }
                _ => {}
            }
        }
        let is_far = best.as_ref().is_ok_and(|held| nearest > FAR_COST_RATIO * held.cost.total);
        self.warm_start.plans_at_rest = if has_changed { 0 } else { PLANS_AT_REST[usize::from(is_far)] };
        best
    }

    /// When an exploration stops: soon, where there is a safe plan to fall back on.
    fn exploration_tolerances(&self, best: &Result<Optimum, DescentError>) -> Tolerances {
        let Tolerances { programme_limit, .. } = self.tolerances;
        let limit = if self.tolerances.trust(best) { EXPLORATION_LIMIT } else { programme_limit };
        Tolerances { programme_limit: limit.min(programme_limit), ..self.tolerances }
    }

    /// What an optimum of another class has to cost less than. In trouble no hysteresis holds.
    fn bar(&self, best: &Result<Optimum, DescentError>) -> f64 {
        match best {
            Ok(held) if self.tolerances.trust(best) => {
                held.cost.total - MIN_COST_ADVANTAGE * (1.0 + held.cost.total.abs())
            }
            Ok(held) => held.bar(),
            Err(_) => f64::INFINITY,
        }
    }
}

/// The cheapest simple motion of each class but one, the cheapest first; `planned` is what everybody plans so far.
fn representatives(problem: &Problem, planned: Option<&Iterate>, without: Option<PassingClass>) -> Vec<Representative> {
    let mut found: Vec<Representative> = Vec::new();
    for_each_motion(problem, planned, |iterate| {
        let class = PassingClass::of(problem, iterate);
        if without == Some(class) {
            return;
        }
        let cost = problem.cost(iterate).total;
        match found.iter_mut().find(|known| known.class == class) {
            Some(known) if known.cost <= cost => {}
            Some(known) => {
                known.cost = cost;
                known.iterate.clone_from(iterate);
            }
            None => found.push(Representative { class, cost, iterate: iterate.clone() }),
        }
    });
    found.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    found
}
