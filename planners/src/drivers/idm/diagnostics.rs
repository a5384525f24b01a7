//! What a driver that follows the intelligent driver model reports.

use crate::plan::diagnostic::{DiagnosticQuantity, Explanation, ValueSet};

/// The lane that the driver drives in or changes to, counted from the right.
pub const LANE: DiagnosticQuantity = DiagnosticQuantity::new("lane", "", ValueSet::Count);
/// By how much acceleration the best other lane is better than staying, less the threshold of a change.
pub const INCENTIVE: DiagnosticQuantity = DiagnosticQuantity::new("incentive", "m/s²", ValueSet::Real);
/// Gap between bumpers to the vehicle ahead.
pub const GAP: DiagnosticQuantity = DiagnosticQuantity::new("gap", "m", ValueSet::Real);

/// How the driver explains its plans.
pub const EXPLANATION: Explanation = Explanation { quantities: &[LANE, INCENTIVE, GAP], ..Explanation::NONE };
