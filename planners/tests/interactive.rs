//! Bayesian persuasion and the persuasion game in closed loop with humans, and with each other.

mod common;

use common::world::{HORIZON, LANES, Run, STEP_S, Vehicle, egos, human, intersection, lane_change, ramp_merge, run};
use interplay_planners::drivers::game::ExpressedBounds;
use interplay_planners::drivers::game::diagnostics::{
    ACCIDENT_PAYOFF, EGO_INTENTION, EGO_PAYOFFS, EGO_POSTERIOR, EGO_TEMPTATION, EXPRESSION_SLACK, OTHER_TEMPTATION,
};
use interplay_planners::drivers::game::expression::wanted_posterior;
use interplay_planners::drivers::human::Style::{self, Nice, Tough};
use interplay_planners::drivers::{bayesian, conservative, cooperative, game, idm, negotiation};
use interplay_planners::plan::diagnostic::{COMMON_QUANTITIES, DiagnosticQuantity, Explanation, RUNNER_UP_COST};
use interplay_planners::prediction::constant_velocity;
use interplay_planners::{Diagnostic, Driver, PassingSide, PlanEvent, PlanEventKind};

const AHEAD: usize = 0;
const BETWEEN: usize = 1;
const BEHIND: usize = 2;
/// On a ramp an ego that goes ahead at its top speed may cut the tapering edge by so much \[m\]: road edges are soft.
const MAX_EDGE_VIOLATION_M: f64 = 0.02;

fn conservative() -> Driver {
    Driver::Conservative(conservative::Settings::default())
}

fn bayesian() -> Driver {
    Driver::Bayesian(bayesian::Settings::default())
}

fn game() -> Driver {
    Driver::Game(game::Settings::default())
}

fn negotiator() -> Driver {
    Driver::Negotiation(negotiation::Settings::default())
}

fn idm() -> Driver {
    Driver::Idm(idm::Settings::default())
}

