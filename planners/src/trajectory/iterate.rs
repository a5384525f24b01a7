//! A point of the trajectory problem: inputs, and the states that follow from them.

use crate::{Input, State, Trajectory};

/// Inputs and states of every deciding vehicle.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Iterate {
    /// Per vehicle, `N` inputs.
    pub inputs: Vec<Vec<Input>>,
    /// Per vehicle, `N + 1` states.
    pub states: Vec<Vec<State>>,
}

impl Iterate {
    /// The motion of one vehicle.
    pub fn trajectory(&self, vehicle: usize) -> Trajectory {
        Trajectory { states: self.states[vehicle].clone(), inputs: self.inputs[vehicle].clone() }
    }
}
