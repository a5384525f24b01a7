//! Sequential quadratic programming with the problem's own cost as merit function.
//!
//! From an iterate that obeys the dynamics, a [`StageQp`] gives a direction `w` and the decrease that its model predicts;
//! a backtracking search takes the largest `α ∈ {1, ½, ¼, …}` with
//!
//! ```text
//! φ(u + α w) ≤ φ(u) − 10⁻⁴ α · predicted,      φ = J − (1 − κ) Σ linear·s       (Armijo)
//! ```
//!
//! where `J` is evaluated on rolled-out states, so that every iterate is admissible. `J` charges a violation `s` of a soft
//! row with `linear = 1e3`, far more than the multipliers of most plans, and a merit so steep would allow only tiny steps
//! along a curved boundary. An exact penalty need only exceed the multipliers (Nocedal and Wright, section 18.5), so the
//! search counts the share `κ = 2 max λ/linear` of it, at most all.
//!
//! A full step that is refused is corrected to second order before it is shortened. The first step is Gauss-Newton; later
//! steps use the exact Hessian of the Lagrangian, which makes the end quadratic; where it is not positive definite on the
//! dynamics a third of the curvature is tried, then none: Gauss-Newton again. Steps that had to be cut very short are followed by damped ones (Levenberg and
//! Marquardt).
//!
//! A planner that plans anew at every step resumes ([`Memory`]): with the multipliers of its last optimum, a stage later, the
//! first step has the exact Hessian already, and where the shifted plan is optimal there is no step. Steps also tell the next
//! one how far to look for rows that matter ([`Reach`]).

use thiserror::Error;

use super::line_search::Search;
use super::linearize::{add_curvature, drop_curvature, linearise, soften_curvature};
use super::warm_start::Memory;
use crate::Input;
use crate::trajectory::problem::{Cost, Iterate, Problem};
use crate::trajectory::stage::kkt;
use crate::trajectory::stage::{Reach, StageError, StageQp, StageSolution, StageSolver};

/// When to stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerances {
    /// Largest KKT residual of a converged solution.
    pub residual: f64,
    /// An undamped step whose predicted decrease is below this share of `1 + |J|` is the last: beyond it the stage
    /// problems' own tolerance shows.
    pub decrease: f64,
    /// Most steps in one descent.
    pub iteration_limit: usize,
    /// A safety row (1 − d²) or a road edge \[m\] violated by more than this makes a solution suspect.
    pub slack: f64,
}

impl Default for Tolerances {
    fn default() -> Self {
        Tolerances { residual: 1e-8, decrease: 1e-11, iteration_limit: 100, slack: 1e-3 }
    }
}

impl Tolerances {
    /// Whether a descent ended somewhere, and not on a violated safety row or road edge.
    pub(crate) fn trust(&self, outcome: &Result<Optimum, DescentError>) -> bool {
        let keeps = |cost: &Cost| cost.safety_slack.max(cost.edge_slack_m) <= self.slack;
        outcome.as_ref().is_ok_and(|optimum| keeps(&optimum.cost))
    }
}

/// What a descent did.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Statistics {
    /// Starting guesses tried.
    pub starts: usize,
    /// Quadratic programmes posed; those refused as not convex cost little.
    pub programmes: usize,
    /// Iterations inside them.
    pub inner_iterations: usize,
    /// KKT residual at the end, by the independent check.
    pub residual: f64,
    /// How many steps fell back from the exact Hessian to Gauss-Newton.
    pub fallbacks: usize,
}

/// A local optimum.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Optimum {
    /// Inputs and states.
    pub iterate: Iterate,
    /// Its cost.
    pub cost: Cost,
    /// How it was found.
    pub statistics: Statistics,
}

/// Why no optimum was found.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum DescentError {
    /// A step problem had no solution.
    #[error("step {step}: {source}")]
    Step {
        /// Which step.
        step: usize,
        /// What the stage solver said.
        source: StageError,
    },
    /// The iteration limit.
    #[error("not converged after {} programmes: residual {:.1e}", .0.programmes, .0.residual)]
    NotConverged(Statistics),
    /// An exploration that was given up: nothing suggests that it ends below the cost that it has to beat.
    #[error("not below a cost of {0} within reason")]
    NotBelow(f64),
    /// The problem holds a number that is not finite.
    #[error("the problem has a cost that is not a number")]
    NotFinite,
}

