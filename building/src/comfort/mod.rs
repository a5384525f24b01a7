//! Wanted temperatures ([`Setpoints`]), their values at the steps of a day ([`Targets`]), and those of every day of a run
//! ([`Agenda`]).

mod agenda;
mod targets;

pub use agenda::Agenda;
pub use targets::{Setpoints, SetpointsError, Targets};
