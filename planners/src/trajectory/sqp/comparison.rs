//! A comparison of the homotopy classes, which may take several plans.

use super::homotopy_class::HomotopyClass;
use crate::Input;
use crate::trajectory::iterate::Iterate;
use crate::trajectory::problem::Problem;

/// What an optimiser remembers of its comparisons.
#[derive(Clone, Debug, Default)]
pub(super) struct Comparison {
    /// For how many more plans the classes are not compared.
    pub(super) plans_at_rest: usize,
    /// What the last plan cost whose classes could have been compared.
    pub(super) last_cost: f64,
    /// Whether a comparison has been finished; the first one is made at once.
    pub(super) has_finished: bool,
    /// The comparison that goes on with the next plan.
    pub(super) round: Round,
}

/// One comparison: which classes have had their turn, and what came of it.
#[derive(Clone, Debug)]
pub(super) struct Round {
    /// Classes of which a representative was examined.
    pub examined: Vec<HomotopyClass>,
    /// Classes whose optimum is known.
    pub settled: Vec<HomotopyClass>,
    /// The exploration that goes on with the next plan.
    pub unfinished: Option<Unfinished>,
    /// The lowest cost that another class was found or expected to have.
    pub nearest_cost: f64,
    /// Whether the plan was replaced.
    pub has_changed: bool,
}

/// An exploration that reached the limit of its work.
#[derive(Clone, Debug)]
pub(super) struct Unfinished {
    /// Per participant, the inputs that it has come to.
    inputs: Vec<Vec<Input>>,
    /// The work that it took so far.
    pub work: usize,
}

impl Default for Round {
    fn default() -> Self {
        Round {
            examined: Vec::new(),
            settled: Vec::new(),
            unfinished: None,
            nearest_cost: f64::INFINITY,
            has_changed: false,
        }
    }
}

impl Unfinished {
    /// An exploration that has come to an iterate.
    pub fn at(iterate: &Iterate, work: usize) -> Unfinished {
        Unfinished { inputs: iterate.inputs.clone(), work }
    }

    /// The same after earlier work; nothing if that makes more than `limit`.
    pub fn after(self, work_before: usize, limit: usize) -> Option<Unfinished> {
        let work = work_before + self.work;
        (work < limit).then_some(Unfinished { work, ..self })
    }

    /// Where it goes on in the problem of the next plan, a step later.
    pub fn iterate(&self, problem: &Problem) -> Iterate {
        let later = |inputs: &Vec<Input>| inputs.iter().skip(1).chain(inputs.last()).copied().collect();
        problem.start(&self.inputs.iter().map(later).collect::<Vec<_>>())
    }
}
