//! The width that a body sweeps in a turn.
//!
//! The rear wheels of a vehicle run on a smaller circle than its front wheels, so in a turn it covers a strip that is wider than
//! its body. With the middle of the rear axle on a circle of radius `R`, the inner side of a body of width `w` reaches in to
//! `R − w/2`, and its outer front corner, `l` ahead of the rear axle, out to `√((R + w/2)² + l²)`.

use interplay_planners::road::network::{RoadNetwork, Turner};
use interplay_planners::{Body, Route};

use crate::model::scenario::{Scenario, Vehicle};
use crate::roads::Road;
use crate::text::error::quoted;

/// The number of positions of a route that are checked per wheelbase.
const PLACES_PER_WHEELBASE: f64 = 2.0;
/// The most positions of a route that are checked.
const MAX_PLACES: f64 = 10_000.0;

/// A body does not come round if a corner is this far beyond an edge, in its widths: for a lorry 1 cm. Drivers follow their routes to some
/// centimetres, and 5 cm count as off the road.
const OFF_ROAD_WIDTHS: f64 = 0.005;
/// The radius that works is searched in steps of the present one by this number.
const STEPS_OF_PRESENT: u32 = 8;
/// The largest radius that is tried, as a multiple of the present one.
const MOST_TIMES: f64 = 4.0;

/// The swept width of a body in the tightest turn of its route.
#[derive(Clone, Copy, Debug, PartialEq)]
struct TightTurn {
    /// Position on the route \[m\].
    along_m: f64,
    /// Radius of the inner edge of the road there \[m\].
    inner_m: f64,
    /// Width of the road \[m\].
    road_m: f64,
    /// Width of the strip that the body sweeps with its inner side on that edge \[m\].
    swept_m: f64,
}

/// Whether a body cannot come round a turn without leaving the road: on a network driven along its route by the bicycle model, elsewhere
/// because it sweeps more than the width of the road.
pub(crate) fn remark(scenario: &Scenario, vehicle: &Vehicle) -> Option<(String, String)> {
    let turn = tightest(&vehicle.body, &vehicle.route, vehicle.route.along(vehicle.start.position()));
    if scenario.network.is_some() {
        let may_leave = turn.is_some() || vehicle.route.is_swept();
        return may_leave.then(|| tight_turn(scenario, vehicle)).flatten();
    }
    let turn = turn?;
    let [swept_m, road_m, radius_m] = [turn.swept_m, turn.road_m, turn.inner_m + 0.5 * turn.road_m].map(to_tenths);
    let message = format!(
        "vehicle {} covers a width of {swept_m} m in the turn after {} m, which has {road_m} m and a radius of {radius_m} m",
        quoted(&vehicle.name),
        to_tenths(turn.along_m)
    );
    let help = "it may stop there, or leave the road; a larger radius works, a wider lane, or the `class` of a shorter vehicle";
    Some((message, help.to_owned()))
}

/// Whether a turn of a network is too tight for a body, and the smallest radius that works.
fn tight_turn(scenario: &Scenario, vehicle: &Vehicle) -> Option<(String, String)> {
    let Vehicle { name, body, limits, route, .. } = vehicle;
    let turner = Turner { body: *body, steering_max_rad: limits.steering_max_rad };
    let (along_m, beyond_m) = route.leaves_road_m(&turner, route.along(vehicle.start.position()));
    if beyond_m <= OFF_ROAD_WIDTHS * body.width_m {
        return None;
    }
    let lane = route.leg(along_m).map(|leg| quoted(&leg.lane)).unwrap_or_default();
    let message = format!(
        "the turn of lane {lane} is too tight for the {} m of vehicle {}: it may leave the road by {beyond_m:.1} m",
        to_tenths(body.front_m + body.rear_m),
        quoted(name)
    );
    let else_works = "a wider lane may work, or the `class` of a shorter vehicle";
    let help = smallest_radius(&scenario.road, vehicle, &turner).map_or_else(
        || else_works.to_owned(),
        |(key, radius_m)| format!("`road.{key} = {radius_m}` works; {else_works}"),
    );
    Some((message, help))
}

/// The key of the radius of a junction, and its smallest value in tenths of a metre with which a body drives along the route of a vehicle
/// within the road; `None` where no key states it, or none up to [`MOST_TIMES`] the present one works.
fn smallest_radius(road: &Road, vehicle: &Vehicle, turner: &Turner) -> Option<(&'static str, f64)> {
    let lanes: Vec<&str> = vehicle.route.legs.iter().map(|leg| leg.lane.as_str()).collect();
    let mut road = road.clone();
    let (key, now_m) = road.turn_radius().map(|(key, radius_m)| (key, *radius_m))?;
    let mut fits = |tenths: u32| {
        *road.turn_radius()?.1 = f64::from(tenths) / 10.0;
        let network = RoadNetwork::new(road.network_lanes()?.ok()?).ok()?;
        let route = network.route_of_body(network.route(&lanes).ok()?, turner);
        Some(route.leaves_road_m(turner, 0.0).1 <= OFF_ROAD_WIDTHS * turner.body.width_m)
    };
    // A larger radius is not always better: the lanes of a junction leave other holes. So the search goes up in steps first.
    let now = (10.0 * now_m) as u32;
    let step = (now / STEPS_OF_PRESENT).max(1);
    let mut tried = (now..=(MOST_TIMES * 10.0 * now_m) as u32).step_by(step as usize).skip(1);
    let mut works = tried.find(|tenths| fits(*tenths) == Some(true))?;
    let mut does_not = works - step;
    while works > does_not + 1 {
        let middle = does_not.midpoint(works);
        if fits(middle) == Some(true) {
            works = middle;
        } else {
            does_not = middle;
        }
    }
    Some((key, f64::from(works) / 10.0))
}

