//! What the Bayesian planner reports.

use crate::plan::diagnostic::{DiagnosticPanel, DiagnosticQuantity, Explanation, ValueSet};

/// The smallest distance `ω` of the ego's plan to the other's, in half axes of the safety ellipse (eq. 7.2).
pub const CONSERVATIVENESS: DiagnosticQuantity = number("conservativeness", "");
/// Variance of the signal, `Σ` (eq. 7.27).
pub const BELIEF_VARIANCE: DiagnosticQuantity = number("belief variance", "");
/// The weight that the other is believed to put on its own plan, `w_1` (eq. 7.28).
pub const LOYALTY: DiagnosticQuantity = number("other's loyalty w_1", "");
/// The weight of `ω` in the ego's cost, `k_1` (eq. 7.19).
pub const ATTRACTION: DiagnosticQuantity = number("attraction k_1", "");
/// Mean change of the ego's plan from one step to the next, `α` (eq. 7.27): the norm of the whole state.
pub const OWN_CHANGE: DiagnosticQuantity = number("own change alpha", "");
/// Mean change of the other's plan from one step to the next, `β` (eq. 7.28).
pub const OTHER_CHANGE: DiagnosticQuantity = number("other's change beta", "m");

/// How the planner explains its plans.
pub const EXPLANATION: Explanation = Explanation {
    quantities: &[CONSERVATIVENESS, BELIEF_VARIANCE, LOYALTY, ATTRACTION, OWN_CHANGE, OTHER_CHANGE],
    panels: &[
        DiagnosticPanel { title: "Persuasion: the other's loyalty to its plan, w₁", quantities: &[LOYALTY] },
        DiagnosticPanel {
            title: "Persuasion: pull towards the other, k₁",
            quantities: &[ATTRACTION, CONSERVATIVENESS],
        },
        DiagnosticPanel {
            title: "Persuasion: changes of plans, noise of the signal",
            quantities: &[OWN_CHANGE, OTHER_CHANGE, BELIEF_VARIANCE],
        },
    ],
    plots: &[
        DiagnosticPanel { title: "weight", quantities: &[LOYALTY, ATTRACTION] },
        DiagnosticPanel { title: "conservativeness ω", quantities: &[CONSERVATIVENESS] },
        DiagnosticPanel { title: "belief variance", quantities: &[BELIEF_VARIANCE] },
        DiagnosticPanel { title: "change of the own plan", quantities: &[OWN_CHANGE] },
        DiagnosticPanel { title: "change of the other's plan", quantities: &[OTHER_CHANGE] },
    ],
    guide: "**Bayesian persuasion.** A change of the other's plan (*beta*) lowers its believed loyalty *w_1*; then *k_1* rises \
            and the ego dares to come closer: *conservativeness* is the smallest distance of its plan, in safety ellipses. \
            A change of the own plan (*alpha*) blurs the signal (*variance*).",
};

const fn number(name: &'static str, unit: &'static str) -> DiagnosticQuantity {
    DiagnosticQuantity::new(name, unit, ValueSet::NonNegative)
}
