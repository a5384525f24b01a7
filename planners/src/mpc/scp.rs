//! Sequential quadratic programming with the cost as its own merit function.
//!
//! From an iterate that obeys the dynamics, a [`StageQp`] gives a direction `w` and the decrease that its model predicts;
//! a backtracking search takes the largest `α ∈ {1, ½, ¼, …}` with
//!
//! ```text
//! J(u + α w) ≤ J(u) − 10⁻⁴ α · predicted          (Armijo)
//! ```
//!
//! where `J` is evaluated on rolled-out states. Every iterate is admissible and the cost never rises, so the method
//! cannot cycle. A full step that is refused is corrected to second order before it is shortened. The first step is
//! Gauss-Newton; later steps use the exact Hessian of the Lagrangian, which makes the end quadratic; where it is not positive
//! definite on the dynamics, `½ μ Σ‖w_k‖²` is added to it (Levenberg and Marquardt), and if that does not help the step is
//! Gauss-Newton again.

use thiserror::Error;

use super::kkt;
use super::linearise::{add_curvature, drop_curvature, linearise, move_rows};
use super::problem::{Cost, Iterate, Problem};
use super::stage::{StageError, StageQp, StageSolution, StageSolver};
use crate::Input;

/// When to stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerances {
    /// Largest KKT residual of a converged solution.
    pub residual: f64,
    /// A step whose predicted decrease is below this share of `1 + |J|` ends the search too.
    pub decrease: f64,
    /// Most steps in one descent.
    pub iteration_limit: usize,
    /// A safety row violated by more than this makes a solution suspect (1 − d²).
    pub slack: f64,
}

impl Default for Tolerances {
    fn default() -> Self {
        Tolerances { residual: 1e-6, decrease: 1e-10, iteration_limit: 50, slack: 1e-3 }
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
    /// The problem holds a number that is not finite.
    #[error("the problem has a cost that is not a number")]
    NotFinite,
}

/// A trajectory optimiser: a stage solver and the memory that a descent needs.
#[derive(Clone, Debug, Default)]
pub struct Optimiser<S> {
    /// The solver of step problems.
    pub solver: S,
    /// When to stop.
    pub tolerances: Tolerances,
    qp: StageQp,
    step: StageSolution,
    trial: Iterate,
    held: StageSolution,
}

/// Damping that is tried in turn where the exact Hessian is not positive definite. Comfort weights are of the order of
/// the first.
const DAMPING: [f64; 3] = [0.1, 1.0, 10.0];

/// How the next step problem is made.
#[derive(Clone, Copy, Debug)]
struct Model {
    /// Whether the curvature of dynamics and rows is in it.
    curved: bool,
    damping: f64,
}

impl Model {
    const GAUSS_NEWTON: Model = Model { curved: false, damping: 0.0 };
    const EXACT: Model = Model { curved: true, damping: 0.0 };

    /// What to try after a step that no search could use; nothing once steps would be too short to matter.
    fn firmer(self) -> Option<Model> {
        match self {
            Model { curved: true, .. } => Some(Model::GAUSS_NEWTON),
            Model { damping, .. } if damping < 1e4 => Some(Model { curved: false, damping: (10.0 * damping).max(1.0) }),
            _ => None,
        }
    }
}

impl<S: StageSolver> Optimiser<S> {
    /// An optimiser with the default tolerances.
    pub fn new(solver: S) -> Self {
        Optimiser {
            solver,
            tolerances: Tolerances::default(),
            qp: StageQp::default(),
            step: StageSolution::default(),
            trial: Iterate::default(),
            held: StageSolution::default(),
        }
    }

    /// Descends from a guess (per participant, inputs; made admissible first) to a local optimum.
    ///
    /// # Errors
    /// [`DescentError`] if a step problem cannot be solved or the iteration limit is reached.
    pub fn descend(&mut self, problem: &Problem, guess: &[Vec<Input>]) -> Result<Optimum, DescentError> {
        let mut now = Optimum { iterate: start(problem, guess), ..Optimum::default() };
        now.statistics.starts = 1;
        now.cost = problem.cost(&now.iterate);
        if !now.cost.total.is_finite() {
            return Err(DescentError::NotFinite);
        }
        linearise(problem, &now.iterate, &mut self.qp);
        let mut model = Model::GAUSS_NEWTON;
        for _ in 0..self.tolerances.iteration_limit {
            let predicted = self.direction(problem, &mut now, model)?;
            // A damped step promises little because it is short, not because there is little to gain.
            let ended = self.qp.damping == 0.0 && predicted <= self.tolerances.decrease * (1.0 + now.cost.total.abs());
            let moved = self.take(problem, &mut now, 1.0, predicted)
                || self.correct(problem, &mut now, predicted)
                || self.search(problem, &mut now, predicted);
            if !moved && !ended {
                now.statistics.fallbacks += 1;
                let Some(next) = model.firmer() else { break };
                model = next;
            } else {
                model = if self.solver.accepts_curvature() { Model::EXACT } else { Model::GAUSS_NEWTON };
            }
            linearise(problem, &now.iterate, &mut self.qp);
            self.step.rest();
            now.statistics.residual = kkt::residual(&self.qp, &self.step).largest();
            if ended || now.statistics.residual <= self.tolerances.residual {
                return Ok(now);
            }
        }
        Err(DescentError::NotConverged(now.statistics))
    }

