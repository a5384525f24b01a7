//! What planners remember from one step to the next, found again by solving what they solved.

use std::collections::BTreeMap;

use interplay_planners::Input;
use interplay_planners::mpc::{Memory, Optimiser, Problem, Robust};

use crate::Result;

/// By the vehicle's name, the tick of its last problem and an optimiser that has solved it.
#[derive(Default)]
pub struct Echo {
    optimisers: BTreeMap<String, (usize, Optimiser<Robust>)>,
}

impl Echo {
    /// The memory before a problem: empty unless another was met a tick ago.
    ///
    /// # Errors
    /// A descent that the planner found possible is not.
    pub fn memory(&mut self, tick: usize, name: &str, problem: &Problem, guess: &[Vec<Input>]) -> Result<Memory> {
        let anew = || (tick, Optimiser::resuming(Robust::default()));
        let (last, optimiser) = self.optimisers.entry(name.to_owned()).or_insert_with(anew);
        if *last + 1 != tick {
            optimiser.memory = Memory::default();
        }
        *last = tick;
        let memory = optimiser.memory.clone();
        // One that fails leaves nothing to the next.
        let _ = optimiser.descend(problem, guess);
        Ok(memory)
    }
}
