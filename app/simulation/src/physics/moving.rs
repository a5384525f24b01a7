//! Inputs and outputs of both plants: vehicles at the start of a tick, and contacts that begin during it.

use interplay_planners::{Body, Input, State};
use rapier2d::prelude::RigidBodyHandle;

use super::footprint::Footprint;

/// One vehicle at the start of a tick.
pub(super) struct Moving {
    pub handle: RigidBodyHandle,
    pub body: Body,
    pub footprint: Footprint,
    pub state: State,
    pub input: Input,
    /// Whether it is not on the road: then it touches no vehicle and does not move.
    pub is_absent: bool,
    /// Its state at the end of the tick, if it follows a record.
    pub recorded: Option<State>,
}

/// Two vehicles, by their indices (ascending), that begin to touch.
pub(super) struct Contact {
    pub pair: [usize; 2],
    /// The share of the tick that has passed by then.
    pub share: f64,
    /// Impulse of the contact \[N s\].
    pub impulse_ns: f64,
}
