//! Vehicles that share one problem: the same solution whichever vehicle solves it, Pareto optimal, and driven to the end.

mod common;

use common::world::{
    self, HORIZON, LANES, STEP_S, Vehicle, begin, intersection, lane_change, lane_keeping, run, run_inferring, vehicle,
};
use interplay_planners::drivers::contingency::diagnostics::FUTURES;
use interplay_planners::drivers::contingency::{futures, shared_steps};
use interplay_planners::drivers::cooperative::diagnostics::{COOPERATING_VEHICLES, OWN_COST};
use interplay_planners::drivers::cooperative::{self, cooperators};
use interplay_planners::drivers::human::Style::{Nice, Tough};
use interplay_planners::drivers::negotiation::diagnostics::ACCEPTANCE;
use interplay_planners::drivers::{conservative, contingency, negotiation};
use interplay_planners::perception::belief::{self, DriverBeliefs};
use interplay_planners::perception::sensing::SensedScene;
use interplay_planners::plan::diagnostic::{COST, DiagnosticQuantity, SAFETY_SLACK};
use interplay_planners::problem::{JointVehicle, joint_problem};
use interplay_planners::scene::Knowledge;
use interplay_planners::scene::inferred_futures::{Alternative, InferredFutures};
use interplay_planners::trajectory::{Optimiser, Problem, Robust, Term};
use interplay_planners::{Driver, Plan, Planner, Proposal, SafetyEllipse, Scene, State};

fn cooperative(normaliser: f64) -> Driver {
    Driver::Cooperative(cooperative::Settings { normaliser, ..cooperative::Settings::default() })
}

/// `count` vehicles in both lanes; the first wants into the lane of the others.
fn convoy(count: usize) -> Vec<Vehicle> {
    let merging = vehicle("a", [0.0, LANES[0], 1.0], [LANES[1], 1.0], [0.0, 1.0, 0.5, 1.0], cooperative(1.0));
    let driving = (1..count).map(|i| {
        let start = [0.35 - 0.95 * i as f64, LANES[1], 1.2];
        vehicle(["b", "c", "d", "e"][i - 1], start, [LANES[1], 1.2], [0.0, 4.0, 1.0, 1.0], cooperative(1.0))
    });
    std::iter::once(merging).chain(driving).collect()
}

/// The moment as vehicle `index` sees it.
fn scene(vehicles: &[Vehicle], index: usize) -> Scene {
    let told = |vehicle: &Vehicle| {
        let mut agent = vehicle.agent.clone();
        agent.shared_goal = vehicle.driver.shared_goal(&vehicle.goal);
        agent
    };
    let others = vehicles.iter().enumerate().filter(|(other, _)| *other != index);
    Scene {
        tick: 0,
        step_s: STEP_S,
        horizon: HORIZON,
        knowledge: Knowledge::Plans,
        ego: told(&vehicles[index]),
        goal: vehicles[index].goal,
        others: others.map(|(_, other)| told(other)).collect(),
    }
}

fn number(plan: &Plan, what: DiagnosticQuantity) -> f64 {
    plan.value_of(&what).expect("reported")
}

#[test]
fn all_vehicles_find_the_same_solution() {
    for count in [2, 3] {
        let vehicles = convoy(count);
        let plans: Vec<Plan> = (0..count)
            .map(|index| {
                let mut planner: Planner = vehicles[index].driver.planner();
                planner.plan(&scene(&vehicles, index)).expect("a plan")
            })
            .collect();
        let joint: Vec<u64> = plans.iter().map(|plan| number(plan, COST).to_bits()).collect();
        assert!(joint.windows(2).all(|pair| pair[0] == pair[1]), "{joint:?}");
        if let [a, b] = plans.as_slice() {
            assert_eq!(a.proposals.first().map(|proposal| &proposal.trajectory), Some(&b.trajectory));
            assert_eq!(b.proposals.first().map(|proposal| &proposal.trajectory), Some(&a.trajectory));
        }
        assert!(plans.iter().all(|plan| plan.proposals.len() == count - 1));
        let own: f64 = plans.iter().map(|plan| number(plan, OWN_COST)).sum();
        assert!((own - number(&plans[0], COST)).abs() < 1e-6, "costs add up but for the pairs' penalties");
    }
}

