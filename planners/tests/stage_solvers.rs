//! The structured solver against the general one, and both against the optimality conditions.

mod common;

use common::{SplitMix64, alone, futures, iterate, pair};
use interplay_planners::trajectory::kkt::Residual;
use interplay_planners::trajectory::{Problem, Sparse, StageQp, StageSolution, StageSolver, Structured, kkt};

fn qp_subproblem(problem: &Problem, seed: u64) -> StageQp {
    common::qp_subproblem(problem, &iterate(problem, &mut SplitMix64::new(seed)))
}

fn compare(problem: &Problem, seed: u64) {
    let qp = qp_subproblem(problem, seed);
    let (mut structured, mut sparse) = (StageSolution::default(), StageSolution::default());
    Structured::default().solve(&qp, &mut structured, false).expect("structured");
    Sparse::default().solve(&qp, &mut sparse, false).expect("sparse");
    let (ours, theirs) = (qp.change(&structured), qp.change(&sparse));
    assert!((ours - theirs).abs() <= 1e-6 * (1.0 + theirs.abs()), "seed {seed}: {ours} against {theirs}");
    let residual = kkt::residual(&qp, &structured);
    // Multipliers reach 1e3 here, and rounding stops a few problems at a complementarity of 1e-8.
    assert!(residual.largest() < 3e-5, "seed {seed}: {residual:?}");
    let residual = kkt::residual(&qp, &sparse);
    assert!(is_optimal_for_oracle(&residual, problem), "seed {seed}, sparse: {residual:?}");
}

/// Whether the general solver's solution satisfies the optimality conditions as well as it can: Clarabel scales the problem,
/// so with multipliers of up to 1e3 (1e2 of them of rows over whole trajectories, each of which adds up 30 steps) its
/// tolerance of 1e-8 means less here. The largest residuals in 300 problems are half of these bounds.
fn is_optimal_for_oracle(residual: &Residual, problem: &Problem) -> bool {
    let stationarity = if problem.participants.len() == 1 { 1e-5 } else { 1e-2 };
    residual.stationarity < stationarity
        && residual.primal < 1e-6
        && residual.dual < 1e-6
        && residual.complementarity < 1e-3
}

/// The bounds are narrow enough to tell a solution from one that is a little off.
#[test]
fn a_slightly_wrong_solution_is_not_accepted_as_optimum() {
    for (seed, problem) in (0..20).flat_map(|seed| [(seed, alone(seed)), (seed, pair(seed, 1.0 + 0.01 * seed as f64))])
    {
        let qp = qp_subproblem(&problem, seed);
        let mut solution = StageSolution::default();
        Sparse::default().solve(&qp, &mut solution, false).expect("sparse");
        solution.inputs[0][10][0] += 1e-3;
        let residual = kkt::residual(&qp, &solution);
        let vehicles = problem.participants.len();
        assert!(!is_optimal_for_oracle(&residual, &problem), "seed {seed}, {vehicles} vehicles: {residual:?}");
    }
}

/// By how much a condition is broken.
const OFF: f64 = 1e-2;
/// Of two opposite bounds on steering at least one is this far away \[rad\].
const FAR: f64 = 0.1;