/// Damping begins with this, in units of the comfort weights.
const GENTLEST: f64 = 1.0;
/// Where even this damping gains nothing, nothing does.
const FIRMEST: f64 = 1e6;
/// Tolerance of the very last step problem where rows on the verge of being active need it: such a row has slack and
/// multiplier of about its root.
const FINEST: f64 = 1e-14;
/// The residual with which the last step is content.
const GOOD: f64 = 1e-6;
/// Of a curvature that is not convex this share is tried before none.
const SOFTENED: f64 = 0.3;
/// A step is expected to go no farther than this many times the one before.
pub(super) const FARTHER: f64 = 2.0;
/// An exploration may still gain so many times what a step promises.
const PATIENCE: f64 = 10.0;
/// A smaller share of a step calls for damping.
const SHORT: f64 = 0.1;

/// A trajectory optimiser: a stage solver and the memory that a descent needs.
#[derive(Clone, Debug, Default)]
pub struct Optimiser<S> {
    /// The solver of step problems.
    pub solver: S,
    /// When to stop.
    pub tolerances: Tolerances,
    /// Whether a descent begins with the memory of the one before, if the problem has the same shape.
    pub resumes: bool,
    /// Whether [`Optimiser::best_of`] looks to the other side of the ellipses that an optimum touches (`across`).
    pub looks_across: bool,
    /// What the last descent left.
    pub memory: Memory,
    pub(super) qp: StageQp,
    pub(super) step: StageSolution,
    pub(super) search: Search,
    before: StageSolution,
    /// What the descent at work will leave as its reach.
    reach: Option<Reach>,
}

impl<S: StageSolver> Optimiser<S> {
    /// An optimiser with the default tolerances.
    pub fn new(solver: S) -> Self {
        Optimiser {
            solver,
            tolerances: Tolerances::default(),
            resumes: false,
            looks_across: false,
            memory: Memory::default(),
            qp: StageQp::default(),
            step: StageSolution::default(),
            search: Search::default(),
            before: StageSolution::default(),
            reach: None,
        }
    }

    /// An optimiser for somebody who plans anew at every step: it resumes, and it stops where the next plan will differ by
    /// more than what is left to gain.
    pub fn resuming(solver: S) -> Self {
        let tolerances = Tolerances { residual: 1e-7, decrease: 1e-9, ..Tolerances::default() };
        Optimiser { tolerances, resumes: true, ..Optimiser::new(solver) }
    }

    /// Descends from a guess (per participant, inputs; made admissible first) to a local optimum, and remembers it.
    ///
    /// # Errors
    /// [`DescentError`] if a step problem cannot be solved or the iteration limit is reached.
    pub fn descend(&mut self, problem: &Problem, guess: &[Vec<Input>]) -> Result<Optimum, DescentError> {
        let outcome = self.descend_from(problem, guess, self.resumes, f64::INFINITY);
        match outcome {
            Ok(_) => self.adopt(),
            Err(_) => self.memory = Memory::default(),
        }
        outcome
    }

    /// Descends from a guess that has nothing to do with what was planned before, in search of an optimum that costs less
    /// than `below`, and leaves the memory as it is.
    ///
    /// # Errors
    /// As [`Optimiser::descend`], and [`DescentError::NotBelow`] as soon as not even many times what a step promises would
    /// lead below.
    pub fn explore(&mut self, problem: &Problem, guess: &[Vec<Input>], below: f64) -> Result<Optimum, DescentError> {
        self.descend_from(problem, guess, false, below)
    }

    /// Remembers the descent that has just ended.
    pub fn adopt(&mut self) {
        self.memory.multipliers.clone_from(&self.step);
        self.memory.reach = self.reach;
    }

    fn descend_from(
        &mut self,
        problem: &Problem,
        guess: &[Vec<Input>],
        resumes: bool,
        below: f64,
    ) -> Result<Optimum, DescentError> {
        let mut now = self.begin(problem, problem.start(guess))?;
        let resumed = resumes && self.memory.fits(&self.qp);
        if resumed && self.recall(&mut now) {
            return Ok(now);
        }
        self.go_down(problem, now, resumed, below)
    }

    /// Descends from where the last step has led, with its multipliers.
    pub(super) fn descend_on(
        &mut self,
        problem: &Problem,
        iterate: Iterate,
        below: f64,
    ) -> Result<Optimum, DescentError> {
        let now = self.begin(problem, iterate)?;
        self.go_down(problem, now, true, below)
    }

    /// The beginning of a descent, with its step problem posed.
    fn begin(&mut self, problem: &Problem, iterate: Iterate) -> Result<Optimum, DescentError> {
        let cost = problem.cost(&iterate);
        if !cost.total.is_finite() {
            return Err(DescentError::NotFinite);
        }
        self.search.restart();
        linearise(problem, &iterate, &mut self.qp);
        Ok(Optimum { iterate, cost, statistics: Statistics { starts: 1, ..Statistics::default() } })
    }

