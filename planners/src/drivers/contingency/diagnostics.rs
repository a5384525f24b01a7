//! The diagnostics of the contingency planner.

use crate::plan::diagnostic::{DiagnosticPanel, DiagnosticQuantity, Explanation, ValueSet};

/// The number of futures that are planned for.
pub const FUTURES: DiagnosticQuantity = DiagnosticQuantity::new("futures", "", ValueSet::Count);
/// The probability of the likeliest future that is planned for.
pub const LIKELIEST: DiagnosticQuantity = DiagnosticQuantity::new("likeliest future", "", ValueSet::Probability);
/// The number of first steps whose inputs are the same in all futures.
pub const SHARED_STEPS: DiagnosticQuantity = DiagnosticQuantity::new("shared steps", "", ValueSet::Count);

/// How the planner explains its plans.
pub const EXPLANATION: Explanation = Explanation {
    quantities: &[FUTURES, LIKELIEST, SHARED_STEPS],
    panels: &[
        DiagnosticPanel {
            title: "Contingency: futures, and steps that they share",
            quantities: &[FUTURES, SHARED_STEPS],
        },
        DiagnosticPanel { title: "Contingency: probability of the likeliest future", quantities: &[LIKELIEST] },
    ],
    plots: &[],
    guide: "**Contingency.** The plan keeps clear of all others in each future, and is the same in all of them until they can \
            be told apart. The plan that is drawn is that for the likeliest one.",
};
