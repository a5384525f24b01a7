//! Converts obstacles to vehicles that follow their records or have a driver of Interplay.

use interplay_planners::drivers::recorded::Record;
use interplay_planners::{Body, State};

use super::super::model::{CommonRoad, Obstacle, Role};
use super::notes::{NOT_YET, Names, Notes};
use crate::format::obstacle::ObstacleConfig;
use crate::format::start::StartConfig;
use crate::format::stated::Stated;
use crate::format::vehicle_config::VehicleConfig;
use crate::model::classes::VehicleClass;
use crate::model::traffic::obstacle::ObstacleKind;
use crate::text::error::Place;

/// The smallest and the largest side of a body \[m\].
const SIDES_M: [f64; 2] = [0.1, 100.0];
/// Where the axles of a vehicle of unknown kind are, as a share of its length from its middle.
const AXLE_SHARE: f64 = 0.3;

/// A vehicle of the imported scenario.
pub(super) struct Follower {
    /// The id of its obstacle.
    pub id: String,
    /// Its keys in a file, except its driver and its route.
    pub config: VehicleConfig,
    /// Its motion: rows of time, x, y, heading and speed.
    pub rows: Vec<[f64; 5]>,
    /// Its state when the run begins.
    pub start: State,
    pub body: Body,
    pub stands: bool,
    /// Whether one of our drivers could drive it.
    pub is_car: bool,
    pub place: Place,
}

/// A vehicle that was never faster than this wants to drive at the speed limit \[m/s\].
const MIN_WANTED_MPS: f64 = 3.0;
/// The desired speed if the file states none: 30 km/h \[m/s\].
const USUAL_MPS: f64 = 8.33;

impl Follower {
    /// The desired speed of a driver that replaces a record: the highest speed of the record, or, if the vehicle never drove,
    /// the speed limit \[m/s\].
    pub(super) fn wanted_mps(&self, limit_mps: Option<f64>) -> f64 {
        let fastest_mps = self.rows.iter().map(|row| row[4]).fold(0.0, f64::max);
        if fastest_mps >= MIN_WANTED_MPS { fastest_mps } else { limit_mps.unwrap_or(USUAL_MPS) }
    }
}

impl Follower {
    /// When its record ends, if it drives then and the run goes on \[s\].
    pub(super) fn leaves_s(&self, duration_s: f64) -> Option<f64> {
        let last = self.rows.last()?;
        (last[4] > 0.0 && last[0] < duration_s - 1e-6).then(|| rounded(last[0], 6))
    }

    /// The obstacle that it is, if it never moves.
    pub(super) fn obstacle(&self) -> ObstacleConfig {
        let kind = match self.config.class {
            Some(VehicleClass::Truck | VehicleClass::Bus | VehicleClass::Van) => ObstacleKind::ParkedVan,
            _ => ObstacleKind::ParkedCar,
        };
        ObstacleConfig {
            name: self.config.name.clone(),
            kind,
            x_m: Some(rounded(self.start.x_m, 4)),
            y_m: Some(rounded(self.start.y_m, 4)),
            heading_rad: Some(rounded(self.start.heading_rad.to_degrees(), 4).to_radians()),
            length_m: Some(rounded(self.body.front_m + self.body.rear_m, 3)),
            width_m: Some(self.body.width_m),
            ..ObstacleConfig::default()
        }
    }
}

/// The vehicles that are on the road at the time step `begin`, or enter later.
pub(super) fn followers(scenario: &CommonRoad<'_>, begin: f64, notes: &mut Notes) -> Vec<Follower> {
    let mut names = Names::default();
    let all = scenario.obstacles.iter();
    all.filter_map(|obstacle| follower(obstacle, scenario.step_s, begin, &mut names, notes)).collect()
}

fn follower(
    obstacle: &Obstacle<'_>,
    step_s: f64,
    begin: f64,
    names: &mut Names,
    notes: &mut Notes,
) -> Option<Follower> {
    let body = body(obstacle, notes)?;
    if obstacle.has_occupancies && obstacle.states.len() < 2 {
        let what = ["obstacle with sets of places for a trajectory", "obstacles with sets of places for a trajectory"];
        notes.one(what, NOT_YET);
        return None;
    }
    let rows = rows(obstacle, step_s, begin, notes);
    let record = Record::new(&rows).ok()?;
    let [from_s, _] = record.span_s();
    let stands = obstacle.role == Role::Static;
    let rows =
        if stands { rows.into_iter().take(1).map(|row| [0.0, row[1], row[2], row[3], 0.0]).collect() } else { rows };
    let enters_s = (from_s > 1e-6 && !stands).then_some(rounded(from_s, 6));
    let Some(start) = Record::new(&rows).ok()?.state_at(from_s.max(0.0)) else {
        notes.one(
            ["vehicle that is gone when the run begins", "vehicles that are gone when the run begins"],
            "left out",
        );
        return None;
    };
    let kind = if obstacle.kind == "parkedVehicle" { "parked" } else { &obstacle.kind };
    let name = names.name("", &format!("{kind}-{}", obstacle.id));
    let class = class(&obstacle.kind);
    let (half_m, axle_m) = (body.front_m, body.front_axle_m);
    let stated = Stated::default().with("front_m", half_m).with("rear_m", half_m).with("width_m", body.width_m);
    let config = VehicleConfig {
        class: Some(class),
        enters_s,
        body: Some(stated.with("front_axle_m", axle_m).with("rear_axle_m", axle_m)),
        ..VehicleConfig::new(&name, in_world(&start))
    };
    let (id, place) = (obstacle.id.clone(), obstacle.element.place());
    let is_car = !matches!(class, VehicleClass::Bicycle | VehicleClass::Pedestrian) && !stands;
    Some(Follower { id, config, rows, start, body, stands, is_car, place })
}

