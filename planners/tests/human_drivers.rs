//! Human drivers who differ by a setting: styles between tough and nice, late reactions, hesitation, plans that are read.

mod common;

use common::starts::perturbed;
use common::world::{HORIZON, LANES, Run, STEP_S, Vehicle, begin, families, intersection, run, vehicle};
use interplay_planners::drivers::game::ExpressedBounds;
use interplay_planners::drivers::human::{Human, Settings, Style};
use interplay_planners::drivers::scripted::{self, Order};
use interplay_planners::drivers::{bayesian, conservative, game, negotiation};
use interplay_planners::prediction::{Prediction, constant_velocity};
use interplay_planners::scene::Knowledge;
use interplay_planners::scene::inferred_futures::InferredFutures;
use interplay_planners::trajectory::HomotopySearch;
use interplay_planners::{Agent, Body, Corridor, Drive, Driver, Input, Limits, Plan, PlanError, Scene, State};
use proptest::prelude::*;

const STEADY: [f64; 4] = [0.0, 4.0, 1.0, 1.0];

fn human(settings: Settings) -> Driver {
    Driver::Human(settings)
}

fn late(reaction_s: f64) -> Settings {
    Settings { reaction_s, ..Settings::default() }
}

fn hesitant(hesitation_s: f64) -> Settings {
    Settings { hesitation_s, ..Settings::default() }
}

/// When the scripted driver turns towards the human's lane \[s\].
const TURNS_S: f64 = 1.0;

/// Where it ends \[m\]: inside the human's safety ellipse, but not so far in its lane that it would be followed.
const BETWEEN_M: f64 = 0.34;

/// A scripted driver beside and a little ahead of the human turns towards its lane; it is vehicle 1, the human vehicle 0.
fn cut_in(settings: Settings) -> Run {
    let turns = Order { from_s: TURNS_S, lateral_m: Some(BETWEEN_M), ..Order::default() };
    let script = Driver::Scripted(scripted::Settings { script: vec![turns] });
    let vehicles = vec![
        vehicle("human", [-0.4, LANES[1], 1.0], [LANES[1], 1.0], STEADY, human(settings)),
        vehicle("other", [0.0, LANES[0], 1.0], [LANES[0], 1.0], STEADY, script),
    ];
    let run = run(vehicles, 60);
    assert!(run.failures.is_empty() && run.collision.is_none(), "{:?} {:?}", run.failures, run.collision);
    run
}

/// When a vehicle has lost 2 cm/s \[ticks\].
fn brakes_at(run: &Run) -> usize {
    run.first(0, |state| state.speed_mps < 0.98).expect("it brakes")
}

#[test]
fn a_late_driver_brakes_later_by_its_reaction_time() {
    let prompt = brakes_at(&cut_in(late(0.0)));
    for delay in [1, 3, 6] {
        let found = brakes_at(&cut_in(late(STEP_S * delay as f64)));
        assert!(found.abs_diff(prompt + delay) <= 1, "{delay} ticks late: at {found} instead of {prompt}");
    }
}

/// It decides at its first plan and then every two seconds: what begins at 1.0 s it takes into account from 2.0 s on.
#[test]
fn a_hesitant_driver_brakes_only_at_its_next_decision() {
    let prompt = brakes_at(&cut_in(hesitant(0.0)));
    assert!(prompt < 18, "{prompt}");
    let found = brakes_at(&cut_in(hesitant(2.0)));
    assert!((20..=22).contains(&found), "{found}");
}

/// Hesitation concerns vehicles that might cut in or cross: the vehicle ahead is watched all the time.
#[test]
fn a_hesitant_driver_does_not_run_into_the_vehicle_ahead() {
    for driver in [hesitant(5.0), Settings { style: Some(Style::Tough), ..hesitant(5.0) }] {
        let brakes = Order { from_s: 1.0, speed_mps: Some(0.0), acceleration_mps2: Some(1.0), ..Order::default() };
        let script = Driver::Scripted(scripted::Settings { script: vec![brakes] });
        let vehicles = vec![
            vehicle("human", [-1.2, LANES[1], 1.2], [LANES[1], 1.2], STEADY, human(driver)),
            vehicle("leader", [0.0, LANES[1], 1.2], [LANES[1], 1.2], STEADY, script),
        ];
        let run = run(vehicles, 80);
        assert!(run.failures.is_empty() && run.collision.is_none(), "{:?} {:?}", run.failures, run.collision);
    }
}

fn crossing_pair(settings: Settings) -> Vec<Vehicle> {
    let ego = Driver::Conservative(conservative::Settings::default());
    let mut vehicles = intersection(ego, Style::Nice, 1.9);
    vehicles[1].drive(human(settings));
    vehicles
}

