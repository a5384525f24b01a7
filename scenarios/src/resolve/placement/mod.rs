//! Places of vehicles: starts in lanes become states in world coordinates, and each vehicle gets its route.

mod known_roads;
mod network;
mod on_network;
mod parallel;
mod written;

use std::sync::Arc;

use interplay_planners::road::network::RoadNetwork;

use crate::check::consistency::curve_faults;
use crate::error::Fault;
use crate::file_format::vehicle_config::VehicleConfig;
use crate::json_schema::SchemaNode;
use crate::read::tree::TomlNode;
use crate::road::{Branch, Road};
pub(crate) use known_roads::KnownRoads;
pub(crate) use written::Start;
use written::VehicleAsWritten;

/// A road with its vehicles on it.
pub(crate) struct Placed {
    /// The lanes of the road, if they have names.
    pub network: Option<Arc<RoadNetwork>>,
    /// The state of each vehicle at its start, in world coordinates, and its route.
    pub starts: Vec<Start>,
}

/// Builds a road and places vehicles on it. What `known_roads` holds of the road, `written` being its text, is not computed again.
///
/// # Errors
/// For a road that is none, and what keeps a start from being a place or a vehicle from having a route.
pub(crate) fn place(
    vehicles: &[VehicleConfig],
    (road, written): (&Road, String),
    (tree, schema): (&TomlNode, SchemaNode),
    known_roads: &KnownRoads,
) -> Result<Placed, Vec<Fault>> {
    let faults = curve_faults(road, tree);
    if !faults.is_empty() {
        return Err(faults);
    }
    let network = known_roads.network(written, || network::network(road, tree)).map_err(|fault| vec![fault])?;
    let [main, cross] = [Branch::Main, Branch::Cross].map(|branch| road.route(branch));
    let (mut starts, mut faults) = (Vec::new(), Vec::new());
    for (index, vehicle) in vehicles.iter().enumerate() {
        let written = VehicleAsWritten { stated: vehicle, index, tree, schema };
        let route = if vehicle.road == Branch::Main { &main } else { &cross };
        let found = match (&network, route) {
            (Some(network), _) => on_network::place(&written, network),
            (None, Some(route)) => parallel::place(&written, road, route),
            // A road that is no network has a route.
            (None, None) => continue,
        };
        match found {
            Ok(start) => starts.push(start),
            Err(fault) => faults.push(fault),
        }
    }
    if !faults.is_empty() {
        return Err(faults);
    }
    if let Some(network) = &network {
        // On a network the routes know where they meet.
        let (states, routes): (Vec<_>, Vec<_>) = starts.into_iter().unzip();
        starts = states.into_iter().zip(network.set_of(routes)).collect();
    }
    Ok(Placed { network: network.map(|known| Arc::clone(&known.network)), starts })
}
