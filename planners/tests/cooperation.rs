//! Vehicles that share one problem: the same solution whichever vehicle solves it, Pareto optimal, and driven to the end.

mod common;

use common::world::{HORIZON, LANES, STEP_S, Vehicle, run, vehicle};
use interplay_planners::drivers::cooperative::diagnostics::{COOPERATING_VEHICLES, OWN_COST};
use interplay_planners::drivers::cooperative::{self, cooperators};
use interplay_planners::drivers::human::Style;
use interplay_planners::plan::diagnostic::{COST, DiagnosticQuantity, SAFETY_SLACK};
use interplay_planners::problem::{JointVehicle, joint_problem};
use interplay_planners::scene::Knowledge;
use interplay_planners::trajectory::{Optimiser, Problem, Robust, Term};
use interplay_planners::{Driver, Plan, Planner, Scene};

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
    vehicles[1].drive(common::world::human(Style::Tough));
    let run = run(vehicles, 60);
    assert!(run.collision.is_none() && run.failures.is_empty(), "{:?} {:?}", run.collision, run.failures);
    assert!(run.nearest > 0.99, "{}", run.nearest);
}
