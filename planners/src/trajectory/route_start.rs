//! Where a vehicle is beside its curved route: at its start, and at each state of a motion from there.

use std::sync::Arc;

use crate::road::centre_line::RoadExpansion;
use crate::{Route, State};

/// A curved route, and where a vehicle starts beside it.
#[derive(Clone, Debug, PartialEq)]
pub struct RouteStart {
    /// The route.
    pub route: Arc<Route>,
    /// Road coordinates of the start, with derivatives.
    pub at: RoadExpansion,
}

impl RouteStart {
    /// The start of a vehicle on its route; none on a straight one, along which nothing needs to be searched.
    pub fn new(route: &Arc<Route>, start: &State) -> Option<RouteStart> {
        let at = || route.centre.expand(start.position(), None);
        route.straight().is_none().then(|| RouteStart { route: Arc::clone(route), at: at() })
    }

    /// Road coordinates at `t = 1…N` of a motion whose first state is the start.
    pub(super) fn locate_all(&self, states: &[State], places: &mut Vec<RoadExpansion>) {
        places.clear();
        let mut before = self.at;
        for pair in states.windows(2) {
            before = self.after(&before, &pair[0], &pair[1]);
            places.push(before);
        }
    }

    /// Road coordinates of a state that follows another, whose place is known. The search begins where the expansion of that place
    /// leads, which a motion misses by the third power of what it moves; so it stays on its branch of the line.
    pub(super) fn after(&self, before: &RoadExpansion, from: &State, to: &State) -> RoadExpansion {
        let ([x0, y0], [x1, y1]) = (from.position(), to.position());
        let near_m = before.along_after_m([x1 - x0, y1 - y0]);
        self.route.centre.expand([x1, y1], Some(near_m))
    }
}
