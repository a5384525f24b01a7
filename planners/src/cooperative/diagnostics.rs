//! What cooperating vehicles report.

use crate::diagnostic::{COST, DiagnosticPanel, DiagnosticQuantity, Explanation, ValueSet};

/// How many vehicles share the problem.
pub const COOPERATING_VEHICLES: DiagnosticQuantity =
    DiagnosticQuantity::new("cooperating vehicles", "", ValueSet::Count);
/// What the own part of the joint plan costs.
pub const OWN_COST: DiagnosticQuantity = DiagnosticQuantity::new("own cost", "", ValueSet::Real);

/// How the planner explains its plans.
pub const EXPLANATION: Explanation = Explanation {
    quantities: &[COOPERATING_VEHICLES, OWN_COST],
    panels: &[DiagnosticPanel { title: "Cooperation: costs of all and of each", quantities: &[COST, OWN_COST] }],
    plots: &[],
    guide: "**Cooperation.** All vehicles with this driver solve one problem; the cost of all falls as long as they agree.",
};
