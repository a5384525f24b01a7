//! Random games of 2 to 4 vehicles: on two lanes in one direction, or where two roads cross.
#![allow(dead_code, reason = "each binary uses its own part")]

use std::f64::consts::FRAC_PI_2;

use interplay_planners::drivers::conservative;
use interplay_planners::problem::{self, JointVehicle};
use interplay_planners::scene::Knowledge;
use interplay_planners::trajectory::Problem;
use interplay_planners::{Corridor, Driver, Route, Scene, State};

use super::SplitMix64;
use super::world::{HORIZON, LANES, STEP_S, Vehicle, vehicle};

const NAMES: [&str; 4] = ["a", "b", "c", "d"];

/// Least distance between the centres of two vehicles in one lane at the start \[m\]: their safety ellipses need 0.75 m.
const LEAST_SPACING_M: f64 = 0.8;

/// A game with random starts, wanted lanes, wanted speeds and weights, in which no vehicle begins in another's ellipse.
pub fn game(random: &mut SplitMix64, players: usize) -> (Scene, Vec<JointVehicle>) {
    let crosses = random.uniform(0.0, 1.0) < 0.5;
    let mut vehicles: Vec<Vehicle> = Vec::new();
    while vehicles.len() < players {
        let index = vehicles.len();
        let vehicle = if crosses { crossing(random, index) } else { beside(random, index) };
        if vehicles.iter().all(|other| are_apart(&vehicle, other)) {
            vehicles.push(vehicle);
        }
    }
    let players: Vec<JointVehicle> =
        vehicles.iter().map(|v| JointVehicle { agent: v.agent.clone(), goal: v.goal }).collect();
    let scene = Scene {
        tick: 0,
        step_s: STEP_S,
        horizon: HORIZON,
        knowledge: Knowledge::Plans,
        ego: players[0].agent.clone(),
        goal: players[0].goal,
        others: players[1..].iter().map(|player| player.agent.clone()).collect(),
    };
    (scene, players)
}

/// The joint problem of a random game.
pub fn joint_problem(random: &mut SplitMix64, players: usize) -> Problem {
    let (scene, players) = game(random, players);
    problem::joint_problem(&scene, &players)
}

fn driver() -> Driver {
    Driver::Conservative(conservative::Settings::default())
}

fn weights(random: &mut SplitMix64) -> [f64; 4] {
    [0.0, random.uniform(0.5, 4.0), random.uniform(0.5, 1.0), random.uniform(0.5, 2.0)]
}

/// A vehicle somewhere on two lanes, which wants into either.
fn beside(random: &mut SplitMix64, index: usize) -> Vehicle {
    let [lane, wanted] = [0, 1].map(|_| LANES[usize::from(random.uniform(0.0, 1.0) < 0.5)]);
    let start = [random.uniform(-2.0, 2.0), lane, random.uniform(0.6, 1.3)];
    vehicle(NAMES[index], start, [wanted, random.uniform(0.6, 1.4)], weights(random), driver())
}

/// A vehicle before a crossing of two roads: of even number on the first, of odd number on the second, which comes from the right.
fn crossing(random: &mut SplitMix64, index: usize) -> Vehicle {
    let (from_m, speed_mps) = (random.uniform(-3.2, -0.9), random.uniform(0.5, 1.1));
    let mut vehicle =
        vehicle(NAMES[index], [from_m, 0.0, speed_mps], [0.0, random.uniform(0.6, 1.4)], weights(random), driver());
    let heading_rad = if index.is_multiple_of(2) { 0.0 } else { FRAC_PI_2 };
    let (sin, cos) = heading_rad.sin_cos();
    vehicle.agent.route = Route::from(Corridor { heading_rad, right_m: -0.185, left_m: 0.185, end: None }).into();
    vehicle.agent.state = State { x_m: from_m * cos, y_m: from_m * sin, heading_rad, speed_mps };
    vehicle.agent.prediction =
        interplay_planners::prediction::constant_velocity(&vehicle.agent.state, HORIZON, STEP_S).into();
    vehicle.goal.target.heading_rad = heading_rad;
    vehicle.goal.safety.across_m = 0.5;
    vehicle
}

/// Whether two vehicles begin outside each other's ellipses, and in one lane not so that they must collide.
fn are_apart(a: &Vehicle, b: &Vehicle) -> bool {
    let (from, to) = (&a.agent.state, &b.agent.state);
    let apart_m = (from.x_m - to.x_m).hypot(from.y_m - to.y_m);
    if a.agent.route != b.agent.route {
        return apart_m > 1.2;
    }
    let ahead_m = a.agent.route.along(from.position()) - b.agent.route.along(to.position());
    let (rear, front) = if ahead_m > 0.0 { (to, from) } else { (from, to) };
    // Beside its braking distance relative to the front vehicle.
    let closing_mps = (rear.speed_mps - front.speed_mps).max(0.0);
    let is_beside = (a.agent.route.across(from.position()) - b.agent.route.across(to.position())).abs() > 0.3;
    is_beside || ahead_m.abs() > LEAST_SPACING_M + closing_mps * closing_mps
}
