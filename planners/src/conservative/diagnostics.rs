//! What the conservative planner reports: what every planner does that optimises a trajectory.

use crate::diagnostic::Explanation;

/// How the planner explains its plans.
pub const EXPLANATION: Explanation = Explanation {
    guide: "**Conservative.** It asks nobody: look at how many steps of its plan lie at a safety ellipse.",
    ..Explanation::NONE
};