    /// Solves the step problem at `now`, returning the decrease that it predicts (at least 0 for Gauss-Newton).
    fn direction(&mut self, problem: &Problem, now: &mut Optimum, model: Model) -> Result<f64, DescentError> {
        let exact = model.curved;
        if exact {
            add_curvature(problem, &now.iterate, &mut self.step, &mut self.qp);
        } else {
            drop_curvature(&mut self.qp);
        }
        self.qp.damping = model.damping;
        let warm = now.statistics.programmes > 0;
        let mut outcome = self.solve_step(now, warm);
        for damping in DAMPING {
            if exact && matches!(outcome, Err(StageError::NotConvex { .. })) {
                now.statistics.fallbacks += 1;
                self.qp.damping = damping;
                outcome = self.solve_step(now, false);
            }
        }
        if exact && outcome.is_err() {
            now.statistics.fallbacks += 1;
            self.qp.damping = 0.0;
            drop_curvature(&mut self.qp);
            outcome = self.solve_step(now, false);
        }
        outcome.map_err(|source| DescentError::Step { step: now.statistics.programmes, source })?;
        Ok(-self.qp.change(&self.step))
    }

    fn solve_step(&mut self, now: &mut Optimum, warm: bool) -> Result<(), StageError> {
        now.statistics.programmes += 1;
        let outcome = self.solver.solve(&self.qp, &mut self.step, warm);
        now.statistics.inner_iterations += self.step.iterations;
        outcome
    }

    /// Takes a share of the step if the cost falls by a sufficient part of what was predicted.
    fn take(&mut self, problem: &Problem, now: &mut Optimum, share: f64, predicted: f64) -> bool {
        const SUFFICIENT: f64 = 1e-4;
        self.try_step(problem, &now.iterate, share);
        let cost = problem.cost(&self.trial);
        let enough = now.cost.total - SUFFICIENT * share * predicted.max(0.0);
        let accepted = cost.total <= enough && cost.total < now.cost.total;
        if accepted {
            std::mem::swap(&mut now.iterate, &mut self.trial);
            now.cost = cost;
        }
        accepted
    }

    /// Second-order correction: the rows are taken where the full step really led, and the step problem is solved again.
    /// Without it, steps along a curved boundary are cut short for the little by which they miss it (Maratos).
    fn correct(&mut self, problem: &Problem, now: &mut Optimum, predicted: f64) -> bool {
        self.held.clone_from(&self.step);
        move_rows(problem, &self.trial, &self.step, &mut self.qp);
        let solved = self.solve_step(now, true).is_ok();
        let taken = solved && self.take(problem, now, 1.0, predicted);
        if !taken {
            self.step.clone_from(&self.held);
        }
        taken
    }

    /// The backtracking search along the step; says whether the iterate moved.
    fn search(&mut self, problem: &Problem, now: &mut Optimum, predicted: f64) -> bool {
        const SHORTEST: f64 = 1.0 / 1024.0;
        let shares = std::iter::successors(Some(0.5), |share| Some(0.5 * share)).take_while(|share| *share >= SHORTEST);
        shares.into_iter().any(|share| self.take(problem, now, share, predicted))
    }

    fn try_step(&mut self, problem: &Problem, from: &Iterate, share: f64) {
        self.trial.inputs.resize_with(from.inputs.len(), Vec::new);
        for (i, inputs) in from.inputs.iter().enumerate() {
            let steps = inputs.iter().zip(&self.step.inputs[i]);
            self.trial.inputs[i].clear();
            self.trial.inputs[i].extend(steps.map(|(input, [acceleration, steering])| Input {
                acceleration_mps2: input.acceleration_mps2 + share * acceleration,
                steering_rad: input.steering_rad + share * steering,
            }));
        }
        problem.roll_out(&mut self.trial);
    }

    /// Descends from the first guess; if that fails or ends on a violated safety row (a stationary point inside an
    /// ellipse: it happens), or if `look_around` asks for it, from the others too. The cheapest optimum wins.
    ///
    /// # Errors
    /// That of the first guess, if every guess fails.
    pub fn best_of(
        &mut self,
        problem: &Problem,
        guesses: &[Vec<Vec<Input>>],
        look_around: bool,
    ) -> Result<Optimum, DescentError> {
        let Some((first, others)) = guesses.split_first() else { return Err(DescentError::NotFinite) };
        let mut best = self.descend(problem, first);
        let trusted = best.as_ref().is_ok_and(|optimum| optimum.cost.safety_slack <= self.tolerances.slack);
        if trusted && !look_around {
            return best;
        }
        let mut total = best.as_ref().map_or_else(|_| Statistics::default(), |optimum| optimum.statistics);
        for guess in others {
            let Ok(candidate) = self.descend(problem, guess) else { continue };
            total.starts += 1;
            total.programmes += candidate.statistics.programmes;
            total.inner_iterations += candidate.statistics.inner_iterations;
            let cheaper =
                |held: &Optimum| candidate.cost.total < held.cost.total - 1e-9 * (1.0 + held.cost.total.abs());
            if best.as_ref().map_or(true, cheaper) {
                best = Ok(candidate);
            }
        }
        best.map(|optimum| {
            let residual = optimum.statistics.residual;
            Optimum { statistics: Statistics { residual, ..total }, ..optimum }
        })
    }
}

/// The admissible iterate nearest to a guess.
fn start(problem: &Problem, guess: &[Vec<Input>]) -> Iterate {
    let inputs = problem.participants.iter().enumerate().map(|(i, participant)| {
        let guess = guess.get(i).map(Vec::as_slice).unwrap_or_default();
        participant.admissible(guess, problem.horizon)
    });
    let mut iterate = Iterate { inputs: inputs.collect(), states: Vec::new() };
    problem.roll_out(&mut iterate);
    iterate
}
