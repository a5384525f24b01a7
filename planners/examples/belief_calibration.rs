//! How often a belief names a driver's style, and how often its interval holds the driver's safety weight.
//!
//! ```sh
//! cargo run --release -p interplay-planners --example belief_calibration -- [RUNS [SEED]]
//! ```
//!
//! In each run an ego that infers meets one human of the families `lane keeping`, `intersection` and `lane change`, from a random start.
//! The *interaction* begins at the first tick at which this human, in its own scene, would do something else as a tough driver than
//! as a nice one: the two first plans are more than 2 cm apart after a second. A run in which that never happens tells nothing
//! and is counted apart. What is believed a second later is compared with the truth:
//!
//! - with humans of a named style (tough, normal or nice, in equal shares), the kind for which the human is taken;
//! - with humans of any weight (log-uniform from 0.2 to 100), whether the interval of the safety weight holds it. A hypothesis
//!   stands for the weights that are nearer to it than to the next, by their ratio: below 2, from 2 to 20, and above.
//!
//! Shares have Wilson's 95 % interval.

#[path = "../tests/common/mod.rs"]
mod common;

use std::error::Error;
use std::io::Write;

use common::Random;
use common::wilson::wilson_interval;
use common::world::{STEP_S, Vehicle, begin, intersection, lane_change, lane_keeping};
use interplay_planners::belief::{self, Prior};
use interplay_planners::driver_estimate::{DriverEstimate, DriverModel};
use interplay_planners::human::{self, Style};
use interplay_planners::predict::Prediction;
use interplay_planners::{Driver, Planner, Scene, State, conservative, negotiation};

/// Ticks in a second.
const SECOND: usize = 10;
/// Ticks of a run.
const TICKS: usize = 60;
/// Plans that are further apart after a second belong to drivers who can be told apart \[m\].
const APART_M: f64 = 0.02;
/// The safety weights at which the likelier hypothesis changes.
const BETWEEN: [f64; 2] = [2.0, 20.0];

/// What was believed a second after the interaction began.
struct Belief {
    family: &'static str,
    safety_weight: f64,
    estimate: DriverEstimate,
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut words = std::env::args().skip(1);
    let runs: usize = words.next().map_or(Ok(300), |word| word.parse())?;
    let seed: u64 = words.next().map_or(Ok(1), |word| word.parse())?;
    let mut out = std::io::stdout();
    for (words, prior) in [("nice", Prior::Nice), ("even", Prior::Even)] {
        writeln!(out, "prior {words}\n")?;
        let weights = |random: &mut Random| [0.0, 8.0, 50.0][(3.0 * random.unit()) as usize];
        named_styles(&mut out, &beliefs(runs, seed, prior, weights))?;
        let weights = |random: &mut Random| 10f64.powf(random.between(0.2f64.log10(), 2.0));
        held_weights(&mut out, &beliefs(runs, seed, prior, weights))?;
    }
    Ok(())
}

/// What is believed in each run in which drivers can be told apart.
fn beliefs(runs: usize, seed: u64, prior: Prior, weight: impl Fn(&mut Random) -> f64) -> Vec<Option<Belief>> {
    let mut random = Random(seed);
    (0..runs).map(|number| meet(number, &mut random, prior, &weight)).collect()
}

fn meet(number: usize, random: &mut Random, prior: Prior, weight: impl Fn(&mut Random) -> f64) -> Option<Belief> {
    let prediction = Prediction::Inferred;
    let ego = match number / 3 % 2 {
        0 => Driver::Negotiation(negotiation::Settings { prediction, ..negotiation::Settings::default() }),
        _ => Driver::Conservative(conservative::Settings { prediction, ..conservative::Settings::default() }),
    };
    let (family, mut vehicles) = match number % 3 {
        0 => ("lane keeping", lane_keeping(ego, Style::Nice)),
        1 => ("intersection", intersection(ego, Style::Nice, random.between(1.6, 2.1))),
        _ => ("lane change", lane_change(ego, [Style::Nice; 2])),
    };
    for vehicle in &mut vehicles {
        let State { x_m, speed_mps, .. } = vehicle.agent.state;
        if vehicle.agent.state.heading_rad == 0.0 {
            vehicle.agent.state.x_m = x_m + random.between(-0.2, 0.2);
        }
        vehicle.agent.state.speed_mps = speed_mps + random.between(-0.15, 0.15);
    }
    let safety_weight = weight(random);
    let observed = if family == "lane change" { 2 } else { 1 };
    vehicles[observed].drive(human(safety_weight));
    let estimate = believed(&vehicles, observed, prior)?;
    Some(Belief { family, safety_weight, estimate })
}

fn human(safety_weight: f64) -> Driver {
    Driver::Human(human::Settings { safety_weight: Some(safety_weight), ..human::Settings::default() })
}

