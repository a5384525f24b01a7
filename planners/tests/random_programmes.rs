//! Ten thousand random QP subproblems, harsher than any road: badly scaled, degenerate, contradictory, with an obstacle on top
//! of the start, without weights. Each is solved, or called infeasible, as the general solver does it.

mod common;

use common::{HORIZON, SplitMix64, alone, iterate, pair, qp_subproblem};
use interplay_planners::Input;
use interplay_planners::trajectory::terms::{DistanceCost, DistancePrice, MeanSpeed, SpeedMeasure};
use interplay_planners::trajectory::{
    Interval, Optimiser, Penalty, Problem, Robust, RowBlock, Sparse, StageError, StageQp, StageSolution, StageSolver,
    Structured, Term, Violation, kkt,
};

const COUNT: u64 = 10_000;
/// How many problems of each half the structured solver may leave to the general one.
const MOST_GIVEN_UP: usize = 30;

/// What is done to an ordinary problem.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Harm {
    None,
    BadlyScaled,
    ObstacleOnTop,
    Degenerate,
    NoWeights,
    SpeedOutOfReach,
    RowsContradict,
}

const HARMS: [Harm; 7] = [
    Harm::None,
    Harm::BadlyScaled,
    Harm::ObstacleOnTop,
    Harm::Degenerate,
    Harm::NoWeights,
    Harm::SpeedOutOfReach,
    Harm::RowsContradict,
];

impl Harm {
    fn on_problem(self, problem: &mut Problem, random: &mut SplitMix64) {
        let scales = |random: &mut SplitMix64| 10.0_f64.powf(random.uniform(-4.0, 4.0));
        let starts: Vec<[f64; 2]> = problem.participants.iter().map(|of| of.start.position()).collect();
        for term in &mut problem.terms {
            match (self, term) {
                (Harm::BadlyScaled, Term::Tracking(term)) => {
                    term.weights = term.weights.map(|weight| weight * scales(random));
                }
                (Harm::BadlyScaled, Term::Comfort(term)) => {
                    term.weights = term.weights.map(|weight| weight * scales(random));
                }
                (Harm::ObstacleOnTop, Term::KeepOut(term)) => term.centres.fill(starts[term.vehicle]),
                (Harm::NoWeights, Term::Tracking(term)) => term.weights = [0.0; 4],
                (Harm::NoWeights, Term::Comfort(term)) => term.weights = [0.0; 2],
                _ => {}
            }
        }
    }

    fn on_programme(self, qp: &mut StageQp, random: &mut SplitMix64) {
        match self {
            Harm::Degenerate => {
                // Every row twice, one of them with nothing to say.
                let twice: Vec<RowBlock> = qp.blocks.iter().flat_map(|block| [block.clone(), block.clone()]).collect();
                qp.blocks = twice;
                if let Some(row) = qp.blocks.first_mut().and_then(|block| block.rows.last_mut()) {
                    (row.value, row.gradient) = (0.0, [0.0; 3]);
                }
            }
            Harm::SpeedOutOfReach => {
                let at = (random.uniform(0.0, 1.0) * 5.0) as usize;
                let boxes = &mut qp.vehicles[0].speed_boxes;
                let lower = 0.2 * (at + 1) as f64 + random.uniform(0.3, 2.0);
                boxes[at] = Interval { lower, upper: lower + 1.0 };
            }
            Harm::RowsContradict => {
                let Some(block) = qp.blocks.first().cloned() else { return };
                let at = 3 + (random.uniform(0.0, 1.0) * 20.0) as usize;
                let (slope, apart) = (random.uniform(0.5, 2.0), random.uniform(0.05, 0.5));
                for direction in [1.0, -1.0] {
                    let mut opposed = block.clone();
                    opposed.penalty = None;
                    opposed.rows.iter_mut().for_each(|row| row.active = false);
                    opposed.rows[at].active = true;
                    opposed.rows[at].value = -apart;
                    opposed.rows[at].gradient = [0.0, direction * slope, 0.0];
                    qp.blocks.push(opposed);
                }
            }
            _ => {}
        }
    }
}

