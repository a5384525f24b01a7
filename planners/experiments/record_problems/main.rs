//! Records the trajectory problems that planners pose in closed loop, with guesses to start from.
//!
//! ```sh
//! cargo run --release -p interplay-planners --example record_problems -- straight
//! cargo run --release -p interplay-planners --example record_problems -- curved
//! ```
//!
//! The first drives three lane changes, two ramp merges and four intersections with every planner, on the bicycle as the plant, and writes
//! `planners/tests/data/{human,conservative,negotiation,bayesian,game,cooperative}.json`. (Humans are recorded beside the first
//! two planners only.)
//!
//! The second drives lane changes in a bend, lane drops in a bend, a left turn and a merge at a junction, and entries to a
//! roundabout with the conservative and the negotiating planner, and writes
//! `planners/tests/data/curved-{human,conservative,negotiation}.json`.
//!
//! A plan holds the problem that it solves. The guess is the last plan with its proposal, a step later. With each problem goes
//! the warm start of a planner: what the descent in the problem of the step before left.

mod closed_loop;
mod curved;
#[path = "../../tests/common/junction.rs"]
mod junction;
#[path = "../../tests/common/recorded.rs"]
mod recorded;
mod replay;
#[path = "../../tests/common/world.rs"]
mod world;

use std::error::Error;
use std::io::Write;

use interplay_planners::trajectory::{Problem, Term};
use interplay_planners::{Driver, Input, Trajectory};

use closed_loop::{CURVED_SCENARIOS, Decision, SCENARIOS, Scenario};
use curved::is_on_curve;
use recorded::{CURVED, CURVED_KINDS, KINDS, Recorded, without_lanes};
use replay::WarmStartReplay;
use world::egos;

/// Problems of a set of scenarios.
struct Collection {
    /// What the names of the files begin with.
    prefix: &'static str,
    /// The planners, and how many problems of each are kept.
    kept: Vec<(&'static str, usize)>,
    scenarios: &'static [Scenario],
    egos: Vec<Driver>,
    /// Which problems may be kept.
    is_wanted: fn(&Problem) -> bool,
    /// The number of first ticks of every run that are always kept: there is little to start from yet.
    first_ticks: usize,
}

impl Collection {
    fn straight() -> Collection {
        let kept = KINDS.into_iter().zip([200, 200, 200, 100, 100, 100]).collect();
        Collection {
            prefix: "",
            kept,
            scenarios: &SCENARIOS,
            egos: egos().to_vec(),
            is_wanted: |_| true,
            first_ticks: 2,
        }
    }

    fn curved() -> Collection {
        let kept = CURVED_KINDS.into_iter().zip([35, 40, 25]).collect();
        let egos = egos().into_iter().filter(|ego| CURVED_KINDS.contains(&ego.kind())).collect();
        Collection { prefix: CURVED, kept, scenarios: &CURVED_SCENARIOS, egos, is_wanted: is_on_curve, first_ticks: 0 }
    }
}

type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// A problem with the guess to start from.
pub type Posed = (Problem, Vec<Vec<Input>>);

/// A problem and the tick at which it was met.
struct Met {
    tick: usize,
    recorded: Recorded,
}

fn main() -> Result<()> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    match words.iter().map(String::as_str).collect::<Vec<_>>().as_slice() {
        ["straight"] => record(&Collection::straight()),
        ["curved"] => record(&Collection::curved()),
        _ => Err("usage: record_problems straight|curved".into()),
    }
}

fn record(collection: &Collection) -> Result<()> {
    let Collection { prefix, kept, scenarios, egos, is_wanted, first_ticks } = collection;
    let mut met: Vec<Vec<Met>> = kept.iter().map(|_| Vec::new()).collect();
    for scenario in *scenarios {
        for ego in egos {
            let run = format!("{}/{}", scenario.name, ego.kind());
            let mut replays: Vec<WarmStartReplay> = kept.iter().map(|_| WarmStartReplay::default()).collect();
            closed_loop::run(scenario, ego, |decision| {
                let kind = kept.iter().position(|(kind, _)| *kind == decision.driver.kind());
                let (Some(kind), Some(posed)) = (kind, posed(decision, ego)) else { return Ok(()) };
                let (tick, name) = (decision.scene.tick, &decision.scene.ego.name);
                let warm_start = replays[kind].warm_start(kept[kind].0, tick, name, &posed)?;
                let (problem, guess) = posed;
                let recorded = Recorded::new(format!("{run}/{tick}/{name}"), &problem, &guess, &warm_start);
                if recorded.problem() != without_lanes(problem) {
                    return Err(format!("the record of {} lost something", recorded.id).into());
                }
                if is_wanted(&recorded.problem()) {
                    met[kind].push(Met { tick, recorded });
                }
                Ok(())
            })?;
        }
    }
    for ((kind, most), met) in kept.iter().zip(met) {
        let kind = format!("{prefix}{kind}");
        let (all, kept) = (met.len(), thin_out(met, *most, *first_ticks));
        recorded::save(&kind, &kept)?;
        let bytes = std::fs::metadata(recorded::path(&kind))?.len();
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
fn thin_out(met: Vec<Met>, most: usize, first_ticks: usize) -> Vec<Recorded> {
    let rest = met.iter().filter(|met| met.tick >= first_ticks).count();
    let wanted = (most + rest).saturating_sub(met.len()).min(rest);
    let mut index = 0;
    let kept = met.into_iter().filter(|met| {
        if met.tick < first_ticks {
            return true;
        }
        index += 1;
        index * wanted / rest > (index - 1) * wanted / rest
    });
    kept.map(|met| met.recorded).collect()
}
