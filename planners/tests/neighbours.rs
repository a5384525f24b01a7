//! Who is left out of a scene changes no plan.

mod common;

use common::world::{LANES, human, vehicle};
use interplay_common::random::Random;
use interplay_planners::Driver;
use interplay_planners::drivers::human::Style;
use interplay_planners::traffic::{Neighbours, RoadUser, Traffic};

const STEP_S: f64 = 0.1;
const HORIZON: usize = 20;
const STREETS: usize = 1000;
const VEHICLES: usize = 60;
const STREET_M: f64 = 80.0;

/// A dense street with two lanes: cars somewhere on it, some of them standing.
fn street(random: &mut Random, driver: &Driver) -> Traffic {
    let users = (0..VEHICLES).map(|index| {
        let x_m = STREET_M * index as f64 / VEHICLES as f64 + random.uniform(-0.4, 0.4);
        let lane = usize::from(random.chance(0.5));
        let speed_mps = if random.chance(0.1) { 0.0 } else { random.uniform(0.6, 1.6) };
        let driver = if index == 0 { driver.clone() } else { human(Style::Nice) };
        let tracking = [0.0, 1.0, 0.5, 1.0];
        let wants = [LANES[usize::from(random.chance(0.5))], random.uniform(0.8, 1.5)];
        let made = vehicle(&format!("car-{index}"), [x_m, LANES[lane], speed_mps], wants, tracking, driver);
        RoadUser::new(made.agent, made.goal, true)
    });
    let mut traffic = Traffic { step_s: STEP_S, horizon: HORIZON, road_users: users.collect(), ..Traffic::default() };
    traffic.predict();
    traffic
}

#[test]
fn vehicles_left_out_of_a_scene_change_no_plan() {
    let mut random = Random::new(11, 0);
    let kinds = ["human", "idm", "conservative", "negotiation", "bayesian", "contingency"];
    let mut left_out = 0;
    for number in 0..STREETS {
        let driver = Driver::at_wheel(kinds[number % kinds.len()]).expect("a kind of driver");
        let near = street(&mut random, &driver);
        let all = Traffic { near: Neighbours::default(), ..near.clone() };
        let vehicle = (random.uniform(0.0, VEHICLES as f64) as usize).min(VEHICLES - 1);
        let plan = |traffic: &Traffic| {
            let mut planner = driver.planner();
            planner.plan(&traffic.scene(vehicle)).map(|plan| plan.trajectory)
        };
        left_out += all.scene(vehicle).others.len() - near.scene(vehicle).others.len();
        assert_eq!(plan(&near), plan(&all), "street {number}, {driver:?}");
    }
    assert!(left_out > 10 * STREETS, "vehicles are left out: {left_out}");
}
