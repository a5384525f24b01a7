//! How often a belief names a driver's style, and how often its interval holds the driver's safety weight.
//!
//! ```sh
//! cargo run --release -p interplay-planners --example belief_calibration -- [RUNS [SEED [SHARPNESS]]]
//! ```
//!
//! In each run an ego that infers meets one human of the families `lane keeping`, `intersection` and `lane change`, from a random start.
//! The *interaction* begins at the first tick at which this human, in its own scene, would do something else as a tough driver than
//! as a nice one: the two first plans are more than 2 cm apart after a second. A run in which that never happens tells nothing
//! and is counted apart. The belief a second later is compared with the truth:
//!
//! - with humans of a named style (tough, normal or nice, in equal shares), the kind for which the human is taken, and whether it is
//!   one of the kinds that it may well be ([`DriverEstimate::credible_models`]);
//! - with humans of any weight (log-uniform from 0.01 to 100), whether the interval of the safety weight holds it. A hypothesis
//!   stands for the weights whose plans are nearer to its plan than to the next one's ([`SAFETY_WEIGHT_EDGES`]).
//!
//! The last table says where these edges are: in each scene in which the interaction begins, the weight whose plan is after a second
//! as far from that of one hypothesis as from that of the next.
//!
//! The deviations of a driver's acceleration and steering from its model, by which the observer judges it, are divided by SHARPNESS (1).
//!
//! Shares have Wilson's 95 % interval.

#[path = "../tests/common/mod.rs"]
mod common;

use std::error::Error;
use std::io::Write;

use common::SplitMix64;
use common::wilson_interval;
use common::world::{STEP_S, Vehicle, begin, intersection, lane_change, lane_keeping};
use interplay_planners::drivers::human::{self, Style};
use interplay_planners::drivers::{conservative, negotiation};
use interplay_planners::perception::belief::{self, Prior};
use interplay_planners::prediction::Prediction;
use interplay_planners::scene::driver_estimate::{DriverEstimate, DriverModel, SAFETY_WEIGHT_EDGES};
use interplay_planners::{Driver, Planner, Scene, State};

const SECOND: usize = 10;
const TICKS: usize = 60;
/// Plans that are further apart after a second belong to drivers who can be told apart \[m\].
const APART_M: f64 = 0.02;
/// Plans of two hypotheses nearer than this after a second have no edge between them \[m\].
const ALIKE_M: f64 = 0.005;
/// Halvings of the logarithm of a weight in the search for an edge.
const HALVINGS: usize = 12;
/// The smallest weight at which an edge is looked for.
const LEAST_WEIGHT: f64 = 1e-3;

/// The named styles: name, safety weight, kind of driver.
const STYLES: [(&str, f64, DriverModel); 3] =
    [("tough", 0.0, DriverModel::Tough), ("normal", 8.0, DriverModel::Normal), ("nice", 50.0, DriverModel::Nice)];
const FAMILIES: [&str; 3] = ["lane keeping", "intersection", "lane change"];

/// What was believed a second after the interaction began.
struct Belief {
    family: &'static str,
    safety_weight: f64,
    estimate: DriverEstimate,
    /// Where the edges between hypotheses are in the scene in which the interaction begins ([`edges_in`]).
    edges: [Option<f64>; 2],
}