/// What vehicle 0 believes of another a second after drivers can first be told apart there.
fn believed(vehicles: &[Vehicle], observed: usize, prior: Prior) -> Option<DriverEstimate> {
    let settings = belief::Settings { prior, ..belief::Settings::default() };
    let (mut traffic, _) = begin(vehicles);
    let mut planners: Vec<Planner> =
        vehicles.iter().map(|vehicle| vehicle.driver.planner_believing(&settings)).collect();
    let mut began = None;
    for tick in 0..TICKS {
        let decisions = traffic.drive(|index, scene| {
            if index == observed && began.is_none() && can_be_told_apart(scene) {
                began = Some(tick);
            }
            planners[index].plan(scene)
        });
        if began.is_some_and(|began| tick >= began + SECOND) {
            let own = decisions.into_iter().find(|decision| decision.vehicle == 0)?;
            return own.plan.beliefs.into_iter().find(|belief| belief.vehicle == vehicles[observed].agent.name);
        }
    }
    None
}

/// Whether the planning driver would be elsewhere after a second as a tough driver than as a nice one.
fn can_be_told_apart(scene: &Scene) -> bool {
    let ends = [0.0, 50.0].map(|weight| human(weight).planner().plan(scene).map(|plan| plan.trajectory.states[SECOND]));
    let [Ok(tough), Ok(nice)] = ends else { return false };
    libm::hypot(tough.x_m - nice.x_m, tough.y_m - nice.y_m) > APART_M
}

fn share(count: usize, of: usize) -> String {
    let [low, high] = wilson_interval(count, of.max(1));
    let percent = 100.0 * count as f64 / of.max(1) as f64;
    format!("{count} of {of}, {percent:.0} % ({:.0} to {:.0})", 100.0 * low, 100.0 * high)
}

/// For each family and style, how often the style is named, and what else.
fn named_styles(out: &mut impl Write, beliefs: &[Option<Belief>]) -> std::io::Result<()> {
    let told: Vec<&Belief> = beliefs.iter().flatten().collect();
    writeln!(out, "{} of {} runs tell styles apart, {STEP_S} s a tick", told.len(), beliefs.len())?;
    writeln!(out, "| family | is | named so | tough, normal, nice, IDM, unknown |\n|---|---|---|---|")?;
    let styles =
        [("tough", 0.0, DriverModel::Tough), ("normal", 8.0, DriverModel::Normal), ("nice", 50.0, DriverModel::Nice)];
    for family in ["lane keeping", "intersection", "lane change"] {
        for (name, weight, model) in styles {
            let of: Vec<&&Belief> =
                told.iter().filter(|belief| belief.family == family && belief.safety_weight == weight).collect();
            let count = |model| of.iter().filter(|belief| belief.estimate.model == model).count();
            let counts = DriverModel::ALL.map(|model| count(model).to_string()).join(", ");
            writeln!(out, "| {family} | {name} | {} | {counts} |", share(count(model), of.len()))?;
        }
    }
    let right = |belief: &&&Belief| {
        styles.iter().any(|(_, weight, model)| belief.safety_weight == *weight && belief.estimate.model == *model)
    };
    writeln!(out, "| all | | {} | |\n", share(told.iter().filter(right).count(), told.len()))
}

/// For each family, how often the interval holds the weight, and how often it says something.
fn held_weights(out: &mut impl Write, beliefs: &[Option<Belief>]) -> std::io::Result<()> {
    let told: Vec<&Belief> = beliefs.iter().flatten().collect();
    writeln!(out, "| family | interval holds the weight | not all weights |\n|---|---|---|")?;
    for family in ["lane keeping", "intersection", "lane change", ""] {
        let of: Vec<&&Belief> = told.iter().filter(|belief| belief.family.starts_with(family)).collect();
        let holds = |belief: &&&&Belief| {
            let [low, high] = interval(&belief.estimate);
            (low..=high).contains(&belief.safety_weight)
        };
        let says = |belief: &&&&Belief| interval(&belief.estimate) != [0.0, f64::INFINITY];
        let family = if family.is_empty() { "all" } else { family };
        let [held, said] = [of.iter().filter(holds).count(), of.iter().filter(says).count()];
        writeln!(out, "| {family} | {} | {} |", share(held, of.len()), share(said, of.len()))?;
    }
    writeln!(out)
}

/// The weights for which the hypotheses of the interval stand.
fn interval(estimate: &DriverEstimate) -> [f64; 2] {
    let [low, high] = estimate.safety_weight_interval;
    let from = BETWEEN.into_iter().filter(|edge| *edge <= low).fold(0.0, f64::max);
    let to = BETWEEN.into_iter().filter(|edge| *edge >= high).fold(f64::INFINITY, f64::min);
    [from, to]
}
