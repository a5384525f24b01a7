//! The timelines of every recording.

/// Name of the timeline of simulated time.
pub const SIM_TIME: &str = "sim_time";
/// Name of the timeline of ticks.
pub const TICK: &str = "tick";
