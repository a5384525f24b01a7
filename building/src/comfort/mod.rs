//! Wanted temperatures ([`Setpoints`]), their values at the steps of a day ([`Targets`]), and those of every day of a run
//! ([`Agenda`]), with the bounds that another program may state ([`ComfortBounds`]).

mod agenda;
mod targets;

pub use agenda::{Agenda, ComfortBounds, ZoneBounds};
pub use targets::{Setpoints, SetpointsError, Targets};
