//! Wanted temperatures ([`Setpoints`]), and their values at the steps of a day ([`Targets`]).

mod targets;

pub use targets::{Setpoints, SetpointsError, Targets};
