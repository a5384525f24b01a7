//! What a human driver reports.

use crate::plan::diagnostic::{DiagnosticQuantity, Explanation, ValueSet};

/// Weight of the squared intrusion of others into the safety ellipse.
pub const SAFETY_WEIGHT: DiagnosticQuantity = DiagnosticQuantity::new("safety weight", "", ValueSet::NonNegative);

/// How the driver explains its plans.
pub const EXPLANATION: Explanation = Explanation { quantities: &[SAFETY_WEIGHT], ..Explanation::NONE };
