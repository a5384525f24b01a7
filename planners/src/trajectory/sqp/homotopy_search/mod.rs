//! The search over homotopy classes: which homotopy classes a problem has, and which of them holds the cheapest plan.
//!
//! A descent ends in the optimum of the class where it began: before or behind another vehicle, to its left or to its right.
//! Which class is the cheapest no descent can tell. So before a plan is made the classes are enumerated:
//!
//! 1. A plan that touches no ellipse and violates nothing has no rival: without ellipses the problem has one optimum.
//! 2. Otherwise simple motions ([`motions`]) are rolled out and sorted into classes ([`HomotopyClass`]). The cheapest of each other
//!    class represents it; classes out of reach have no representative. A plan that violates something is compared with
//!    the representative of its own class, too.
//! 3. Each class is bounded by what one Gauss-Newton step from its representative promises. Where that is less than the plan
//!    at hand costs, a descent begins there. It is given up as soon as it enters a class whose optimum is known and its steps
//!    promise nothing cheaper: most descents that fail end in the plan at hand.
//! 4. The cheapest optimum wins if it saves enough ([`super::hysteresis`]).
//!
//! A comparison may take several plans: each has a limit of work, and an exploration that reaches it goes on with the next
//! plan, a step later. Only the first comparison, and one without any plan to fall back on, are made at once.
//! After a comparison that changed nothing the next few plans go without one, more of them where every other class is far
//! dearer.

mod followed_road;
mod global;
mod motions;
mod start_outside;

use super::comparison::{Round, Unfinished};
use super::exploration::{Exploration, GivesUp, replace};
use super::homotopy_class::HomotopyClass;
use super::optimiser::Optimiser;
use super::optimum::{DescentError, Optimum, Statistics, Tolerances};
use super::search_setting::HomotopySearch;
use crate::Input;
use crate::trajectory::iterate::Iterate;
use crate::trajectory::problem::Problem;
use crate::trajectory::stage::{ACTIVE_MULTIPLIER, StageSolver};
use motions::for_each_motion;

/// Most classes that are examined in one comparison, the cheapest representatives first.
const MAX_CLASSES: usize = 4;
/// Most work of one exploration, spread over plans.
const EXPLORATION_WORK: usize = 400;
/// A plan that costs this multiple of the one before is compared at once: a vehicle did what was not expected.
const MAX_COST_GROWTH: f64 = 1.1;
/// With every other class dearer than this multiple of the plan, the comparison rests longer.
const FAR_COST_RATIO: f64 = 2.0;
/// Number of plans without a comparison after one that changed nothing, and after one that found all others far dearer.
const PLANS_AT_REST: [usize; 2] = [2, 4];

/// The cheapest motion of a class.
struct Representative {
    class: HomotopyClass,
    cost: f64,
    iterate: Iterate,
}

impl<S: StageSolver> Optimiser<S> {
    /// The cheapest plan: descends from a guess (per participant, inputs), which decides a first homotopy class, then compares it
    /// with others as far as [`Optimiser::homotopy_search`] says.
    ///
    /// # Errors
    /// That of the descent from the guess, if no class has an optimum.
    pub fn optimise(&mut self, problem: &Problem, guess: &[Vec<Input>]) -> Result<Optimum, DescentError> {
        let found = self.descend(problem, guess);
        let trusted = self.tolerances.trust(&found);
        // What a descent has come to without an end has no multipliers to tell.
        let is_unfinished = found.as_ref().is_ok_and(|optimum| optimum.statistics.unfinished > 0);
        match self.homotopy_search {
            HomotopySearch::Off if trusted => return found,
            _ if trusted && !(is_unfinished || self.has_rivals(problem)) => return found,
            HomotopySearch::Global => return self.search_globally(problem, found),
            _ => {}
        }
        let cost = found.as_ref().map_or(f64::INFINITY, |optimum| optimum.cost.total);
        let has_jumped = cost > MAX_COST_GROWTH * self.comparison.last_cost;
        self.comparison.last_cost = cost;
        if trusted && !has_jumped && self.comparison.plans_at_rest > 0 {
            self.comparison.plans_at_rest -= 1;
            return found;
        }
        self.compare_classes(problem, guess, found)
    }

    /// As [`Optimiser::optimise`]; without any optimum, the motion that the descent from the guess has come to, if it is cheaper
    /// than the guess and no less safe. The guess is what a vehicle without a plan would follow.
    ///
    /// # Errors
    /// That of the descent from the guess, if the guess is cheaper or safer.
    pub fn optimise_or_improve(&mut self, problem: &Problem, guess: &[Vec<Input>]) -> Result<Optimum, DescentError> {
        let mut reached = match self.optimise(problem, guess) {
            Err(DescentError::NotConverged(reached)) => reached,
            outcome => return outcome,
        };
        let before = problem.cost(&problem.start(guess));
        if reached.cost.total < before.total && reached.cost.unsafety() <= before.unsafety() {
            reached.statistics.unfinished = 1;
            return Ok(*reached);
        }
        Err(DescentError::NotConverged(reached))
    }

    /// Whether the optimum of the last descent touches an ellipse.
    fn has_rivals(&self, problem: &Problem) -> bool {
        let mut block = 0;
        for rows in problem.row_terms() {
            let multipliers = self.warm_start.multipliers.row_multipliers.get(block);
            let touches = |row: &Vec<f64>| row.iter().any(|multiplier| *multiplier > ACTIVE_MULTIPLIER);
            if rows.ellipse(0).is_some() && multipliers.is_some_and(touches) {
                return true;
            }
            block += rows.rows_per_stage();
        }
        false
    }

