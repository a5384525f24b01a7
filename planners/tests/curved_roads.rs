//! Curved roads: derivatives, the straight road as a special case, and every planner in closed loop.

mod common;

use std::sync::Arc;

use common::world::{Run, begin, egos, lane_change, moved_to, run};
use common::{HORIZON, SplitMix64, iterate, lane_change as change_of_lanes};
use interplay_planners::drivers::human::Style::{Nice, Tough};
use interplay_planners::drivers::idm;
use interplay_planners::road::centre_line::{Piece, smooth};
use interplay_planners::trajectory::terms::{Comfort, FrenetTarget, FrenetTracking, RoadEdge, StopLine};
use interplay_planners::trajectory::{Participant, Penalty, Problem, RouteStart, StageBounds, Term, check_derivatives};
use interplay_planners::{Body, CentreLine, Driver, Input, Profile, Route, State};

/// A road of two lanes of 0.37 m along a line.
fn road(line: CentreLine) -> Arc<Route> {
    Arc::new(Route::curved(line, Profile::constant(0.0), Profile::constant(0.74), Profile::constant(0.37)))
}

/// 4 m straight on, then a turn to the left (to the right for a negative curvature), then straight on.
fn bend(curvature_1pm: f64) -> CentreLine {
    let pieces = [
        Piece::Straight { length_m: 4.0 },
        Piece::Arc { length_m: 6.0, curvature_1pm },
        Piece::Straight { length_m: 20.0 },
    ];
    let pieces = smooth(&pieces, 1.0).expect("room for transitions");
    CentreLine::from_pieces([-3.0, 0.0], 0.0, &pieces).expect("a line")
}

/// A vehicle that tracks a place beside a curve and is beyond both edges of its road, from a random start beside the curve.
fn off_the_road(random: &mut SplitMix64) -> Problem {
    let line = bend(0.25);
    let along_m = random.uniform(2.5, 6.0);
    let [x_m, y_m] = line.position(along_m, random.uniform(-0.1, 0.3));
    let heading_rad = line.at(along_m).heading_rad + random.uniform(-0.1, 0.1);
    let start = State { x_m, y_m, heading_rad, speed_mps: random.uniform(0.5, 1.2) };
    // The right edge lies to the left of the body and the left edge to its right, and both move.
    let moving = |from_m: f64, to_m: f64| Profile::steps(&[[2.0, from_m], [11.0, to_m]]).expect("a profile");
    let route = Arc::new(Route::curved(line, moving(3.0, 3.6), moving(-3.0, -3.4), Profile::constant(0.37)));
    let free = change_of_lanes(random);
    let participant = Participant { start, route_start: RouteStart::new(&route, &start), ..free.participant };
    let terms = vec![
        Term::Comfort(Comfort { vehicle: 0, weights: [0.1, 0.1] }),
        Term::FrenetTracking(FrenetTracking {
            vehicle: 0,
            weights: [0.4, 1.0, 0.7, 2.0],
            target: FrenetTarget { along_m: 6.0, across_m: 0.2, speed_mps: 1.0 },
            permitted_mps: vec![0.8; HORIZON],
            slips_rad: vec![0.03; HORIZON],
        }),
        Term::RoadEdge(RoadEdge {
            vehicle: 0,
            body: Body::default(),
            route: Arc::clone(&route),
            penalty: Penalty { linear: 1.0, quadratic: 1.0 },
        }),
        Term::StopLine(StopLine {
            vehicle: 0,
            front_m: 0.2,
            route,
            lines_m: vec![along_m - 0.1; HORIZON],
            penalty: Penalty { linear: 1.0, quadratic: 1.0 },
        }),
    ];
    Problem { horizon: HORIZON, participants: vec![participant], shared_steps: 0, terms }
}

/// A largest change of the steering angle which some changes of an iterate exceed and none is near: there the slope of its cost bends
/// \[rad\].
fn most_turn_rad(problem: &Problem, inputs: &[Input]) -> f64 {
    let angles_rad = inputs.iter().map(|input| input.steering_rad);
    let before_rad = std::iter::once(problem.participants[0].previous_input.steering_rad).chain(angles_rad.clone());
    let mut changes_rad: Vec<f64> = angles_rad.zip(before_rad).map(|(now, before)| (now - before).abs()).collect();
    changes_rad.sort_by(f64::total_cmp);
    let lower_half = changes_rad[..changes_rad.len() / 2].windows(2);
    let widest = lower_half.max_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0]))).expect("changes");
    0.5 * (widest[0] + widest[1])
}

/// With wheels that turn at once, and with slow ones.
#[test]
fn derivatives_agree_with_finite_differences() {
    for seed in 0..20 {
        let random = &mut SplitMix64::new(seed);
        let mut problem = off_the_road(random);
        let iterate = iterate(&problem, random);
        let turn_rad = most_turn_rad(&problem, &iterate.inputs[0]);
        let slow =
            StageBounds { acceleration_mps2: [-1.0, 1.0], steering_rad: [-1.0, 1.0], speed_mps: [0.0, 1.5], turn_rad };
        for bounds in [Vec::new(), vec![slow; HORIZON]] {
            problem.participants[0].stage_bounds = bounds;
            let seen = check_derivatives(&problem, &iterate).unwrap_or_else(|error| panic!("{error}"));
            assert!(seen.first > 1.0 && seen.second > 1.0, "nothing costs anything here");
        }
    }
}

