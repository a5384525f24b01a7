//! Places of vehicles: starts in lanes become states in world coordinates, and each vehicle gets its route.

mod network;
mod on_network;
mod parallel;

use std::sync::Arc;

use interplay_planners::road::network::RoadNetwork;
use interplay_planners::{Route, State};
use serde_json::Value as Json;

use crate::consistency::curve_faults;
use crate::error::{Fault, quoted};
use crate::lane_reference::LaneReference;
use crate::road::{Branch, Road};
use crate::schema::{self, SchemaNode};
use crate::start::StartConfig;
use crate::tree::TomlNode;

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
/// What is no table of the format is left as it is.
///
/// # Errors
/// For a road that is none, and what keeps a start from being a place or a vehicle from having a route.
pub(crate) fn resolve_starts(scenario: &mut Json, tree: &TomlNode) -> Result<Placed, Vec<Fault>> {
    let road = scenario.get("road").cloned().map_or_else(|| Ok(Road::default()), serde_json::from_value);
    let Ok(road) = road else { return Ok(Placed::default()) };
    let faults = curve_faults(&road, tree);
    if !faults.is_empty() {
        return Err(faults);
    }
    let network = network::network(&road, tree).map_err(|fault| vec![fault])?.map(Arc::new);
    let mut placed = Placed { network, routes: Vec::new() };
    let Some(vehicles) = scenario.get_mut("vehicle").and_then(Json::as_array_mut) else { return Ok(placed) };
    let [main, cross] = [Branch::Main, Branch::Cross].map(|branch| road.route(branch));
    let mut faults = Vec::new();
    for (index, vehicle) in vehicles.iter_mut().enumerate() {
        let Some(written) = VehicleAsWritten::new(vehicle, index, tree) else { continue };
        let route = if written.branch == Branch::Main { &main } else { &cross };
        let found = match (&placed.network, route) {
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
    if placed.network.is_some() {
        // On a network the routes know where they meet.
        placed.routes = Route::set_of(placed.routes.into_iter().map(Arc::unwrap_or_clone).collect());
    }
    if faults.is_empty() { Ok(placed) } else { Err(faults) }
}

/// The state in which a vehicle starts, and its route.
type Start = (State, Arc<Route>);

/// What a file says of the place of a vehicle and of its way.
struct VehicleAsWritten<'a> {
    branch: Branch,
    start: StartConfig,
    goal_lane: Option<LaneReference>,
    /// The lanes of its route, if they are stated.
    lanes: Vec<String>,
    /// The path of the vehicle, as the tree has it.
    path: String,
    /// The path of the vehicle, as errors show it.
    shown: String,
    tree: &'a TomlNode,
}

impl<'a> VehicleAsWritten<'a> {
    /// None if the table is no vehicle with a start.
    fn new(vehicle: &Json, index: usize, tree: &'a TomlNode) -> Option<VehicleAsWritten<'a>> {
        let name = vehicle.get("name").and_then(Json::as_str).unwrap_or_default();
        let goal_lane = vehicle.get("goal").and_then(|goal| goal.get("lane")).cloned();
        Some(VehicleAsWritten {
            branch: parsed(vehicle.get("road").cloned())?.unwrap_or_default(),
            start: parsed(vehicle.get("start").cloned())??,
            goal_lane: parsed(goal_lane)?,
            lanes: parsed(vehicle.get("route").cloned())?.unwrap_or_default(),
            path: format!("vehicle.{index}"),
            shown: format!("vehicle.{name}"),
            tree,
        })
    }

    /// A fault of a key of the vehicle.
    fn fault(&self, key: &str, label: &str, message: String) -> Fault {
        Fault::at(self.tree.place_of(&format!("{}.{key}", self.path)), label, message)
    }

    /// The refusal of a start without a key that it needs.
    fn missing(&self, key: &str) -> Fault {
        let start = schema::complete().property("vehicle").and_then(SchemaNode::entries);
        let property = start.and_then(|vehicle| vehicle.property("start")).and_then(|start| start.property(key));
        let message = format!("{} is missing", quoted(&format!("{}.start.{key}", self.shown)));
        self.at_start(&format!("has no `{key}`"), message)
            .help(property.map(SchemaNode::description).unwrap_or_default())
    }

    /// A fault of the whole start.
    fn at_start(&self, label: &str, message: String) -> Fault {
        let place = self.tree.at(&format!("{}.start", self.path)).map_or(&self.tree.place, |start| &start.place);
        Fault::at(place, label, message)
    }

    /// The stated position in world coordinates \[m\].
    fn position(&self) -> Result<[f64; 2], Fault> {
        match (self.start.x_m, self.start.y_m) {
            (Some(x_m), Some(y_m)) => Ok([x_m, y_m]),
            (Some(_), None) => Err(self.missing("y_m")),
            (None, Some(_)) => Err(self.missing("x_m")),
            (None, None) => {
                let message = format!("{} does not say where", quoted(&format!("{}.start", self.shown)));
                let help = "state `lane` and `along_m`, or `x_m` and `y_m`";
                Err(self.at_start("no place", message).help(help))
            }
        }
    }

    /// Refuses an offset beyond half of the width of the lane \[m\].
    fn offset_within(&self, most_m: f64) -> Result<f64, Fault> {
        let offset_m = self.start.lateral_offset_m.unwrap_or_default();
        if offset_m.abs() > most_m {
            let message = format!("`{}.start.lateral_offset_m` ({offset_m}) leads out of the lane", self.shown);
            let help = format!("it may be at most {most_m} m to either side; `lane` chooses another lane");
            return Err(self.fault("start.lateral_offset_m", "out of the lane", message).help(help));
        }
        Ok(offset_m)
    }
}

impl StartConfig {
    /// Whether it is stated as a place in a lane.
    fn is_in_lane(&self) -> bool {
        self.lane.is_some()
            || self.along_m.is_some()
            || self.lateral_offset_m.is_some()
            || self.heading_error_deg.is_some()
    }

    /// The stated heading; 0 if none is \[rad\].
    fn heading_rad(&self) -> f64 {
        self.heading_rad.or(self.heading_deg.map(f64::to_radians)).unwrap_or_default()
    }

    /// The heading against that of the lane; 0 if none is stated \[rad\].
    fn heading_error_rad(&self) -> f64 {
        self.heading_error_deg.unwrap_or_default().to_radians()
    }
}

/// A heading by full turns nearer to another one \[rad\]: planners compare headings along a route, which may turn by more than
/// half a circle, as numbers.
fn next_to(heading_rad: f64, along_rad: f64) -> f64 {
    let turns = ((along_rad - heading_rad) / std::f64::consts::TAU).round();
    heading_rad + turns * std::f64::consts::TAU
}

/// A value of the format, or nothing where there is none; none for what is not of the format.
fn parsed<Value: serde::de::DeserializeOwned>(stated: Option<Json>) -> Option<Option<Value>> {
    stated.map(serde_json::from_value).transpose().ok()
}
