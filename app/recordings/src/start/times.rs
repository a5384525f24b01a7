//! The time span before the start of a prediction that is observed, and the horizons after it that are evaluated.

/// Time before a start over which slopes are computed \[s\].
pub(crate) const PAST_S: f64 = 1.2;
/// The horizons at which predictions are evaluated \[s\].
pub(crate) const HORIZONS_S: [f64; 5] = [1.0, 2.0, 3.0, 4.0, 5.0];
