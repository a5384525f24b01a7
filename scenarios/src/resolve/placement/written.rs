//! The stated position of a vehicle.

use std::sync::Arc;

use interplay_planners::{Route, State};

use crate::format::json_schema::SchemaNode;
use crate::format::read::tree::TomlNode;
use crate::format::start::StartConfig;
use crate::format::vehicle_config::VehicleConfig;
use crate::text::error::{Fault, quoted};

/// The state in which a vehicle starts, and its route.
pub(crate) type Start = (State, Arc<Route>);

/// A vehicle of a file, and its place.
pub(super) struct VehicleAsWritten<'a> {
    /// Its keys.
    pub stated: &'a VehicleConfig,
    pub index: usize,
    pub tree: &'a TomlNode,
    pub schema: SchemaNode<'a>,
}

impl VehicleAsWritten<'_> {
    /// The path of the vehicle, as errors show it.
    pub(super) fn shown(&self) -> String {
        format!("vehicle.{}", self.stated.name)
    }

    /// A fault of a key of the vehicle.
    pub(super) fn fault(&self, key: &str, label: &str, message: String) -> Fault {
        Fault::at(self.tree.place_of(&format!("vehicle.{}.{key}", self.index)), label, message)
    }

    /// The refusal of a start that lacks a required key.
    pub(super) fn missing(&self, key: &str) -> Fault {
        let start = self.schema.property("vehicle").and_then(SchemaNode::entries);
        let property = start.and_then(|vehicle| vehicle.property("start")).and_then(|start| start.property(key));
        let message = format!("{} is missing", quoted(&format!("{}.start.{key}", self.shown())));
        self.at_start(&format!("has no `{key}`"), message)
            .help(property.map(SchemaNode::description).unwrap_or_default())
    }

    /// A fault of the whole start.
    pub(super) fn at_start(&self, label: &str, message: String) -> Fault {
        let place =
            self.tree.at(&format!("vehicle.{}.start", self.index)).map_or(&self.tree.place, |start| &start.place);
        Fault::at(place, label, message)
    }

    /// The stated position in world coordinates \[m\].
    pub(super) fn position(&self) -> Result<[f64; 2], Fault> {
        match (self.stated.start.x_m, self.stated.start.y_m) {
            (Some(x_m), Some(y_m)) => Ok([x_m, y_m]),
            (Some(_), None) => Err(self.missing("y_m")),
            (None, Some(_)) => Err(self.missing("x_m")),
            (None, None) => {
                let message = format!("{} does not say where", quoted(&format!("{}.start", self.shown())));
                let help = "state `lane` and `along_m`, or `x_m` and `y_m`";
                Err(self.at_start("no place", message).help(help))
            }
        }
    }

    /// Refuses an offset beyond half of the width of the lane \[m\].
    pub(super) fn offset_within(&self, most_m: f64) -> Result<f64, Fault> {
        let offset_m = self.stated.start.lateral_offset_m.unwrap_or_default();
        if offset_m.abs() > most_m {
            let message = format!("`{}.start.lateral_offset_m` ({offset_m}) leads out of the lane", self.shown());
            let help = format!("it may be at most {most_m} m to either side; `lane` chooses another lane");
            return Err(self.fault("start.lateral_offset_m", "out of the lane", message).help(help));
        }
        Ok(offset_m)
    }
}

impl StartConfig {
    /// Whether it is stated in a lane.
    pub(super) fn is_in_lane(&self) -> bool {
        self.lane.is_some()
            || self.along_m.is_some()
            || self.lateral_offset_m.is_some()
            || self.heading_error_deg.is_some()
    }

    /// The stated heading; 0 if not stated \[rad\].
    pub(super) fn heading_rad(&self) -> f64 {
        self.heading_rad.or(self.heading_deg.map(f64::to_radians)).unwrap_or_default()
    }

    /// The heading against that of the lane; 0 if not stated \[rad\].
    pub(super) fn heading_error_rad(&self) -> f64 {
        self.heading_error_deg.unwrap_or_default().to_radians()
    }
}

/// A heading shifted by full turns to be nearest to another one \[rad\]: planners compare headings as numbers along a route, which may
/// turn by more than half a circle.
pub(super) fn next_to(heading_rad: f64, along_rad: f64) -> f64 {
    let turns = ((along_rad - heading_rad) / std::f64::consts::TAU).round();
    heading_rad + turns * std::f64::consts::TAU
}
