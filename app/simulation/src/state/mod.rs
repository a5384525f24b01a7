//! The state of a world and its frames: components, resources, and plain values for watchers.

pub mod components;
pub mod day;
pub(crate) mod detail;
pub mod frame;
pub mod standing;
pub mod whole_run;
pub mod worst_zones;