/// What is wrong, how it is brought about, and the residual that must show it.
type Broken = (&'static str, fn(&mut StageSolution), fn(&Residual) -> f64);

const BROKEN: [Broken; 12] = [
    ("a state that the dynamics do not lead to", |solution| solution.states[0][5][0] += OFF, |found| found.primal),
    ("an input of its own where it is shared", |solution| solution.inputs[1][0][1] += OFF, |found| found.stationarity),
    ("a bound that pulls", |solution| solution.bound_multipliers[0][3][0] = [-OFF; 2], |found| found.dual),
    ("a row that pulls", |solution| solution.row_multipliers[0].fill(-OFF), |found| found.dual),
    (
        "bounds on both sides that push",
        |solution| solution.bound_multipliers[0][3][1] = [OFF; 2],
        |found| found.complementarity / FAR,
    ),
    (
        "a bound at the first stage that pulls",
        |solution| solution.bound_multipliers[0][0][0] = [-OFF; 2],
        |found| found.dual,
    ),
    (
        "an acceleration that is pushed",
        |solution| solution.bound_multipliers[0][3][0][0] += OFF,
        |found| found.stationarity,
    ),
    ("a steering that is pushed", |solution| solution.bound_multipliers[0][3][1][1] += OFF, |found| found.stationarity),
    (
        "a first input that is pushed",
        |solution| solution.bound_multipliers[0][0][0][0] += OFF,
        |found| found.stationarity,
    ),
    (
        "an input that is shared and pushed a little in each future",
        |solution| (0..2).for_each(|future| solution.bound_multipliers[future][0][0][0] += 0.5 * OFF),
        |found| found.stationarity,
    ),
    (
        "a steering that is shared and pushed a little in each future",
        |solution| (0..2).for_each(|future| solution.bound_multipliers[future][0][1][1] += 0.5 * OFF),
        |found| found.stationarity,
    ),
    ("a row that pulls over a trajectory", |solution| solution.trajectory_multipliers.fill(-OFF), |found| found.dual),
];

/// Each optimality condition is checked by itself: a solution that breaks one of them by a known amount has at least that residual.
#[test]
fn each_violated_optimality_condition_has_a_residual() {
    for (what, break_it, of) in BROKEN {
        for seed in 0..10 {
            let problem = if what.contains("shared") { futures(seed, 2, 5) } else { pair(seed, 1.2) };
            let qp = qp_subproblem(&problem, seed);
            let mut solution = StageSolution::default();
            Structured::default().solve(&qp, &mut solution, false).expect("solved");
            assert!(kkt::residual(&qp, &solution).largest() < 3e-5);
            break_it(&mut solution);
            let residual = kkt::residual(&qp, &solution);
            assert!(of(&residual) >= OFF - 1e-4, "{what}, seed {seed}: {residual:?}");
            let all = [residual.stationarity, residual.primal, residual.dual, residual.complementarity];
            assert_eq!(residual.largest(), all.into_iter().fold(0.0, f64::max), "{what}");
        }
    }
}

/// Damping belongs to the problem: its solution is none of the problem without.
#[test]
fn optimality_conditions_include_the_damping() {
    for seed in 0..10 {
        let mut qp = qp_subproblem(&pair(seed, 1.2), seed);
        qp.damping = 3.0;
        let mut solution = StageSolution::default();
        Structured::default().solve(&qp, &mut solution, false).expect("solved");
        assert!(kkt::residual(&qp, &solution).largest() < 3e-5, "seed {seed}");
        qp.damping = 0.0;
        assert!(kkt::residual(&qp, &solution).stationarity > 1e-3, "seed {seed}");
    }
}

/// The curvature of the dynamics pushes the steering, and nothing else: a bound that pushes back as much makes up for it.
#[test]
fn optimality_conditions_include_the_curvature_of_the_dynamics() {
    for seed in 0..10 {
        let mut qp = qp_subproblem(&pair(seed, 1.2), seed);
        let mut solution = StageSolution::default();
        Structured::default().solve(&qp, &mut solution, false).expect("solved");
        let steering_rad = |k: &usize| solution.inputs[0][*k][1];
        let sharpest = (0..qp.horizon).max_by(|a, b| steering_rad(a).abs().total_cmp(&steering_rad(b).abs()));
        let k = sharpest.expect("it has steps");
        qp.vehicles[0].curvatures[k].steering_steering = OFF / steering_rad(&k);
        assert!((kkt::residual(&qp, &solution).stationarity - OFF).abs() < 1e-4, "seed {seed}");
        solution.bound_multipliers[0][k][1][0] += OFF;
        assert!(kkt::residual(&qp, &solution).stationarity < 3e-5, "seed {seed}");
    }
}

#[test]
fn one_vehicle() {
    for seed in 0..200 {
        compare(&alone(seed), seed);
    }
}

#[test]
fn two_vehicles_with_persuasion() {
    for seed in 0..100 {
        compare(&pair(seed, 1.0 + 0.01 * seed as f64), seed);
    }
}

/// One vehicle in several futures, whose first inputs are the same in all.
#[test]
fn stage_solvers_agree_for_futures_that_share_their_first_inputs() {
    for seed in 0..60 {
        let (count, shared_steps) = (2 + seed as usize % 3, 1 + seed as usize % 20);
        compare(&futures(seed, count, shared_steps), seed);
    }
}

#[test]
fn a_warm_start_changes_the_iterations_and_not_the_optimum() {
    for seed in 0..50 {
        let problem = alone(seed);
        let (first, second) = (qp_subproblem(&problem, seed), qp_subproblem(&problem, seed + 1000));
        let mut solver = Structured::default();
        let (mut warm, mut cold) = (StageSolution::default(), StageSolution::default());
        solver.solve(&first, &mut warm, false).expect("first");
        solver.solve(&second, &mut warm, true).expect("warm");
        Structured::default().solve(&second, &mut cold, false).expect("cold");
        let (warm, cold) = (second.change(&warm), second.change(&cold));
        assert!((warm - cold).abs() <= 1e-7 * (1.0 + cold.abs()));
    }
}
