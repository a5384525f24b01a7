//! What the negotiation planner reports.

use crate::plan::diagnostic::{DiagnosticPanel, DiagnosticQuantity, Explanation, ValueSet};

/// How far the other accepted the last proposal, `p_a` of eq. 6.19.
pub const ACCEPTANCE: DiagnosticQuantity = DiagnosticQuantity::new("acceptance", "", ValueSet::Probability);
/// The weight of the ego's cost against the other's deviation, `w` of eq. 6.18.
pub const CONCESSION_WEIGHT: DiagnosticQuantity = DiagnosticQuantity::new("concession weight", "", ValueSet::Share);
/// How strongly the ego leans towards its last proposal, `α` of eq. 6.20; 0 without a persuasion constraint.
pub const PERSUASION_STRENGTH: DiagnosticQuantity =
    DiagnosticQuantity::new("persuasion strength", "", ValueSet::NonNegative);
/// Whether the persuasion constraint holds with equality.
pub const PERSUASION_ACTIVE: DiagnosticQuantity = DiagnosticQuantity::new("persuasion active", "", ValueSet::Switch);
/// Whether the safety filter replaced the plan by the conservative one.
pub const SAFETY_FILTER: DiagnosticQuantity = DiagnosticQuantity::new("safety filter", "", ValueSet::Switch);

/// How the planner explains its plans.
pub const EXPLANATION: Explanation = Explanation {
    quantities: &[ACCEPTANCE, CONCESSION_WEIGHT, PERSUASION_STRENGTH, PERSUASION_ACTIVE, SAFETY_FILTER],
    panels: &[DiagnosticPanel {
        title: "Negotiation: acceptance and concession",
        quantities: &[ACCEPTANCE, CONCESSION_WEIGHT, PERSUASION_ACTIVE, SAFETY_FILTER],
    }],
    plots: &[
        DiagnosticPanel { title: "probability", quantities: &[ACCEPTANCE] },
        DiagnosticPanel { title: "weight", quantities: &[CONCESSION_WEIGHT, PERSUASION_STRENGTH] },
    ],
    guide: "**Negotiation.** *acceptance* near 1: the other does what the dotted proposal asks. Near 0: it refuses, and the \
            *concession weight* of the own cost falls, so that the next proposal asks for less. *persuasion active*: the \
            plan leans towards the proposal. *safety filter* at 1: the conservative input was driven instead.",
};
