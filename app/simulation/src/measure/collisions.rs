//! Contacts between vehicles.

use serde::Serialize;

/// Two vehicles that began to touch.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Collision {
    /// When \[s\].
    pub time_s: f64,
    /// Who, in the scenario's order.
    pub between: [String; 2],
    /// How hard \[N s\].
    pub impulse_ns: f64,
}
