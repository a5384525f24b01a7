//! Positions of vehicles: starts in lanes become states in world coordinates, and each vehicle gets its route.

mod known_roads;
mod network;
mod obstacles;
mod on_network;
mod parallel;
mod recorded;
mod written;

use std::sync::Arc;

use interplay_planners::road::network::RoadNetwork;
use interplay_planners::{Body, Route};

use crate::format::json_schema::SchemaNode;
use crate::format::read::tree::TomlNode;
use crate::format::vehicle_config::VehicleConfig;
use crate::model::derived::narrowest_lane::narrowest_lane_of;
use crate::model::traffic::light::LightConfig;
use crate::resolve::check::consistency::curve_faults;
use crate::resolve::records::KIND;
use crate::roads::{Branch, Road};
use crate::text::error::Fault;
use known_roads::KnownNetwork;
pub(crate) use known_roads::KnownRoads;
pub(crate) use obstacles::obstacles;
pub(crate) use recorded::way as way_of_record;
pub(crate) use written::Start;
use written::VehicleAsWritten;

/// A road with its vehicles on it.
pub(crate) struct Placed {
    /// The lanes of the road, if they have names.
    pub network: Option<Arc<RoadNetwork>>,
    /// The state of each vehicle at its start, in world coordinates, and its route.
    pub starts: Vec<Start>,
}

/// Builds a road and places vehicles on it. Results in `known_roads` for the road, whose text is `written`, are not computed again.
///
/// # Errors
/// For an invalid road, and for starts that are not on it and vehicles without a route.
pub(crate) fn place(
    vehicles: &[VehicleConfig],
    road: &Road,
    lights: &[LightConfig],
    written: String,
    tree: &TomlNode,
    schema: SchemaNode,
    known_roads: &KnownRoads,
) -> Result<Placed, Vec<Fault>> {
    let faults = curve_faults(road, tree);
    if !faults.is_empty() {
        return Err(faults);
    }
    let network = known_roads.network(written, || network::network(road, lights, tree)).map_err(|fault| vec![fault])?;
    let [main, cross] = [Branch::Main, Branch::Cross].map(|branch| road.route(branch));
    let (mut starts, mut faults) = (Vec::new(), Vec::new());
    for (index, vehicle) in vehicles.iter().enumerate() {
        let written = VehicleAsWritten { stated: vehicle, index, tree, schema };
        let route = if vehicle.road == Branch::Main { &main } else { &cross };
        let found = match (recorded::start(&written), &network, route) {
            (Err(fault), ..) => Err(vec![fault]),
            (Ok(Some((record, state))), Some(network), _) => {
                Ok(recorded::place(&record, state, &vehicle.route, network))
            }
            (Ok(Some((_, state))), None, Some(route)) => Ok((state, Arc::clone(route))),
            (Ok(None), Some(network), _) => on_network::place(&written, network),
            (Ok(None), None, Some(route)) => parallel::place(&written, road, route),
            // A road that is not a network has a route.
            (Ok(_), None, None) => continue,
        };
        match found {
            Ok(start) => starts.push(start),
            Err(found) => faults.extend(found),
        }
    }
    if !faults.is_empty() {
        return Err(faults);
    }
    if network.is_none() && !lights.is_empty() {
        let message = "traffic lights stand at the ends of lanes with names, which this road does not have".to_owned();
        let fault = Fault::at(tree.place_of("light"), "no lanes with names", message);
        return Err(vec![fault.help("state the road as a `network`, or one of the junctions")]);
    }
    if let Some(network) = network.as_ref().filter(|network| bodies_fit(vehicles, &starts, road, network)) {
        // On a network, the routes store where they meet.
        let (states, routes): (Vec<_>, Vec<_>) = starts.into_iter().unzip();
        starts = states.into_iter().zip(in_one_set(routes, network)).collect();
    }
    Ok(Placed { network: network.map(|known| Arc::clone(&known.network)), starts })
}

/// Whether the bodies of all vehicles fit their lanes. Bodies that do not are refused by later checks, so where their
/// routes meet is not computed: on lanes far narrower than any body that takes minutes.
fn bodies_fit(vehicles: &[VehicleConfig], starts: &[Start], road: &Road, network: &KnownNetwork) -> bool {
    let is_refused = |(vehicle, (state, route)): (&VehicleConfig, &Start)| {
        // A record stays where it was recorded, even beside its lane.
        let kind = vehicle.driver.as_ref().and_then(|driver| driver.get("kind"));
        if kind.is_some_and(|kind| kind == KIND) {
            return false;
        }
        let body: Body = vehicle.body.clone().and_then(|body| body.settings().ok()).unwrap_or_default();
        body.width_m > narrowest_lane_of(road, Some(&network.network), state, route).width_m
    };
    !vehicles.iter().zip(starts).any(is_refused)
}

/// The routes, such that those along lanes store where they meet. Strips beside the lanes belong to no set.
fn in_one_set(routes: Vec<Arc<Route>>, network: &KnownNetwork) -> Vec<Arc<Route>> {
    let along_lanes = routes.iter().filter(|route| !route.legs.is_empty()).cloned().collect();
    let mut known = network.set_of(along_lanes).into_iter();
    let of_set = |route: Arc<Route>| if route.legs.is_empty() { Some(route) } else { known.next() };
    routes.into_iter().filter_map(of_set).collect()
}
