//! Vehicles that follow a record: they start where it begins, on any road.

use std::sync::Arc;

use interplay_planners::Driver;
use interplay_planners::drivers::recorded::Record;
use interplay_planners::road::network::{Lane, RoadNetwork};
use interplay_planners::{Corridor, Route, State};

use super::known_roads::KnownNetwork;
use super::written::{Start, VehicleAsWritten, next_to};
use crate::resolve::records;
use crate::text::error::{Fault, quoted};
use crate::text::readable::readable;

/// Cosine of the largest angle between a vehicle and the lane that it is assumed to follow.
const MIN_COS_OF_START: f64 = 0.5;
/// The largest distance from the middle of a lane at which a vehicle counts as beside it \[m\].
const MAX_BESIDE_M: f64 = 15.0;
/// Half of the width of the strip of a vehicle that is not beside any lane \[m\].
const STRIP_M: f64 = 100.0;
/// The most lanes of a route.
const MAX_LANES: usize = 200;

/// The largest distance between a stated start and the record \[m\].
const MAX_START_ERROR_M: f64 = 1.0;
/// Records that begin later than this do not determine the start \[s\].
const MAX_BEGIN_S: f64 = 1e-6;

/// The record of a vehicle, and its state at the start of the run; `None` for a vehicle without a record, and for invalid rows,
/// which are refused later.
///
/// # Errors
/// For a start that differs from the record, and a record that begins after the run.
pub(super) fn start(written: &VehicleAsWritten<'_>) -> Result<Option<(Record, State)>, Fault> {
    let Some(driver) = &written.stated.driver else { return Ok(None) };
    if driver.get("kind").is_none_or(|kind| kind != records::KIND) {
        return Ok(None);
    }
    let settings: Option<Driver> = driver.clone().settings().ok();
    let Some(record) = settings.and_then(|driver| driver.record()) else { return Ok(None) };
    let [from_s, _] = record.span_s();
    let begins_s = written.stated.enters_s.unwrap_or(0.0).max(0.0);
    let Some(state) = record.state_at(begins_s).filter(|_| from_s <= begins_s + MAX_BEGIN_S) else {
        let message =
            format!("the record of {} does not say where it is when it comes on the road", quoted(&written.shown()));
        let [from_s, to_s] = record.span_s().map(readable);
        let help =
            format!("it reaches from {from_s} to {to_s} s; `enters_s` says when the vehicle comes, by default at 0 s");
        return Err(written.fault("driver", "not then", message).help(help));
    };
    if let (Some(x_m), Some(y_m)) = (written.stated.start.x_m, written.stated.start.y_m) {
        let missed_m = libm::hypot(x_m - state.x_m, y_m - state.y_m);
        if missed_m > MAX_START_ERROR_M {
            let message = format!(
                "{} does not start where its record begins: {} m are between them",
                quoted(&written.shown()),
                readable(missed_m)
            );
            let help = format!("the record says `x_m = {}, y_m = {}`", readable(state.x_m), readable(state.y_m));
            return Err(written.at_start("elsewhere", message).help(help));
        }
    }
    Ok(Some((record, state)))
}

/// The start of a vehicle on a network, and its route: along its stated lanes, or from the lane that it is on or beside, in
/// its direction, along the lanes of its record. Beside all lanes, the route is a straight strip.
pub(super) fn place(record: &Record, state: State, stated: &[String], known: &KnownNetwork) -> Start {
    let network = &known.network;
    let route = lane_at(network, &state).and_then(|lane| {
        let way = if stated.is_empty() { way(record, lane, network) } else { stated.to_vec() };
        known
            .route(way.clone(), || network.route(&way))
            .or_else(|_| {
                // If no curve joins the lanes, the first of them alone.
                let first = vec![lane.name.clone()];
                known.route(first.clone(), || network.route(&first))
            })
            .ok()
    });
    let route = route.unwrap_or_else(|| strip(&state));
    let along_rad = route.heading_at(state.position());
    (State { heading_rad: next_to(state.heading_rad, along_rad), ..state }, route)
}

/// The lane that a vehicle is on or beside, in about its direction.
fn lane_at<'a>(network: &'a RoadNetwork, state: &State) -> Option<&'a Lane> {
    let on_lane = network.locate(state.position(), state.heading_rad).into_iter().next();
    let on_lane = on_lane.filter(|place| libm::cos(place.heading_error_rad) >= MIN_COS_OF_START);
    on_lane.and_then(|place| network.lane(&place.lane)).or_else(|| nearest(state, network.lanes()))
}

/// The lane that a vehicle or an obstacle is on or beside, as a route.
pub(super) fn lane_route(network: &RoadNetwork, state: &State) -> Option<Arc<Route>> {
    network.route(&[&*lane_at(network, state)?.name]).ok().map(Arc::new)
}

/// The lane that a vehicle is beside, in about its direction.
fn nearest<'a>(state: &State, lanes: &'a [Lane]) -> Option<&'a Lane> {
    let beside = lanes.iter().filter_map(|lane| {
        let at = lane.centre.project(state.position(), None);
        let is_along = libm::cos(state.heading_rad - at.heading_rad) >= MIN_COS_OF_START;
        let is_beside = (0.0..=lane.centre.length_m()).contains(&at.along_m) && at.across_m.abs() <= MAX_BESIDE_M;
        (is_along && is_beside).then(|| (lane, at.across_m.abs()))
    });
    beside.min_by(|one, other| one.1.total_cmp(&other.1)).map(|(lane, _)| lane)
}

/// The names of the lanes that a record follows, from a lane on: at a fork, the lane nearest to the record.
pub(crate) fn way(record: &Record, lane: &Lane, network: &RoadNetwork) -> Vec<String> {
    let mut names = vec![lane.name.clone()];
    let mut last = lane;
    while names.len() < MAX_LANES {
        let ahead = last.successors.iter().filter_map(|name| network.lane(name));
        let ahead: Vec<&Lane> = ahead.filter(|lane| !names.contains(&lane.name)).collect();
        let next = match ahead.as_slice() {
            [] => break,
            [only] => only,
            several => {
                let missed = several.iter().map(|lane| (lane, missed_m(record, lane)));
                let Some((nearest, _)) = missed.min_by(|one, other| one.1.total_cmp(&other.1)) else { break };
                nearest
            }
        };
        names.push(next.name.clone());
        last = next;
    }
    names
}

/// The least distance of a record from the end of a lane \[m\].
fn missed_m(record: &Record, lane: &Lane) -> f64 {
    let [x, y] = lane.centre.position(lane.centre.length_m(), 0.0);
    record.positions().map(|[at_x, at_y]| libm::hypot(at_x - x, at_y - y)).fold(f64::INFINITY, f64::min)
}

/// A wide straight strip in the direction of a vehicle.
pub(super) fn strip(state: &State) -> Arc<Route> {
    let (sin, cos) = libm::sincos(state.heading_rad);
    let across_m = cos * state.y_m - sin * state.x_m;
    let (right_m, left_m) = (across_m - STRIP_M, across_m + STRIP_M);
    Arc::new(Route::from(Corridor { heading_rad: state.heading_rad, right_m, left_m, end: None }))
}
