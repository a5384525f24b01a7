//! Who is judged.

use crate::Agent;

/// A road user as the rules see it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Obliged<'a> {
    /// The vehicle.
    pub agent: &'a Agent,
    /// How fast it wants to drive \[m/s\].
    pub wanted_mps: f64,
    /// Where it wants to drive beside the centre line of its route \[m\].
    pub lateral_goal_m: f64,
    /// Whether it keeps the rules.
    pub keeps_rules: bool,
}
