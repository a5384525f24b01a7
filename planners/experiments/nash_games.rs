//! How many random games of 2, 3 and 4 vehicles the Nash solver solves, how fast, and with what certificate.
//!
//! ```sh
//! cargo run --release -p interplay-planners --example nash_games -- [GAMES [SEED]]
//! cargo run --release -p interplay-planners --example nash_games -- GAMES SEED FILE.json
//! ```
//!
//! Each game is solved once without a guess, over 30 steps of 0.1 s, to the tolerances of planners. *Local* is one descent whose
//! certificate holds against small deviations; *all classes* compares the homotopy classes, for the joint motion and for each player's
//! deviation. A game counts as solved if the descent or the best responses in its place ended, no vehicle enters a safety ellipse by more
//! than 0.001 (of `1 − d²`), and no player gains more than 1e-4 by leaving. Shares have Wilson's 95 % interval. The times include the
//! certificate.
//!
//! With a file, it writes the own problem of every player of the solved games, with the equilibrium as the guess, for
//! `tests/peers/nash_second_opinion.py`.

#[path = "../tests/common/mod.rs"]
mod common;
#[path = "../tests/common/recorded.rs"]
mod recorded;

use std::error::Error;
use std::io::Write;
use std::time::Instant;

use common::SplitMix64;
use common::games::joint_problem;
use common::wilson_interval;
use interplay_planners::drivers::nash::{Equilibrium, equilibrium, joint_optimiser};
use interplay_planners::trajectory::HomotopySearch;
use interplay_planners::trajectory::{DescentError, Optimiser, Problem, Robust, Tolerances, Violation, WarmStart};
use recorded::Recorded;

/// A solved game whose KKT residual is larger is counted: there the rounding of large weights hides what is left to gain.
const LARGEST_RESIDUAL: f64 = 1e-6;

/// What one solution of a game was like.
struct Solution {
    solved: bool,
    /// Why not, in a word.
    because: &'static str,
    time_ms: f64,
    departures: usize,
    by_best_responses: bool,
    /// Largest KKT residual of the descents that it comes from.
    residual: f64,
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut words = std::env::args().skip(1);
    let games: usize = words.next().map_or(Ok(1000), |word| word.parse())?;
    let seed: u64 = words.next().map_or(Ok(1), |word| word.parse())?;
    let mut out = std::io::stdout();
    if let Some(file) = words.next() {
        let records = own_problems(games, seed)?;
        std::fs::write(&file, serde_json::to_string(&records)?)?;
        writeln!(out, "{} problems of players in {file}", records.len())?;
        return Ok(());
    }
    writeln!(
        out,
        "| players | certificate | solved | 95 % interval | median ms | p99 ms | max ms | departures | by responses | residual above 1e-6 | unsolved because |"
    )?;
    writeln!(out, "|---|---|---|---|---|---|---|---|---|---|---|")?;
    for players in 2..=4 {
        for (name, all_classes) in [("local", false), ("all classes", true)] {
            let mut random = SplitMix64::new(seed);
            let solutions: Vec<Solution> =
                (0..games).map(|_| solve(&joint_problem(&mut random, players), all_classes)).collect();
            writeln!(out, "| {players} | {name} | {}", row(&solutions))?;
        }
    }
    Ok(())
}

/// The own problem of every player of the certified games, a third of the games with 2, 3 and 4 players each.
fn own_problems(games: usize, seed: u64) -> Result<Vec<Recorded>, Box<dyn Error>> {
    let (mut random, mut records) = (SplitMix64::new(seed), Vec::new());
    for game in 0..games {
        let players = 2 + game % 3;
        let problem = joint_problem(&mut random, players);
        let found = find(&problem, true)?;
        if !found.is_certified() {
            continue;
        }
        let iterate = &found.optimum.iterate;
        records.extend((0..players).map(|player| {
            let alone = problem.alone(player, iterate);
            let guess = [iterate.inputs[player].clone()];
            Recorded::new(format!("{game}/{players}/{player}"), &alone, &guess, &WarmStart::default())
        }));
    }
    Ok(records)
}

fn find(problem: &Problem, all_classes: bool) -> Result<Equilibrium, DescentError> {
    let search = if all_classes { HomotopySearch::Classes } else { HomotopySearch::Off };
    let mut joint = joint_optimiser(search);
    let mut responses = Optimiser::new(Robust::default()).searching(search);
    equilibrium(&mut joint, &mut responses, problem, &[])
}

fn solve(problem: &Problem, all_classes: bool) -> Solution {
    let began = Instant::now();
    let outcome = find(problem, all_classes);
    let time_ms = 1e3 * began.elapsed().as_secs_f64();
    let Ok(found) = outcome else {
        let (departures, by_best_responses, residual) = (0, false, f64::INFINITY);
        return Solution { solved: false, because: "failed", time_ms, departures, by_best_responses, residual };
    };
    let optimum = &found.optimum;
    let because = if optimum.statistics.unfinished > 0 {
        "not converged"
    } else if optimum.cost.violation(Violation::Safety) > Tolerances::default().slack {
        "ellipse entered"
    } else if !found.is_certified() {
        "a player gains"
    } else {
        ""
    };
    let Equilibrium { departures, by_best_responses, .. } = found;
    let residual = found.optimum.statistics.residual;
    Solution { solved: because.is_empty(), because, time_ms, departures, by_best_responses, residual }
}

fn row(solutions: &[Solution]) -> String {
    let mut times_ms: Vec<f64> = solutions.iter().map(|solution| solution.time_ms).collect();
    times_ms.sort_by(f64::total_cmp);
    let quantile = |share: f64| times_ms[((times_ms.len() - 1) as f64 * share).round() as usize];
    let solved = solutions.iter().filter(|solution| solution.solved).count();
    let by_best_responses = solutions.iter().filter(|solution| solution.solved && solution.by_best_responses).count();
    let residuals = solutions.iter().filter(|solution| solution.solved && solution.residual > LARGEST_RESIDUAL).count();
    let [low, high] = wilson_interval(solved, solutions.len());
    let departures: usize = solutions.iter().map(|solution| solution.departures).sum();
    let reasons = ["failed", "not converged", "ellipse entered", "a player gains"].map(|reason| {
        let count = solutions.iter().filter(|solution| solution.because == reason).count();
        format!("{reason} {count}")
    });
    format!(
        "{:.1} % | {:.1} to {:.1} | {:.2} | {:.2} | {:.1} | {departures} | {by_best_responses} | {residuals} | {} |",
        100.0 * solved as f64 / solutions.len() as f64,
        100.0 * low,
        100.0 * high,
        quantile(0.5),
        quantile(0.99),
        quantile(1.0),
        reasons.join(", ")
    )
}
