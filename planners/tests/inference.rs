//! What a planner without known plans infers: what it keeps, what it names, and what happens where no hypothesis fits.

mod common;

use common::world::{self, Run, Vehicle};
use common::{HORIZON, SplitMix64, futures};
use interplay_planners::drivers::human::Style;
use interplay_planners::drivers::{bayesian, conservative, game, negotiation, scripted};
use interplay_planners::perception::belief::{self, DriverBeliefs, Prior};
use interplay_planners::perception::sensing::{self, SensedScene, Sensor};
use interplay_planners::prediction::Prediction;
use interplay_planners::scene::driver_estimate::DriverModel;
use interplay_planners::trajectory::terms::{Comfort, KeepOut, RoadEdge, Tracking};
use interplay_planners::trajectory::{DescentError, HomotopySearch, Optimiser, Optimum, Problem, Robust, Term};
use interplay_planners::{Driver, Input};

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

fn solve(problem: &Problem) -> Result<Optimum, DescentError> {
    Optimiser::new(Robust::default()).searching(HomotopySearch::Off).optimise(problem, &[])
}

/// The problem of one future, with the weights that it has among all.
fn alone(problem: &Problem, future: usize) -> Problem {
    problem.alone(future, &problem.start(&[]))
}

/// The term of the only vehicle of a problem, as that of another number.
fn moved_to(term: &Term, vehicle: usize) -> Term {
    match term.clone() {
        Term::Comfort(term) => Term::Comfort(Comfort { vehicle, ..term }),
        Term::Tracking(term) => Term::Tracking(Tracking { vehicle, ..term }),
        Term::RoadEdge(term) => Term::RoadEdge(RoadEdge { vehicle, ..term }),
        Term::KeepOut(term) => Term::KeepOut(KeepOut { vehicle, ..term }),
        other => other,
    }
}

#[test]
fn branches_share_their_first_inputs_and_then_differ() {
    let mut differ = 0;
    for seed in 0..20 {
        let shared_steps = 1 + seed as usize % 12;
        let found = solve(&futures(seed, 3, shared_steps)).expect("an optimum");
        let [one, two, three] = &found.iterate.inputs[..] else { panic!("three futures") };
        assert_eq!(one[..shared_steps], two[..shared_steps]);
        assert_eq!(one[..shared_steps], three[..shared_steps]);
        let apart =
            |a: &[Input], b: &[Input]| (a[shared_steps].acceleration_mps2 - b[shared_steps].acceleration_mps2).abs();
        differ += usize::from(apart(one, two) > 1e-3);
    }
    assert!(differ > 5, "{differ} of 20");
}

/// Not knowing the future costs something: knowing it from the begin is never dearer, and having to decide everything now never
/// cheaper.
#[test]
fn learning_the_future_later_costs_more() {
    let mut dearer = 0;
    for seed in 0..20 {
        let known: f64 =
            (0..2).map(|future| solve(&alone(&futures(seed, 2, 0), future)).expect("an optimum").cost.total).sum();
        // Each is started at the one that knows less, whose plan it could follow.
        let mut costs = Vec::new();
        let mut guess = Vec::new();
        for shared_steps in [HORIZON - 1, 12, 4] {
            let problem = futures(seed, 2, shared_steps);
            let found = Optimiser::new(Robust::default())
                .searching(HomotopySearch::Off)
                .optimise(&problem, &guess)
                .expect("an optimum");
            costs.push(found.cost.total);
            guess = found.iterate.inputs;
        }
        let tolerance = 1e-6 * (1.0 + costs[0]);
        assert!(costs.windows(2).all(|pair| pair[1] <= pair[0] + tolerance), "seed {seed}: {costs:?}");
        dearer += usize::from(costs[2] > known + tolerance);
    }
    assert!(dearer > 5, "{dearer} of 20");
}

/// With the same future everywhere the plan is that of one vehicle, whatever is shared.
#[test]
fn equal_futures_give_the_plan_of_one_future() {
    for seed in 0..10 {
        let one = futures(seed, 1, 0);
        let guess = one.start(&[]).inputs[0].clone();
        let single = solve(&one).expect("an optimum");
        let mut twice = futures(seed, 2, 7);
        twice.terms = (0..2).flat_map(|future| one.terms.iter().map(move |term| moved_to(term, future))).collect();
        let found = Optimiser::new(Robust::default())
            .searching(HomotopySearch::Off)
            .optimise(&twice, &[guess.clone(), guess])
            .expect("an optimum");
        assert!((found.cost.total - 2.0 * single.cost.total).abs() < 1e-6 * (1.0 + single.cost.total), "seed {seed}");
        let apart = |t: usize| (found.iterate.states[1][t].x_m - single.iterate.states[0][t].x_m).abs();
        assert!((0..=HORIZON).all(|t| apart(t) < 1e-4), "seed {seed}");
    }
}

/// No small change of the inputs, shared where they are to be, makes an optimum cheaper.
#[test]
fn no_admissible_change_makes_an_optimum_cheaper() {
    let mut random = SplitMix64::new(3);
    for seed in 0..10 {
        let problem = futures(seed, 3, 6);
        let found = solve(&problem).expect("an optimum");
        for _ in 0..200 {
            let size = 10f64.powf(random.uniform(-4.0, -1.0));
            let guess = found.iterate.inputs.iter().map(|inputs| {
                let moved = inputs.iter().map(|input| Input {
                    acceleration_mps2: input.acceleration_mps2 + size * random.uniform(-1.0, 1.0),
                    steering_rad: input.steering_rad + 0.1 * size * random.uniform(-1.0, 1.0),
                });
                moved.collect()
            });
            let cost = problem.cost_of(&guess.collect::<Vec<Vec<Input>>>());
            assert!(cost > found.cost.total - 1e-7, "seed {seed}: {cost} below {}", found.cost.total);
        }
    }
}
