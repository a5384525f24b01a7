//! The warm starts of planners, reconstructed by solving the problems that they solved.

use std::collections::BTreeMap;

use interplay_planners::trajectory::{Optimiser, Robust, WarmStart};

use crate::recorded::optimiser;
use crate::{Posed, Result};

/// By the name of the vehicle, the tick of its last problem and an optimiser that has solved that problem.
#[derive(Default)]
pub struct WarmStartReplay {
    optimisers: BTreeMap<String, (usize, Optimiser<Robust>)>,
}

impl WarmStartReplay {
    /// The warm start of a problem: empty unless the vehicle had a problem a tick before.
    ///
    /// # Errors
    /// A descent that the planner found possible is not.
    pub fn warm_start(&mut self, kind: &str, tick: usize, name: &str, (problem, guess): &Posed) -> Result<WarmStart> {
        let anew = || (tick, optimiser(kind));
        let (last, optimiser) = self.optimisers.entry(name.to_owned()).or_insert_with(anew);
        if *last + 1 != tick {
            optimiser.warm_start = WarmStart::default();
        }
        *last = tick;
        let warm_start = optimiser.warm_start.clone();
        // One that fails leaves nothing to the next.
        let _ = optimiser.optimise(problem, guess);
        Ok(warm_start)
    }
}
