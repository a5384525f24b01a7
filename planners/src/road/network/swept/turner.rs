//! What of a vehicle matters in a turn.

use crate::vehicle::Body;

/// Distance of the places of a path, in wheelbases.
pub(super) const SPACING: f64 = 0.1;
/// Most by which a new edge moves sideways per metre.
pub(super) const MAX_EDGE_SLOPE: f64 = 1.0;

/// What of a vehicle decides how it comes round a turn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turner {
    /// Its body and axles.
    pub body: Body,
    /// Its largest steering angle \[rad\].
    pub steering_max_rad: f64,
}