impl Belief {
    /// The style of the human, if its weight is that of a named one.
    fn style(&self) -> Option<DriverModel> {
        STYLES.iter().find(|(_, weight, _)| *weight == self.safety_weight).map(|(.., model)| *model)
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut words = std::env::args().skip(1);
    let runs: usize = words.next().map_or(Ok(300), |word| word.parse())?;
    let seed: u64 = words.next().map_or(Ok(1), |word| word.parse())?;
    let sharpness: f64 = words.next().map_or(Ok(1.0), |word| word.parse())?;
    let usual = belief::Settings::default();
    let mut out = std::io::stdout();
    for (words, prior) in [("nice", Prior::Nice), ("even", Prior::Even)] {
        writeln!(out, "prior {words}\n")?;
        let settings = belief::Settings {
            prior,
            acceleration_sd_mps2: usual.acceleration_sd_mps2 / sharpness,
            steering_sd_rad: usual.steering_sd_rad / sharpness,
            ..usual
        };
        let weights = |random: &mut SplitMix64| STYLES[(3.0 * random.uniform(0.0, 1.0)) as usize].1;
        let named = beliefs(runs, seed, &settings, weights);
        named_styles(&mut out, &named)?;
        credible_names(&mut out, &named)?;
        let weights = |random: &mut SplitMix64| 10f64.powf(random.uniform(-2.0, 2.0));
        let beliefs = beliefs(runs, seed, &settings, weights);
        held_weights(&mut out, &beliefs)?;
        edges(&mut out, &beliefs)?;
    }
    Ok(())
}

/// What is believed in each run in which drivers can be told apart.
fn beliefs(
    runs: usize,
    seed: u64,
    settings: &belief::Settings,
    weight: impl Fn(&mut SplitMix64) -> f64,
) -> Vec<Option<Belief>> {
    let mut random = SplitMix64::new(seed);
    (0..runs).map(|number| meet(number, &mut random, settings, &weight)).collect()
}

fn meet(
    number: usize,
    random: &mut SplitMix64,
    settings: &belief::Settings,
    weight: impl Fn(&mut SplitMix64) -> f64,
) -> Option<Belief> {
    let prediction = Prediction::Inferred;
    let ego = match number / 3 % 2 {
        0 => Driver::Negotiation(negotiation::Settings { prediction, ..negotiation::Settings::default() }),
        _ => Driver::Conservative(conservative::Settings { prediction, ..conservative::Settings::default() }),
    };
    let (family, mut vehicles) = match number % 3 {
        0 => ("lane keeping", lane_keeping(ego, Style::Nice)),
        1 => ("intersection", intersection(ego, Style::Nice, random.uniform(1.6, 2.1))),
        _ => ("lane change", lane_change(ego, [Style::Nice; 2])),
    };
    for vehicle in &mut vehicles {
        let State { x_m, speed_mps, .. } = vehicle.agent.state;
        if vehicle.agent.state.heading_rad == 0.0 {
            vehicle.agent.state.x_m = x_m + random.uniform(-0.2, 0.2);
        }
        vehicle.agent.state.speed_mps = speed_mps + random.uniform(-0.15, 0.15);
    }
    let safety_weight = weight(random);
    let observed = if family == "lane change" { 2 } else { 1 };
    vehicles[observed].drive(human(safety_weight));
    let (estimate, edges) = believed(&vehicles, observed, settings)?;
    Some(Belief { family, safety_weight, estimate, edges })
}

fn human(safety_weight: f64) -> Driver {
    Driver::Human(human::Settings { safety_weight: Some(safety_weight), ..human::Settings::default() })
}

/// What vehicle 0 believes of another a second after drivers can first be told apart there, and where the edges are then.
fn believed(
    vehicles: &[Vehicle],
    observed: usize,
    settings: &belief::Settings,
) -> Option<(DriverEstimate, [Option<f64>; 2])> {
    let (mut traffic, _) = begin(vehicles);
    let mut planners: Vec<Planner> =
        vehicles.iter().map(|vehicle| vehicle.driver.planner_believing(settings)).collect();
    let mut began = None;
    for tick in 0..TICKS {
        let decisions = traffic.drive(|index, scene| {
            if index == observed && began.is_none() && can_be_told_apart(scene) {
                began = Some((tick, edges_in(scene)));
            }
            planners[index].plan(scene)
        });
        if let Some((_, edges)) = began.filter(|(began, _)| tick >= began + SECOND) {
            let own = decisions.into_iter().find(|decision| decision.vehicle == 0)?;
            let of = |belief: &DriverEstimate| belief.vehicle == vehicles[observed].agent.name;
            return own.plan.beliefs.iter().find(|estimate| of(estimate)).cloned().map(|estimate| (estimate, edges));
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
    for family in FAMILIES {
        for (name, weight, model) in STYLES {
            let of: Vec<&&Belief> =
                told.iter().filter(|belief| belief.family == family && belief.safety_weight == weight).collect();
            let count = |model| of.iter().filter(|belief| belief.estimate.model == model).count();
            let counts = DriverModel::ALL.map(|model| count(model).to_string()).join(", ");
            writeln!(out, "| {family} | {name} | {} | {counts} |", share(count(model), of.len()))?;
        }
    }
    let right = |belief: &&&Belief| belief.style() == Some(belief.estimate.model);
    writeln!(out, "| all | | {} | |\n", share(told.iter().filter(right).count(), told.len()))
}

/// For each family, how often the style is among the kinds that are credible, and how often these are how many.
fn credible_names(out: &mut impl Write, beliefs: &[Option<Belief>]) -> std::io::Result<()> {
    writeln!(out, "| family | style is among the credible names | of 1, 2, 3, 4, 5 names |\n|---|---|---|")?;
    for family in FAMILIES.into_iter().chain([""]) {
        let of: Vec<&Belief> = beliefs.iter().flatten().filter(|belief| belief.family.starts_with(family)).collect();
        let (mut held, mut sizes) = (0, [0; DriverModel::ALL.len()]);
        for belief in &of {
            let names = belief.estimate.credible_models();
            sizes[names.len() - 1] += 1;
            held += usize::from(belief.style().is_some_and(|style| names.contains(&style)));
        }
        let (family, sizes) = (if family.is_empty() { "all" } else { family }, sizes.map(|count| count.to_string()));
        writeln!(out, "| {family} | {} | {} |", share(held, of.len()), sizes.join(", "))?;
    }
    writeln!(out)
}

/// For each family, how often the interval holds the weight, and how often it says something.
fn held_weights(out: &mut impl Write, beliefs: &[Option<Belief>]) -> std::io::Result<()> {
    let told: Vec<&Belief> = beliefs.iter().flatten().collect();
    writeln!(out, "| family | interval holds the weight | not all weights |\n|---|---|---|")?;
    for family in FAMILIES.into_iter().chain([""]) {
        let of: Vec<&&Belief> = told.iter().filter(|belief| belief.family.starts_with(family)).collect();
        let interval = |belief: &Belief| belief.estimate.safety_weight_interval;
        let holds = |belief: &&&&Belief| {
            let [low, high] = interval(belief);
            (low..=high).contains(&belief.safety_weight)
        };
        let says = |belief: &&&&Belief| interval(belief) != [0.0, SAFETY_WEIGHT_EDGES[3]];
        let family = if family.is_empty() { "all" } else { family };
        let [held, said] = [of.iter().filter(holds).count(), of.iter().filter(says).count()];
        writeln!(out, "| {family} | {} | {} |", share(held, of.len()), share(said, of.len()))?;
    }
    writeln!(out)
}

/// Where edges between hypotheses are: quartiles over all runs.
fn edges(out: &mut impl Write, beliefs: &[Option<Belief>]) -> std::io::Result<()> {
    writeln!(out, "| edge between | scenes | lower quartile | median | upper quartile |\n|---|---|---|---|---|")?;
    for (index, between) in ["tough and normal", "normal and nice"].into_iter().enumerate() {
        let mut found: Vec<f64> = beliefs.iter().flatten().filter_map(|belief| belief.edges[index]).collect();
        found.sort_by(f64::total_cmp);
        let Some(last) = found.len().checked_sub(1) else { continue };
        let [lower, median, upper] = [0.25, 0.5, 0.75].map(|share| found[(share * last as f64) as usize]);
        writeln!(out, "| {between} | {} | {lower:.2} | {median:.2} | {upper:.2} |", found.len())?;
    }
    writeln!(out)
}

/// The weights at which the planning human is after a second as far from a tough as from a normal driver, and as far from a normal as
/// from a nice one; none where these two do the same.
fn edges_in(scene: &Scene) -> [Option<f64>; 2] {
    let end = |weight: f64| Some(human(weight).planner().plan(scene).ok()?.trajectory.states[SECOND].position());
    let apart_m = |a: [f64; 2], b: [f64; 2]| libm::hypot(a[0] - b[0], a[1] - b[1]);
    [[0.0, 8.0], [8.0, 50.0]].map(|[low, high]| {
        let [from, to] = [end(low)?, end(high)?];
        let [mut low, mut high] = [low.max(LEAST_WEIGHT).log10(), high.log10()];
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            let between = end(10f64.powf(middle))?;
            let is_near = apart_m(between, from) < apart_m(between, to);
            [low, high] = if is_near { [middle, high] } else { [low, middle] };
        }
        (apart_m(from, to) > ALIKE_M).then_some(10f64.powf(0.5 * (low + high)))
    })
}
