//! Laws of vehicles that react.

use super::{RoadUser, Traffic};
use crate::drivers::idm;
use crate::fixture::{real_car, scene};
use crate::scene::lane_order::{LaneOrder, OnRoad, Strip};
use crate::{Agent, ComfortLimits, DriverKind, Planner};
use proptest::prelude::*;

const STEP_S: f64 = 0.1;

/// A car of people with the intelligent driver model that wants to drive at a speed.
fn car(number: usize, x_m: f64, speed_mps: f64, wanted_mps: f64) -> RoadUser {
    let mut agent = Agent { name: number.to_string(), ..real_car(x_m, speed_mps) };
    agent.limits.comfort = Some(ComfortLimits::default());
    let mut goal = scene(agent.clone(), Vec::new()).goal;
    goal.target.speed_mps = wanted_mps;
    RoadUser { knows_plans: false, tells_plan: false, may_react: true, ..RoadUser::new(agent, goal, true) }
}

/// The values of the literature, on a road of one lane.
fn literature() -> idm::Settings {
    let mobil = idm::Mobil { lane_width_m: Some(10.5), safe_braking_mps2: 2.0, ..idm::Mobil::default() };
    idm::Settings { mobil, ..idm::Settings::literature() }
}

/// Cars in one lane that drive for some ticks. `look` is given the traffic after each decision.
fn drive(users: Vec<RoadUser>, horizon: usize, ticks: usize, mut look: impl FnMut(&Traffic)) -> Traffic {
    let mut planners: Vec<Planner> = users.iter().map(|_| Planner::new(&literature(), &Default::default())).collect();
    let mut traffic = Traffic { step_s: STEP_S, horizon, road_users: users, ..Traffic::default() };
    for tick in 0..ticks {
        traffic.begin_plan(tick, STEP_S * tick as f64);
        traffic.predict();
        traffic.react(|traffic, rows, answers| {
            answers.extend(rows.iter().map(|row| traffic.at_moment(*row, |moment| planners[*row].react(moment).ok())));
        });
        let decisions = traffic.plan(|_, _| panic!("all react"));
        assert!(decisions.is_empty(), "a reacting vehicle decides nothing else");
        let inputs = traffic.applied_inputs();
        look(&traffic);
        traffic.advance(&inputs);
    }
    traffic
}

/// The formula by itself, written out once more: Treiber, Hennecke and Helbing (2000).
fn formula(speed_mps: f64, wanted_mps: f64, gap_m: f64, closing_mps: f64) -> f64 {
    let wanted_gap_m = 2.0 + (1.5 * speed_mps + speed_mps * closing_mps / (2.0 * (1.4_f64 * 2.0).sqrt())).max(0.0);
    1.4 * (1.0 - libm::pow(speed_mps / wanted_mps, 4.0) - libm::pow(wanted_gap_m / gap_m, 2.0))
}

/// The strongest braking of the formula from 33.3 m/s towards a car that stands at a gap \[m/s²\].
fn strongest_of_formula(mut gap_m: f64) -> f64 {
    let (mut speed_mps, mut strongest_mps2) = (33.3, 0.0_f64);
    while speed_mps > 0.5 {
        let acceleration_mps2 = formula(speed_mps, 33.3, gap_m, speed_mps);
        strongest_mps2 = strongest_mps2.min(acceleration_mps2);
        gap_m -= 1e-3 * speed_mps;
        speed_mps += 1e-3 * acceleration_mps2;
    }
    strongest_mps2
}

/// From 33.3 m/s towards a car that stands 1,500 m ahead: as the formula says to 0.05 m/s², whatever the horizon.
#[test]
fn a_standing_car_is_approached_as_the_formula_says_whatever_the_horizon() {
    let (mut strongest, least_mps2) = (Vec::new(), strongest_of_formula(1495.0));
    assert!((least_mps2 + 2.2).abs() < 0.1, "{least_mps2}");
    for horizon in [1, 2, 10, 40] {
        let users = vec![car(0, 0.0, 33.3, 33.3), car(1, 1500.0, 0.0, 1e-6)];
        let (mut strongest_mps2, mut compared) = (0.0_f64, 0);
        let traffic = drive(users, horizon, 1200, |traffic| {
            let [own, ahead] = [0, 1].map(|row| &traffic.road_users[row].agent);
            let gap_m = ahead.state.x_m - own.state.x_m - own.body.front_m - ahead.body.rear_m;
            let applied_mps2 = traffic.road_users[0].planned_input().acceleration_mps2;
            strongest_mps2 = strongest_mps2.min(applied_mps2);
            // Below 3 m/s brakes are released in comfort.
            if own.state.speed_mps > 3.0 && traffic.tick > 2 {
                let wanted = formula(own.state.speed_mps, 33.3, gap_m, own.state.speed_mps - ahead.state.speed_mps);
                assert!((applied_mps2 - wanted).abs() < 0.05, "{applied_mps2} is not {wanted} at {gap_m} m");
                compared += 1;
            }
        });
        assert!((strongest_mps2 - least_mps2).abs() < 0.05, "{strongest_mps2} {least_mps2}");
        assert!(compared > 300 && traffic.road_users[0].agent.state.speed_mps < 0.5, "{compared}");
        strongest.push((strongest_mps2.to_bits(), traffic.road_users[0].agent.state));
    }
    assert!(strongest.windows(2).all(|pair| pair[0] == pair[1]), "the same bits: {strongest:?}");
}

