//! Rows over whole trajectories and costs of distances: the structured solver against the general one, and both against the
//! optimality conditions.

mod common;

use common::{HORIZON, SplitMix64, iterate, pair, qp_subproblem};
use interplay_planners::Input;
use interplay_planners::trajectory::terms::{DistanceCost, DistancePrice, MeanSpeed, SpeedMeasure};
use interplay_planners::trajectory::{
    Optimiser, Penalty, Problem, Sparse, StageSolution, StageSolver, Structured, Term, Violation, kkt,
};

const SEEDS: u64 = 60;
const PENALTY: Penalty = Penalty { linear: 15.0, quadratic: 0.0 };

/// Two vehicles with a persuasion row and bounds on both mean speeds; the first is drawn to the second.
fn problem(seed: u64) -> Problem {
    let random = &mut SplitMix64::new(seed + 500);
    let mut problem = pair(seed, 1.0 + 0.01 * seed as f64);
    let centres = (1..=HORIZON).map(|t| [0.1 + 0.1 * t as f64, 0.555]).collect();
    let price = DistancePrice::Linear { weight: random.uniform(0.02, 0.9) };
    problem.terms.push(Term::DistanceCost(DistanceCost {
        vehicle: 0,
        centres,
        metrics: vec![[1.8, 0.3, 8.2]; HORIZON],
        price,
    }));
    let lower = random.uniform(0.6, 1.4);
    for (vehicle, width) in [0.05, 0.0].into_iter().enumerate() {
        let (lower_mps, upper_mps) = (Some(lower), Some(lower + width));
        problem.terms.extend(
            MeanSpeed { measure: SpeedMeasure::Speeds, lower_mps, upper_mps, penalty: PENALTY }
                .bounds(vehicle)
                .map(Term::MeanSpeed),
        );
    }
    problem
}

#[test]
fn the_solvers_agree_on_qp_subproblems() {
    for seed in 0..SEEDS {
        let problem = problem(seed);
        let qp = qp_subproblem(&problem, &iterate(&problem, &mut SplitMix64::new(seed)));
        assert_eq!(qp.trajectory_rows.len(), 5);
        let (mut structured, mut sparse) = (StageSolution::default(), StageSolution::default());
        Structured::default().solve(&qp, &mut structured, false).expect("structured");
        Sparse::default().solve(&qp, &mut sparse, false).expect("sparse");
        let (ours, theirs) = (qp.change(&structured), qp.change(&sparse));
        assert!((ours - theirs).abs() <= 1e-6 * (1.0 + theirs.abs()), "seed {seed}: {ours} against {theirs}");
        let residual = kkt::residual(&qp, &structured);
        assert!(residual.largest() < 1e-5, "seed {seed}: {residual:?}");
    }
}

#[test]
fn descents_with_coupled_rows_end_at_optima() {
    let (mut confirmed, mut compared) = (0, 0);
    for seed in 0..SEEDS {
        let problem = problem(seed);
        let guess = vec![vec![Input::default(); HORIZON]; 2];
        let outcome = Optimiser::new(Structured::default()).descend(&problem, &guess);
        // One that reached its limit claims no optimum.
        let Some(ours) = outcome.ok().filter(|ours| ours.statistics.unfinished == 0) else { continue };
        confirmed += 1;
        // The stated residual may be that of a last step that was not taken; a descent from there confirms the optimum.
        let again = Optimiser::new(Structured::default()).descend(&problem, &ours.iterate.inputs).expect("confirmed");
        let residual = ours.statistics.residual.min(again.statistics.residual);
        assert!(residual <= 1e-4, "seed {seed}: {:?}", ours.statistics);
        assert!(ours.cost.total - again.cost.total <= 1e-6 * (1.0 + again.cost.total), "seed {seed}");
        if seed % 6 == 0 {
            let Ok(theirs) = Optimiser::new(Sparse::default()).descend(&problem, &ours.iterate.inputs) else {
                continue;
            };
            compared += 1;
            let gained = (ours.cost.total - theirs.cost.total) / (1.0 + ours.cost.total);
            assert!(gained <= 1e-5, "seed {seed}: {} improved to {}", ours.cost.total, theirs.cost.total);
        }
    }
    // Few descents may give up: enough must be left to test.
    assert!(8 * confirmed >= 7 * SEEDS && 12 * compared >= SEEDS, "{confirmed} and {compared} of {SEEDS}");
}

/// A bound on the mean speed that costs nothing to keep is kept, and one that costs too much is not.
#[test]
fn a_bound_on_the_mean_speed_binds_only_if_its_price_is_high() {
    let mut free = common::alone(3);
    free.terms.retain(|term| !matches!(term, Term::KeepOut(_)));
    let guess = vec![vec![Input::default(); HORIZON]];
    let mean = |weight: f64| {
        let mut problem = free.clone();
        let penalty = Penalty { linear: weight, quadratic: 0.0 };
        problem.terms.extend(
            MeanSpeed { measure: SpeedMeasure::Speeds, lower_mps: Some(1.25), upper_mps: Some(1.3), penalty }
                .bounds(0)
                .map(Term::MeanSpeed),
        );
        let optimum = Optimiser::new(Structured::default()).descend(&problem, &guess).expect("an optimum");
        (SpeedMeasure::Speeds.evaluate(&optimum.iterate.states[0]), optimum.cost.violation(Violation::MeanSpeed))
    };
    let (dear, cheap) = (mean(1e3), mean(1e-3));
    assert!((1.25 - 1e-6..=1.3 + 1e-6).contains(&dear.0) && dear.1 < 1e-6, "{dear:?}");
    assert!(cheap.1 > 0.02, "{cheap:?}");
}
