//! Records the trajectory problems that planners pose in closed loop, with the guesses they start from.
//!
//! ```sh
//! cargo run --release -p interplay-planners --example record_problems
//! ```
//!
//! drives the three embedded lane changes with every planner, on the bicycle as the plant, and writes
//! `planners/tests/data/{human,conservative,negotiation,bayesian,game,cooperative}.json`. (Humans are recorded beside the first
//! two only.)
//!
//! Problems are rebuilt from outside, from what a planner was shown and what it answered. Every one is checked before it
//! is kept: solved again it must have exactly the cost that the planner stated. (A human states none: its plan must be an
//! optimum of the rebuilt problem.)
//!
//! With each problem goes the warm start of the planner: what the descent in the problem of the step before left.

mod closed_loop;
mod negotiation_replay;
#[path = "../../tests/common/recorded.rs"]
mod recorded;
mod replay;
mod stated_problems;
#[path = "../../tests/common/world.rs"]
mod world;

use std::error::Error;
use std::io::Write;

use interplay_planners::diagnostic::{COST, DiagnosticQuantity};
use interplay_planners::trajectory::{Iterate, Optimiser, Problem, Robust};
use interplay_planners::{Agent, Driver, Plan, Trajectory, conservative, human, negotiation};

use closed_loop::{Decision, SCENARIOS};
use negotiation_replay::{NegotiationReplay, Posed};
use recorded::{KINDS, Recorded};
use replay::WarmStartReplay;
use stated_problems::StatedProblems;

/// How many problems of each kind are kept.
const KEPT: [usize; KINDS.len()] = [200, 200, 200, 100, 100, 100];
/// The first ticks of every run are always kept: there is little to start from yet.
const FIRST_TICKS: usize = 2;
/// By how much a human's plan may be improved upon, relative.
const OPTIMAL: f64 = 1e-5;

type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// A problem and the tick at which it was met.
struct Met {
    tick: usize,
    recorded: Recorded,
}

fn main() -> Result<()> {
    let mut met: [Vec<Met>; KINDS.len()] = Default::default();
    for scenario in SCENARIOS {
        let asking = negotiation::Settings::default();
        let baseline = conservative::Settings::default();
        for ego in egos(baseline, asking) {
            let run = format!("{}/{}", scenario.name, ego.kind());
            let (mut negotiation, mut stated) = (NegotiationReplay::new(asking), StatedProblems::default());
            let mut replays: [WarmStartReplay; KINDS.len()] = Default::default();
            closed_loop::run(&scenario, &ego, |decision| {
                let posed = match decision.driver {
                    Driver::Human(settings) => match ego {
                        Driver::Conservative(_) | Driver::Negotiation(_) => Some(posed_by_human(decision, settings)?),
                        _ => None,
                    },
                    Driver::Conservative(_) => Some(posed_by_conservative(decision)?),
                    Driver::Negotiation(_) => negotiation.rebuild(decision.scene, decision.plan)?,
                    Driver::Bayesian(settings) => stated.bayesian(decision, settings)?,
                    Driver::Game(settings) => stated.game(decision, settings)?,
                    Driver::Cooperative(settings) => stated.cooperative(decision, settings)?,
                    // The problems of other planners are not recorded.
                    _ => None,
                };
                let kind = KINDS.iter().position(|kind| *kind == decision.driver.kind()).ok_or("a new kind")?;
                let (tick, name) = (decision.scene.tick, &decision.scene.ego.name);
                if let Some(posed) = posed {
                    let warm_start = replays[kind].warm_start(KINDS[kind], tick, name, &posed)?;
                    let (problem, guess) = posed;
                    let recorded = Recorded::new(format!("{run}/{tick}/{name}"), &problem, &guess, &warm_start);
                    if recorded.problem() != problem {
                        return Err(format!("the record of {} lost something", recorded.id).into());
                    }
                    met[kind].push(Met { tick, recorded });
                }
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

fn egos(baseline: conservative::Settings, asking: negotiation::Settings) -> [Driver; 5] {
    [
        Driver::Conservative(baseline),
        Driver::Negotiation(asking),
        Driver::Bayesian(Default::default()),
        Driver::Game(Default::default()),
        Driver::Cooperative(Default::default()),
    ]
}

fn posed_by_human(decision: &Decision, settings: &human::Settings) -> Result<Posed> {
    let problem = human::problem(decision.scene, settings);
    let cost = cost_of_plan(&problem, decision.plan);
    let from_plan = std::slice::from_ref(&decision.plan.trajectory.inputs);
    // A descent that does not converge from there has found nothing better to speak of.
    if let Ok(better) = Optimiser::new(Robust::default()).descend(&problem, from_plan)
        && better.cost.total < cost - OPTIMAL * (1.0 + cost)
    {
        let (tick, name) = (decision.scene.tick, &decision.scene.ego.name);
        return Err(format!("tick {tick}: the plan of {name} is no optimum: {cost}, {}", better.cost.total).into());
    }
    Ok((problem, vec![human::guess(decision.scene, decision.last)]))
}

fn posed_by_conservative(decision: &Decision) -> Result<Posed> {
    let others: Vec<&Agent> = decision.scene.others.iter().collect();
    let problem = conservative::problem(decision.scene, &others);
    let (cost, stated) = (cost_of_plan(&problem, decision.plan), stated(decision.plan, &COST)?);
    if cost != stated {
        return Err(format!("tick {}: the rebuilt problem costs {cost}, not {stated}", decision.scene.tick).into());
    }
    Ok((problem, vec![decision.last.map_or_else(Vec::new, Trajectory::later_inputs)]))
}

/// What a lone vehicle's plan costs in a problem.
fn cost_of_plan(problem: &Problem, plan: &Plan) -> f64 {
    let (inputs, states) = (plan.trajectory.inputs.clone(), plan.trajectory.states.clone());
    problem.cost(&Iterate { inputs: vec![inputs], states: vec![states] }).total
}

/// What a plan reports of a quantity.
fn stated(plan: &Plan, quantity: &DiagnosticQuantity) -> Result<f64> {
    plan.value_of(quantity).ok_or_else(|| format!("the plan reports no {}", quantity.name).into())
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
