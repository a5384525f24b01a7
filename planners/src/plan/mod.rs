//! What a planner answers: a plan with its reasons, or why there is none.

mod activity;
pub mod certificate;
pub mod diagnostic;
pub mod homotopy;
pub(crate) mod plan_time;
pub(crate) mod planned_passing;
pub(crate) mod violation;

pub use diagnostic::Diagnostic;
pub use plan_time::PlanTime;
pub use planned_passing::{PassingSide, PlannedPassing};
pub use violation::{PlanCondition, PlanViolation};

use std::sync::Arc;

use thiserror::Error;

use crate::Trajectory;
use crate::plan::diagnostic::DiagnosticQuantity;
use crate::scene::driver_estimate::DriverEstimate;
use crate::trajectory::{Problem, Statistics};

/// The answer of a planner: a planned motion, proposals to other vehicles, and the numbers and events that explain
/// them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Plan {
    /// The planned motion from the present state on; its first input is applied.
    pub trajectory: Trajectory,
    /// Other continuations of a plan that branches, one for each other future; empty for plans that do not.
    pub branches: Vec<PlanBranch>,
    /// The motions that the planner proposes to other vehicles, in the order in which it asks them.
    pub proposals: Vec<Proposal>,
    /// The motion that the vehicle indicates in place of the plan: what it asks for while its filter keeps it from driving it.
    pub announced: Option<Trajectory>,
    /// Its homotopy class: how it passes each vehicle that it comes near; empty for planners that keep out of no ellipses.
    pub homotopy_class: Vec<PlannedPassing>,
    /// Numbers that explain the plan, in a fixed order for each planner.
    pub diagnostics: Vec<Diagnostic>,
    /// The beliefs about the other drivers; empty where their plans are told.
    pub beliefs: Vec<DriverEstimate>,
    /// The conditions that the plan violates, by its certificate.
    pub violations: Vec<PlanViolation>,
    /// What happened while this plan was made.
    pub events: Vec<PlanEvent>,
    /// The trajectory problem that the plan solves, so that it can be checked; `None` from a planner that optimises
    /// nothing.
    pub problem: Option<Arc<Problem>>,
    /// The work of all optimisations behind the plan.
    pub statistics: Statistics,
}

/// A continuation of a plan that branches, from now on.
#[derive(Clone, Debug, PartialEq)]
pub struct PlanBranch {
    /// Probability of the future for which this continuation is made.
    pub probability: f64,
    /// The motion from the present state on.
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
    /// The planner turns to another vehicle, by its name; none if no vehicle is left.
    Partner(Option<String>),
    /// The planner's own problem has no solution, and the plan is the fallback, the conservative one; the optimiser's reason.
    Fallback(String),
    /// The planner finds nothing to ask for; the optimiser's reason.
    NoProposal(String),
    /// The plan passes another vehicle in a way that is new or has changed.
    Passing(PlannedPassing),
    /// A vehicle that was recorded does not follow its record any more: the plan is carried out.
    LeavesRecord,
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
    /// The name of the vehicle to which the proposal is made.
    pub to: String,
    /// The motion from the present state on.
    pub trajectory: Trajectory,
    /// How far the vehicle accepted the proposal before this one, from 0 to 1; `None` where the planner does not
    /// measure it.
    pub acceptance: Option<f64>,
}

impl Plan {
    /// The value of a quantity, if the planner reported it.
    pub fn value_of(&self, quantity: &DiagnosticQuantity) -> Option<f64> {
        let found = self.diagnostics.iter().find(|diagnostic| diagnostic.quantity.name == quantity.name);
        found.map(|diagnostic| diagnostic.value)
    }
}

/// Why a planner has no plan.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum PlanError {
    /// No input sequence satisfies the hard bounds.
    #[error("infeasible: {0}")]
    Infeasible(String),
    /// The optimiser gave up.
    #[error("unsolved after {iterations} iterations: {status}")]
    Unsolved {
        /// The optimiser's status.
        status: String,
        /// Number of quadratic programmes that were solved.
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
        /// The work that the plan took.
        work: usize,
        /// The largest work that the deadline allows.
        most_work: usize,
    },
}