    /// The cheapest of what the descent from a guess found and the optima of other classes, as far as the work of one plan goes.
    fn compare_classes(
        &mut self,
        problem: &Problem,
        guess: &[Vec<Input>],
        mut best: Result<Optimum, DescentError>,
    ) -> Result<Optimum, DescentError> {
        let mut round = std::mem::take(&mut self.comparison.round);
        // The class of a plan that violates something may hold a better one.
        let trusted = best.as_ref().ok().filter(|_| self.tolerances.trust(&best));
        let own_class = trusted.map(|optimum| HomotopyClass::classify(problem, &optimum.iterate));
        let planned = best.as_ref().ok().map(|optimum| &optimum.iterate);
        let mut candidates = representatives(problem, planned, own_class);
        if problem.has_pairs() {
            // The guess may be a simple motion itself: `Problem::start_outside`.
            let begun = problem.start(guess);
            candidates.retain(|candidate| candidate.iterate.inputs != begun.inputs);
        }
        candidates.truncate(MAX_CLASSES);
        candidates.retain(|candidate| !round.examined.contains(&candidate.class));
        let mut candidates = candidates.into_iter().peekable();
        round.settled.extend(own_class);
        let mut work_left = self.work_of_a_plan(&best);
        while self.bar(&best) > 0.0 {
            // (With a bar of 0 the plan cannot be beaten by more than the hysteresis: costs are not negative, but with the exact
            // value of Bayesian responses, which is not compared then.)
            if work_left == 0 && (round.unfinished.is_some() || candidates.peek().is_some()) {
                self.comparison.round = round;
                self.comparison.plans_at_rest = 0;
                return best;
            }
            let (iterate, work_before) = match (round.unfinished.take(), &mut candidates) {
                (Some(unfinished), _) => (unfinished.iterate(problem), unfinished.work),
                (None, candidates) => {
                    let Some(Representative { class, iterate, .. }) = candidates.next() else { break };
                    round.examined.push(class);
                    (iterate, 0)
                }
            };
            let most = self.work_of_an_exploration(&best);
            let limit = work_left.min(most.saturating_sub(work_before));
            let work = self.examine(problem, iterate, limit, &mut round, &mut best);
            round.unfinished = round.unfinished.and_then(|unfinished| unfinished.after(work_before, most));
            work_left -= work.min(work_left);
        }
        self.comparison.has_finished = true;
        let is_far = best.as_ref().is_ok_and(|held| round.nearest_cost > FAR_COST_RATIO * held.cost.total);
        self.comparison.plans_at_rest = if round.has_changed { 0 } else { PLANS_AT_REST[usize::from(is_far)] };
        best
    }

    /// Most work of the explorations of this plan. The first comparison of all, and one that has no plan at all to fall
    /// back on, are made at once.
    fn work_of_a_plan(&self, best: &Result<Optimum, DescentError>) -> usize {
        let is_at_once = !self.comparison.has_finished || best.is_err();
        if is_at_once { usize::MAX } else { self.tolerances.comparison_work_limit }
    }

    /// Most work of one exploration.
    fn work_of_an_exploration(&self, best: &Result<Optimum, DescentError>) -> usize {
        let limit = self.tolerances.work_limit;
        if best.is_err() { limit } else { limit.min(EXPLORATION_WORK) }
    }

    /// Explores from an iterate within a limit of work, and notes in `round` and `best` what it found. Returns its work.
    fn examine(
        &mut self,
        problem: &Problem,
        iterate: Iterate,
        work_limit: usize,
        round: &mut Round,
        best: &mut Result<Optimum, DescentError>,
    ) -> usize {
        let tolerances = Tolerances { work_limit, ..self.tolerances };
        let gives_up = GivesUp { above: self.bar(best), settled: &round.settled };
        let explored = self.explore_class(problem, iterate, gives_up.above, Some(&gives_up), &tolerances);
        if let Ok(Exploration::Cheaper(found) | Exploration::Dearer(found)) = &explored {
            round.settled.push(HomotopyClass::classify(problem, &found.iterate));
        }
        let statistics = match explored {
            Ok(Exploration::Cheaper(found)) => {
                round.has_changed = true;
                return replace(best, found);
            }
            Ok(Exploration::Dearer(found)) => {
                round.nearest_cost = round.nearest_cost.min(found.cost.total);
                best.iter_mut().for_each(|held| held.note_rival(&found));
                return found.statistics.work();
            }
            Ok(Exploration::Unfinished(mut reached)) if self.is_better(&reached, best) => {
                reached.statistics.unfinished = 1;
                round.has_changed = true;
                return replace(best, reached);
            }
            Ok(Exploration::Unfinished(reached)) => {
                let work = reached.statistics.work();
                // A descent may also stop because no step leads on.
                round.unfinished = (work >= work_limit).then(|| Unfinished::at(&reached.iterate, work));
                reached.statistics
            }
            Err(DescentError::NotBelow { expected, statistics, .. }) => {
                round.nearest_cost = round.nearest_cost.min(expected);
                statistics
            }
            Err(DescentError::Settled(statistics)) => statistics,
            Err(_) => Statistics::default(),
        };
        best.iter_mut().for_each(|held| held.add_work(&statistics));
        statistics.work()
    }
}

/// The cheapest simple motion of each class but one, the cheapest first; `planned` is what all vehicles plan so far.
fn representatives(
    problem: &Problem,
    planned: Option<&Iterate>,
    without: Option<HomotopyClass>,
) -> Vec<Representative> {
    let mut found: Vec<Representative> = Vec::new();
    for_each_motion(problem, planned, |iterate| {
        let class = HomotopyClass::classify(problem, iterate);
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
