//! What a planner without known plans infers: what it keeps, what it names, and what happens where no hypothesis fits.

mod common;

use common::world::{self, Run, Vehicle};
use interplay_planners::Driver;
use interplay_planners::drivers::human::Style;
use interplay_planners::drivers::{bayesian, conservative, game, negotiation, scripted};
use interplay_planners::perception::belief::{self, DriverBeliefs, Prior};
use interplay_planners::perception::sensing::{self, SensedScene, Sensor};
use interplay_planners::prediction::Prediction;
use interplay_planners::scene::driver_estimate::DriverModel;

const TICKS: usize = 70;
/// A second, within which a style is to be named.
const NAMED_WITHIN_TICKS: usize = 10;

fn negotiation(prediction: Prediction) -> Driver {
    Driver::Negotiation(negotiation::Settings { prediction, ..negotiation::Settings::default() })
}

/// Starts near that of a family: the ego's place and speed are changed a little.
fn starts(vehicles: impl Fn() -> Vec<Vehicle>, count: i32) -> impl Iterator<Item = Vec<Vehicle>> {
    (0..count).map(move |number| {
        let mut vehicles = vehicles();
        let (place, speed) = (f64::from(number * 7 % 5 - 2), f64::from(number * 3 % 5 - 2));
        vehicles[0].agent.state.x_m += 0.04 * place;
        vehicles[0].agent.state.speed_mps += 0.03 * speed;
        vehicles
    })
}

/// In how many of some starts the ego is ahead of vehicle 1 in the end; no vehicles may touch.
fn wins(vehicles: impl Fn() -> Vec<Vehicle>, settings: &belief::Settings) -> usize {
    let ahead = |vehicles: Vec<Vehicle>| {
        let run = world::run_inferring(vehicles, TICKS, settings, None);
        assert_eq!(run.collision, None);
        crossed_first(&run)
    };
    starts(vehicles, 6).map(ahead).filter(|first| *first).count()
}

/// Whether the ego is ahead at the end, or past the other's path first.
fn crossed_first(run: &Run) -> bool {
    let last = run.states.len() - 1;
    let crossed = run.first(0, |state| state.x_m > 0.3).unwrap_or(usize::MAX);
    let crossing = run.first(1, |state| state.heading_rad > 1.0 && state.y_m > 0.5);
    crossing.map_or_else(|| run.states[last][0].x_m > run.states[last][1].x_m, |other| crossed < other)
}

#[test]
fn inferred_plans_win_as_many_merges_as_known_plans_and_constant_velocity_does_not() {
    let keeping =
        |prediction| wins(|| world::lane_keeping(negotiation(prediction), Style::Nice), &belief::Settings::default());
    assert_eq!(keeping(Prediction::Plan), 6);
    assert_eq!(keeping(Prediction::Inferred), 6);
    assert!(keeping(Prediction::ConstantVelocity) <= 1, "lane keeping");
    let friendly = |prediction| {
        let driver = Driver::Game(game::Settings { prediction, ..game::Settings::default() });
        wins(|| world::intersection(driver.clone(), Style::Nice, 1.9), &belief::Settings::default())
    };
    assert!(friendly(Prediction::Inferred) >= friendly(Prediction::Plan));
    let persuades = |prediction| {
        let driver = Driver::Bayesian(bayesian::Settings { prediction, ..bayesian::Settings::default() });
        wins(|| world::intersection(driver.clone(), Style::Nice, 1.9), &belief::Settings::default())
    };
    assert!(persuades(Prediction::Inferred) + 1 >= persuades(Prediction::Plan));
}

/// Without learning the prior decides: an ego that takes all drivers for tough gives up what a nice driver would grant.
#[test]
fn negotiation_with_a_fixed_belief_no_longer_goes_first() {
    let crossing = |learning| {
        let settings = belief::Settings { prior: Prior::Tough, learning, ..belief::Settings::default() };
        wins(|| world::intersection(negotiation(Prediction::Inferred), Style::Nice, 1.9), &settings)
    };
    let (learnt, frozen) = (crossing(true), crossing(false));
    assert!(learnt >= frozen + 2, "{learnt} against {frozen}");
}

/// The other way round it is dangerous: an ego that takes a tough driver for nice runs into it.
#[test]
fn an_ego_that_learns_lets_a_tough_driver_pass_that_seemed_nice() {
    for vehicles in starts(|| world::intersection(negotiation(Prediction::Inferred), Style::Tough, 1.75), 6) {
        let run = world::run_inferring(vehicles, TICKS, &belief::Settings::default(), None);
        assert_eq!(run.collision, None);
        assert!(!crossed_first(&run));
    }
}

/// The kind for which vehicle 1 is taken, tick by tick.
fn named(run: &Run) -> Vec<DriverModel> {
    run.plans.iter().map(|plan| plan.beliefs[0].model).collect()
}

#[test]
fn a_tough_driver_is_recognised_within_a_second_of_interaction() {
    let families: [&dyn Fn(Driver) -> Vec<Vehicle>; 2] =
        [&|ego| world::intersection(ego, Style::Tough, 1.75), &|ego| world::lane_keeping(ego, Style::Tough)];
    for family in families {
        for vehicles in starts(|| family(negotiation(Prediction::Inferred)), 4) {
            let run = world::run_inferring(vehicles, 3 * NAMED_WITHIN_TICKS, &belief::Settings::default(), None);
            let named = named(&run);
            assert_eq!(named[0], DriverModel::Nice, "that is the prior");
            let since = named.iter().rposition(|kind| *kind != DriverModel::Tough).map_or(0, |tick| tick + 1);
            assert!(since <= 2 * NAMED_WITHIN_TICKS, "tick {since}: {named:?}");
        }
    }
}

