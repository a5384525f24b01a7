//! Roads on which the truth is known: a straight line of pieces is a straight road, and an arc is a circle.

mod common;

use std::sync::Arc;

use common::{HORIZON, SplitMix64, iterate, lane_change};
use interplay_planners::prediction::steadily_along;
use interplay_planners::road::centre_line::Piece;
use interplay_planners::trajectory::terms::{Comfort, FrenetTarget, FrenetTracking, RoadEdge, Tracking};
use interplay_planners::trajectory::{Participant, Penalty, Problem, RouteStart, StageQp, Term, exact_model};
use interplay_planners::{Axes, Body, CentreLine, Corridor, Profile, Route, State, Trajectory};

const WEIGHTS: [f64; 4] = [0.4, 1.0, 0.7, 2.0];
const PENALTY: Penalty = Penalty { linear: 1.0, quadratic: 1.0 };

/// The same problem on a straight road and on a line of one straight piece, in some direction. The road is so narrow that all
/// corners are beyond their edges.
fn twins(random: &mut SplitMix64) -> [Problem; 2] {
    let heading_rad = random.uniform(-3.0, 3.0);
    let (sin, cos) = libm::sincos(heading_rad);
    let [right_m, left_m] = [random.uniform(0.3, 0.5), random.uniform(-0.3, 0.0)];
    let [along_m, across_m, speed_mps] = [6.0, 0.2, 1.0];
    let in_world = |along_m: f64, across_m: f64| [cos * along_m - sin * across_m, sin * along_m + cos * across_m];
    let free = lane_change(random);
    let [x_m, y_m] = in_world(free.participant.start.x_m, free.participant.start.y_m);
    let start =
        State { x_m, y_m, heading_rad: heading_rad + free.participant.start.heading_rad, ..free.participant.start };
    // The line begins 3 m before the origin.
    let line = CentreLine::from_pieces(in_world(-3.0, 0.0), heading_rad, &[Piece::Straight { length_m: 40.0 }]);
    let edge = Profile::constant;
    let pieced = Arc::new(Route::curved(
        line.expect("a line"),
        edge(right_m),
        edge(left_m),
        edge(0.5 * (left_m - right_m).abs()),
    ));
    let straight = Arc::new(Route::from(Corridor { heading_rad, right_m, left_m, end: None }));
    let [x_m, y_m] = in_world(along_m, across_m);
    let target = State { x_m, y_m, heading_rad, speed_mps };
    let tracking =
        Tracking { vehicle: 0, weights: WEIGHTS, axes: Axes::along(heading_rad), targets: vec![target; HORIZON] };
    let frenet_tracking = FrenetTracking {
        vehicle: 0,
        weights: WEIGHTS,
        target: FrenetTarget { along_m: along_m + 3.0, across_m, speed_mps },
        permitted_mps: Vec::new(),
        slips_rad: Vec::new(),
    };
    [(Term::Tracking(tracking), straight), (Term::FrenetTracking(frenet_tracking), pieced)].map(|(tracking, route)| {
        let participant =
            Participant { start, route_start: RouteStart::new(&route, &start), ..free.participant.clone() };
        let edge = RoadEdge { vehicle: 0, body: Body::default(), route, penalty: PENALTY };
        let comfort = Comfort { vehicle: 0, weights: [0.1, 0.1] };
        let terms = vec![Term::Comfort(comfort), tracking, Term::RoadEdge(edge)];
        Problem { horizon: HORIZON, participants: vec![participant], shared_steps: 0, terms }
    })
}

/// Everything that a QP subproblem with the exact Hessian knows of tracking and edges: value, gradient and Hessian of each.
fn numbers(qp: &StageQp) -> Vec<f64> {
    let costs = qp.vehicles.iter().flat_map(|vehicle| &vehicle.state_costs).flat_map(|cost| {
        let convex = cost.gradient.into_iter().chain(cost.hessian).chain([cost.cross]).chain(cost.heading_cross);
        convex.chain(cost.curvature)
    });
    let rows = qp.blocks.iter().flat_map(|block| &block.rows);
    costs.chain(rows.flat_map(|row| [row.value].into_iter().chain(row.gradient).chain(row.curvature))).collect()
}

