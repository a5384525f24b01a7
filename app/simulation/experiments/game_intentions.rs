//! Outcomes of a persuasion game over many starts, and the probabilities in it.
//!
//! ```sh
//! cargo run --release -p interplay-simulation --example game_intentions -- SCENARIO SEEDS [PATH=VALUE ...]
//! ```
//!
//! runs the scenario with seeds 1 to SEEDS and starts perturbed by up to 0.1 m and 0.1 m/s. It prints how often each order
//! occurs, when the ego completes, and in how many steps of the game its intention is off its bounds, an accident is its
//! worst outcome, it expresses its intention, the bounds on its mean speed hold, and then the next belief about the ego
//! is as desired within 0.02.

#![allow(clippy::print_stdout, reason = "the numbers are the result")]

use std::collections::BTreeMap;
use std::error::Error;
use std::sync::mpsc::{Sender, channel};

use interplay_planners::drivers::game::best_response::{MAX_INTENTION, MIN_INTENTION};
use interplay_planners::drivers::game::diagnostics::{
    ACCIDENT_PAYOFF, EGO_INTENTION, EGO_PAYOFFS, EGO_POSTERIOR, EXPRESSION_SLACK,
};
use interplay_planners::drivers::game::expression::wanted_posterior;
use interplay_planners::{Driver, Plan};
use interplay_scenarios::{Override, load};
use interplay_simulation::frame::Frame;
use interplay_simulation::run::run;
use interplay_simulation::watch::{WatchError, Watcher};

/// Violations of bounds below this are ignored \[m/s\].
const MAX_SLACK_MPS: f64 = 1e-3;
/// Tolerance of a belief about the desired interval.
const BELIEF_TOLERANCE: f64 = 0.02;

/// Sends the ego's plans; the ego is the first vehicle.
struct Plans(Sender<Plan>);

impl Watcher for Plans {
    fn tick(&mut self, frame: &Frame) -> Result<(), WatchError> {
        self.0.send(Plan::clone(&frame.vehicles[0].plan))?;
        Ok(())
    }

    fn finish(self: Box<Self>) -> Result<(), WatchError> {
        Ok(())
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let name = arguments.next().ok_or("which scenario?")?;
    let seeds: u64 = arguments.next().ok_or("how many seeds?")?.parse()?;
    let jitter = ["start_jitter.position_m=0.1", "start_jitter.speed_mps=0.1"].map(str::to_owned);
    let changes: Vec<Override> = arguments.chain(jitter).map(Override::Set).collect();
    let (mut orders, mut completed_s) = (BTreeMap::<String, usize>::new(), Vec::new());
    let [mut played, mut inside, mut worst, mut expressed, mut held, mut believed] = [0_usize; 6];
    for seed in 1..=seeds {
        let changes: Vec<Override> = changes.iter().cloned().chain([Override::Seed(seed)]).collect();
        let scenario = load(&name, &changes).map_err(|error| format!("{error:?}"))?;
        let Driver::Game(settings) = scenario.vehicles[0].driver else {
            return Err("the first vehicle does not play".into());
        };
        let (sender, receiver) = channel();
        let report = serde_json::to_value(run(&name, &scenario, vec![Box::new(Plans(sender))])?)?;
        *orders.entry(report["order"].to_string()).or_default() += 1;
        completed_s.extend(report["vehicles"][0]["completed_s"].as_f64());
        let plans: Vec<Plan> = receiver.iter().collect();
        for (index, plan) in plans.iter().enumerate() {
            let Some(intention) = plan.value_of(&EGO_INTENTION) else { continue };
            let accident = plan.value_of(&ACCIDENT_PAYOFF);
            played += 1;
            inside += usize::from(intention > MIN_INTENTION + 1e-4 && intention < MAX_INTENTION - 1e-4);
            worst += usize::from(EGO_PAYOFFS.iter().all(|payoff| plan.value_of(payoff) > accident));
            let Some(slack) = plan.value_of(&EXPRESSION_SLACK) else { continue };
            let Some(belief) = plans.get(index + 1).and_then(|next| next.value_of(&EGO_POSTERIOR)) else { continue };
            let [lowest, highest] = wanted_posterior(intention, &settings);
            let is_wanted = lowest.is_none_or(|lowest| belief >= lowest - BELIEF_TOLERANCE)
                && highest.is_none_or(|highest| belief <= highest + BELIEF_TOLERANCE);
            expressed += 1;
            held += usize::from(slack < MAX_SLACK_MPS);
            believed += usize::from(slack < MAX_SLACK_MPS && is_wanted);
        }
    }
    completed_s.sort_by(f64::total_cmp);
    let (first, last) = (completed_s.first(), completed_s.last());
    println!("{name}, {seeds} starts: {orders:?}");
    println!(
        "ego completes {}: median {:?} s, {first:?} to {last:?} s",
        completed_s.len(),
        completed_s.get(completed_s.len() / 2)
    );
    println!("{played} steps: {inside} off the bounds, accident worst in {worst}");
    println!(
        "{expressed} steps with an expression: bounds hold in {held}, next belief as wanted in {believed} of these"
    );
    Ok(())
}