/// A start in world coordinates, with rounded numbers.
pub(super) fn in_world(state: &State) -> StartConfig {
    StartConfig {
        x_m: Some(rounded(state.x_m, 4)),
        y_m: Some(rounded(state.y_m, 4)),
        heading_deg: Some(rounded(state.heading_rad.to_degrees(), 4)),
        speed_mps: rounded(state.speed_mps, 3),
        ..StartConfig::default()
    }
}

/// Rounds a number to `digits` decimal places.
pub(super) fn rounded(number: f64, digits: i32) -> f64 {
    let factor = 10_f64.powi(digits);
    (factor * number).round() / factor
}

/// The class of vehicle that is most similar to an obstacle.
fn class(kind: &str) -> VehicleClass {
    match kind {
        "truck" | "train" => VehicleClass::Truck,
        "bus" => VehicleClass::Bus,
        "bicycle" | "motorcycle" => VehicleClass::Bicycle,
        "pedestrian" => VehicleClass::Pedestrian,
        _ => VehicleClass::Car,
    }
}

/// The body of an obstacle, with its middle as the mass centre; `None` if the obstacle is not a vehicle.
fn body(obstacle: &Obstacle<'_>, notes: &mut Notes) -> Option<Body> {
    if obstacle.role == Role::Surroundings {
        notes.one(["obstacle beside the road", "obstacles beside the road"], NOT_YET);
        return None;
    }
    if obstacle.kind == "roadBoundary" {
        notes.one(["boundary of the road", "boundaries of the road"], "left out: lanes have edges");
        return None;
    }
    let shapes: Vec<_> = obstacle.shape.iter().filter_map(|shape| shape.rectangle()).collect();
    let Some((rectangle, is_exact)) = shapes.first() else {
        notes.one(["obstacle without a shape", "obstacles without a shape"], "left out");
        return None;
    };
    if !is_exact {
        notes.one(
            ["obstacle that is not a rectangle", "obstacles that are not rectangles"],
            "carried over as the box around it",
        );
    }
    if shapes.len() > 1 {
        notes.one(["obstacle of several shapes", "obstacles of several shapes"], "carried over with the first of them");
    }
    let [length_m, width_m] =
        [rectangle.length_m, rectangle.width_m].map(|side| rounded(side.clamp(SIDES_M[0], SIDES_M[1]), 3));
    let axle_m = rounded(AXLE_SHARE * length_m, 3);
    let half_m = 0.5 * length_m;
    Some(Body {
        front_m: half_m,
        rear_m: half_m,
        width_m,
        front_axle_m: axle_m,
        rear_axle_m: axle_m,
        scale: Body::REAL_SCALE,
    })
}

/// The motion of an obstacle: of the middle of its box.
fn rows(obstacle: &Obstacle<'_>, step_s: f64, begin: f64, notes: &mut Notes) -> Vec<[f64; 5]> {
    let shape = obstacle.shape.first().and_then(|shape| shape.rectangle());
    let (offset, turned_rad) = shape.map_or(([0.0; 2], 0.0), |(it, _)| (it.centre, it.orientation_rad));
    // A moving box is oriented along its motion.
    let turned_rad = if obstacle.role == Role::Static { turned_rad } else { 0.0 };
    let mut rows: Vec<[f64; 5]> = Vec::with_capacity(obstacle.states.len());
    let (mut backwards, mut out_of_order, mut uncertain) = (false, 0, false);
    for state in &obstacle.states {
        let (sin, cos) = libm::sincos(state.orientation_rad);
        let [x, y] = state.position;
        let row = [
            rounded((state.time - begin) * step_s, 6),
            rounded(x + cos * offset[0] - sin * offset[1], 4),
            rounded(y + sin * offset[0] + cos * offset[1], 4),
            rounded(state.orientation_rad + turned_rad, 5),
            rounded(state.velocity_mps.max(0.0), 3),
        ];
        backwards |= state.velocity_mps < 0.0;
        uncertain |= !state.is_exact;
        if rows.last().is_some_and(|before| row[0] <= before[0]) {
            out_of_order += 1;
            continue;
        }
        rows.push(row);
    }
    if backwards {
        notes.one(["vehicle that drives backwards", "vehicles that drive backwards"], "their speed is 0 meanwhile");
    }
    if uncertain {
        notes.one(["vehicle with uncertain states", "vehicles with uncertain states"], "taken in the middle");
    }
    notes.several(out_of_order, ["state out of order", "states out of order"], "left out");
    rows
}
