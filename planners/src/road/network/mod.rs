//! Roads as a network of lanes.
//!
//! A [`RoadNetwork`] is a list of [`Lane`]s that name their successors and neighbours. A [`Route`] is the path of a vehicle through it:
//! one centre line, and the strip beside it that the vehicle may use. [`conflicts`] finds the places where two routes cross or merge.

mod conflicts;
mod edges;
mod error;
mod lane;
mod light;
mod neighbours;
mod road_network;
mod route;
mod route_set;
mod routing;
mod strip;
mod swept;

#[cfg(test)]
mod tests;

pub use conflicts::{CONFLICT_TOLERANCE_RATIO, Conflict, conflicts};
pub use error::{LaneFault, RoadNetworkError, RouteError};
pub use lane::{Lane, LaneNeighbour, LaneUser, NeighbourRelation, RightOfWay};
pub use light::{LightColour, LightCycle, LightPhase};
pub use road_network::{LanePlace, RoadNetwork};
pub use route::{ConflictKind, Precedence, Route, RouteConflict, RouteLeg, TightestTurn};
pub use routing::EndingLane;
pub use swept::Turner;