/// The cost of each of two vehicles at the joint optimum for weights `1/Z`, all from one guess.
fn costs(normalisers: [f64; 2], guess: &Problem) -> ([f64; 2], Problem) {
    let mut weighted = guess.clone();
    for term in &mut weighted.terms {
        match term {
            Term::Tracking(term) => term.weights = term.weights.map(|q| q / normalisers[term.vehicle]),
            Term::Comfort(term) => term.weights = term.weights.map(|r| r / normalisers[term.vehicle]),
            _ => {}
        }
    }
    let start = vec![Vec::new(), Vec::new()];
    let optimum = Optimiser::new(Robust::default()).descend(&weighted, &start).expect("an optimum");
    let own = [0, 1].map(|vehicle| guess.own_cost(vehicle, &optimum.iterate));
    (own, weighted)
}

/// At other weights no vehicle is better off without another being worse off.
#[test]
fn solutions_are_pareto_optimal() {
    let vehicles = convoy(2);
    let goals = cooperators(&scene(&vehicles, 0), vehicles[0].goal);
    let posed = joint_problem(&scene(&vehicles, 0), &goals);
    let normalisers = [0.2, 0.4, 0.7, 1.0, 1.5, 2.5, 5.0];
    let front: Vec<[f64; 2]> = normalisers.map(|z| costs([z, 1.0], &posed).0).into();
    assert!(front.iter().any(|point| (point[0] - front[0][0]).abs() > 1e-3), "weights change nothing: {front:?}");
    for (z, point) in normalisers.iter().zip(&front) {
        let weighted = |p: &[f64; 2]| p[0] / z + p[1];
        for other in &front {
            assert!(weighted(point) <= weighted(other) + 1e-6, "{point:?} at {z} is worse than {other:?}");
        }
    }
    // The dearer the first vehicle's cost, the lower it is, and the higher the other's.
    for pair in front.windows(2) {
        assert!(pair[0][0] <= pair[1][0] + 1e-6 && pair[0][1] >= pair[1][1] - 1e-6, "{front:?}");
    }
}

#[test]
fn all_vehicles_agree_on_the_list_of_cooperators() {
    let vehicles = convoy(3);
    let lists: Vec<Vec<JointVehicle>> = (0..3).map(|i| cooperators(&scene(&vehicles, i), vehicles[i].goal)).collect();
    assert!(lists.windows(2).all(|pair| pair[0] == pair[1]));
    let problems: Vec<Problem> = (0..3).map(|i| joint_problem(&scene(&vehicles, i), &lists[i])).collect();
    assert!(problems.windows(2).all(|pair| pair[0] == pair[1]));
    let separations = problems[0].terms.iter().filter(|term| matches!(term, Term::Separation(_))).count();
    assert_eq!((problems[0].participants.len(), separations), (3, 3));
}

#[test]
fn a_cooperative_merge_is_driven_as_agreed() {
    for count in [2, 3, 4] {
        let run = run(convoy(count), 60);
        assert!(run.collision.is_none(), "{count}: {:?}", run.collision);
        assert!(run.failures.is_empty(), "{count}: {:?}", run.failures);
        assert!(run.nearest > 0.999, "{count}: {}", run.nearest);
        let (_, merged_s) = run.merged().expect("the first vehicle merges");
        assert!(merged_s < 3.0, "{count}: after {merged_s} s");
    }
}

/// More than the structured solver takes: the general one takes over.
#[test]
fn five_cooperating_vehicles_share_one_problem() {
    let vehicles = convoy(5);
    let plan = vehicles[0].driver.planner().plan(&scene(&vehicles, 0)).expect("a plan");
    assert_eq!(number(&plan, COOPERATING_VEHICLES), 5.0);
    assert!(number(&plan, SAFETY_SLACK) < 1e-3);
}

/// A human between cooperating vehicles is an obstacle to both.
#[test]
fn cooperating_vehicles_avoid_other_drivers() {
    let mut vehicles = convoy(3);
    vehicles[1].drive(world::human(Tough));
    let run = run(vehicles, 60);
    assert!(run.collision.is_none() && run.failures.is_empty(), "{:?} {:?}", run.collision, run.failures);
    assert!(run.nearest > 0.99, "{}", run.nearest);
}

fn negotiator(partners_at_most: usize) -> Driver {
    Driver::Negotiation(negotiation::Settings { partners_at_most, ..negotiation::Settings::default() })
}

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

const TICKS: usize = 70;

fn settings(probability_at_least: f64) -> contingency::Settings {
    contingency::Settings { probability_at_least, ..contingency::Settings::default() }
}

fn contingency(probability_at_least: f64) -> Driver {
    Driver::Contingency(settings(probability_at_least))
}

