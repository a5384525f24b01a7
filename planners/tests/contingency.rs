//! Plans that branch: what they are without branches, what each branch keeps, and what the branches are good for.

mod common;

use common::world::{self, Vehicle, lane_keeping, run_inferring};
use interplay_planners::drivers::conservative;
use interplay_planners::drivers::contingency::diagnostics::FUTURES;
use interplay_planners::drivers::contingency::{self, futures, shared_steps};
use interplay_planners::drivers::human::Style;
use interplay_planners::perception::belief::{self, DriverBeliefs};
use interplay_planners::perception::sensing::SensedScene;
use interplay_planners::scene::inferred_futures::{Alternative, InferredFutures};
use interplay_planners::{Driver, Plan, Scene};

const TICKS: usize = 70;

fn settings(probability_at_least: f64) -> contingency::Settings {
    contingency::Settings { probability_at_least, ..contingency::Settings::default() }
}

fn contingency(probability_at_least: f64) -> Driver {
    Driver::Contingency(settings(probability_at_least))
}

/// The scenes that the ego infers in closed loop, with what the others may do, and its plans.
fn seen(vehicles: &[Vehicle]) -> Vec<(Scene, InferredFutures, Plan)> {
    let (mut traffic, mut planners) = world::begin(vehicles);
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
    for (scene, ..) in seen(&lane_keeping(contingency(0.05), Style::Tough)) {
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
    for (scene, inferred_futures, plan) in seen(&lane_keeping(contingency(0.05), Style::Tough)) {
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
        // Whose branch is whose is known by the probabilities; the likeliest future has the plan itself.
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
        let vehicles = lane_keeping(contingency(probability_at_least), Style::Tough);
        let run = run_inferring(vehicles, TICKS, &belief::Settings::default(), None);
        assert_eq!(run.collision, None);
        let speeds: Vec<f64> = run.states.iter().map(|states| states[0].speed_mps).collect();
        speeds.windows(2).map(|pair| (pair[0] - pair[1]) / world::STEP_S).fold(0.0, f64::max)
    };
    let (branching, likeliest) = (peak(0.05), peak(1.0));
    assert!(branching < 0.8 * likeliest, "{branching} against {likeliest} m/s²");
}

#[test]
fn an_unlikely_driver_that_is_recognised_at_once_has_its_own_branch() {
    let (scene, inferred_futures, plan) = seen(&lane_keeping(contingency(0.05), Style::Nice)).swap_remove(0);
    let mass = |known: &[Alternative]| known.iter().map(|one| one.probability).sum::<f64>();
    assert!(inferred_futures.alternatives.iter().all(|known| (mass(known) - 1.0).abs() < 1e-12));
    assert_eq!(
        plan.value_of(&FUTURES),
        Some(futures(&scene, &inferred_futures.alternatives, &settings(0.05)).len() as f64)
    );
}