/// Behind a leader at 20 m/s the gap is `s*/√(1 − (v/v₀)⁴)` to 1 cm.
#[test]
fn followers_keep_the_gap_of_the_closed_form() {
    for horizon in [2, 40] {
        let users = vec![car(0, 0.0, 20.0, 30.0), car(1, 60.0, 20.0, 20.0)];
        let traffic = drive(users, horizon, 6000, |_| {});
        let [own, ahead] = [0, 1].map(|row| &traffic.road_users[row].agent);
        let gap_m = ahead.state.x_m - own.state.x_m - own.body.front_m - ahead.body.rear_m;
        let closed_form_m = (2.0 + 1.5 * 20.0) / (1.0 - libm::pow(20.0 / 30.0, 4.0)).sqrt();
        assert!((gap_m - closed_form_m).abs() < 0.01, "{gap_m} {closed_form_m}");
    }
}

/// A car 18 m ahead at the same speed that brakes with 6 m/s² at once is not touched.
#[test]
fn in_an_emergency_a_reacting_driver_brakes_as_it_needs() {
    let mut users = vec![car(0, 0.0, 25.0, 25.0), car(1, 22.0, 25.0, 25.0)];
    users[1].may_react = false;
    let mut planner = Planner::new(&literature(), &Default::default());
    let mut traffic = Traffic { step_s: STEP_S, horizon: 2, road_users: users, ..Traffic::default() };
    for tick in 0..80 {
        traffic.begin_plan(tick, STEP_S * tick as f64);
        traffic.predict();
        traffic.react(|traffic, _, answers| answers.push(traffic.at_moment(0, |moment| planner.react(moment).ok())));
        let mut inputs = traffic.applied_inputs();
        let speed_mps = traffic.road_users[1].agent.state.speed_mps;
        inputs[1].acceleration_mps2 = (-6.0_f64).max(-speed_mps / STEP_S);
        traffic.advance(&inputs);
        let [own, ahead] = [0, 1].map(|row| &traffic.road_users[row].agent);
        assert!(own.state.x_m + own.body.front_m < ahead.state.x_m - ahead.body.rear_m, "a contact in tick {tick}");
    }
}

/// Three lanes of people with one driver that does not react: it plans, and the others still answer alone.
#[test]
fn a_driver_without_an_answer_plans_like_the_others() {
    let mut traffic = Traffic {
        step_s: STEP_S,
        horizon: 5,
        road_users: vec![car(0, 0.0, 20.0, 20.0), car(1, 50.0, 20.0, 20.0)],
        ..Traffic::default()
    };
    traffic.begin_plan(0, 0.0);
    traffic.predict();
    traffic.react(|_, rows, answers| answers.resize(rows.len(), None));
    let mut asked = Vec::new();
    let decisions = traffic.plan(|row, scene| {
        asked.push((row, scene.others.len(), scene.knowledge.is_of_motion()));
        idm::Settings::literature().driver().plan(scene, &Default::default())
    });
    assert_eq!((decisions.len(), asked), (2, vec![(1, 1, true), (0, 1, true)]));
}

proptest! {
    /// The vehicles ahead and behind in a strip are those that a comparison with all finds.
    #[test]
    fn the_lane_order_finds_what_a_comparison_with_all_finds(
        places in prop::collection::vec((-200.0..200.0_f64, -9.0..9.0_f64), 2..40), centre_m in -6.0..6.0_f64,
    ) {
        let users: Vec<RoadUser> = places.iter().enumerate().map(|(row, (x_m, y_m))| {
            let mut user = car(row, *x_m, 20.0, 20.0);
            user.agent.state.y_m = *y_m;
            user
        }).collect();
        let mut order = LaneOrder::default();
        for _ in 0..2 {
            order.sort(users.iter().map(|user| Some(&user.agent)));
        }
        let strip = Strip { centre_m, width_m: 3.5 };
        for (row, own) in users.iter().enumerate() {
            let own = &own.agent;
            let is_in = |other: &&Agent| (other.state.y_m - centre_m).abs() < 0.5 * (3.5 + other.body.width_m);
            let others = || users.iter().enumerate().filter(|(other, _)| *other != row).map(|(_, user)| &user.agent);
            let lead_m = |other: &Agent| other.state.x_m - own.state.x_m;
            let ahead = others().filter(is_in).map(lead_m).filter(|lead_m| *lead_m > 0.0).reduce(f64::min);
            let behind = others().filter(is_in).map(lead_m).filter(|lead_m| *lead_m <= 0.0).reduce(f64::max);
            let found = order.of(row).expect("on a straight road");
            let found_m = |other: &OnRoad| other.along_m - found.own.along_m;
            prop_assert_eq!(found.ahead(strip).map(|(other, _)| found_m(other)), ahead);
            prop_assert_eq!(found.behind(strip, |_| true).map(found_m), behind);
        }
    }
}
