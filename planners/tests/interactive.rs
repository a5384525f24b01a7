//! Bayesian persuasion and the persuasion game in closed loop with humans, and with each other.

mod common;

use common::world::{Run, intersection, lane_change, ramp_merge, run};
use interplay_planners::human::Style::{self, Nice, Tough};
use interplay_planners::{Driver, bayesian, conservative, game, negotiation};

const AHEAD: usize = 0;
const BETWEEN: usize = 1;
const BEHIND: usize = 2;

fn conservative() -> Driver {
    Driver::Conservative(conservative::Settings::default())
}

fn bayesian() -> Driver {
    Driver::Bayesian(bayesian::Settings::default())
}

fn game() -> Driver {
    Driver::Game(game::Settings::default())
}

/// The game with what the recommended settings say about intersections.
fn crossing_game() -> Driver {
    Driver::Game(game::Settings { accident: 1.0, slack_weight: 50.0, ..game::Settings::default() })
}

/// What must hold in every run.
fn sound(run: Run) -> Run {
    assert!(run.collision.is_none(), "{:?}", run.collision);
    assert!(run.failures.is_empty(), "{:?}", run.failures);
    run
}

/// The ego's place from the front once it has merged.
fn place(driver: Driver, styles: [Style; 2]) -> usize {
    let run = sound(run(lane_change(driver, styles), 100));
    assert!(run.nearest > 0.99, "the ego entered a safety ellipse: {}", run.nearest);
    run.merged().expect("the ego merges").0
}

#[test]
fn nice_drivers_are_persuaded_to_let_the_ego_in_ahead() {
    assert_eq!(place(bayesian(), [Nice, Nice]), AHEAD);
    assert_eq!(place(game(), [Nice, Nice]), AHEAD);
    assert_eq!(place(conservative(), [Nice, Nice]), BETWEEN);
}

#[test]
fn tough_drivers_are_let_pass() {
    for driver in [bayesian, game, conservative] {
        assert_eq!(place(driver(), [Tough, Nice]), BETWEEN, "{}", driver().kind());
        assert_eq!(place(driver(), [Tough, Tough]), BEHIND, "{}", driver().kind());
    }
}

#[test]
fn on_a_ramp_nobody_leaves_the_road() {
    for driver in [bayesian, game] {
        for styles in [[Nice, Nice], [Tough, Nice], [Tough, Tough]] {
            let vehicles = ramp_merge(driver(), styles);
            let ego = vehicles[0].agent.clone();
            let run = run(vehicles, 80);
            assert!(run.collision.is_none(), "{}: {:?}", driver().kind(), run.collision);
            let keeps = run.states.iter().all(|states| ego.corridor.contains(&ego.body, &states[0], 1e-2));
            assert!(keeps && run.merged().is_some(), "{} among {styles:?}", driver().kind());
        }
    }
}

/// The value that follows from the source's own equations repels: the ego does not persuade anybody.
#[test]
fn the_exact_value_persuades_nobody() {
    let exact = bayesian::Settings { value: bayesian::Value::Exact, ..bayesian::Settings::default() };
    let run = run(lane_change(Driver::Bayesian(exact), [Nice, Nice]), 100);
    assert!(run.collision.is_none());
    assert!(run.merged().is_none_or(|(place, _)| place != AHEAD), "{:?}", run.merged());
}

/// Who crosses first, and the ego's lowest speed.
fn crossing(driver: Driver, style: Style, away_m: f64) -> (bool, f64) {
    let run = sound(run(intersection(driver, style, away_m), 70));
    let ego = run.first(0, |state| state.x_m > 0.0).expect("the ego crosses");
    let other = run.first(1, |state| state.y_m > 0.185).expect("the other crosses");
    let slowest = run.states.iter().map(|states| states[0].speed_mps).fold(f64::INFINITY, f64::min);
    (ego < other, slowest)
}

#[test]
fn at_an_intersection_nice_drivers_yield_to_those_who_persuade() {
    assert!(crossing(bayesian(), Nice, 1.9).0);
    assert!(crossing(crossing_game(), Nice, 1.9).0);
    assert!(!crossing(conservative(), Nice, 1.9).0);
}

#[test]
fn at_an_intersection_everybody_yields_to_the_tough() {
    for driver in [bayesian(), crossing_game(), conservative()] {
        let kind = driver.kind();
        let (first, slowest) = crossing(driver, Tough, 1.75);
        assert!(!first && slowest < 0.6, "{kind}: {slowest}");
    }
}

#[test]
fn a_mixed_equilibrium_drives_too() {
    let nash = || Driver::Game(game::Settings { solution: game::Method::Nash, ..game::Settings::default() });
    for styles in [[Nice, Nice], [Tough, Nice], [Tough, Tough]] {
        let run = sound(run(lane_change(nash(), styles), 100));
        for plan in &run.plans {
            let tempted = plan.diagnostics.iter().filter(|(name, _)| name.starts_with("temptation"));
            assert!(tempted.into_iter().all(|(_, gain)| *gain < 1e-8), "{:?}", plan.diagnostics);
        }
    }
}

/// Any vehicle may have any driver.
#[test]
fn two_who_persuade_may_meet() {
    let negotiator = || Driver::Negotiation(negotiation::Settings::default());
    for (ego, front) in [(bayesian(), game()), (game(), bayesian()), (bayesian(), negotiator()), (game(), game())] {
        let mut vehicles = lane_change(ego.clone(), [Nice, Nice]);
        vehicles[1].drive(front.clone());
        let run = run(vehicles, 80);
        assert!(run.collision.is_none(), "{} and {}: {:?}", ego.kind(), front.kind(), run.collision);
        assert!(run.failures.len() <= 2, "{} and {}: {:?}", ego.kind(), front.kind(), run.failures);
    }
}

#[test]
fn plans_explain_themselves() {
    let explains = |driver: Driver, names: &[&str]| {
        let run = run(lane_change(driver, [Nice, Nice]), 5);
        let plan = run.plans.last().expect("a plan");
        for name in names {
            assert!(plan.diagnostics.iter().any(|(held, value)| held == name && value.is_finite()), "{name}");
        }
    };
    let common = ["cost", "safety slack", "steps at a safety ellipse", "steps at a road edge"];
    explains(bayesian(), &common);
    explains(bayesian(), &["conservativeness", "belief variance", "other's loyalty w_1", "attraction k_1"]);
    explains(game(), &common);
    explains(game(), &["posterior of the other", "intention p_e", "payoff: accident", "expressed speed from"]);
}
