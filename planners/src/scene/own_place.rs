//! The place of a vehicle on its own route, searched once for its position.
//!
//! On a curved road a place is searched on the whole line. Rules, relations and drivers ask for the same one many times in a tick.

use std::sync::Arc;

use crate::Route;
use crate::road::centre_line::FrenetPoint;

/// A place that is known, with the position and the route for which it was searched. It says nothing that the vehicle does not, so all are
/// equal.
#[derive(Clone, Debug, Default)]
pub struct OwnPlace(Option<([f64; 2], Arc<Route>, FrenetPoint)>);

impl PartialEq for OwnPlace {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl OwnPlace {
    /// The place of a position on a route.
    pub fn of(route: &Arc<Route>, position: [f64; 2]) -> OwnPlace {
        OwnPlace(Some((position, Arc::clone(route), route.locate(position, None))))
    }

    /// The known place, if it is that of this position on this route; else it is searched.
    pub fn or_search(&self, route: &Arc<Route>, position: [f64; 2]) -> FrenetPoint {
        let known = self.0.as_ref().filter(|(at, on, _)| *at == position && Arc::ptr_eq(on, route));
        known.map_or_else(|| route.locate(position, None), |(_, _, place)| *place)
    }
}
