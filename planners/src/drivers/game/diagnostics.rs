//! What the planner of the persuasion game reports.

use crate::plan::diagnostic::{DiagnosticPanel, DiagnosticQuantity, Explanation, ValueSet};

/// The probability that the other passes, as the ego reads it, `p̃_s|e` (eq. 8.1).
pub const OTHER_POSTERIOR: DiagnosticQuantity = probability("posterior of the other");
/// The probability that the ego passes, as the other must read it, `p̃_e|s` (eq. 8.1).
pub const EGO_POSTERIOR: DiagnosticQuantity = probability("posterior of the ego");
/// The probability with which the ego means to pass, `p_e`.
pub const EGO_INTENTION: DiagnosticQuantity = probability("intention p_e");
/// The probability with which the other means to pass by the game's solution, `p_s`.
pub const OTHER_INTENTION: DiagnosticQuantity = probability("other's intention p_s");
/// By how much the ego could gain by deviating alone from the game's solution.
pub const EGO_TEMPTATION: DiagnosticQuantity = temptation("temptation of the ego");
/// By how much the other could gain by deviating alone from the game's solution.
pub const OTHER_TEMPTATION: DiagnosticQuantity = temptation("temptation of the other");
/// The ego's payoffs of Table 8.2: both yield, the ego yields alone, the ego passes alone.
pub const EGO_PAYOFFS: [DiagnosticQuantity; 3] =
    [payoff("payoff ego: both yield"), payoff("payoff ego: yields alone"), payoff("payoff ego: passes alone")];
/// The other's payoffs: both yield, the other yields alone, the other passes alone.
pub const OTHER_PAYOFFS: [DiagnosticQuantity; 3] =
    [payoff("payoff other: both yield"), payoff("payoff other: yields alone"), payoff("payoff other: passes alone")];
/// The payoff of each player if both pass.
pub const ACCIDENT_PAYOFF: DiagnosticQuantity = payoff("payoff: accident");
/// The lowest mean speed that expresses the intention (eq. 8.11).
pub const EXPRESSED_FROM: DiagnosticQuantity = speed("expressed speed from");
/// The highest mean speed that expresses the intention (eq. 8.11).
pub const EXPRESSED_TO: DiagnosticQuantity = speed("expressed speed to");
/// By how much the plan's mean speed misses the interval from [`EXPRESSED_FROM`] to [`EXPRESSED_TO`].
pub const EXPRESSION_SLACK: DiagnosticQuantity =
    DiagnosticQuantity::new("expression slack", "m/s", ValueSet::NonNegative);
/// The mean speed of the plan.
pub const MEAN_SPEED: DiagnosticQuantity = speed("mean speed");

/// How the planner explains its plans.
pub const EXPLANATION: Explanation = Explanation {
    quantities: &[
        OTHER_POSTERIOR,
        EGO_POSTERIOR,
        EGO_INTENTION,
        OTHER_INTENTION,
        EGO_TEMPTATION,
        OTHER_TEMPTATION,
        EGO_PAYOFFS[0],
        EGO_PAYOFFS[1],
        EGO_PAYOFFS[2],
        OTHER_PAYOFFS[0],
        OTHER_PAYOFFS[1],
        OTHER_PAYOFFS[2],
        ACCIDENT_PAYOFF,
        EXPRESSED_FROM,
        EXPRESSED_TO,
        EXPRESSION_SLACK,
        MEAN_SPEED,
    ],
    panels: &[
        DiagnosticPanel {
            title: "Game: who seems to pass, who means to",
            quantities: &[OTHER_POSTERIOR, EGO_POSTERIOR, EGO_INTENTION, OTHER_INTENTION],
        },
        DiagnosticPanel {
            title: "Game: what each outcome is worth",
            quantities: &[
                EGO_PAYOFFS[0],
                EGO_PAYOFFS[1],
                EGO_PAYOFFS[2],
                OTHER_PAYOFFS[0],
                OTHER_PAYOFFS[1],
                OTHER_PAYOFFS[2],
                ACCIDENT_PAYOFF,
            ],
        },
        DiagnosticPanel {
            title: "Game: mean speeds that show the intention [m/s]",
            quantities: &[EXPRESSED_FROM, EXPRESSED_TO, MEAN_SPEED],
        },
    ],
    plots: &[
        DiagnosticPanel { title: "probability", quantities: &[OTHER_POSTERIOR, EGO_POSTERIOR] },
        DiagnosticPanel { title: "intention to pass", quantities: &[EGO_INTENTION, OTHER_INTENTION] },
        DiagnosticPanel { title: "payoff of the ego", quantities: &EGO_PAYOFFS },
        DiagnosticPanel { title: "mean speed", quantities: &[EXPRESSED_FROM, EXPRESSED_TO, MEAN_SPEED] },
    ],
    guide: "**The game.** The *posteriors* say who seems to pass, judged by speed or time of arrival; they set the payoffs, \
            the payoffs the *intentions*. The plan's *mean speed* should lie between the expressed bounds: so the other \
            reads the intention.",
};

const fn probability(name: &'static str) -> DiagnosticQuantity {
    DiagnosticQuantity::new(name, "", ValueSet::Probability)
}

const fn temptation(name: &'static str) -> DiagnosticQuantity {
    DiagnosticQuantity::new(name, "", ValueSet::NonNegative)
}

const fn payoff(name: &'static str) -> DiagnosticQuantity {
    DiagnosticQuantity::new(name, "", ValueSet::Real)
}

const fn speed(name: &'static str) -> DiagnosticQuantity {
    DiagnosticQuantity::new(name, "m/s", ValueSet::Real)
}