/// A random problem of a kind, linearised at random inputs.
fn programme(seed: u64) -> (Harm, StageQp) {
    let random = &mut SplitMix64::new(seed.wrapping_mul(0x5851_f42d_4c95_7f2d));
    let harm = HARMS[(seed % HARMS.len() as u64) as usize];
    let mut problem = if seed.is_multiple_of(5) { pair(seed, random.uniform(1.0, 2.0)) } else { alone(seed) };
    harm.on_problem(&mut problem, random);
    let mut qp = qp_subproblem(&problem, &iterate(&problem, random));
    harm.on_programme(&mut qp, random);
    (harm, qp)
}

/// What a solver made of a problem.
#[derive(Debug)]
enum Answer {
    Solved { change: f64, residual: f64, iterations: usize },
    Infeasible,
    GaveUp(String),
}

fn ask(solver: &mut impl StageSolver, qp: &StageQp) -> Answer {
    let mut solution = StageSolution::default();
    match solver.solve(qp, &mut solution, false) {
        Ok(()) => Answer::Solved {
            change: qp.change(&solution),
            residual: kkt::residual(qp, &solution).largest(),
            iterations: solution.iterations,
        },
        Err(StageError::Infeasible { .. }) => Answer::Infeasible,
        Err(error) => Answer::GaveUp(error.to_string()),
    }
}

/// Half of the problems each, on the machine's two threads.
#[test]
fn every_random_problem_gets_the_verdict_of_the_general_solver() {
    let halves = [0, 1].map(|half| std::thread::spawn(move || compare((half..COUNT).step_by(2))));
    let wrong: Vec<String> = halves.into_iter().flat_map(|half| half.join().expect("no panic")).collect();
    assert!(wrong.is_empty(), "{} of {COUNT}: {:#?}", wrong.len(), &wrong[..wrong.len().min(20)]);
}

fn compare(seeds: impl Iterator<Item = u64>) -> Vec<String> {
    let (mut structured, mut robust, mut sparse) = (Structured::default(), Robust::default(), Sparse::default());
    let (mut wrong, mut given_up) = (Vec::new(), Vec::new());
    for seed in seeds {
        let (harm, qp) = programme(seed);
        let mut ours = ask(&mut structured, &qp);
        if let Answer::GaveUp(why) = &ours {
            // The planners' solver then asks the general one: seldom, and hardly but for problems without any weight.
            given_up.push(format!("{seed} {harm:?}: {why}"));
            ours = ask(&mut robust, &qp);
        }
        let theirs = ask(&mut sparse, &qp);
        let agreed = match (&ours, &theirs) {
            (Answer::Solved { change, residual, iterations }, Answer::Solved { change: reference, .. }) => {
                let scale = 1.0 + reference.abs();
                // Both minimise: we may be lower where the general solver stops early.
                change.is_finite()
                    && *change <= reference + 1e-5 * scale
                    && *residual <= 1e-4 * scale
                    && *iterations <= 100
            }
            // What the general solver cannot decide, the optimality conditions do.
            (Answer::Solved { residual, .. }, Answer::GaveUp(_)) => *residual <= 1e-3,
            (Answer::Infeasible, Answer::Infeasible) => true,
            (Answer::Infeasible, Answer::GaveUp(_)) => matches!(harm, Harm::SpeedOutOfReach | Harm::RowsContradict),
            _ => false,
        };
        if !agreed {
            wrong.push(format!("{seed} {harm:?}: {ours:?}, the general solver: {theirs:?}"));
        }
    }
    if given_up.len() > MOST_GIVEN_UP {
        wrong.append(&mut given_up);
    }
    wrong
}

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
    let mut free = alone(3);
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
