//! Obstacles: from the keys of a file to positions in the world and outlines.

use std::sync::Arc;

use interplay_common::spelling::suggestion;
use interplay_planners::drivers::recorded;
use interplay_planners::road::network::RoadNetwork;
use interplay_planners::rules::RuleKeeping;
use interplay_planners::{Driver, Route, State};

use crate::format::obstacle::ObstacleConfig;
use crate::format::read::tree::TomlNode;
use crate::model::scenario::Vehicle;
use crate::model::traffic::lane_reference::LaneReference;
use crate::model::traffic::obstacle::{DeclaredObstacle, ObstacleForm, Outline};
use crate::roads::{Branch, Road};
use crate::text::error::{Fault, quoted};
use crate::text::readable::readable;

/// How long before the time of a row an obstacle is there, still with the speed at which it came \[s\].
const ARRIVING_S: f64 = 1e-6;

/// Ratio of lengths of real cars to those of 1/10 scale.
const REAL_SCALE: f64 = interplay_planners::Body::REAL_SCALE;

/// The obstacles of a file on a road, as vehicles without a driver, of the scale of the others.
///
/// # Errors
/// For invalid positions, and outlines that are not convex polygons.
pub(crate) fn obstacles(
    stated: &[ObstacleConfig],
    declared: &[DeclaredObstacle],
    road: &Road,
    network: Option<&RoadNetwork>,
    tree: &TomlNode,
    vehicles: &[Vehicle],
) -> Result<Vec<Vehicle>, Vec<Fault>> {
    let scale = vehicles.first().map_or(REAL_SCALE, |vehicle| vehicle.body.scale);
    let (mut found, mut faults) = (Vec::new(), Vec::new());
    for (index, stated) in stated.iter().enumerate() {
        let written = Written { stated, declared, index, tree, road, network };
        match written.vehicle(scale) {
            Ok(vehicle) => found.push(vehicle),
            Err(fault) => faults.push(fault),
        }
    }
    if faults.is_empty() { Ok(found) } else { Err(faults) }
}

/// An obstacle of a file, and its place.
struct Written<'a> {
    stated: &'a ObstacleConfig,
    declared: &'a [DeclaredObstacle],
    index: usize,
    tree: &'a TomlNode,
    road: &'a Road,
    network: Option<&'a RoadNetwork>,
}

