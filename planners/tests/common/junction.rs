//! A crossing of two roads with oncoming traffic, for 1/10 scale cars.
#![allow(dead_code, reason = "each binary uses its own part")]

use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

use interplay_planners::road::CentreLine;
use interplay_planners::road::centre_line::Piece;
use interplay_planners::road::network::{Lane, RightOfWay, RoadNetwork};
use interplay_planners::{Agent, Driver, Goal, Route, State};

use super::world::{Vehicle, vehicle};

/// The arms, counter-clockwise from the west; a vehicle comes in on the right.
pub const ARMS: [&str; 4] = ["west", "south", "east", "north"];

const WIDTH_M: f64 = 0.37;
/// From the middle to the lines.
pub const HALF_M: f64 = 1.3;
const ARM_M: f64 = 6.0;

fn line(start: [f64; 2], heading_rad: f64, pieces: &[Piece]) -> CentreLine {
    CentreLine::from_pieces(start, heading_rad, pieces).expect("sound pieces")
}

/// The lanes `ARM-in`, `ARM-out` and `ARM-to-ARM`, with a sign at each `ARM-in`.
pub fn crossing(signs: [RightOfWay; 4]) -> RoadNetwork {
    let mut lanes = Vec::new();
    for (arm, name) in ARMS.iter().enumerate() {
        // The way in of arm 0 leads along x; arm `i` is turned by `i` right angles.
        let heading_rad = FRAC_PI_2 * arm as f64;
        let (sin, cos) = libm::sincos(heading_rad);
        let turned = |x: f64, y: f64| [cos * x - sin * y, sin * x + cos * y];
        let straight = |length_m: f64| vec![Piece::Straight { length_m }];
        let turn = |radius_m: f64, side: f64| {
            vec![Piece::Arc { length_m: FRAC_PI_2 * radius_m, curvature_1pm: side / radius_m }]
        };
        let half_m = 0.5 * WIDTH_M;
        let ways = [(1, turn(HALF_M - half_m, -1.0)), (2, straight(2.0 * HALF_M)), (3, turn(HALF_M + half_m, 1.0))];
        let mut into = Lane::new(
            &format!("{name}-in"),
            line(turned(-HALF_M - ARM_M, -half_m), heading_rad, &straight(ARM_M)),
            WIDTH_M,
        );
        into.right_of_way = signs[arm];
        for (quarters, pieces) in ways {
            let to = ARMS[(arm + quarters) % 4];
            let mut way =
                Lane::new(&format!("{name}-to-{to}"), line(turned(-HALF_M, -half_m), heading_rad, &pieces), WIDTH_M);
            way.successors = vec![format!("{to}-out")];
            into.successors.push(way.name.clone());
            lanes.push(way);
        }
        lanes.push(into);
        let out = line(turned(-HALF_M, half_m), heading_rad + PI, &straight(ARM_M));
        lanes.push(Lane::new(&format!("{name}-out"), out, WIDTH_M));
    }
    RoadNetwork::new(lanes).expect("a sound network")
}

/// The routes from one arm to another.
pub fn routes(network: &RoadNetwork, ways: &[[&str; 2]]) -> Vec<Arc<Route>> {
    let lanes = |[from, to]: &[&str; 2]| vec![format!("{from}-in"), format!("{from}-to-{to}"), format!("{to}-out")];
    network.routes(&ways.iter().map(lanes).collect::<Vec<_>>()).expect("routes")
}

/// A vehicle with its front `before_m` before the line of its way in.
pub fn on_route(name: &str, route: &Arc<Route>, before_m: f64, speed_mps: f64, driver: Driver) -> Vehicle {
    let Vehicle { agent, goal, driver } =
        vehicle(name, [0.0, 0.0, speed_mps], [0.0, speed_mps], [0.0, 4.0, 1.0, 1.0], driver);
    let along_m = ARM_M - before_m - agent.body.front_m;
    let [x_m, y_m] = route.position(along_m, 0.0);
    let state = State { x_m, y_m, heading_rad: route.centre.at(along_m).heading_rad, speed_mps };
    let prediction = interplay_planners::prediction::steadily_along(route, &agent.body, &state, 30, 0.1).into();
    let goal = Goal { target: state, ..goal };
    Vehicle { agent: Agent { state, route: Arc::clone(route), prediction, ..agent }, goal, driver }
}
