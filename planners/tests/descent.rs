//! The sequential method as a whole: descent, optimality, and agreement with a method that shares no step solver.

mod common;

use common::{Random, alone, iterate, pair};
use interplay_planners::Input;
use interplay_planners::trajectory::{Optimiser, Problem, Sparse, Structured};

const SEEDS: u64 = 60;

fn at_rest(problem: &Problem) -> Vec<Vec<Input>> {
    vec![vec![Input::default(); problem.horizon]; problem.participants.len()]
}

fn problems() -> impl Iterator<Item = (u64, Problem)> {
    (0..SEEDS).flat_map(|seed| [(seed, alone(seed)), (seed, pair(seed, 1.0 + 0.02 * seed as f64))])
}

/// Random starts on top of others are harder than anything met on a road: some descents give up, but say so.
#[test]
fn descents_end_at_points_that_satisfy_the_optimality_conditions() {
    let (mut solved, mut given_up) = (0, Vec::new());
    for (seed, problem) in problems() {
        match Optimiser::new(Structured::default()).descend(&problem, &at_rest(&problem)) {
            Ok(optimum) => {
                let residual = optimum.statistics.residual;
                assert!(residual <= 1e-4, "seed {seed}: residual {residual:.1e}");
                solved += 1;
            }
            Err(error) => given_up.push(format!("seed {seed}, {} vehicles: {error}", problem.participants.len())),
        }
    }
    assert!(given_up.len() * 8 <= solved, "{given_up:#?}");
}

#[test]
fn an_optimum_costs_no_more_than_its_guess() {
    for (seed, problem) in problems() {
        let guess = iterate(&problem, &mut Random(seed + 7));
        let before = problem.cost(&guess).total;
        let Ok(optimum) = Optimiser::new(Structured::default()).descend(&problem, &guess.inputs) else { continue };
        assert!(optimum.cost.total <= before, "seed {seed}: {} from {before}", optimum.cost.total);
    }
}

/// Gauss-Newton steps of the general solver, started where the structured one ended, find nothing notably cheaper (they
/// may jump to another optimum nearby).
#[test]
fn the_general_solver_does_not_improve_an_optimum() {
    for (seed, problem) in problems().filter(|(seed, _)| seed % 4 == 0) {
        let Ok(ours) = Optimiser::new(Structured::default()).descend(&problem, &at_rest(&problem)) else { continue };
        let Ok(theirs) = Optimiser::new(Sparse::default()).descend(&problem, &ours.iterate.inputs) else { continue };
        let gained = (ours.cost.total - theirs.cost.total) / (1.0 + ours.cost.total);
        assert!(gained <= 1e-4, "seed {seed}: {} improved to {}", ours.cost.total, theirs.cost.total);
    }
}
