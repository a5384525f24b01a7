//! Where a vehicle is beside its curved route: at its start, and at each state of a motion from there.

use std::sync::Arc;

use crate::road::centre_line::FrenetExpansion;
use crate::{Bicycle, Input, Route, State};

/// A curved route, and where a vehicle starts beside it.
#[derive(Clone, Debug, PartialEq)]
pub struct RouteStart {
    /// The curved route.
    pub route: Arc<Route>,
    /// Frenet coordinates of the start, with derivatives.
    pub at: FrenetExpansion,
}

impl RouteStart {
    /// The start of a vehicle on its route; none on a straight one, along which nothing needs to be searched.
    pub fn new(route: &Arc<Route>, start: &State) -> Option<RouteStart> {
        let at = || route.centre.expand(start.position(), None);
        route.straight().is_none().then(|| RouteStart { route: Arc::clone(route), at: at() })
    }

    /// The states that inputs lead to, from the start on, and the Frenet coordinates of all but the first.
    ///
    /// State by state: a processor finds the place of one state while it computes the next.
    pub(super) fn roll_out(
        &self,
        model: &Bicycle,
        start: &State,
        inputs: &[Input],
        states: &mut Vec<State>,
        frenet: &mut Vec<FrenetExpansion>,
    ) {
        states.clear();
        states.push(*start);
        let (mut state, mut place) = (*start, self.at);
        for input in inputs {
            let next = model.step(&state, input);
            place = self.after(&place, &state, &next);
            state = next;
            states.push(state);
            frenet.push(place);
        }
    }

    /// Frenet coordinates of a state that follows another, whose place is known. The search begins where the expansion of that place
    /// leads, which a motion misses by the third power of what it moves; so it stays on its branch of the line.
    #[inline(always)]
    pub(super) fn after(&self, before: &FrenetExpansion, from: &State, to: &State) -> FrenetExpansion {
        let ([x0, y0], [x1, y1]) = (from.position(), to.position());
        let near_m = before.along_after_m([x1 - x0, y1 - y0]);
        self.route.centre.expand([x1, y1], Some(near_m))
    }
}
