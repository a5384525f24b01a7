//! The diagnostics of the conservative planner: those of every planner that optimises a trajectory.

use crate::plan::diagnostic::Explanation;

/// How the planner explains its plans.
pub const EXPLANATION: Explanation = Explanation {
    guide: "**Conservative.** The others' predictions are constraints: see how many steps of the plan touch a safety ellipse.",
    ..Explanation::NONE
};
