//! What a planner answers: a plan with its reasons, or why there is none.

use thiserror::Error;

use crate::diagnostic::{Diagnostic, DiagnosticQuantity};
use crate::driver_estimate::DriverEstimate;
use crate::homotopy::PlannedPassing;
use crate::trajectory::{Problem, Statistics};
use crate::{PlanViolation, Trajectory};

/// What a vehicle will do, what it asks of another, and why.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Plan {
    /// The planned motion; its first input is applied.
    pub trajectory: Trajectory,
    /// What it will do instead if things go on otherwise; of plans that branch.
    pub branches: Vec<PlanBranch>,
    /// What the planner asks of others, whom it asks first at first.
    pub proposals: Vec<Proposal>,
    /// Its homotopy class: how it passes each vehicle that it comes near; empty for planners that keep out of no ellipses.
    pub homotopy_class: Vec<PlannedPassing>,
    /// Numbers that explain it, in a fixed order for one planner.
    pub diagnostics: Vec<Diagnostic>,
    /// What is believed of the others, where their plans are inferred.
    pub beliefs: Vec<DriverEstimate>,
    /// What it violates, by its certificate.
    pub violations: Vec<PlanViolation>,
    /// What happened in this step.
    pub events: Vec<PlanEvent>,
    /// The trajectory problem that the plan solves, for whoever checks it; none of a planner that poses none.
    pub problem: Option<Box<Problem>>,
    /// The work of all optimisations behind the plan.
    pub statistics: Statistics,
}

/// A continuation of a plan that branches, from now on.
#[derive(Clone, Debug, PartialEq)]
pub struct PlanBranch {
    /// How likely the future is for which it is made.
    pub probability: f64,
    /// The motion.
    pub trajectory: Trajectory,
}

/// Something that happened while a planner planned.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PlanEvent {
    /// What kind of event it is, for programs.
    pub kind: PlanEventKind,
    /// What happened, in words for people.
    pub text: String,
}

/// The kinds of event that a program may have to tell apart.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PlanEventKind {
    /// The planner turns to another vehicle, by its name; to none if nobody is left.
    Partner(Option<String>),
    /// The planner's own problem has no solution, and the plan is the fallback, the conservative one; the optimiser's reason.
    Fallback(String),
    /// The planner finds nothing to ask for; the optimiser's reason.
    NoProposal(String),
    /// The plan passes another vehicle in a way that is new or has changed.
    Passing(PlannedPassing),
    /// Any other event.
    Note,
}

impl PlanEvent {
    /// An event that no program has to tell apart.
    pub fn note(text: impl Into<String>) -> Self {
        PlanEvent { kind: PlanEventKind::Note, text: text.into() }
    }
}

/// The motion that a planner would like another vehicle to choose.
#[derive(Clone, Debug, PartialEq)]
pub struct Proposal {
    /// Whom it is made to.
    pub to: String,
    /// The motion.
    pub trajectory: Trajectory,
    /// How far the vehicle accepted the proposal before this one, from 0 to 1; none where the planner does not judge it.
    pub acceptance: Option<f64>,
}

impl Plan {
    /// The value of a quantity, if the planner reported it.
    pub fn value_of(&self, quantity: &DiagnosticQuantity) -> Option<f64> {
        let found = self.diagnostics.iter().find(|diagnostic| diagnostic.quantity.name == quantity.name);
        found.map(|diagnostic| diagnostic.value)
    }
}

/// Why there is no plan.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum PlanError {
    /// No input sequence satisfies the hard bounds.
    #[error("infeasible: {0}")]
    Infeasible(String),
    /// The optimiser gave up.
    #[error("unsolved after {iterations} iterations: {status}")]
    Unsolved {
        /// What it said.
        status: String,
        /// Quadratic programmes solved.
        iterations: usize,
    },
    /// The driver's inputs come from outside, and none has come.
    #[error("no input has come from outside: a driver of the kind `external` does not plan")]
    NoInput,
    /// The scene holds a number that is not finite.
    #[error("bad input: {0}")]
    BadInput(String),
    /// There is a plan, but its certificate says that it must not be driven.
    #[error("the plan was refused: {0}")]
    Refused(PlanViolation),
    /// There is a plan, but it took more work than its deadline allows.
    #[error("the plan is late: it took {work} units of work, and {most_work} were allowed")]
    Late {
        /// The work that it took.
        work: usize,
        /// The most that it may take.
        most_work: usize,
    },
}