/// Times below half a tick, and a decision at every tick, change nothing, bit for bit.
#[test]
fn without_delay_the_driver_is_the_same_bit_for_bit() {
    let same = [late(0.0), hesitant(0.0), late(0.04), hesitant(0.1), Settings { hesitation_s: 0.14, ..late(0.01) }];
    let [crossed, merged] = [run(crossing_pair(Settings::default()), 40), cut_in(Settings::default())];
    for settings in same {
        assert!(run(crossing_pair(settings), 40).states == crossed.states, "{settings:?}");
        assert!(cut_in(settings).states == merged.states, "{settings:?}");
    }
    for settings in [late(0.3), hesitant(0.8)] {
        assert!(cut_in(settings).states != merged.states, "{settings:?}");
    }
}

/// The same scenes lead a fresh driver to the same plans: all that it remembers is its own.
#[test]
fn a_late_and_hesitant_driver_can_be_replayed() {
    let settings = Settings { hesitation_s: 0.7, ..late(0.4) };
    let vehicles = crossing_pair(settings);
    let (mut traffic, mut planners) = begin(&vehicles);
    let mut replayed = Human::new(settings);
    for _ in 0..40 {
        traffic.drive(|index, scene| {
            let plan = planners[index].plan(scene);
            if index == 1 {
                let trajectory = |plan: &Result<Plan, PlanError>| plan.clone().map(|plan| plan.trajectory);
                assert!(trajectory(&plan) == trajectory(&replayed.plan(scene, &InferredFutures::default())));
            }
            plan
        });
    }
}

/// The more a driver minds others, the more it slows down for one who cuts in.
#[test]
fn driver_styles_are_points_of_a_continuum() {
    let slowest = |settings| {
        let run = cut_in(settings);
        run.states.iter().map(|states| states[0].speed_mps).fold(f64::INFINITY, f64::min)
    };
    let speeds = Style::ALL.map(|style| slowest(Settings { style: Some(style), ..Settings::default() }));
    assert!(speeds.is_sorted(), "{speeds:?}");
    for style in Style::ALL {
        let weight = style.safety_weight();
        let stated = Settings { safety_weight: Some(weight), ..Settings::default() };
        assert_eq!(stated.weight(), Settings { style: Some(style), ..Settings::default() }.weight());
        assert_eq!(human(stated).description(), format!("human, {}", style.name()));
        assert_eq!(serde_json::to_value(style).expect("a word"), style.name());
    }
    let between = Settings { safety_weight: Some(5.0), ..Settings::default() };
    assert_eq!(human(between).description(), "human, safety weight 5");
}

fn any_settings() -> impl Strategy<Value = Settings> {
    let duration_s = || prop_oneof![Just(0.0), 0.0..2.0, Just(1e12)];
    let weight = || prop_oneof![Just(0.0), 0.0..100.0, Just(1e4)];
    let prediction = prop_oneof![Just(Prediction::Plan), Just(Prediction::ConstantVelocity)];
    let style = prop::option::of(prop::sample::select(Style::ALL.to_vec()));
    let orders = prop_oneof![Just(HomotopySearch::Off), Just(HomotopySearch::Classes)];
    let plain = (style, prop::option::of(weight()), weight(), 0.0..2.0, orders);
    (plain, prediction, duration_s(), duration_s()).prop_map(|(plain, prediction, reaction_s, hesitation_s)| {
        let (style, safety_weight, following_weight, closing_mps, passing_orders) = plain;
        Settings {
            style,
            safety_weight,
            following_weight,
            closing_mps,
            passing_orders,
            prediction,
            reaction_s,
            hesitation_s,
            ..Settings::default()
        }
    })
}

