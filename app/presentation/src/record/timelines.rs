//! The timelines of every recording.

/// Simulated time.
pub const SIM_TIME: &str = "sim_time";
/// Ticks.
pub const TICK: &str = "tick";
