//! The diagnostics of the cooperative planner.

use crate::plan::diagnostic::{COST, DiagnosticPanel, DiagnosticQuantity, Explanation, ValueSet};

/// The number of vehicles in the joint problem.
pub const COOPERATING_VEHICLES: DiagnosticQuantity =
    DiagnosticQuantity::new("cooperating vehicles", "", ValueSet::Count);
/// The ego's share of the joint cost.
pub const OWN_COST: DiagnosticQuantity = DiagnosticQuantity::new("own cost", "", ValueSet::Real);

/// How the planner explains its plans.
pub const EXPLANATION: Explanation = Explanation {
    quantities: &[COOPERATING_VEHICLES, OWN_COST],
    panels: &[DiagnosticPanel { title: "Cooperation: costs of all and of each", quantities: &[COST, OWN_COST] }],
    plots: &[],
    guide: "**Cooperation.** All vehicles with this driver solve one joint problem. The joint cost falls while their plans agree.",
};
