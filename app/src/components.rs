//! What the entities carry: components of vehicles, and the resources of a world.

use bevy::ecs::prelude::*;
use interplay_planners::{Agent, Body, Corridor, Goal, Input, Planner, State, Trajectory, mpc::Limits};

use crate::frame::Frame;

/// Who a vehicle is: its place in the scenario, which is the order of everything that is listed.
#[derive(Component, Clone, Debug)]
pub struct Identity {
    /// Index in the scenario.
    pub index: usize,
    /// Name in the scenario.
    pub name: String,
}

/// How a vehicle moves.
#[derive(Component, Clone, Copy, Debug)]
pub struct Motion {
    /// Where it is.
    pub state: State,
    /// The input it applied last.
    pub input: Input,
}

/// What a vehicle is like.
#[derive(Component, Clone, Copy, Debug)]
pub struct Physique {
    /// Its body.
    pub body: Body,
    /// What it can do.
    pub limits: Limits,
    /// The road it may use.
    pub corridor: Corridor,
}

/// What a vehicle wants.
#[derive(Component, Clone, Copy, Debug)]
pub struct Wish(pub Goal);

/// Who drives a vehicle, with all that the planner remembers.
#[derive(Component, Clone, Debug)]
pub struct Mind {
    /// The planner.
    pub planner: Planner,
    /// Whether it plans before those who rely on knowing its plan.
    pub goes_first: bool,
}

/// What a vehicle decided last, to be expected by others and continued if its planner fails.
#[derive(Component, Clone, Debug, Default)]
pub struct Intention {
    /// The plan as it was decided, or the fallback since.
    pub plan: Option<Trajectory>,
    /// How many inputs of the planner's last plan are still to come.
    pub remaining: usize,
}

/// Simulated time.
#[derive(Resource, Clone, Copy, Debug)]
pub struct Clock {
    /// Ticks done.
    pub tick: usize,
    /// Length of a tick \[s\].
    pub step_s: f64,
    /// Steps that plans look ahead.
    pub horizon: usize,
}

impl Clock {
    /// Simulated time at the start of this tick \[s\].
    pub fn time_s(&self) -> f64 {
        self.step_s * self.tick as f64
    }
}

/// All vehicles as plain values, in the scenario's order; sensed anew every tick.
#[derive(Resource, Clone, Debug, Default)]
pub struct Agents(pub Vec<Agent>);

/// The tick in the making.
#[derive(Resource, Clone, Debug, Default)]
pub struct Present(pub Frame);
