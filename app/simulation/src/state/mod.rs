//! What a world holds and what a tick looked like: components, resources, and the plain values that are handed out.

pub mod components;
pub mod day;
pub(crate) mod detail;
pub mod frame;
pub(crate) mod not_copied;
pub mod standing;
pub mod whole_run;
pub mod worst_zones;
