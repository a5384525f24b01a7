//! Searches for scenarios in which a planner touches another vehicle.
//!
//! ```sh
//! cargo run --release -p interplay-planners --example adversary -- [STEPS [seed=NUMBER] [WORD ...]]
//! ```
//!
//! For each planner and family of scenarios it varies the starts of all vehicles, their speeds, and how much each human minds others
//! (safety weights from 0.01 to 100), so that the ego comes as near to another vehicle as possible: half of the steps (200 unless stated)
//! are drawn at random, the others change the nearest encounter so far by ever smaller amounts. Of every contact it says
//!
//! - until which tick one of the [last resorts](interplay_planners::plan::certificate::last_resorts) would have avoided it if the others
//!   had moved as they did (*avoidable*), which no planner knows beforehand, and
//! - whether the same motion of the ego would have touched another vehicle if the others had done from that tick on what they planned at
//!   it (*foretold*),
//! - and who caused it (*by the ego*): the ego if it moved towards the other at least as fast as the other towards it, as in sweeps.
//!
//! Words select families and planners; another seed (7 unless stated) draws others.

#[path = "../tests/common/mod.rs"]
mod common;

use std::io::Write;

use common::SplitMix64;
use common::world::{Vehicle, begin, egos, families};
use interplay_planners::drivers::{contingency, human, nash};
use interplay_planners::plan::certificate::{last_resorts, overlap_m};
use interplay_planners::{Agent, Driver, Scene, State, Trajectory};

const TICKS: usize = 60;
/// How far starts and speeds vary to either side \[m\], \[m/s\].
const ALONG_M: f64 = 0.5;
const SPEED_MPS: f64 = 0.3;
/// Vehicles start at least this far apart \[m\].
const FIRST_GAP_M: f64 = 0.1;
/// Words of a verdict.
const AVOIDABLE: &str = "avoidable";
const FORETOLD: &str = "foretold";
const BY_THE_EGO: &str = "by the ego";
/// Numbers that vary, a vehicle: place, speed, and the weight of a human.
const NUMBERS: usize = 3;

struct Encounter {
    /// The smallest gap between the ego and any other vehicle \[m\]; not positive at a contact.
    gap_m: f64,
    /// The tick at which it was smallest.
    tick: usize,
    /// Per tick, the ego's scene before any driver plans.
    scenes: Vec<Scene>,
    /// Per tick, what the others plan then, in the order of the scene.
    told: Vec<Vec<Trajectory>>,
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut words: Vec<String> = std::env::args().skip(1).collect();
    let steps = if words.is_empty() { 200 } else { words.remove(0).parse()? };
    let mut seed = 7;
    if let Some(stated) = words.first().and_then(|word| word.strip_prefix("seed=")) {
        seed = stated.parse()?;
        words.remove(0);
    }
    let mut out = std::io::stdout();
    writeln!(out, "| family | planner | runs | contacts | avoidable | foretold | by the ego | smallest gap m |")?;
    writeln!(out, "|---|---|---|---|---|---|---|---|")?;
    // The styles of humans are varied here: one of the families that differ in them only.
    let names = ["lane-change/nice-nice", "ramp-merge/nice-nice", "lane-keeping/nice", "intersection/nice"];
    for (family, pose) in families().into_iter().filter(|(name, _)| names.contains(&name.as_str())) {
        for ego in egos()
            .into_iter()
            .chain([Driver::Nash(nash::Settings::default()), Driver::Contingency(contingency::Settings::default())])
        {
            let name = format!("{family}/{}", ego.kind());
            if !words.iter().all(|word| name.contains(word)) {
                continue;
            }
            let vehicles = || {
                let mut vehicles = pose(ego.clone());
                if let (Driver::Cooperative(_), true) = (&ego, family.starts_with("lane-keeping")) {
                    vehicles[1].drive(ego.clone());
                }
                vehicles
            };
            let (runs, nearest_m, contacts) = search(&vehicles, steps, seed);
            let counted = |word: &str| contacts.iter().filter(|contact| contact.contains(word)).count();
            let [avoidable, foretold, by_ego] = [AVOIDABLE, FORETOLD, BY_THE_EGO].map(counted);
            let (kind, all) = (ego.kind(), contacts.len());
            writeln!(
                out,
                "| {family} | {kind} | {runs} | {all} | {avoidable} | {foretold} | {by_ego} | {nearest_m:.3} |"
            )?;
            contacts.iter().take(20).try_for_each(|contact| writeln!(out, "{contact}"))?;
            out.flush()?;
        }
    }
    Ok(())
}

/// The number of runs, the smallest gap in them, and the contacts in words.
fn search(vehicles: &dyn Fn() -> Vec<Vehicle>, steps: usize, seed: u64) -> (usize, f64, Vec<String>) {
    let mut random = SplitMix64::new(seed);
    let count = NUMBERS * vehicles().len();
    let (mut best, mut best_m, mut runs) = (vec![0.5; count], f64::INFINITY, 0);
    let mut contacts = Vec::new();
    for step in 0..steps {
        let width = 0.3 * (1.0 - (step as f64 - 0.5 * steps as f64) / (0.51 * steps as f64));
        let numbers: Vec<f64> = match step < steps / 2 {
            true => best.iter().map(|_| random.uniform(0.0, 1.0)).collect(),
            false => best.iter().map(|number| (number + random.uniform(-width, width)).clamp(0.0, 1.0)).collect(),
        };
        let Some(encounter) = drive(vehicles(), &numbers) else { continue };
        runs += 1;
        if encounter.gap_m < best_m {
            (best, best_m) = (numbers.clone(), encounter.gap_m);
        }
        if encounter.gap_m <= 0.0 {
            let verdict = avoidable_until(&encounter).map_or("no last resort avoids it".to_owned(), |tick| {
                let told = if touches_as_told(&encounter, tick) { FORETOLD } else { "not as planned then" };
                format!("{AVOIDABLE} until tick {tick}, {told}")
            });
            let cause = if is_by_ego(&encounter) { BY_THE_EGO } else { "by the other" };
            contacts.push(format!("contact at tick {}, {cause}, {verdict}: {numbers:?}", encounter.tick));
        }
    }
    (runs, best_m, contacts)
}

