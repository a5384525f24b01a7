//! The hot loop allocates nothing once its buffers have their size: expanding a problem, its cost, and solving QP subproblems.

mod common;

use common::{SplitMix64, alone, iterate, pair};
use interplay_planners::trajectory::{Problem, QpSubproblem, StageSolution, StageSolver, Structured};

/// Steps of one descent, as the sequential method takes them.
fn steps(problem: &Problem, seed: u64) -> u64 {
    let at = iterate(problem, &mut SplitMix64::new(seed));
    let (mut solver, mut step, mut solution) =
        (Structured::default(), QpSubproblem::default(), StageSolution::default());
    let mut round = || {
        assert!(problem.cost(&at).total.is_finite());
        step.linearize(problem, &at);
        solver.solve(&step.qp, &mut solution, false).expect("a Gauss-Newton step");
        step.use_lagrangian(problem, &at, &mut solution);
        step.use_gauss_newton();
        solver.solve(&step.qp, &mut solution, true).expect("a warm step");
    };
    round();
    allocation_counter::measure(round).count_total
}

#[test]
fn optimiser_steps_after_the_first_allocate_no_memory() {
    for seed in 0..10 {
        assert_eq!(steps(&alone(seed), seed), 0, "one vehicle, seed {seed}");
        assert_eq!(steps(&pair(seed, 1.5), seed), 0, "two vehicles, seed {seed}");
    }
}