fn any_agent() -> impl Strategy<Value = Agent> {
    let roads = prop::sample::select(vec![0.0, 1.0, std::f64::consts::FRAC_PI_2]);
    ("[abc]", -2.0..2.0, -0.2..1.0, -0.5..0.5, 0.0..1.5, roads).prop_map(|(name, x_m, y_m, turned, speed_mps, road)| {
        let state = State { x_m, y_m, heading_rad: road + turned, speed_mps };
        Agent {
            name,
            state,
            previous_input: Input::default(),
            body: Body::default(),
            limits: Limits::default(),
            route: Corridor { heading_rad: road, right_m: -1.0, left_m: 2.0, end: None }.into(),
            prediction: constant_velocity(&state, HORIZON, STEP_S).into(),
            shared_goal: None,
            can_be_asked: true,
            is_obstacle: false,
            indicator: None,
            rules: interplay_planners::rules::RoadRules::default(),
            urgency: 1.0,
            own_place: Default::default(),
        }
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Whatever the settings, and whichever vehicles come, go and jump, a driver plans a finite motion or says why it has none.
    #[test]
    fn no_setting_of_a_human_driver_panics(
        settings in any_settings(),
        seen in prop::collection::vec((0_usize..4, prop::collection::vec(any_agent(), 0..4)), 1..8),
    ) {
        let own = vehicle("own", [0.0, LANES[1], 1.0], [LANES[1], 1.2], STEADY, human(settings));
        let mut driver = Human::new(settings);
        let mut tick = 0;
        for (later, others) in seen {
            tick += later;
            let (ego, goal) = (own.agent.clone(), own.goal);
            let scene = Scene { tick, step_s: STEP_S, horizon: HORIZON, knowledge: Knowledge::Plans, ego, goal, others };
            if let Ok(plan) = driver.plan(&scene, &InferredFutures::default()) {
                prop_assert!(plan.trajectory.states.iter().all(State::is_finite));
                prop_assert_eq!(plan.trajectory.inputs.len(), HORIZON);
            }
        }
    }
}

const TICKS: usize = 60;
const STARTS: u64 = 30;

/// The places of an ego when it is in its lane, added up over the starts of a family, and the mean time until then \[s\].
fn merged(family: &str, ego: &Driver) -> (usize, f64) {
    let (_, pose) = families().into_iter().find(|(name, _)| name == family).expect("a family");
    let merged = |seed| Run::merged(&run(perturbed(pose(ego.clone()), seed), TICKS)).expect("merges");
    let (places, times): (Vec<_>, Vec<_>) = (1..=STARTS).map(merged).unzip();
    (places.into_iter().sum(), times.into_iter().sum::<f64>() / STARTS as f64)
}

/// Asserts that an ego merges later as printed, and gets no better place.
fn assert_later_as_printed(family: &str, ego: &Driver, printed: &Driver, later_s: f64) {
    let [(place, time_s), (printed_place, printed_s)] = [ego, printed].map(|ego| merged(family, ego));
    assert!(time_s < printed_s - later_s && place <= printed_place, "{family}: {time_s} and {printed_s} s");
}

/// As printed the signal also draws back an ego that is ahead of the other.
#[test]
fn an_ego_drawn_back_to_the_vehicle_behind_merges_later() {
    let with = |ahead_share| Driver::Bayesian(bayesian::Settings { ahead_share, ..bayesian::Settings::default() });
    let (ego, printed) = (Driver::Bayesian(bayesian::Settings::default()), with(1.0));
    for (family, later_s) in [("lane-change/nice-nice", 0.5), ("ramp-merge/tough-nice", 0.15)] {
        assert_later_as_printed(family, &ego, &printed, later_s);
    }
}

/// As printed an ego that seems surer to pass than it is slows down.
#[test]
fn an_ego_that_must_not_seem_too_sure_merges_later() {
    let with = |expressed_bounds| {
        Driver::Game(game::Settings { slack_weight: 1.5, expressed_bounds, ..game::Settings::default() })
    };
    let (ego, printed) = (with(ExpressedBounds::OneSided), with(ExpressedBounds::Interval));
    assert_later_as_printed("ramp-merge/nice-nice", &ego, &printed, 0.3);
}

/// At how many starts the ego merges behind both.
fn last(ego: &Driver) -> usize {
    let (_, pose) = families().into_iter().find(|(name, _)| name == "ramp-merge/tough-nice").expect("a family");
    let place = |seed| run(perturbed(pose(ego.clone()), seed), TICKS).merged();
    (1..=STARTS).filter(|seed| place(*seed).is_none_or(|(place, _)| place == 2)).count()
}

/// A conservative ego merges between the two from each of these starts. One that asks the tough driver five times before it gives up
/// comes too late for that at one start in six or more, one that minds what its fallback costs at one in thirty at most.
#[test]
fn an_ego_that_asks_on_while_its_fallback_becomes_dearer_loses_its_place() {
    let minds = negotiation::Settings::default();
    let patient = negotiation::Settings { retreat_dearer_at_most: 1e6, ..minds };
    assert_eq!(last(&Driver::Conservative(conservative::Settings::default())), 0);
    let [lost, lost_by_patience] = [minds, patient].map(|settings| last(&Driver::Negotiation(settings)));
    assert!(lost <= 1 && lost_by_patience >= 5, "{lost} and {lost_by_patience} of {STARTS}");
}
