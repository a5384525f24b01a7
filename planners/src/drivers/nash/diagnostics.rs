//! The diagnostics of the Nash planner.

use crate::plan::diagnostic::{COST, DiagnosticPanel, DiagnosticQuantity, Explanation, ValueSet};

/// The number of vehicles in the game.
pub const PLAYERS: DiagnosticQuantity = DiagnosticQuantity::new("players", "", ValueSet::Count);
/// The most that one player could save by leaving the plan while the others keep to it.
pub const DEVIATION_GAIN: DiagnosticQuantity = DiagnosticQuantity::new("gain of leaving", "", ValueSet::NonNegative);
/// The ego's cost in the game.
pub const EGO_COST: DiagnosticQuantity = DiagnosticQuantity::new("ego's cost", "", ValueSet::Real);

/// How the planner explains its plans.
pub const EXPLANATION: Explanation = Explanation {
    quantities: &[PLAYERS, DEVIATION_GAIN, EGO_COST],
    panels: &[
        DiagnosticPanel { title: "Game: costs of all players and of the ego", quantities: &[COST, EGO_COST] },
        DiagnosticPanel {
            title: "Game: what a player gains by leaving the equilibrium",
            quantities: &[DEVIATION_GAIN],
        },
    ],
    plots: &[],
    guide: "**Nash.** The plans of all players form an equilibrium: no player gains by leaving it alone. The gain of leaving is \
            checked in every plan, by solving each player's own problem anew.",
};
