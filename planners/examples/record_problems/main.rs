//! Records the trajectory problems that planners pose in closed loop, with guesses to start from.
//!
//! ```sh
//! cargo run --release -p interplay-planners --example record_problems
//! ```
//!
//! drives three lane changes, two ramp merges and four intersections with every planner, on the bicycle as the plant, and writes
//! `planners/tests/data/{human,conservative,negotiation,bayesian,game,cooperative}.json`. (Humans are recorded beside the first
//! two planners only.)
//!
//! A plan holds the problem that it solves. The guess is the last plan with its proposal, a step later. With each problem goes
//! the warm start of a planner: what the descent in the problem of the step before left.

mod closed_loop;
#[path = "../../tests/common/recorded.rs"]
mod recorded;
mod replay;
#[path = "../../tests/common/world.rs"]
mod world;

use std::error::Error;
use std::io::Write;

use interplay_planners::trajectory::{Problem, Term};
use interplay_planners::{Driver, Input, Trajectory};

use closed_loop::{Decision, SCENARIOS};
use recorded::{KINDS, Recorded};
use replay::WarmStartReplay;
use world::egos;

/// How many problems of each kind are kept.
const KEPT: [usize; KINDS.len()] = [200, 200, 200, 100, 100, 100];
/// The first ticks of every run are always kept: there is little to start from yet.
const FIRST_TICKS: usize = 2;

type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// A problem with the guess to start from.
pub type Posed = (Problem, Vec<Vec<Input>>);

/// A problem and the tick at which it was met.
struct Met {
    tick: usize,
    recorded: Recorded,
}

fn main() -> Result<()> {
    let mut met: [Vec<Met>; KINDS.len()] = Default::default();
    for scenario in SCENARIOS {
        for ego in egos() {
            let run = format!("{}/{}", scenario.name, ego.kind());
            let mut replays: [WarmStartReplay; KINDS.len()] = Default::default();
            closed_loop::run(&scenario, &ego, |decision| {
                let Some(kind) = KINDS.iter().position(|kind| *kind == decision.driver.kind()) else { return Ok(()) };
                let Some(posed) = posed(decision, &ego) else { return Ok(()) };
                let (tick, name) = (decision.scene.tick, &decision.scene.ego.name);
                let warm_start = replays[kind].warm_start(KINDS[kind], tick, name, &posed)?;
                let (problem, guess) = posed;
                let recorded = Recorded::new(format!("{run}/{tick}/{name}"), &problem, &guess, &warm_start);
                if recorded.problem() != problem {
                    return Err(format!("the record of {} lost something", recorded.id).into());
                }
                met[kind].push(Met { tick, recorded });
                Ok(())
            })?;
        }
    }
    for ((kind, most), met) in KINDS.into_iter().zip(KEPT).zip(met) {
        let (all, kept) = (met.len(), thin_out(met, most));
        recorded::save(kind, &kept)?;
        let bytes = std::fs::metadata(recorded::path(kind))?.len();
        writeln!(std::io::stdout(), "{kind}: {} of {all} problems kept, {bytes} bytes", kept.len())?;
    }
    Ok(())
}

/// The problem of a decision that is worth recording. Of the planners that interact only steps are kept at which they do: at the
/// others their problem is the conservative one.
fn posed(decision: &Decision, ego: &Driver) -> Option<Posed> {
    let problem = decision.plan.problem.as_deref()?.clone();
    let holds = |of: fn(&Term) -> bool| problem.terms.iter().any(of);
    let is_kept = match decision.driver {
        Driver::Human(_) => matches!(ego, Driver::Conservative(_) | Driver::Negotiation(_)),
        Driver::Bayesian(_) => holds(|term| matches!(term, Term::DistanceCost(_))),
        Driver::Game(_) => holds(|term| matches!(term, Term::MeanSpeed(_))),
        Driver::Negotiation(_) => problem.participants.len() == 2,
        Driver::Cooperative(_) => problem.participants.len() == 2 && decision.scene.ego.name == "ego",
        _ => true,
    };
    let last = |trajectory: Option<&Trajectory>| trajectory.map_or_else(Vec::new, Trajectory::later_inputs);
    let mut guess = vec![last(decision.last)];
    if problem.participants.len() == 2 {
        guess.push(last(decision.last_proposal));
    }
    is_kept.then_some((problem, guess))
}

/// The first ticks of every run, and an even choice of the rest.
fn thin_out(met: Vec<Met>, most: usize) -> Vec<Recorded> {
    let rest = met.iter().filter(|met| met.tick >= FIRST_TICKS).count();
    let wanted = (most + rest).saturating_sub(met.len()).min(rest);
    let mut index = 0;
    let kept = met.into_iter().filter(|met| {
        if met.tick < FIRST_TICKS {
            return true;
        }
        index += 1;
        index * wanted / rest > (index - 1) * wanted / rest
    });
    kept.map(|met| met.recorded).collect()
}
