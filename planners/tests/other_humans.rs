//! Other humans than the optimising one: the intelligent driver model and scripts, with every planner among them.

mod common;

use std::collections::BTreeSet;

use common::world::{LANES, egos, intersection, lane_change, run, vehicle};
use interplay_planners::Driver;
use interplay_planners::drivers::human::Style::Nice;
use interplay_planners::drivers::scripted::Order;
use interplay_planners::drivers::{human, idm, negotiation, scripted};

fn idm() -> Driver {
    Driver::Idm(idm::Settings::default())
}

#[test]
fn every_planner_merges_among_idm_drivers() {
    for planner in egos() {
        let name = planner.kind();
        let mut vehicles = lane_change(planner, [Nice, Nice]);
        vehicles[1].drive(idm());
        vehicles[2].drive(idm());
        let run = run(vehicles, 100);
        assert!(run.collision.is_none(), "{name}: {:?}", run.collision);
        assert!(run.failures.is_empty(), "{name}: {:?}", run.failures);
        assert!(run.merged().is_some(), "{name} never merged");
    }
}

/// Three drivers after the model: one changes lanes, none brakes harder than it may, none collides.
#[test]
fn idm_drivers_change_lanes_among_themselves() {
    let mut vehicles = lane_change(idm(), [Nice, Nice]);
    vehicles[1].drive(idm());
    vehicles[2].drive(idm());
    let run = run(vehicles, 250);
    assert!(run.collision.is_none() && run.failures.is_empty());
    assert!(run.merged().is_some(), "{:?}", run.states.last());
    let lanes_kept = run.states.iter().all(|states| states.iter().all(|state| (0.09..=0.65).contains(&state.y_m)));
    assert!(lanes_kept, "a vehicle left its lane's middle to the outside");
}

/// A script that brakes hard ahead of a follower: planners stay behind it.
#[test]
fn all_planners_stay_behind_a_scripted_vehicle_that_brakes() {
    let brakes = Order { from_s: 1.0, speed_mps: Some(0.2), ..Order::default() };
    let goes_on = Order { from_s: 4.0, speed_mps: Some(1.0), acceleration_mps2: Some(0.5), ..Order::default() };
    for planner in egos().into_iter().chain([idm()]) {
        let name = planner.kind();
        let script = Driver::Scripted(scripted::Settings { script: vec![goes_on.clone(), brakes.clone()] });
        let steady = [0.0, 4.0, 1.0, 1.0];
        let vehicles = vec![
            vehicle("ego", [0.0, LANES[1], 1.0], [LANES[1], 1.2], steady, planner),
            vehicle("ahead", [1.5, LANES[1], 1.0], [LANES[1], 1.0], steady, script),
        ];
        let run = run(vehicles, 80);
        assert!(run.collision.is_none(), "{name}: {:?}", run.collision);
        assert!(run.failures.is_empty(), "{name}: {:?}", run.failures);
        let slowest = run.states.iter().map(|states| states[1].speed_mps).fold(f64::INFINITY, f64::min);
        assert!((slowest - 0.2).abs() < 1e-9, "the script was not followed");
    }
}

/// A driver after the model sees no vehicle outside its lane: a negotiator asks the human behind it instead.
#[test]
fn a_negotiator_sends_requests_only_to_drivers_that_see_it() {
    let negotiator = Driver::Negotiation(negotiation::Settings::default());
    let asked = |drivers: [Option<Driver>; 2]| {
        let mut vehicles = lane_change(negotiator.clone(), [Nice, Nice]);
        for (vehicle, driver) in vehicles[1..].iter_mut().zip(drivers) {
            driver.into_iter().for_each(|driver| vehicle.drive(driver));
        }
        let plans = run(vehicles, 10).plans;
        let asked: BTreeSet<String> =
            plans.into_iter().flat_map(|plan| plan.proposals).map(|proposal| proposal.to).collect();
        asked.into_iter().collect::<Vec<_>>()
    };
    assert_eq!(asked([None, None]), ["front"]);
    assert_eq!(asked([Some(idm()), None]), ["rear"]);
    assert!(asked([Some(idm()), Some(idm())]).is_empty());
}

/// A crossing driver who hesitates changes its plan by leaps, so that the ego has little room: it may have to brake hard,
/// but it does not leave the road.
#[test]
fn the_ego_stays_on_the_road_before_a_hesitating_driver() {
    for hesitation_s in [0.5, 0.8, 1.0, 1.5] {
        let mut vehicles = intersection(Driver::Negotiation(negotiation::Settings::default()), Nice, 1.965);
        let settings =
            human::Settings { style: Some(Nice), reaction_s: 1.0, hesitation_s, ..human::Settings::default() };
        vehicles[1].drive(Driver::Human(settings));
        let (route, body) = (vehicles[0].agent.route.clone(), vehicles[0].agent.body);
        let run = run(vehicles, 60);
        let beyond = run.states.iter().filter(|states| !route.contains(&body, &states[0], 2e-3)).count();
        assert_eq!(beyond, 0, "off the road at {beyond} ticks, hesitation {hesitation_s} s");
    }
}