impl Written<'_> {
    fn vehicle(&self, scale: f64) -> Result<Vehicle, Fault> {
        let mut outline = self.outline(scale)?;
        let (mut points, mut start) = self.points()?;
        let route = self.route(&start);
        if let [point] = points.as_mut_slice() {
            // A standing obstacle lies along the road: its outline is turned instead.
            let along_rad = route.heading_at(start.position());
            outline = outline.turned(start.heading_rad - along_rad);
            (point[3], start.heading_rad) = (along_rad, along_rad);
        }
        let driver = Driver::Recorded(recorded::Settings { points, ..recorded::Settings::default() });
        Ok(Vehicle {
            name: self.stated.name.clone(),
            body: outline.body(scale),
            rules: Some(RuleKeeping::Ignored),
            obstacle: Some(ObstacleForm { kind: self.stated.kind.clone(), outline }),
            ..Vehicle::new(start, route, driver)
        })
    }

    /// The rows of its record, and its state at the start.
    fn points(&self) -> Result<(Vec<[f64; 5]>, State), Fault> {
        if self.stated.timetable.is_empty() {
            let at = self.place()?;
            return Ok((vec![[0.0, at.x_m, at.y_m, at.heading_rad, 0.0]], at));
        }
        let stated = self.stated;
        if stated.lane.is_some() || stated.along_m.is_some() || stated.x_m.is_some() || stated.y_m.is_some() {
            let message = format!("{} has a place and a timetable", self.shown());
            return Err(self
                .fault("timetable", "and a place", message)
                .help("the rows of a timetable say where it is"));
        }
        let rows = &stated.timetable;
        let is_late = |pair: &[[f64; 4]]| pair[1][0] <= pair[0][0];
        if let Some(row) = rows.windows(2).position(is_late) {
            let message = format!("the timetable of {} goes back in time in row {}", self.shown(), row + 2);
            return Err(self.fault("timetable", "not later", message).help("rows are in the order of their times"));
        }
        if rows[0][0] > 0.0 {
            let message = format!("the timetable of {} begins at {} s", self.shown(), readable(rows[0][0]));
            return Err(self
                .fault("timetable", "not at 0 s", message)
                .help("let the first row say where it is at 0 s"));
        }
        let speed_mps = |row: usize| {
            let [from, to] = [rows[row], *rows.get(row + 1)?];
            let (sin, cos) = libm::sincos(from[3]);
            let way_m = [to[1] - from[1], to[2] - from[2]];
            // Negative where it goes backwards.
            let speed_mps = libm::hypot(way_m[0], way_m[1]) / (to[0] - from[0]);
            Some(speed_mps.copysign(if way_m[0] * cos + way_m[1] * sin < 0.0 { -1.0 } else { 1.0 }))
        };
        // It keeps its speed until the next row, so each row but the first has a moment just before it.
        let points = rows.iter().enumerate().flat_map(|(row, [time_s, x_m, y_m, heading_rad])| {
            let arrives = row.checked_sub(1).and_then(speed_mps);
            let arrives = arrives.map(|speed_mps| [*time_s - ARRIVING_S, *x_m, *y_m, *heading_rad, speed_mps]);
            let leaves = [*time_s, *x_m, *y_m, *heading_rad, speed_mps(row).unwrap_or(0.0)];
            arrives.into_iter().chain([leaves])
        });
        let points: Vec<[f64; 5]> = points.collect();
        let record = recorded::Record::new(&points).map_err(|_| {
            let message = format!("the timetable of {} has a number that is not finite", self.shown());
            self.fault("timetable", "not finite", message)
        })?;
        let start = record.state_at(0.0).unwrap_or_else(|| record.first());
        Ok((points, start))
    }

    fn place(&self) -> Result<State, Fault> {
        let stated = self.stated;
        let turned_rad = stated.heading_rad.unwrap_or(0.0);
        if let (Some(x_m), Some(y_m)) = (stated.x_m, stated.y_m) {
            return Ok(State { x_m, y_m, heading_rad: turned_rad, speed_mps: 0.0 });
        }
        let (Some(lane), Some(along_m)) = (&stated.lane, stated.along_m) else {
            let message = format!("{} does not say where it stands", self.shown());
            let help = "state `lane` and `along_m`, or `x_m` and `y_m`";
            return Err(Fault::at(self.tree.place_of(&self.path()), "no place", message).help(help));
        };
        let offset_m = stated.lateral_offset_m.unwrap_or(0.0);
        let ([x_m, y_m], along_rad) = match (lane, self.network) {
            (LaneReference::Name(name), Some(network)) => self.in_lane(network, name, along_m, offset_m)?,
            (LaneReference::Number(number), None) => self.in_numbered(*number, along_m, offset_m)?,
            (_, network) => {
                let (what, help) = if network.is_some() { ("a number", "name") } else { ("a name", "number") };
                let message = format!("the lane of {} is {what}", self.shown());
                return Err(self
                    .fault("lane", "no such lane", message)
                    .help(format!("a lane of this road has a {help}")));
            }
        };
        Ok(State { x_m, y_m, heading_rad: along_rad + turned_rad, speed_mps: 0.0 })
    }

    fn in_lane(
        &self,
        network: &RoadNetwork,
        name: &str,
        along_m: f64,
        offset_m: f64,
    ) -> Result<([f64; 2], f64), Fault> {
        let Some(lane) = network.lane(name) else {
            let names: Vec<&str> = network.lanes().iter().map(|lane| lane.name.as_str()).collect();
            let message = format!("there is no lane {}", quoted(name));
            return Err(self.fault("lane", "no such lane", message).help(suggestion(name, "", &names)));
        };
        let length_m = lane.centre.length_m();
        if !(0.0..=length_m).contains(&along_m) {
            let message = format!("{} stands {} m along lane {}", self.shown(), readable(along_m), quoted(name));
            let help = format!("the lane is {} m long", readable(length_m));
            return Err(self.fault("along_m", "beyond the lane", message).help(help));
        }
        Ok((lane.centre.position(along_m, offset_m), lane.centre.at(along_m).heading_rad))
    }

    fn in_numbered(&self, number: usize, along_m: f64, offset_m: f64) -> Result<([f64; 2], f64), Fault> {
        let centre = self.road.lane_centre_m(Branch::Main, number).zip(self.road.route(Branch::Main));
        let Some((centre_m, route)) = centre else {
            let message = format!("there is no lane {number}");
            return Err(self.fault("lane", "no such lane", message).help("lane 0 is the rightmost one"));
        };
        Ok((route.position(along_m, centre_m + offset_m), route.heading_at(route.position(along_m, centre_m))))
    }

    /// The route with which others compare theirs: along the lane that it is on or beside.
    fn route(&self, at: &State) -> Arc<Route> {
        let along_lane = self.network.and_then(|network| super::recorded::lane_route(network, at));
        along_lane.or_else(|| self.road.route(Branch::Main)).unwrap_or_else(|| super::recorded::strip(at))
    }

    fn outline(&self, scale: f64) -> Result<Outline, Fault> {
        let ObstacleConfig { kind, length_m, width_m, radius_m, corners_m, .. } = self.stated;
        if !corners_m.is_empty() {
            return self.polygon(corners_m);
        }
        let (usual_m, is_round) = kind.shape(self.declared);
        let usual_m = usual_m.map(|size_m| size_m * scale / REAL_SCALE);
        Ok(match (radius_m, length_m, width_m) {
            (Some(radius_m), _, _) => Outline::Circle { radius_m: *radius_m },
            (None, None, None) if is_round => Outline::Circle { radius_m: 0.5 * usual_m[0] },
            _ => Outline::Box { length_m: length_m.unwrap_or(usual_m[0]), width_m: width_m.unwrap_or(usual_m[1]) },
        })
    }

    /// A polygon, if it is convex, counter-clockwise and around its middle.
    fn polygon(&self, corners_m: &[[f64; 2]]) -> Result<Outline, Fault> {
        let count = corners_m.len();
        let turns = |index: usize| {
            let [a, b, c] = [0, 1, 2].map(|next| corners_m[(index + next) % count]);
            (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0]) > 0.0
        };
        let holds_middle = |index: usize| {
            let [a, b] = [0, 1].map(|next| corners_m[(index + next) % count]);
            a[0] * b[1] - a[1] * b[0] > 0.0
        };
        if count < 3 || !(0..count).all(|index| turns(index) && holds_middle(index)) {
            let message = format!("the corners of {} are no convex polygon around its middle", self.shown());
            let help = "state at least three corners counter-clockwise, such as `[[1, -1], [1, 1], [-1, 0]]`; two obstacles can \
                        make a shape that is not convex";
            return Err(self.fault("corners_m", "not convex", message).help(help));
        }
        Ok(Outline::Polygon { corners_m: corners_m.to_vec() })
    }

    fn shown(&self) -> String {
        format!("`obstacle.{}`", self.stated.name)
    }

    fn path(&self) -> String {
        format!("obstacle.{}", self.index)
    }

    fn fault(&self, key: &str, label: &str, message: String) -> Fault {
        Fault::at(self.tree.place_of(&format!("{}.{key}", self.path())), label, message)
    }
}