/// The scenes that the ego infers in closed loop, with what the others may do, and its plans.
fn seen(vehicles: &[Vehicle]) -> Vec<(Scene, InferredFutures, Plan)> {
    let (mut traffic, mut planners) = begin(vehicles);
    let mut beliefs = DriverBeliefs::new(belief::Settings::default());
    let mut seen = Vec::new();
    for _ in 0..30 {
        traffic.drive(|index, scene| {
            let plan = planners[index].plan(scene);
            if index == 0 {
                let sensed = SensedScene::perfect(scene);
                let inferred = beliefs.infer(&sensed).scene;
                let alternatives = beliefs.alternatives(&sensed, &inferred);
                let plan = plan.clone().expect("a plan");
                seen.push((inferred, InferredFutures { alternatives, ..InferredFutures::default() }, plan));
            }
            plan
        });
    }
    seen
}

#[test]
fn without_alternatives_the_contingency_problem_is_the_conservative_one() {
    for (scene, ..) in seen(&lane_keeping(contingency(0.05), Tough)) {
        let one = futures(&scene, &[], &settings(0.05));
        let others: Vec<_> = scene.others.iter().collect();
        assert_eq!(contingency::problem(&scene, &one, 0), conservative::problem(&scene, &others));
    }
}

/// The plan, by geometry of its own: in every future the ego is outside of the ellipses around the motions of that future, and all
/// branches begin alike.
#[test]
fn every_branch_stays_outside_the_safety_ellipses_of_its_future() {
    let mut several = 0;
    for (scene, inferred_futures, plan) in seen(&lane_keeping(contingency(0.05), Tough)) {
        let problem = plan.problem.as_ref().expect("a problem");
        let found = futures(&scene, &inferred_futures.alternatives, &settings(0.05));
        assert_eq!(found.len(), problem.participants.len());
        assert_eq!(plan.branches.len() + 1, found.len());
        assert_eq!(shared_steps(&found, 0.05, 0, scene.horizon), problem.shared_steps);
        several += usize::from(found.len() > 1);
        for branch in &plan.branches {
            assert_eq!(
                branch.trajectory.inputs[..problem.shared_steps],
                plan.trajectory.inputs[..problem.shared_steps]
            );
        }
        // Probabilities match branches to futures; the plan itself is the branch of the likeliest one.
        let mut rest = plan.branches.iter();
        let likeliest = found.iter().map(|future| future.probability).fold(0.0, f64::max);
        let mut is_taken = false;
        for future in &found {
            let own = future.probability == likeliest && !std::mem::replace(&mut is_taken, true);
            let motion = if own { &plan.trajectory } else { &rest.next().expect("a branch").trajectory };
            for prediction in &future.predictions {
                for (ours, theirs) in motion.states.iter().zip(&prediction.states).skip(1) {
                    let ellipse = scene.goal.safety.oriented(0.0);
                    let distance = ellipse.distance(ours.position(), theirs.position());
                    assert!(distance.squared > 1.0 - 1e-3, "{ours:?} in the ellipse around {theirs:?}");
                }
            }
        }
    }
    assert!(several > 1, "{several} plans have branches");
}

/// A plan for the likeliest driver alone counts on being let in and must brake harder when it learns better; the one with branches
/// has waited for what it would soon know.
#[test]
fn a_branch_for_the_unlikely_driver_saves_hard_braking() {
    let peak = |probability_at_least: f64| {
        let vehicles = lane_keeping(contingency(probability_at_least), Tough);
        let run = run_inferring(vehicles, TICKS, &belief::Settings::default(), None);
        assert_eq!(run.collision, None);
        let speeds: Vec<f64> = run.states.iter().map(|states| states[0].speed_mps).collect();
        speeds.windows(2).map(|pair| (pair[0] - pair[1]) / STEP_S).fold(0.0, f64::max)
    };
    let (branching, likeliest) = (peak(0.05), peak(1.0));
    assert!(branching < 0.8 * likeliest, "{branching} against {likeliest} m/s²");
}

#[test]
fn an_unlikely_driver_that_is_recognised_at_once_has_its_own_branch() {
    let (scene, inferred_futures, plan) = seen(&lane_keeping(contingency(0.05), Nice)).swap_remove(0);
    let mass = |known: &[Alternative]| known.iter().map(|one| one.probability).sum::<f64>();
    assert!(inferred_futures.alternatives.iter().all(|known| (mass(known) - 1.0).abs() < 1e-12));
    assert_eq!(
        plan.value_of(&FUTURES),
        Some(futures(&scene, &inferred_futures.alternatives, &settings(0.05)).len() as f64)
    );
}
