//! Negotiation with several vehicles at once.

mod common;

use common::world::{Vehicle, begin, intersection, lane_change, run};
use interplay_planners::drivers::human::Style::{Nice, Tough};
use interplay_planners::drivers::negotiation;
use interplay_planners::drivers::negotiation::diagnostics::ACCEPTANCE;
use interplay_planners::{Driver, Plan, Proposal, SafetyEllipse, State};

fn negotiator(partners_at_most: usize) -> Driver {
    Driver::Negotiation(negotiation::Settings { partners_at_most, ..negotiation::Settings::default() })
}

/// The ego's first plan.
fn first_plan(vehicles: &[Vehicle]) -> Plan {
    let (traffic, mut planners) = begin(vehicles);
    planners[0].plan(&traffic.scene(0)).expect("a plan")
}

fn names(proposals: &[Proposal]) -> Vec<&str> {
    proposals.iter().map(|proposal| proposal.to.as_str()).collect()
}

/// The smallest squared elliptical distance of two motions along x, the present state left out.
fn nearest(a: &[State], b: &[State]) -> f64 {
    let ellipse = SafetyEllipse::default().oriented(0.0);
    let distances = a.iter().zip(b).skip(1).map(|(a, b)| ellipse.distance(a.position(), b.position()).squared);
    distances.fold(f64::INFINITY, f64::min)
}

/// Both are asked for motions that leave room for the ego and for one another, in one problem.
#[test]
fn a_negotiator_asks_two_vehicles_at_once_and_keeps_them_apart() {
    assert_eq!(names(&first_plan(&lane_change(negotiator(1), [Nice, Nice])).proposals), ["front"]);
    let plan = first_plan(&lane_change(negotiator(2), [Nice, Nice]));
    assert_eq!(names(&plan.proposals), ["front", "rear"]);
    let [front, rear] = [0, 1].map(|index| &plan.proposals[index].trajectory.states);
    for other in [front, rear] {
        assert!(nearest(&plan.trajectory.states, other) > 1.0 - 2e-3);
    }
    // The humans of this lane plan to follow at less than the ellipse's half axis or more; they are asked for no less than that.
    let vehicles = lane_change(negotiator(2), [Nice, Nice]);
    let (traffic, _) = begin(&vehicles);
    let scene = traffic.scene(0);
    let planned = nearest(&scene.others[0].prediction.states, &scene.others[1].prediction.states).min(1.0);
    assert!(nearest(front, rear) > planned - 2e-3, "{} of {planned}", nearest(front, rear));
}

/// What one vehicle is asked for while the other goes on as it plans is one of the motions that are compared when both are asked.
#[test]
fn asking_two_vehicles_costs_no_more_than_asking_one() {
    for styles in [[Nice, Nice], [Nice, Tough], [Tough, Nice]] {
        let vehicles = lane_change(negotiator(2), styles);
        let (both, one) = (first_plan(&vehicles), first_plan(&lane_change(negotiator(1), styles)));
        let rear = begin(&vehicles).0.scene(0).others[1].prediction.inputs.clone();
        let asked = one.proposals[0].trajectory.inputs.clone();
        let problem = both.problem.as_ref().expect("a problem");
        let motions = |front: Vec<_>, rear: Vec<_>, plan: &Plan| vec![plan.trajectory.inputs.clone(), front, rear];
        let joint = both.proposals.iter().map(|proposal| proposal.trajectory.inputs.clone()).collect::<Vec<_>>();
        let optimum = problem.cost_of(&motions(joint[0].clone(), joint[1].clone(), &both));
        let alone = problem.cost_of(&motions(asked, rear, &one));
        assert!(optimum <= alone + 1e-6 * (1.0 + alone), "{styles:?}: {optimum} and {alone}");
    }
}

/// Each is believed to accept what it accepts itself, and the planner reports the one that accepts least.
#[test]
fn each_asked_vehicle_has_its_own_acceptance() {
    let plans = run(lane_change(negotiator(2), [Nice, Tough]), 15).plans;
    let both: Vec<[f64; 2]> = plans
        .iter()
        .filter(|plan| names(&plan.proposals) == ["front", "rear"])
        .map(|plan| [0, 1].map(|index| plan.proposals[index].acceptance.expect("an answer")))
        .collect();
    assert!(both.iter().any(|[front, rear]| (front - rear).abs() > 0.1), "{both:?}");
    for plan in plans.iter().filter(|plan| !plan.proposals.is_empty()) {
        let least = plan.proposals.iter().filter_map(|proposal| proposal.acceptance).fold(1.0, f64::min);
        let told = plan.diagnostics.iter().find(|diagnostic| diagnostic.quantity == ACCEPTANCE).expect("told");
        assert_eq!(told.value, least);
    }
}

/// With one other vehicle it does not matter how many may be asked.
#[test]
fn a_limit_on_partners_changes_nothing_with_one_other_vehicle() {
    for style in [Nice, Tough] {
        let plans = [1, 3].map(|most| run(intersection(negotiator(most), style, 1.965), 40).plans);
        assert_eq!(plans[0], plans[1]);
    }
}

/// In the closed loop no plan fails and no vehicles touch.
#[test]
fn no_plan_fails_and_no_vehicles_touch() {
    for styles in [[Nice, Nice], [Nice, Tough], [Tough, Nice], [Tough, Tough]] {
        let run = run(lane_change(negotiator(2), styles), 80);
        assert!(run.collision.is_none() && run.failures.is_empty(), "{styles:?}: {:?}", run.collision);
    }
}