/// The turn in which a body lacks the most width, from an arc length of a route on; `None` if it fits everywhere.
fn tightest(body: &Body, route: &Route, start_m: f64) -> Option<TightTurn> {
    let (wheelbase_m, length_m) = (body.wheelbase_m(), route.end_m() - start_m);
    let count = (PLACES_PER_WHEELBASE * length_m / wheelbase_m).ceil();
    if !count.is_finite() || route.straight().is_some() {
        return None;
    }
    let count = count.clamp(1.0, MAX_PLACES) as usize;
    let turns = (0..=count).filter_map(|place| {
        let along_m = start_m + length_m * place as f64 / count as f64;
        // A curve shorter than its wheelbase does not affect a vehicle.
        let ends = [-0.5, 0.5].map(|share| route.centre.at(along_m + share * wheelbase_m).heading_rad);
        let curvature_1pm = (ends[1] - ends[0]) / wheelbase_m;
        let [right_m, left_m] = route.edges_before_end_m(along_m);
        let inwards_m = if curvature_1pm > 0.0 { left_m } else { -right_m };
        let inner_m = (1.0 / curvature_1pm.abs() - inwards_m).max(0.0);
        let turn = TightTurn { along_m, inner_m, road_m: left_m - right_m, swept_m: swept_width_m(body, inner_m) };
        (turn.swept_m > turn.road_m).then_some(turn)
    });
    turns.max_by(|one, other| (one.swept_m - one.road_m).total_cmp(&(other.swept_m - other.road_m)))
}

/// Width of the strip that a body sweeps on a circle, with its inner side on a radius \[m\].
fn swept_width_m(body: &Body, inner_m: f64) -> f64 {
    let ahead_m = (body.front_m + body.rear_axle_m).max(body.rear_m - body.rear_axle_m);
    // The same as `hypot(R + w, l) − R`, without its cancellation where the road is nearly straight.
    let squares = 2.0 * inner_m * body.width_m + body.width_m * body.width_m + ahead_m * ahead_m;
    if inner_m.is_infinite() {
        body.width_m
    } else {
        squares / (libm::hypot(inner_m + body.width_m, ahead_m) + inner_m)
    }
}

/// Rounds to tenths of a metre.
fn to_tenths(length_m: f64) -> f64 {
    (10.0 * length_m).round() / 10.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::classes::VehicleClass;
    use interplay_planners::{Bicycle, Input, State};

    /// The corners and sides of a lorry at a constant steering angle stay within the strip and reach both of its edges.
    #[test]
    fn a_body_on_a_circle_sweeps_the_computed_strip() {
        let body = VehicleClass::Truck.dimensions().body;
        let step_s = 0.01;
        let input = Input { acceleration_mps2: 0.0, steering_rad: 0.4 };
        let mut state = State { speed_mps: 3.0, ..State::default() };
        // The centre of the circle: to the left of the middle of the rear axle.
        let rear_m = body.wheelbase_m() / libm::tan(input.steering_rad);
        let middle = [-body.rear_axle_m, rear_m];
        let inner_m = rear_m - 0.5 * body.width_m;
        let mut outermost_m = 0.0_f64;
        for _ in 0..2000 {
            state = Bicycle::new(&body, step_s).step(&state, &input);
            let (sin, cos) = libm::sincos(state.heading_rad);
            for corner in body.corners(&state) {
                outermost_m = outermost_m.max(libm::hypot(corner[0] - middle[0], corner[1] - middle[1]));
            }
            let rear = [state.x_m - body.rear_axle_m * cos, state.y_m - body.rear_axle_m * sin];
            let reached_m = libm::hypot(rear[0] - middle[0], rear[1] - middle[1]);
            assert!((reached_m - rear_m).abs() < 0.02, "the rear axle stays on its circle: {reached_m} of {rear_m}");
        }
        assert!((outermost_m - inner_m - swept_width_m(&body, inner_m)).abs() < 0.02, "{outermost_m} {inner_m}");
    }

    #[test]
    fn the_swept_width_on_a_straight_road_is_the_body_width() {
        let body = VehicleClass::Car.dimensions().body;
        assert_eq!(swept_width_m(&body, f64::INFINITY), 1.8);
        for inner_m in [1e6, 1e12, 1e16] {
            assert!((swept_width_m(&body, inner_m) - 1.8).abs() < 1e-4, "{inner_m}");
        }
    }
}
