//! The times before and after a start.

/// How long before a start its slopes begin \[s\].
pub(crate) const PAST_S: f64 = 1.2;
/// The horizons at which predictions are judged \[s\].
pub(crate) const HORIZONS_S: [f64; 5] = [1.0, 2.0, 3.0, 4.0, 5.0];