/// The game with what the recommended settings say about intersections.
fn crossing_game() -> Driver {
    let settings =
        game::Settings { slack_weight: 50.0, crossing_s: 0.5, temperature: 0.25, ..game::Settings::default() };
    Driver::Game(settings)
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
fn every_planner_lets_tough_drivers_pass() {
    for driver in [bayesian, game, conservative] {
        assert_eq!(place(driver(), [Tough, Nice]), BETWEEN, "{}", driver().kind());
        assert_eq!(place(driver(), [Tough, Tough]), BEHIND, "{}", driver().kind());
    }
}

/// Whether an ego on a ramp merges and stays on its road.
fn keeps_to_its_ramp(driver: Driver, styles: [Style; 2]) -> bool {
    let vehicles = ramp_merge(driver, styles);
    let ego = vehicles[0].agent.clone();
    let run = run(vehicles, 80);
    assert!(run.collision.is_none(), "{:?}", run.collision);
    let contains = |state| ego.route.contains(&ego.body, state, MAX_EDGE_VIOLATION_M);
    run.merged().is_some() && run.states.iter().all(|states| contains(&states[0]))
}

#[test]
fn on_a_ramp_no_vehicle_leaves_the_road() {
    for styles in [[Nice, Nice], [Tough, Nice], [Tough, Tough]] {
        assert!(keeps_to_its_ramp(game(), styles), "game among {styles:?}");
    }
    for styles in [[Tough, Nice], [Tough, Tough]] {
        assert!(keeps_to_its_ramp(bayesian(), styles), "Bayesian persuasion among {styles:?}");
    }
}

/// From this start it comes between the two, finds no safe plan, and leaves the road at the end of its lane.
#[test]
#[ignore = "not solved: 12 cm off the road"]
fn on_a_ramp_bayesian_persuasion_among_nice_drivers_stays_on_the_road() {
    assert!(keeps_to_its_ramp(bayesian(), [Nice, Nice]));
}

/// The value that follows from the source's own equations repels: the ego persuades no driver.
#[test]
fn the_exact_value_persuades_no_driver() {
    let exact = bayesian::Settings { value: bayesian::ReplyValue::Exact, ..bayesian::Settings::default() };
    let run = run(lane_change(Driver::Bayesian(exact), [Nice, Nice]), 100);
    assert!(run.collision.is_none());
    assert!(run.merged().is_none_or(|(place, _)| place != AHEAD), "{:?}", run.merged());
}

/// Who crosses first, and the ego's lowest speed.
fn crossing(driver: Driver, style: Style, away_m: f64) -> (bool, f64) {
    crossed(intersection(driver, style, away_m))
}

/// The same for the game from the start of its scenarios, from which neither is first by itself.
fn crossing_by_game(style: Style) -> (bool, f64) {
    crossing_from(crossing_game(), style, -2.6, 0.7)
}

/// The same for Bayesian persuasion from the start of its scenarios.
fn crossing_by_persuasion(style: Style) -> (bool, f64) {
    crossing_from(bayesian(), style, -2.5, 0.75)
}

fn crossing_from(driver: Driver, style: Style, x_m: f64, speed_mps: f64) -> (bool, f64) {
    let mut vehicles = intersection(driver, style, 1.965);
    let ego = &mut vehicles[0].agent;
    (ego.state.x_m, ego.state.speed_mps) = (x_m, speed_mps);
    ego.prediction = constant_velocity(&ego.state, HORIZON, STEP_S).into();
    crossed(vehicles)
}

fn crossed(vehicles: Vec<Vehicle>) -> (bool, f64) {
    let run = sound(run(vehicles, 70));
    let ego = run.first(0, |state| state.x_m > 0.0).expect("the ego crosses");
    let other = run.first(1, |state| state.y_m > 0.185).expect("the other crosses");
    let slowest = run.states.iter().map(|states| states[0].speed_mps).fold(f64::INFINITY, f64::min);
    (ego < other, slowest)
}

#[test]
fn at_an_intersection_nice_drivers_yield_to_planners_that_persuade() {
    assert!(crossing_by_persuasion(Nice).0);
    assert!(!crossing_by_persuasion(Tough).0);
    assert!(crossing_by_game(Nice).0);
    assert!(!crossing(conservative(), Nice, 1.965).0);
}

#[test]
fn at_an_intersection_all_planners_yield_to_tough_drivers() {
    for driver in [bayesian(), conservative()] {
        let kind = driver.kind();
        let (first, slowest) = crossing(driver, Tough, 1.965);
        assert!(!first && slowest < 0.69, "{kind}: {slowest}");
    }
    let (first, slowest) = crossing_by_game(Tough);
    assert!(!first && slowest < 0.6, "{slowest}");
}

#[test]
fn a_planner_with_a_mixed_equilibrium_drives_safely() {
    let (form, solution) = (game::GameForm::AsPrinted, game::SolutionConcept::Nash);
    let nash = || Driver::Game(game::Settings { form, solution, ..game::Settings::default() });
    for styles in [[Nice, Nice], [Tough, Nice], [Tough, Tough]] {
        let run = sound(run(lane_change(nash(), styles), 100));
        let mut played = 0;
        for plan in &run.plans {
            let gains = [EGO_TEMPTATION, OTHER_TEMPTATION].map(|temptation| plan.value_of(&temptation));
            assert!(gains.iter().flatten().all(|gain| *gain < 1e-8), "{:?}", plan.diagnostics);
            played += gains.iter().flatten().count();
        }
        assert!(played > 20, "the ego hardly plays: {played}");
    }
}

/// With the bounds on its mean speed satisfied, the other's next belief is what the ego wanted (eq. 8.11): the bounds start from the belief
/// after forgetting, as the update does.
#[test]
fn what_the_ego_expresses_is_what_the_other_believes_next() {
    for expressed_bounds in [ExpressedBounds::OneSided, ExpressedBounds::Interval] {
        let settings = game::Settings { expressed_bounds, ..game::Settings::default() };
        let ego = || Driver::Game(settings);
        let (mut satisfied, mut hit) = (0, 0);
        for vehicles in [ramp_merge(ego(), [Nice, Nice]), lane_change(ego(), [Tough, Nice])] {
            let run = sound(run(vehicles, 80));
            for pair in run.plans.windows(2) {
                let value = |plan: usize, quantity| pair[plan].value_of(&quantity);
                let (Some(intention), Some(slack)) = (value(0, EGO_INTENTION), value(0, EXPRESSION_SLACK)) else {
                    continue;
                };
                let Some(believed) = value(1, EGO_POSTERIOR) else { continue };
                let is_new = |event: &PlanEvent| matches!(event.kind, PlanEventKind::Partner(Some(_)));
                // A new partner has other beliefs.
                if slack > 1e-4 || pair[1].events.iter().any(is_new) {
                    continue;
                }
                satisfied += 1;
                // Between the two plans the vehicles move on by a step, which the bounds do not foresee.
                let [lowest, highest] = wanted_posterior(intention, &settings);
                hit += usize::from(
                    lowest.is_none_or(|lowest| believed >= lowest - 0.02)
                        && highest.is_none_or(|highest| believed <= highest + 0.02),
                );
            }
        }
        assert!(satisfied > 30 && 20 * hit >= 19 * satisfied, "{expressed_bounds:?}: {hit} of {satisfied}");
    }
}

#[test]
fn in_the_corrected_form_the_accident_is_worst_and_intentions_stay_inside_their_bounds() {
    for (vehicles, ticks) in [
        (lane_change(game(), [Tough, Nice]), 80),
        (lane_change(game(), [Tough, Tough]), 80),
        (intersection(crossing_game(), Nice, 1.9), 40),
        (intersection(crossing_game(), Tough, 1.75), 40),
    ] {
        let run = sound(run(vehicles, ticks));
        let played: Vec<_> = run.plans.iter().filter(|plan| plan.value_of(&EGO_INTENTION).is_some()).collect();
        assert!(played.len() > 10);
        for plan in played {
            let value = |quantity| plan.value_of(&quantity).expect("it plays");
            assert!(EGO_PAYOFFS.into_iter().all(|payoff| value(payoff) > value(ACCIDENT_PAYOFF)));
            assert!((0.051..0.95).contains(&value(EGO_INTENTION)), "{}", value(EGO_INTENTION));
        }
    }
}

/// Any vehicle may have any driver.
#[test]
fn two_persuading_planners_can_interact_without_contact() {
    for (ego, front) in [(bayesian(), game()), (game(), bayesian()), (bayesian(), negotiator()), (game(), game())] {
        let mut vehicles = lane_change(ego.clone(), [Nice, Nice]);
        vehicles[1].drive(front.clone());
        let run = run(vehicles, 80);
        assert!(run.collision.is_none(), "{} and {}: {:?}", ego.kind(), front.kind(), run.collision);
        assert!(run.failures.len() <= 2, "{} and {}: {:?}", ego.kind(), front.kind(), run.failures);
    }
}

/// Every planner reports what it declares, nothing else, and values that are possible.
#[test]
fn plans_explain_themselves() {
    let cooperative = Driver::Cooperative(cooperative::Settings::default());
    for driver in [conservative(), negotiator(), bayesian(), game(), cooperative, idm(), human(Nice)] {
        let (kind, explanation) = (driver.kind(), driver.explanation());
        let mut vehicles = lane_change(driver.clone(), [Nice, Nice]);
        if kind == "cooperative" {
            vehicles[1].drive(driver);
        }
        // Long enough for a driver after the model to meet a vehicle ahead.
        let run = sound(run(vehicles, if kind == "idm" { 100 } else { 40 }));
        for Diagnostic { quantity, value } in run.plans.iter().flat_map(|plan| &plan.diagnostics) {
            let declared = explanation.quantities.contains(quantity) || COMMON_QUANTITIES.contains(quantity);
            assert!(declared, "{kind} does not declare {quantity:?}");
            assert!(quantity.values.contains(*value), "{kind}: {value} of {quantity:?}");
        }
        let unseen: Vec<&str> =
            explanation.quantities.iter().filter(|of| !is_reported(&run, of)).map(|of| of.name).collect();
        assert!(unseen.is_empty(), "{kind} never reports {unseen:?}");
        let optimises = !["idm", "human"].contains(&kind);
        // A runner-up exists only where a vehicle is in the way.
        let always = || COMMON_QUANTITIES.iter().filter(|of| **of != RUNNER_UP_COST);
        assert!(always().all(|of| is_reported(&run, of) == optimises), "{kind}");
    }
}

fn is_reported(run: &Run, quantity: &DiagnosticQuantity) -> bool {
    run.plans.iter().any(|plan| plan.value_of(quantity).is_some())
}

/// What a declaration of diagnostics must keep to, so that recordings and figures can show them.
#[test]
fn declarations_of_planner_diagnostics_are_valid() {
    let human = human(Nice);
    for driver in [conservative(), negotiator(), bayesian(), game(), idm(), human] {
        let (kind, Explanation { quantities, panels, plots, .. }) = (driver.kind(), driver.explanation());
        let mut names: Vec<&str> = quantities.iter().chain(COMMON_QUANTITIES).map(|quantity| quantity.name).collect();
        names.sort_unstable();
        assert!(names.windows(2).all(|pair| pair[0] != pair[1]), "{kind}: {names:?}");
        for quantity in panels.iter().chain(*plots).flat_map(|panel| panel.quantities) {
            assert!(quantities.contains(quantity), "{kind} shows {} and does not declare it", quantity.name);
        }
        for plot in *plots {
            let mut units = plot.quantities.iter().map(|quantity| quantity.unit);
            let first = units.next().expect("a plot has a curve");
            assert!(units.all(|unit| unit == first), "{kind}: units of {}", plot.title);
        }
    }
}

/// Every planner reports which vehicle its plans pass ahead of or behind; the last report comes true, and an event states it.
#[test]
fn plans_say_in_which_order_they_pass() {
    for (ego, style) in egos().into_iter().flat_map(|ego| [(ego.clone(), Nice), (ego, Tough)]) {
        let name = format!("{} before a {style:?} driver", ego.kind());
        let run = sound(run(intersection(ego, style, 1.965), 60));
        let last = run.plans.iter().rev().find_map(|plan| plan.homotopy_class.first()).expect("an order");
        let [own, other] = [run.first(0, |at| at.x_m > 0.0), run.first(1, |at| at.y_m > LANES[0])];
        let goes_first = own.expect("the ego crosses") < other.expect("the other crosses");
        let happened = if goes_first { PassingSide::Ahead } else { PassingSide::Behind };
        assert_eq!((last.of.as_str(), last.side), ("crossing", happened), "{name}");
        let mut events = run.plans.iter().flat_map(|plan| &plan.events);
        assert!(events.any(|event| event.kind == PlanEventKind::Passing(last.clone())), "{name}: no event");
    }
}
