//! Roads as a network of lanes.
//!
//! A [`RoadNetwork`] is a list of [`Lane`]s that name their successors and neighbours. A [`Route`] is the path of a vehicle through it:
//! one centre line, and the strip beside it that the vehicle may use. [`conflicts`] finds the places where two routes cross or merge.

mod bend;
mod conflicts;
mod edges;
mod error;
mod lane;
mod lane_user;
mod light;
mod locating;
mod neighbours;
mod open_lanes;
mod road_network;
mod route;
mod route_conflict;
mod route_set;
mod routing;
mod search;
mod self_overlap;
mod strip;

#[cfg(test)]
mod tests;

pub use conflicts::{CONFLICT_TOLERANCE_RATIO, Conflict, conflicts};
pub use error::{LaneFault, RoadNetworkError, RouteError};
pub use lane::{Lane, LaneNeighbour, NeighbourRelation, RightOfWay};
pub use lane_user::LaneUser;
pub use light::{LightColour, LightCycle, LightPhase};
pub use locating::LanePlace;
pub use road_network::RoadNetwork;
pub use route::{Route, RouteLeg, TightestTurn};
pub use route_conflict::{ConflictKind, Precedence, RouteConflict};