/// In Frenet coordinates, tracking and edges have the same value, gradient and Hessian as on a straight road.
#[test]
fn terms_on_a_straight_centre_line_equal_those_on_a_straight_road() {
    for seed in 0..50 {
        let random = &mut SplitMix64::new(seed);
        let problems = twins(random);
        let [straight, pieced] = problems.map(|problem| {
            let iterate = iterate(&problem, &mut random.clone());
            (problem.cost(&iterate).total, numbers(&exact_model(&problem, &iterate)))
        });
        assert!((straight.0 - pieced.0).abs() <= 1e-12 * straight.0, "{} and {}", straight.0, pieced.0);
        assert_eq!(straight.1.len(), pieced.1.len());
        assert!(straight.1.len() >= HORIZON * (14 + 4 * 10), "{} numbers", straight.1.len());
        for (place, (a, b)) in straight.1.iter().zip(&pieced.1).enumerate() {
            assert!((a - b).abs() <= 1e-12 * (1.0 + a.abs()), "number {place}: {a} on a straight road, {b} on pieces");
        }
    }
}

const RADIUS_M: f64 = 5.0;

/// A circle to the left (1) or to the right (−1) that begins at the origin along x.
fn circle(side: f64) -> Route {
    let arc = Piece::Arc { length_m: 6.0 * RADIUS_M, curvature_1pm: side / RADIUS_M };
    let line = CentreLine::from_pieces([0.0; 2], 0.0, &[arc]).expect("an arc");
    Route::curved(line, Profile::constant(-1.0), Profile::constant(1.0), Profile::constant(1.0))
}

/// The motion from a place beside the circle, with an angle of the motion to the road \[rad\].
fn from_place(side: f64, across_m: f64, angle_rad: f64, horizon: usize, step_s: f64) -> Trajectory {
    let (route, body, along_m) = (circle(side), Body::default(), 2.0);
    let [x_m, y_m] = route.position(along_m, across_m);
    // On its own circle, a vehicle heads outward of its motion by the slip angle `β` with `sin β = L_r/ρ`.
    let slip_rad = libm::asin(side * body.rear_axle_m / (RADIUS_M - side * across_m));
    let heading_rad = side * along_m / RADIUS_M + angle_rad - slip_rad;
    let state = State { x_m, y_m, heading_rad, speed_mps: 1.2 };
    steadily_along(&route, &body, &state, horizon, step_s)
}

/// Beside the middle of a circle of radius `R`, a vehicle at the speed `v` drives on a circle of radius `R − n` around the same point,
/// by the angle `v t/(R − n)`.
#[test]
fn a_prediction_along_an_arc_is_a_circle() {
    for (side, across_m) in [(1.0, 0.0), (1.0, 0.6), (1.0, -0.6), (-1.0, 0.6), (-1.0, -0.6)] {
        let predicted = from_place(side, across_m, 0.0, 30, 0.1);
        let own_m = RADIUS_M - side * across_m;
        for (t, state) in predicted.states.iter().enumerate() {
            let turned_rad = side * (2.0 / RADIUS_M + 1.2 * 0.1 * t as f64 / own_m);
            let (sin, cos) = libm::sincos(turned_rad);
            let [x_m, y_m] = [side * own_m * sin, side * (RADIUS_M - own_m * cos)];
            let apart_m = libm::hypot(state.x_m - x_m, state.y_m - y_m);
            // A centre line is a polynomial that misses a circle by some nanometres.
            assert!(apart_m < 1e-7, "side {side}, {across_m} m beside, step {t}: {apart_m} m");
            let slip_rad = libm::asin(side * Body::default().rear_axle_m / own_m);
            assert!((state.heading_rad - (turned_rad - slip_rad)).abs() < 1e-7, "{state:?}");
            assert_eq!(state.speed_mps, 1.2);
        }
    }
}

/// With a constant angle `φ` to the circles around a point, the motion is a logarithmic spiral: `ρ = ρ₀ − v t sin φ`, and the angle
/// around the point is `cot φ ln(ρ₀/ρ)`. Euler's method comes to it by the first power of the step.
#[test]
fn a_prediction_at_an_angle_to_an_arc_is_a_spiral() {
    let angle_rad = 0.2;
    let (rate_mps, duration_s) = (1.2 * libm::sin(angle_rad), 3.0);
    let left_m = RADIUS_M - rate_mps * duration_s;
    let turned_rad = 2.0 / RADIUS_M + libm::log(RADIUS_M / left_m) / libm::tan(angle_rad);
    let (sin, cos) = libm::sincos(turned_rad);
    let error_m = |horizon: usize| {
        let predicted = from_place(1.0, 0.0, angle_rad, horizon, duration_s / horizon as f64);
        let last = predicted.states.last().expect("states");
        libm::hypot(last.x_m - left_m * sin, last.y_m - (RADIUS_M - left_m * cos))
    };
    let [coarse_m, fine_m] = [30, 3000].map(error_m);
    assert!(coarse_m < 0.02 && fine_m < 2e-4, "{coarse_m} m and {fine_m} m");
    assert!((coarse_m / fine_m - 100.0).abs() < 5.0, "{coarse_m} m and {fine_m} m");
}