    /// Begins with what is remembered, one stage later. Returns whether nothing is left to do.
    fn recall(&mut self, now: &mut Optimum) -> bool {
        self.step.clone_from(&self.memory.multipliers);
        self.step.pass_a_stage();
        self.reach = self.memory.reach;
        self.qp.reach = self.reach;
        now.statistics.residual = kkt::residual(&self.qp, &self.step).largest();
        now.statistics.residual <= self.tolerances.residual
    }

    /// Takes steps until the tolerances are met.
    fn go_down(
        &mut self,
        problem: &Problem,
        mut now: Optimum,
        resumed: bool,
        below: f64,
    ) -> Result<Optimum, DescentError> {
        let mut damping = 0.0;
        for step in 0..self.tolerances.iteration_limit {
            self.before.clone_from(&self.step);
            let warm = step > 0 || resumed;
            self.direction(problem, &mut now, warm, damping)?;
            let promised = -self.qp.change(&self.step);
            if now.cost.total - PATIENCE * (1.0 + damping) * promised.max(0.0) > below {
                return Err(DescentError::NotBelow(below));
            }
            let predicted = self.predict(&now.cost, promised);
            let little = predicted <= self.tolerances.decrease * (1.0 + now.cost.total.abs());
            // A damped step promises little because it is short, not because there is little to gain.
            let last = self.qp.damping == 0.0 && little;
            let share = self.advance(problem, &mut now, predicted, last);
            if warm {
                self.step.retreat(&self.before, share);
            }
            damping = match share {
                0.0 if last => 0.0,
                // Nothing is left to gain but what the merit's own rounding hides.
                0.0 if self.qp.damping > FIRMEST && now.statistics.residual <= GOOD => return Ok(now),
                0.0 if self.qp.damping > FIRMEST => break,
                0.0 => (16.0 * self.qp.damping).max(GENTLEST),
                short if short < SHORT => (4.0 * self.qp.damping).max(GENTLEST),
                1.0 if self.qp.damping > GENTLEST => 0.25 * self.qp.damping,
                1.0 => 0.0,
                _ => self.qp.damping,
            };
            // A damped step says little about the next.
            let reach = (damping == 0.0).then(|| self.step.reach().times(FARTHER));
            if step == 0 {
                self.reach = reach;
            }
            linearise(problem, &now.iterate, &mut self.qp);
            self.qp.reach = reach;
            self.step.rest();
            now.statistics.residual = kkt::residual(&self.qp, &self.step).largest();
            if last && now.statistics.residual > GOOD {
                self.polish(problem, &mut now);
            }
            if last || now.statistics.residual <= self.tolerances.residual {
                return Ok(now);
            }
        }
        Err(DescentError::NotConverged(now.statistics))
    }

    /// One more step, from a step problem solved to the last digits, if that brings the optimality conditions nearer.
    /// (Where large weights cost more digits than that it does not.)
    fn polish(&mut self, problem: &Problem, now: &mut Optimum) {
        let Optimum { cost, statistics: Statistics { residual, .. }, .. } = *now;
        self.before.clone_from(&self.step);
        self.qp.tolerance = FINEST;
        if self.direction(problem, now, true, 0.0).is_ok() && self.take(problem, now, 1.0, 0.0, true) {
            linearise(problem, &now.iterate, &mut self.qp);
            self.step.rest();
            now.statistics.residual = kkt::residual(&self.qp, &self.step).largest();
            if now.statistics.residual <= residual {
                return;
            }
            self.undo(now);
            now.cost = cost;
        }
        self.step.clone_from(&self.before);
        now.statistics.residual = residual;
    }

    /// Solves the step problem at `now`: with the exact Hessian if there are multipliers to make it from and it is convex.
    fn direction(
        &mut self,
        problem: &Problem,
        now: &mut Optimum,
        warm: bool,
        damping: f64,
    ) -> Result<(), DescentError> {
        self.qp.damping = damping;
        let mut outcome = Err(StageError::NotConvex { stage: 0 });
        if warm && self.solver.accepts_curvature() {
            add_curvature(problem, &now.iterate, &mut self.step, &mut self.qp);
            outcome = self.solve_step(now, damping == 0.0);
            now.statistics.fallbacks += usize::from(outcome.is_err());
            if matches!(outcome, Err(StageError::NotConvex { .. })) {
                soften_curvature(&mut self.qp, SOFTENED);
                outcome = self.solve_step(now, false);
            }
        }
        if outcome.is_err() {
            drop_curvature(&mut self.qp);
            outcome = self.solve_step(now, false);
        }
        outcome.map_err(|source| DescentError::Step { step: now.statistics.programmes, source })
    }

    pub(super) fn solve_step(&mut self, now: &mut Optimum, warm: bool) -> Result<(), StageError> {
        now.statistics.programmes += 1;
        let outcome = self.solver.solve(&self.qp, &mut self.step, warm);
        now.statistics.inner_iterations += self.step.iterations;
        outcome
    }
}
