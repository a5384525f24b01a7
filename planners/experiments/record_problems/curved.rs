//! Vehicles on curved roads.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::sync::Arc;

use interplay_planners::drivers::human::Style;
use interplay_planners::road::centre_line::{Piece, smooth};
use interplay_planners::road::network::RightOfWay;
use interplay_planners::trajectory::{Problem, Term};
use interplay_planners::{Agent, CentreLine, Driver, Profile, Route, State, prediction};

use crate::junction::{crossing, on_route, routes};
use crate::world::{HORIZON, STEP_S, Vehicle, human, lane_change, moved_to, ramp_merge};

#[derive(Clone, Copy)]
pub enum CurvedRoad {
    /// A lane change in a bend of two lanes.
    Bend,
    /// The same from a lane that ends in the bend.
    LaneDrop,
    /// The ego and a vehicle behind it turn left across an oncoming one.
    LeftTurn,
    /// The ego and a vehicle behind it turn right into a road before another one.
    Merge,
    /// The ego enters a roundabout before two vehicles.
    Roundabout,
}

/// A road whose curvature stays below this is straight \[1/m\].
const LEAST_CURVATURE_1PM: f64 = 1e-3;

/// Whether the first vehicle of a problem is on a road that turns.
pub fn is_on_curve(problem: &Problem) -> bool {
    let turns = |route: &Route| {
        let curvatures_1pm = route.centre.knots_m().into_iter().map(|along_m| route.centre.at(along_m).curvature_1pm);
        curvatures_1pm.into_iter().any(|curvature_1pm| curvature_1pm.abs() > LEAST_CURVATURE_1PM)
    };
    problem.terms.iter().any(|term| matches!(term, Term::RoadEdge(edge) if edge.vehicle == 0 && turns(&edge.route)))
}

/// Who has priority at the junction: the road from west to east.
const SIGNS: [RightOfWay; 4] = [RightOfWay::Priority, RightOfWay::Yield, RightOfWay::Priority, RightOfWay::Yield];

/// The ego is the first.
pub fn vehicles(road: CurvedRoad, ego: &Driver, styles: [Style; 2]) -> Vec<Vehicle> {
    match road {
        CurvedRoad::Bend => moved_to(&bend(Profile::constant(0.0)), lane_change(ego.clone(), styles)),
        CurvedRoad::LaneDrop => lane_drop(ego, styles),
        CurvedRoad::LeftTurn => at_junction(["west", "north"], ["east", "west"], ego, styles),
        CurvedRoad::Merge => at_junction(["south", "east"], ["west", "east"], ego, styles),
        CurvedRoad::Roundabout => roundabout(ego, styles),
    }
}

/// 4 m straight on, a bend to the left with a radius of 4 m, and a bend to the right.
fn bend(right: Profile) -> Arc<Route> {
    let pieces = [
        Piece::Straight { length_m: 4.0 },
        Piece::Arc { length_m: 5.0, curvature_1pm: 0.25 },
        Piece::Arc { length_m: 5.0, curvature_1pm: -0.25 },
        Piece::Straight { length_m: 20.0 },
    ];
    let line = line([-3.0, 0.0], 0.0, &pieces, 1.0);
    Arc::new(Route::curved(line, right, Profile::constant(0.74), Profile::constant(0.37)))
}

fn line(start: [f64; 2], heading_rad: f64, pieces: &[Piece], transition_m: f64) -> CentreLine {
    let pieces = smooth(pieces, transition_m).expect("room for transitions");
    CentreLine::from_pieces(start, heading_rad, &pieces).expect("sound pieces")
}

fn lane_drop(ego: &Driver, styles: [Style; 2]) -> Vec<Vehicle> {
    let mut vehicles = moved_to(&bend(Profile::constant(0.0)), ramp_merge(ego.clone(), styles));
    let ending = Profile::steps(&[[5.0, 0.0], [6.5, 0.37]]).expect("sound knots");
    vehicles[0].agent.route = bend(ending);
    vehicles
}

/// The ego on one way of the junction, a human on another one, and a human that follows the ego.
fn at_junction(own: [&str; 2], others: [&str; 2], ego: &Driver, [first, second]: [Style; 2]) -> Vec<Vehicle> {
    let found = routes(&crossing(SIGNS), &[own, others]);
    vec![
        on_route("ego", &found[0], 0.9, 0.9, ego.clone()),
        on_route("first", &found[1], 0.9, 0.9, human(first)),
        on_route("second", &found[0], 1.9, 0.9, human(second)),
    ]
}

/// Radius of the roundabout's centre line, of the curves that lead into it and out of it, and the lateral coordinate of the
/// straight road before \[m\].
const RING_M: f64 = 1.5;
const ENTRY_M: f64 = 1.0;
const ROAD_M: f64 = 0.2;

/// A roundabout that is entered from the south and left to the north: the ego on the way in, two humans on the ring.
fn roundabout(ego: &Driver, [first, second]: [Style; 2]) -> Vec<Vehicle> {
    // The way in is a circle that touches the straight road and the ring.
    let apart_m = RING_M + ENTRY_M;
    let below_m = (apart_m * apart_m - (ROAD_M + ENTRY_M) * (ROAD_M + ENTRY_M)).sqrt();
    let turn_rad = libm::atan2(below_m, ROAD_M + ENTRY_M);
    let before_m = 4.0;
    let curve = Piece::Arc { length_m: ENTRY_M * turn_rad, curvature_1pm: -1.0 / ENTRY_M };
    let ring = |angle_rad: f64| Piece::Arc { length_m: RING_M * angle_rad, curvature_1pm: 1.0 / RING_M };
    let straight = |length_m: f64| Piece::Straight { length_m };
    // The ring is left where it was entered, mirrored.
    let inside_rad = 2.0 * turn_rad;
    let way = [straight(before_m), curve, ring(inside_rad), curve, straight(9.0)];
    let own = lane(line([ROAD_M, -below_m - before_m], FRAC_PI_2, &way, 0.4));
    let upstream_rad = 0.3 * TAU;
    let entry_rad = upstream_rad + turn_rad;
    let (sin, cos) = libm::sincos(-entry_rad);
    let around = [ring(upstream_rad + inside_rad), curve, straight(9.0)];
    let on_ring = lane(line([RING_M * cos, RING_M * sin], FRAC_PI_2 - entry_rad, &around, 0.4));
    vec![
        placed("ego", &own, 2.6, ego.clone()),
        placed("first", &on_ring, 1.0, human(first)),
        placed("second", &on_ring, 0.1, human(second)),
    ]
}

/// A lane of 0.37 m along a line.
fn lane(line: CentreLine) -> Arc<Route> {
    Arc::new(Route::curved(line, Profile::constant(-0.185), Profile::constant(0.185), Profile::constant(0.185)))
}

/// A vehicle at an arc length of its lane, at 0.8 m/s.
fn placed(name: &str, route: &Arc<Route>, along_m: f64, driver: Driver) -> Vehicle {
    let Vehicle { agent, goal, driver } = on_route(name, route, 0.0, 0.8, driver);
    let [x_m, y_m] = route.position(along_m, 0.0);
    let state = State { x_m, y_m, heading_rad: route.centre.at(along_m).heading_rad, ..agent.state };
    let prediction = prediction::steadily_along(route, &agent.body, &state, HORIZON, STEP_S).into();
    Vehicle { agent: Agent { state, prediction, ..agent }, goal, driver }
}
