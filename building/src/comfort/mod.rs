//! The temperatures that are wanted ([`Setpoints`]), and what they mean for the steps of a day ([`Targets`]).

mod targets;

pub use targets::{Setpoints, SetpointsError, Targets};
