//! The optimiser that planners hold: descents, and what one leaves to the next.

use super::comparison::Comparison;
use super::descent::Descent;
use super::exploration::{Exploration, GivesUp};
use super::optimum::{DescentError, Optimum, Tolerances};
use super::search_setting::HomotopySearch;
use super::warm_start::WarmStart;
use crate::Input;
use crate::trajectory::iterate::Iterate;
use crate::trajectory::problem::Problem;
use crate::trajectory::stage::StageSolver;

/// A trajectory optimiser: a stage solver and the memory that a descent needs.
#[derive(Clone, Debug, Default)]
pub struct Optimiser<S> {
    /// Tolerances and limits of a descent.
    pub tolerances: Tolerances,
    /// Whether a descent starts warm: with the multipliers that the one before has left, if the problem has the same shape.
    pub starts_warm: bool,
    /// How far [`Optimiser::optimise`] looks for a cheaper homotopy class.
    pub homotopy_search: HomotopySearch,
    /// Multipliers of the last descent whose optimum was kept, for the next one.
    pub warm_start: WarmStart,
    /// How far the comparison of classes has got.
    pub(super) comparison: Comparison,
    pub(super) descent: Descent<S>,
}

impl<S: StageSolver + Default> Optimiser<S> {
    /// An optimiser with the default tolerances.
    pub fn new(solver: S) -> Self {
        let mut optimiser = Optimiser::default();
        optimiser.descent.steps.solver = solver;
        optimiser
    }

    /// An optimiser for a receding horizon, where a new plan is made at every step: it starts warm, and stops where the next plan
    /// will differ by more than what is left to gain.
    pub fn receding_horizon(solver: S) -> Self {
        let tolerances = Tolerances { residual: 1e-7, decrease: 1e-9, ..Tolerances::default() };
        Optimiser { tolerances, starts_warm: true, ..Optimiser::new(solver) }
    }

    /// This optimiser, looking so far for a cheaper homotopy class.
    pub fn searching(self, homotopy_search: HomotopySearch) -> Self {
        Optimiser { homotopy_search, ..self }
    }
}

impl<S: StageSolver> Optimiser<S> {
    /// Descends from a guess (per participant, inputs; made admissible first) to a local optimum, from which the next descent
    /// resumes. At the limit of its work it hands out what it has come to, if that violates nothing: such a motion is
    /// admissible and costs less than the guess (Scokaert, Mayne and Rawlings, "Suboptimal model predictive control", 1999).
    ///
    /// # Errors
    /// [`DescentError`] if a QP subproblem cannot be solved, or at the limit a safety row or road edge is violated.
    pub fn descend(&mut self, problem: &Problem, guess: &[Vec<Input>]) -> Result<Optimum, DescentError> {
        let outcome = self.resume(problem, guess);
        match outcome {
            Ok(_) => self.descent.leave(&mut self.warm_start),
            Err(_) => self.warm_start = WarmStart::default(),
        }
        match outcome {
            Err(DescentError::NotConverged(mut reached)) if reached.cost.unsafety() <= self.tolerances.slack => {
                reached.statistics.unfinished = 1;
                Ok(*reached)
            }
            outcome => outcome,
        }
    }

    /// Descends from another motion in search of an optimum that costs less than `bar`.
    ///
    /// # Errors
    /// As [`Optimiser::descend`], and the reasons for which an exploration is given up.
    pub(super) fn explore_class(
        &mut self,
        problem: &Problem,
        from: Iterate,
        bar: f64,
        gives_up: Option<&GivesUp>,
        tolerances: &Tolerances,
    ) -> Result<Exploration, DescentError> {
        let now = self.descent.begin(problem, from)?;
        let found = match self.descent.run(problem, now, false, gives_up, tolerances) {
            Err(DescentError::NotConverged(reached)) => return Ok(Exploration::Unfinished(*reached)),
            outcome => outcome?,
        };
        if found.cost.total < bar {
            self.descent.leave(&mut self.warm_start);
            return Ok(Exploration::Cheaper(found));
        }
        Ok(Exploration::Dearer(found))
    }

    fn resume(&mut self, problem: &Problem, guess: &[Vec<Input>]) -> Result<Optimum, DescentError> {
        let mut now = self.descent.begin(problem, problem.start(guess))?;
        let warm = self.starts_warm && self.warm_start.fits(&self.descent.steps.problem.qp);
        if warm && self.descent.resume(&self.warm_start, &mut now, &self.tolerances) {
            return Ok(now);
        }
        self.descent.run(problem, now, warm, None, &self.tolerances)
    }
}
