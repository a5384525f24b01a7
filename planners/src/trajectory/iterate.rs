//! A point of the trajectory problem: inputs, and the states that follow from them.

use crate::road::centre_line::FrenetExpansion;
use crate::{Input, State, Trajectory};

/// Inputs and states of every deciding vehicle.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Iterate {
    /// Per vehicle, `N` inputs.
    pub inputs: Vec<Vec<Input>>,
    /// Per vehicle, `N + 1` states.
    pub states: Vec<Vec<State>>,
    /// Per vehicle, the Frenet coordinates of its states at `t = 1…N` on a curved route; empty for a vehicle on a
    /// straight one.
    pub frenet: Vec<Vec<FrenetExpansion>>,
}

impl Iterate {
    /// Inputs whose states are not known yet ([`Problem::roll_out`](super::Problem::roll_out)).
    pub fn of_inputs(inputs: Vec<Vec<Input>>) -> Iterate {
        Iterate { inputs, ..Iterate::default() }
    }

    /// Where a vehicle is beside its curved route after a stage; none on a straight one.
    pub(super) fn place(&self, vehicle: usize, stage: usize) -> Option<&FrenetExpansion> {
        self.frenet[vehicle].get(stage)
    }

    /// The motion of one vehicle.
    pub fn trajectory(&self, vehicle: usize) -> Trajectory {
        Trajectory { states: self.states[vehicle].clone(), inputs: self.inputs[vehicle].clone() }
    }
}
