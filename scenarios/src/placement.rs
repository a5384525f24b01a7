//! Places of vehicles: starts in lanes become states in world coordinates, and each vehicle gets its route.

mod known_roads;
mod network;
mod on_network;
mod parallel;
mod written;

use std::sync::Arc;

use interplay_planners::Route;
use interplay_planners::road::network::RoadNetwork;
use serde_json::Value as Json;

use crate::consistency::curve_faults;
use crate::error::Fault;
use crate::road::{Branch, Road};
use crate::schema::SchemaNode;
use crate::tree::TomlNode;
pub(crate) use known_roads::KnownRoads;
use written::VehicleAsWritten;

/// What is known of a road and its vehicles once their starts are states.
#[derive(Default)]
pub(crate) struct Placed {
    /// The lanes of the road, if they have names.
    pub network: Option<Arc<RoadNetwork>>,
    /// The route of each vehicle.
    pub routes: Vec<Arc<Route>>,
}

/// Writes the state of each vehicle in world coordinates in place of its `start`, which may be a place in a lane.
///
/// What is no table of the format is left as it is. What `known_roads` holds is not computed again.
///
/// # Errors
/// For a road that is none, and what keeps a start from being a place or a vehicle from having a route.
pub(crate) fn resolve_starts(
    scenario: &mut Json,
    tree: &TomlNode,
    schema: SchemaNode,
    known_roads: &KnownRoads,
) -> Result<Placed, Vec<Fault>> {
    let text = scenario.get("road").map(Json::to_string).unwrap_or_default();
    let road = scenario.get("road").cloned().map_or_else(|| Ok(Road::default()), serde_json::from_value);
    let Ok(road) = road else { return Ok(Placed::default()) };
    let faults = curve_faults(&road, tree);
    if !faults.is_empty() {
        return Err(faults);
    }
    let network = known_roads.network(text, || network::network(&road, tree)).map_err(|fault| vec![fault])?;
    let mut placed = Placed { network: network.as_ref().map(|known| Arc::clone(&known.network)), routes: Vec::new() };
    let Some(vehicles) = scenario.get_mut("vehicle").and_then(Json::as_array_mut) else { return Ok(placed) };
    let [main, cross] = [Branch::Main, Branch::Cross].map(|branch| road.route(branch));
    let mut faults = Vec::new();
    for (index, vehicle) in vehicles.iter_mut().enumerate() {
        let Some(written) = VehicleAsWritten::new(vehicle, index, tree, schema) else { continue };
        let route = if written.branch == Branch::Main { &main } else { &cross };
        let found = match (&network, route) {
            (Some(network), _) => on_network::place(&written, network),
            (None, Some(route)) => parallel::place(&written, &road, route),
            // A road that is no network has a route.
            (None, None) => continue,
        };
        match found {
            Ok((state, route)) => {
                vehicle["start"] = serde_json::to_value(state).unwrap_or_default();
                placed.routes.push(route);
            }
            Err(fault) => faults.push(fault),
        }
    }
    if let Some(network) = &network {
        // On a network the routes know where they meet.
        placed.routes = network.set_of(placed.routes);
    }
    if faults.is_empty() { Ok(placed) } else { Err(faults) }
}