/// Cheap values of the edge rows are the exact ones wherever a corner is beyond its edge, and positive lower bounds elsewhere.
#[test]
fn approximate_edge_distances_never_hide_a_violation() {
    let (random, body) = (&mut SplitMix64::new(3), Body::default());
    let narrowing = |from_m: f64, to_m: f64| Profile::steps(&[[3.0, from_m], [9.0, to_m]]).expect("a profile");
    let route = Route::curved(bend(0.9), narrowing(-0.2, 0.05), narrowing(0.2, 0.3), Profile::constant(0.37));
    let (mut beyond, mut bounds) = (0, 0);
    for _ in 0..20_000 {
        let along_m = random.uniform(0.0, 14.0);
        let [x_m, y_m] = route.position(along_m, random.uniform(-0.4, 0.4));
        let heading_rad = route.centre.at(along_m).heading_rad + random.uniform(-1.0, 1.0);
        let state = State { x_m, y_m, heading_rad, speed_mps: 1.0 };
        let at = route.locate(state.position(), Some(along_m));
        let exact = route.clearances(&body, &state, &at);
        for (exact, cheap) in exact.iter().zip(route.clearance_bounds(&body, &state, &at)) {
            let is_same = (exact.value - cheap).abs() < 1e-9;
            assert!(is_same || (cheap > 0.0 && cheap < exact.value), "{} and {cheap} at {state:?}", exact.value);
            beyond += usize::from(exact.value < 0.0);
            bounds += usize::from(!is_same);
        }
    }
    assert!(beyond > 5_000 && bounds > 5_000, "{beyond} corners beyond an edge, {bounds} bounds");
}

/// The place of the ego in the order at the end of a run, from the front.
fn place(run: &Run, route: &Route) -> usize {
    let states = run.states.last().expect("states");
    let along: Vec<f64> = states.iter().map(|state| route.along(state.position())).collect();
    along.iter().filter(|other| **other > along[0]).count()
}

/// The largest distance by which a corner of a vehicle crosses an edge \[m\].
fn beyond_edges(run: &Run, route: &Route) -> f64 {
    let body = Body::default();
    let corners = run
        .states
        .iter()
        .flatten()
        .flat_map(|state| route.clearances(&body, state, &route.locate(state.position(), None)));
    corners.map(|corner| -corner.value).fold(0.0, f64::max)
}

/// A line of straight pieces is not treated as a straight road, but leads to the same plans.
#[test]
fn a_straight_line_of_pieces_gives_the_plans_of_a_straight_road() {
    let line = CentreLine::from_pieces([-3.0, 0.0], 0.0, &[Piece::Straight { length_m: 40.0 }]).expect("a line");
    let route = road(line);
    for driver in egos() {
        let kind = driver.kind();
        let plans = [lane_change(driver.clone(), [Nice, Nice]), moved_to(&route, lane_change(driver, [Nice, Nice]))]
            .map(|vehicles| {
                let (mut traffic, mut planners) = begin(&vehicles);
                let mut found = Vec::new();
                traffic.drive(|index, scene| {
                    let plan = planners[index].plan(scene)?;
                    found.push(plan.trajectory.clone());
                    Ok(plan)
                });
                found
            });
        for (straight, pieced) in plans[0].iter().zip(&plans[1]) {
            for (a, b) in straight.states.iter().zip(&pieced.states) {
                let apart = (a.x_m - b.x_m).hypot(a.y_m - b.y_m) + (a.heading_rad - b.heading_rad).abs();
                assert!(apart < 1e-5, "{kind}: {a:?} and {b:?}");
            }
        }
    }
}

#[test]
fn every_planner_changes_lanes_in_a_bend_and_stays_on_the_road() {
    for curvature_1pm in [0.2, -0.2] {
        let route = road(bend(curvature_1pm));
        for driver in egos().into_iter().chain([Driver::Idm(idm::Settings::default())]) {
            let kind = driver.kind();
            for styles in [[Nice, Nice], [Tough, Tough]] {
                let run = run(moved_to(&route, lane_change(driver.clone(), styles)), 60);
                assert!(run.collision.is_none(), "{kind} {styles:?}: {:?}", run.collision);
                assert!(run.failures.is_empty(), "{kind} {styles:?}: {:?}", run.failures);
                let beyond_m = beyond_edges(&run, &route);
                assert!(beyond_m < 5e-3, "{kind} {styles:?}: {beyond_m} m off the road");
                if kind != "idm" {
                    assert!(run.nearest > 0.99, "{kind} entered a safety ellipse: {}", run.nearest);
                    let behind = if styles == [Tough, Tough] { 2..=2 } else { 0..=2 };
                    assert!(behind.contains(&place(&run, &route)), "{kind} {styles:?}");
                }
            }
        }
    }
}
