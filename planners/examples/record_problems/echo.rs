//! What planners remember from one step to the next, found again by solving what they solved.

use std::collections::BTreeMap;

use interplay_planners::trajectory::{Optimiser, Robust, WarmStart};

use crate::Result;
use crate::negotiation_view::Posed;
use crate::recorded::optimiser;

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
    pub fn memory(&mut self, kind: &str, tick: usize, name: &str, (problem, guess): &Posed) -> Result<WarmStart> {
        let anew = || (tick, optimiser(kind));
        let (last, optimiser) = self.optimisers.entry(name.to_owned()).or_insert_with(anew);
        if *last + 1 != tick {
            optimiser.warm_start = WarmStart::default();
        }
        *last = tick;
        let memory = optimiser.warm_start.clone();
        // One that fails leaves nothing to the next.
        let _ = optimiser.best_of(problem, std::slice::from_ref(guess), false);
        Ok(memory)
    }
}
