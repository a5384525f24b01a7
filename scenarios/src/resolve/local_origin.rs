//! A local origin for roads far from the origin of their coordinates.
//!
//! Maps of real places have coordinates of 10⁵ to 10⁷ m. Curves, projections and bodies in single precision are exact to a
//! micrometre within some kilometres only. So a network with large coordinates is moved, with everything on it, by a whole
//! number of kilometres; it is loaded, planned and recorded as if it were there.

use interplay_planners::Driver;
use serde_json::{Value as Json, json};

use super::records;
use crate::format::obstacle::ObstacleConfig;
use crate::format::read::tree::TomlNode;
use crate::format::stated::Stated;
use crate::format::vehicle_config::VehicleConfig;
use crate::roads::{LaneConfig, Road};
use crate::text::error::Fault;

/// Coordinates up to this are unchanged \[m\].
const MAX_COORDINATE_M: f64 = 10_000.0;
/// Roads are moved by multiples of this \[m\].
const GRID_M: f64 = 1000.0;

/// Moves a network with large coordinates, and the vehicles and obstacles on it, near the origin. Returns by what was moved: what stood there is now
/// at (0, 0); none for a road that stays where it is \[m\].
pub(super) fn move_near_origin(
    road: &mut Road,
    vehicles: &mut [VehicleConfig],
    obstacles: &mut [ObstacleConfig],
) -> Option<[f64; 2]> {
    let Road::Network(network) = road else { return None };
    let first = network.lanes.iter().find_map(first_point)?;
    let origin = of(first)?;
    for lane in &mut network.lanes {
        lane.points.iter_mut().for_each(|point| *point = [point[0] - origin[0], point[1] - origin[1]]);
        if let Some(start) = &mut lane.start {
            start.x_m -= origin[0];
            start.y_m -= origin[1];
        }
    }
    for vehicle in vehicles {
        for (stated_m, origin_m) in [&mut vehicle.start.x_m, &mut vehicle.start.y_m].into_iter().zip(origin) {
            *stated_m = stated_m.map(|stated_m| stated_m - origin_m);
        }
        vehicle.driver.iter_mut().for_each(|driver| move_record(driver, origin));
    }
    for obstacle in obstacles {
        for (stated_m, origin_m) in [&mut obstacle.x_m, &mut obstacle.y_m].into_iter().zip(origin) {
            *stated_m = stated_m.map(|stated_m| stated_m - origin_m);
        }
        obstacle.timetable.iter_mut().for_each(|row| (row[1], row[2]) = (row[1] - origin[0], row[2] - origin[1]));
    }
    Some(origin)
}

/// The origin for a road that begins at a point; `None` if it is near enough to (0, 0) \[m\].
pub(crate) fn of(first: [f64; 2]) -> Option<[f64; 2]> {
    let is_near = first.iter().all(|coordinate| coordinate.abs() <= MAX_COORDINATE_M);
    (!is_near).then(|| first.map(|coordinate| (coordinate / GRID_M).round() * GRID_M))
}

/// The remark that a road was moved, for readers of positions in reports and recordings.
pub(super) fn remark([x_m, y_m]: [f64; 2], tree: &TomlNode) -> Fault {
    let message =
        format!("the road is far from the origin, so that all is moved: ({x_m:.0}, {y_m:.0}) is (0, 0) in this run");
    Fault::at(tree.place_of("road"), "far away", message)
}

/// The first point of a lane \[m\].
fn first_point(lane: &LaneConfig) -> Option<[f64; 2]> {
    lane.points.first().copied().or_else(|| lane.start.map(|start| [start.x_m, start.y_m]))
}

/// Moves the rows of a recorded driver.
fn move_record(driver: &mut Stated<Driver>, origin: [f64; 2]) {
    if driver.get("kind").is_none_or(|kind| kind != records::KIND) {
        return;
    }
    let Some(Json::Array(mut rows)) = driver.take("points") else { return };
    for row in rows.iter_mut().filter_map(Json::as_array_mut) {
        for (cell, origin_m) in row.iter_mut().skip(1).zip(origin) {
            if let Some(stated_m) = cell.as_f64() {
                *cell = json!(stated_m - origin_m);
            }
        }
    }
    *driver = std::mem::take(driver).with("points", Json::Array(rows));
}
