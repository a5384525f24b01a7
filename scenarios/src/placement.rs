//! Places of vehicles: starts in lanes become states in world coordinates.

use interplay_planners::State;
use serde_json::Value as Json;

use crate::consistency::{curve_faults, no_such_lane};
use crate::error::{Fault, quoted};
use crate::road::{Branch, Road};
use crate::schema::{self, SchemaNode};
use crate::start::StartConfig;
use crate::tree::TomlNode;

/// Writes the state of each vehicle in world coordinates in place of its `start`, which may be a place in a lane.
///
/// Returns what keeps a start from being a place. What is no table of the format is left as it is.
pub(crate) fn resolve_starts(scenario: &mut Json, tree: &TomlNode) -> Vec<Fault> {
    let road = scenario.get("road").cloned().map_or_else(|| Ok(Road::default()), serde_json::from_value);
    let Ok(road) = road else { return Vec::new() };
    let faults = curve_faults(&road, tree);
    let vehicles = scenario.get_mut("vehicle").and_then(Json::as_array_mut);
    let Some(vehicles) = vehicles.filter(|_| faults.is_empty()) else { return faults };
    let mut faults = Vec::new();
    for (index, vehicle) in vehicles.iter_mut().enumerate() {
        let branch = vehicle.get("road").cloned().map_or_else(|| Ok(Branch::Main), serde_json::from_value);
        let start = vehicle.get("start").cloned().map(serde_json::from_value::<StartConfig>);
        let (Ok(branch), Some(Ok(start))) = (branch, start) else { continue };
        let name = vehicle.get("name").and_then(Json::as_str).unwrap_or_default().to_owned();
        let path = Paths { written: format!("vehicle.{index}.start"), shown: format!("vehicle.{name}.start"), tree };
        match start.state(&road, branch, &path) {
            Ok(state) => vehicle["start"] = serde_json::to_value(state).unwrap_or_default(),
            Err(fault) => faults.push(fault),
        }
    }
    faults
}

/// Where a start is written, and what errors call it.
struct Paths<'a> {
    written: String,
    shown: String,
    tree: &'a TomlNode,
}

impl Paths<'_> {
    fn fault(&self, key: &str, label: &str, message: String) -> Fault {
        Fault::at(self.tree.place_of(&format!("{}.{key}", self.written)), label, message)
    }

    /// The refusal of a start without a key that it needs.
    fn missing(&self, key: &str) -> Fault {
        let start = schema::complete().property("vehicle").and_then(SchemaNode::entries);
        let property = start.and_then(|vehicle| vehicle.property("start")).and_then(|start| start.property(key));
        let message = format!("{} is missing", quoted(&format!("{}.{key}", self.shown)));
        let place = self.tree.at(&self.written).map_or(&self.tree.place, |start| &start.place);
        Fault::at(place, &format!("has no `{key}`"), message)
            .help(property.map(SchemaNode::description).unwrap_or_default())
    }
}

impl StartConfig {
    /// The state in world coordinates.
    fn state(&self, road: &Road, branch: Branch, path: &Paths<'_>) -> Result<State, Fault> {
        let in_lane = self.lane.is_some()
            || self.along_m.is_some()
            || self.lateral_offset_m.is_some()
            || self.heading_error_deg.is_some();
        if in_lane { self.in_lane(road, branch, path) } else { self.in_world(road, branch, path) }
    }

    fn in_world(&self, road: &Road, branch: Branch, path: &Paths<'_>) -> Result<State, Fault> {
        let (x_m, y_m) = match (self.x_m, self.y_m) {
            (Some(x_m), Some(y_m)) => (x_m, y_m),
            (Some(_), None) => return Err(path.missing("y_m")),
            (None, Some(_)) => return Err(path.missing("x_m")),
            (None, None) => {
                let message = format!("{} does not say where", quoted(&path.shown));
                let place = path.tree.at(&path.written).map_or(&path.tree.place, |start| &start.place);
                let help = "state `lane` and `along_m`, or `x_m` and `y_m`";
                return Err(Fault::at(place, "no place", message).help(help));
            }
        };
        let stated_rad = self.heading_rad.or(self.heading_deg.map(f64::to_radians)).unwrap_or_default();
        let state = State { x_m, y_m, heading_rad: stated_rad, speed_mps: self.speed_mps };
        if road.corridor(branch).is_some() {
            return Ok(state);
        }
        // Planners compare headings along a route, which may turn by more than half a circle, as numbers.
        let along_rad = road.route(branch).heading_at(state.position());
        let turns = ((along_rad - stated_rad) / std::f64::consts::TAU).round();
        Ok(State { heading_rad: stated_rad + turns * std::f64::consts::TAU, ..state })
    }

    fn in_lane(&self, road: &Road, branch: Branch, path: &Paths<'_>) -> Result<State, Fault> {
        let lane = self.lane.ok_or_else(|| path.missing("lane"))?;
        let along_m = self.along_m.ok_or_else(|| path.missing("along_m"))?;
        if let Some((message, help)) = no_such_lane(&format!("{}.lane", path.shown), lane, road) {
            return Err(path.fault("lane", "no such lane", message).help(help));
        }
        let (offset_m, most_m) = (self.lateral_offset_m.unwrap_or_default(), 0.5 * road.lane_width_m());
        if offset_m.abs() > most_m {
            let message = format!("`{}.lateral_offset_m` ({offset_m}) leads out of the lane", path.shown);
            let help = format!("it may be at most {most_m} m to either side; `lane` chooses another lane");
            return Err(path.fault("lateral_offset_m", "out of the lane", message).help(help));
        }
        let centre = &road.route(branch).centre;
        let [x_m, y_m] = centre.position(along_m, road.lane_centre_m(branch, lane) + offset_m);
        let heading_rad = centre.at(along_m).heading_rad + self.heading_error_deg.unwrap_or_default().to_radians();
        Ok(State { x_m, y_m, heading_rad, speed_mps: self.speed_mps })
    }
}