/// A run from a start that numbers from 0 to 1 choose; none if two vehicles start too near to each other.
fn drive(mut vehicles: Vec<Vehicle>, numbers: &[f64]) -> Option<Encounter> {
    let within = |share: f64, bound: f64| bound * (2.0 * share - 1.0);
    for (vehicle, numbers) in vehicles.iter_mut().zip(numbers.chunks(NUMBERS)) {
        let (sin, cos) = vehicle.agent.state.heading_rad.sin_cos();
        let along_m = within(numbers[0], ALONG_M);
        vehicle.agent.state.x_m += along_m * cos;
        vehicle.agent.state.y_m += along_m * sin;
        vehicle.agent.state.speed_mps = (vehicle.agent.state.speed_mps + within(numbers[1], SPEED_MPS)).max(0.0);
        if let Driver::Human(settings) = &vehicle.driver {
            let safety_weight = Some(10.0_f64.powf(within(numbers[2], 2.0)));
            vehicle.drive(Driver::Human(human::Settings { style: None, safety_weight, ..*settings }));
        }
    }
    let bodies: Vec<_> = vehicles.iter().map(|vehicle| vehicle.agent.body.corners(&vehicle.agent.state)).collect();
    let is_near = |a: usize, b: usize| overlap_m(&bodies[a], &bodies[b]) > -FIRST_GAP_M;
    if (0..bodies.len()).any(|a| (0..a).any(|b| is_near(a, b))) {
        return None;
    }
    let (mut traffic, mut planners) = begin(&vehicles);
    let mut encounter = Encounter { gap_m: f64::INFINITY, tick: 0, scenes: Vec::new(), told: Vec::new() };
    for tick in 0..TICKS {
        encounter.scenes.push(traffic.scene(0));
        let mut decisions = traffic.drive(|index, scene| planners[index].plan(scene));
        decisions.sort_by_key(|decision| decision.vehicle);
        encounter.told.push(decisions.into_iter().skip(1).map(|decision| decision.plan.trajectory.clone()).collect());
        let gap_m = gap_m(&traffic.scene(0));
        if gap_m < encounter.gap_m {
            (encounter.gap_m, encounter.tick) = (gap_m, tick + 1);
        }
        if gap_m <= 0.0 {
            break;
        }
    }
    encounter.scenes.push(traffic.scene(0));
    Some(encounter)
}

/// The smallest gap between the planning vehicle of a scene and the others \[m\].
fn gap_m(scene: &Scene) -> f64 {
    let ego = scene.ego.body.corners(&scene.ego.state);
    let gaps = scene.others.iter().map(|other| -overlap_m(&ego, &other.body.corners(&other.state)));
    gaps.fold(f64::INFINITY, f64::min)
}

/// Whether the ego drives into another vehicle at the end.
fn is_by_ego(encounter: &Encounter) -> bool {
    encounter.scenes.last().is_some_and(|scene| {
        let own = scene.ego.body.corners(&scene.ego.state);
        let touched = |other: &&Agent| overlap_m(&own, &other.body.corners(&other.state)) >= 0.0;
        scene.others.iter().filter(touched).any(|other| scene.ego.state.drives_into(&other.state))
    })
}

/// The last tick from which a last resort touches no vehicle until the contact, if the others move as they did.
fn avoidable_until(encounter: &Encounter) -> Option<usize> {
    let end = encounter.scenes.len() - 1;
    (0..end).rev().find(|from| {
        let moved = |other: usize| -> Vec<State> {
            encounter.scenes[*from..].iter().map(|scene| scene.others[other].state).collect()
        };
        let is_clear = |motion: &Trajectory| {
            (1..=end - from).all(|stage| {
                let Some(state) = motion.states.get(stage) else { return true };
                let scene = &encounter.scenes[*from];
                let ego = scene.ego.body.corners(state);
                let on_road = scene.ego.route.contains(&scene.ego.body, state, 0.05);
                let others = scene.others.iter().enumerate();
                on_road
                    && others
                        .into_iter()
                        .all(|(index, other)| overlap_m(&ego, &other.body.corners(&moved(index)[stage])) <= 0.0)
            })
        };
        last_resorts(&encounter.scenes[*from]).any(|motion| is_clear(&motion))
    })
}

/// Whether the ego's motion from a tick on touches another vehicle if the others do what they planned at that tick.
fn touches_as_told(encounter: &Encounter, tick: usize) -> bool {
    encounter.scenes[tick..].iter().enumerate().skip(1).any(|(stage, scene)| {
        let ego = scene.ego.body.corners(&scene.ego.state);
        scene.others.iter().zip(&encounter.told[tick]).any(|(other, told)| {
            let state = told.states.get(stage).or(told.states.last());
            state.is_some_and(|state| overlap_m(&ego, &other.body.corners(state)) > 0.0)
        })
    })
}
