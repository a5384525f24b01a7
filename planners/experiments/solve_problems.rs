//! Solves recorded problems and prints what came out, as JSON, for the comparison with other people's solvers
//! (`tests/peers/`).
//!
//! ```sh
//! cargo run --release -p interplay-planners --example solve_problems -- KIND SOLVER REPEATS [STARTS.json]
//! ```
//!
//! `KIND` is a planner of `tests/data`. `SOLVER` is one of
//!
//! - `robust`, `structured`, `sparse`: one descent from the guess alone, each with its own solver of QP subproblems,
//! - `resumed`: one descent of `robust` that begins with the recorded warm start,
//! - `planner`: the same, then a comparison of the homotopy classes. It is finished at once: each problem has an optimiser of its
//!   own, whereas in closed loop a comparison may rest for a few plans or take several,
//! - `global`: the same with the global search (`passing_orders = "global"`).
//!
//! Every problem is solved `REPEATS` times for the median time. A descent begins at the recorded guess, or at the inputs that
//! `STARTS.json` holds by the problem's id; the cost of that beginning is printed too.

#[path = "../tests/common/recorded.rs"]
mod recorded;

use std::collections::BTreeMap;
use std::error::Error;
use std::io::Write;
use std::time::Instant;

use interplay_planners::Input;
use interplay_planners::trajectory::HomotopySearch;
use interplay_planners::trajectory::{
    DescentError, Iterate, Optimiser, Optimum, Problem, Robust, Sparse, StageSolver, Structured, Violation,
};
use recorded::Recorded;
use serde::Serialize;

type Inputs = Vec<Vec<[f64; 2]>>;

#[derive(Serialize)]
struct Outcome {
    id: String,
    /// Cost of the admissible inputs nearest to the guess.
    start_cost: f64,
    error: Option<String>,
    cost: Option<f64>,
    /// Largest violation of a safety row (1 − d²).
    safety_slack: Option<f64>,
    /// Largest KKT residual, by the independent check.
    residual: Option<f64>,
    programmes: Option<usize>,
    inner_iterations: Option<usize>,
    fallbacks: Option<usize>,
    inputs: Option<Inputs>,
    /// Median time of a descent \[ms\].
    time_ms: f64,
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (kind, solver, repeats, starts) = match arguments.as_slice() {
        [kind, solver, repeats] => (kind, solver, repeats, None),
        [kind, solver, repeats, starts] => (kind, solver, repeats, Some(starts)),
        _ => return Err("usage: solve_problems KIND SOLVER REPEATS [STARTS.json]".into()),
    };
    let repeats: usize = repeats.parse()?;
    let starts: BTreeMap<String, Inputs> = match starts {
        Some(path) => serde_json::from_str(&std::fs::read_to_string(path)?)?,
        None => BTreeMap::new(),
    };
    let problems = recorded::load(kind)?;
    let outcomes = match solver.as_str() {
        "planner" => solve_all(&problems, &starts, repeats, recorded::optimiser(kind)),
        "global" => solve_all(&problems, &starts, repeats, recorded::optimiser(kind).searching(HomotopySearch::Global)),
        "resumed" => solve_all(&problems, &starts, repeats, recorded::optimiser(kind).searching(HomotopySearch::Off)),
        "robust" => {
            solve_all(&problems, &starts, repeats, Optimiser::new(Robust::default()).searching(HomotopySearch::Off))
        }
        "structured" => {
            solve_all(&problems, &starts, repeats, Optimiser::new(Structured::default()).searching(HomotopySearch::Off))
        }
        "sparse" => {
            solve_all(&problems, &starts, repeats, Optimiser::new(Sparse::default()).searching(HomotopySearch::Off))
        }
        other => {
            return Err(format!(
                "no solver is called {other}: planner, global, resumed, robust, structured and sparse are"
            )
            .into());
        }
    };
    writeln!(std::io::stdout(), "{}", serde_json::to_string(&outcomes)?)?;
    Ok(())
}

fn solve_all<S: StageSolver + Clone>(
    problems: &[Recorded],
    starts: &BTreeMap<String, Inputs>,
    repeats: usize,
    optimiser: Optimiser<S>,
) -> Vec<Outcome> {
    let solve = |recorded: &Recorded| {
        let problem = recorded.problem();
        let guess = starts.get(&recorded.id).map_or_else(|| recorded.guess(), inputs);
        // A descent leaves its memory allocated, as in closed loop, and no comparison begun.
        let mut prepared = optimiser.clone();
        let _ = prepared.descend(&problem, &guess);
        prepared.warm_start = recorded.memory();
        let (outcome, time_ms) = timed(repeats, || prepared.clone(), |it| it.optimise(&problem, &guess));
        Outcome::new(recorded.id.clone(), start_cost(&problem, &guess), outcome, time_ms)
    };
    problems.iter().map(solve).collect()
}

fn inputs(rows: &Inputs) -> Vec<Vec<Input>> {
    rows.iter().map(|rows| rows.iter().copied().map(Input::from_array).collect()).collect()
}

/// The last of several equal results of `work`, and the median time of one \[ms\], without that of `prepare`.
fn timed<S, T>(repeats: usize, prepare: impl Fn() -> S, work: impl Fn(&mut S) -> T) -> (T, f64) {
    let mut times_ms = Vec::new();
    loop {
        let mut prepared = prepare();
        let began = Instant::now();
        let result = work(&mut prepared);
        times_ms.push(1e3 * began.elapsed().as_secs_f64());
        if times_ms.len() >= repeats {
            times_ms.sort_by(f64::total_cmp);
            return (result, times_ms[times_ms.len() / 2]);
        }
    }
}

fn start_cost(problem: &Problem, guess: &[Vec<Input>]) -> f64 {
    let own = |i: usize| guess.get(i).map(Vec::as_slice).unwrap_or_default();
    let vehicles = problem.participants.iter().enumerate();
    let inputs = vehicles.map(|(i, participant)| participant.admissible(own(i), problem.horizon)).collect();
    let mut iterate = Iterate::of_inputs(inputs);
    problem.roll_out(&mut iterate);
    problem.cost(&iterate).total
}

impl Outcome {
    fn new(id: String, start_cost: f64, outcome: Result<Optimum, DescentError>, time_ms: f64) -> Self {
        let error = outcome.as_ref().err().map(ToString::to_string);
        let optimum = outcome.ok();
        let statistics = optimum.as_ref().map(|optimum| optimum.statistics);
        let rows = |inputs: &Vec<Input>| inputs.iter().map(|input| input.to_array()).collect();
        Outcome {
            id,
            start_cost,
            error,
            cost: optimum.as_ref().map(|optimum| optimum.cost.total),
            safety_slack: optimum.as_ref().map(|optimum| optimum.cost.violation(Violation::Safety)),
            residual: statistics.map(|statistics| statistics.residual),
            programmes: statistics.map(|statistics| statistics.programmes),
            inner_iterations: statistics.map(|statistics| statistics.inner_iterations),
            fallbacks: statistics.map(|statistics| statistics.fallbacks),
            inputs: optimum.map(|optimum| optimum.iterate.inputs.iter().map(rows).collect()),
            time_ms,
        }
    }
}