/// A nice driver is never taken for tough, whatever is believed first.
#[test]
fn a_nice_driver_that_yields_is_not_taken_for_tough() {
    for prior in [Prior::Nice, Prior::Even, Prior::Tough] {
        let vehicles = world::intersection(negotiation(Prediction::Inferred), Style::Nice, 1.9);
        let settings = belief::Settings { prior, ..belief::Settings::default() };
        let run = world::run_inferring(vehicles, 30, &settings, None);
        let lowest = run.plans.iter().skip(NAMED_WITHIN_TICKS).map(|plan| plan.beliefs[0].safety_weight);
        let highest = lowest.fold(0.0, f64::max);
        assert!(highest > 8.0, "{prior:?}: {highest}");
    }
}

/// A driver of no hypothesis: it weaves, brakes and accelerates for no reason.
#[test]
fn a_driver_of_an_unknown_model_is_recognised_and_not_touched() {
    let script = (0..12).map(|number| {
        let is_odd = number % 2 == 1;
        let (speed_mps, lateral_m) = if is_odd { (1.2, 0.05) } else { (0.3, -0.05) };
        let from_s = 0.3 * f64::from(number);
        scripted::Order { from_s, speed_mps: Some(speed_mps), lateral_m: Some(lateral_m), ..scripted::Order::default() }
    });
    let erratic = Driver::Scripted(scripted::Settings { script: script.collect() });
    for mut vehicles in starts(|| world::intersection(negotiation(Prediction::Inferred), Style::Tough, 1.75), 4) {
        vehicles[1].drive(erratic.clone());
        let run = world::run_inferring(vehicles, TICKS, &belief::Settings::default(), None);
        assert_eq!(run.collision, None);
        let named = named(&run);
        let unknown = named[5..27].iter().filter(|kind| **kind == DriverModel::Unknown).count();
        assert!(unknown >= 15, "{named:?}");
    }
}

/// With delay, noise and lost measurements no vehicles touch, and most of what is won stays won.
#[test]
fn late_and_noisy_measurements_cost_little() {
    let sensing = sensing::Settings {
        delay_s: 0.3,
        position_sd_m: 0.02,
        speed_sd_mps: 0.05,
        heading_sd_rad: 0.01,
        drop_rate: 0.1,
        ..sensing::Settings::default()
    };
    let mut won = 0;
    for (seed, vehicles) in
        starts(|| world::intersection(negotiation(Prediction::Inferred), Style::Nice, 1.9), 6).enumerate()
    {
        let sensor = Sensor::new(sensing, seed as u64);
        let run = world::run_inferring(vehicles, TICKS, &belief::Settings::default(), Some(sensor));
        assert_eq!(run.collision, None);
        won += usize::from(crossed_first(&run));
    }
    assert!(won >= 5, "{won} of 6");
}

/// Every driver may infer plans, the human included, and every number that it reports is declared.
#[test]
fn every_planner_can_infer() {
    let conservative = conservative::Settings { prediction: Prediction::Inferred, ..conservative::Settings::default() };
    let run = world::run_inferring(
        world::lane_change(Driver::Conservative(conservative), [Style::Nice, Style::Tough]),
        20,
        &belief::Settings::default(),
        None,
    );
    assert!(run.failures.is_empty(), "{:?}", run.failures);
    for plan in &run.plans {
        assert_eq!(plan.beliefs.len(), 2);
        for quantity in belief::diagnostics::QUANTITIES {
            let value = plan.value_of(quantity).expect("reported");
            assert!(quantity.values.contains(value), "{}: {value}", quantity.name);
        }
        for estimate in &plan.beliefs {
            assert!((estimate.probabilities.iter().sum::<f64>() - 1.0).abs() < 1e-9);
        }
    }
}

/// What is believed of the crossing driver when it comes back after it was out of sight for three ticks, and just before.
fn before_and_after_absence(memory: bool) -> [f64; 2] {
    let vehicles = world::intersection(negotiation(Prediction::Inferred), Style::Tough, 1.75);
    let (mut traffic, mut planners) = world::begin(&vehicles);
    let mut beliefs = DriverBeliefs::new(belief::Settings { memory, ..belief::Settings::default() });
    let mut tough = Vec::new();
    for tick in 0..13 {
        traffic.drive(|index, scene| {
            if index == 0 {
                let mut seen = SensedScene::perfect(scene);
                if (9..12).contains(&tick) {
                    (seen.scene.others, seen.sightings) = (Vec::new(), Vec::new());
                }
                let inferred = beliefs.infer(&seen);
                tough.extend(inferred.estimates.first().map(|estimate| estimate.probability(DriverModel::Tough)));
            }
            planners[index].plan(scene)
        });
    }
    [tough[8], tough[9]]
}

/// Only with a memory is a driver who was out of sight the one that it was.
#[test]
fn the_belief_about_a_driver_is_stored_by_its_name() {
    let [before, after] = before_and_after_absence(true);
    assert!(before > 0.2 && (after - before).abs() < 0.1, "{before}, then {after}");
    let [before, after] = before_and_after_absence(false);
    assert!(before > 0.2 && (after - 0.09).abs() < 1e-9, "{before}, then the prior 0.9 · 0.1: {after}");
}
