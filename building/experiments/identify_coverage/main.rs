//! How often the intervals of the method `state-space` hold the truth, and how often "identified" is wrong: houses with one, two
//! and three temperatures, simulated with random parameters, weather, heating, disturbances and sampling times.
//!
//! ```sh
//! cargo run --release -p interplay-building --example identify_coverage -- 100
//! ```
//!
//! The first argument is the number of houses of each kind; the second one, if there is one, the number of the first house
//! (0), and the third one the only kind, or `worlds` for all but those with a right world. The houses are simulated in steps of
//! six seconds; telemetry is sampled every 5 to 60 minutes.
//!
//! - Houses with one, two and three temperatures.
//! - `two states, silent`: heated and mild all the time alike, so that the data say next to nothing of the capacity.
//! - 30 to 100 % of the sun fall on the wall, or on the interior mass.
//! - Worlds that differ from what the models take for granted ([`world::World`]).

#![allow(clippy::print_stdout, reason = "this is a program: its results go to standard output")]

mod house;
mod world;

use house::{House, Kind};
use interplay_building::identify::{Confidence, IdentificationReport, IdentifySettings, SuspectedCause, identify};
use interplay_common::random::Random;
use rayon::prelude::*;
use world::World;

/// What one house showed of each quantity: name, truth, estimate, interval, verdict.
struct Outcome {
    quantity: &'static str,
    truth: f64,
    value: Option<f64>,
    interval: (Option<f64>, Option<f64>),
    confidence: Confidence,
    states: usize,
    /// Whether the chosen model has sun on a mass.
    sunlit: bool,
    /// What the data are said to contradict.
    causes: Vec<SuspectedCause>,
}

fn outcomes(house: &House, report: &IdentificationReport) -> Vec<Outcome> {
    let chosen = report.models.iter().find(|model| model.chosen);
    let states = chosen.map_or(0, |model| model.states);
    let sunlit = chosen.is_some_and(|model| model.model.contains("sun on"));
    let truths = [
        ("heat capacity", house.capacity()),
        ("conductance to outdoor", house.ua()),
        ("aperture to the sun", house.effective_aperture()),
    ];
    truths
        .into_iter()
        .filter_map(|(name, truth)| {
            let found = report.zones[0].physical.iter().find(|quantity| quantity.name == name)?;
            Some(Outcome {
                quantity: name,
                truth,
                value: found.value,
                interval: found.interval,
                confidence: found.verdict.confidence,
                states,
                sunlit,
                causes: report.suspicions.iter().map(|it| it.cause).collect(),
            })
        })
        .collect()
}

fn main() {
    let number = |argument: usize| std::env::args().nth(argument).and_then(|text| text.parse::<u64>().ok());
    let (houses, first) = (number(1).unwrap_or(10), number(2).unwrap_or(0));
    let only = std::env::args().nth(3);
    for (label, kind, world, name) in [
        (1, Kind::Air, World::Matched, "one state"),
        (2, Kind::Wall, World::Matched, "two states"),
        (3, Kind::WallAndInterior, World::Matched, "three states"),
        (4, Kind::Silent, World::Matched, "two states, silent"),
        (5, Kind::SunnyWall, World::Matched, "two states, sun on the wall"),
        (6, Kind::SunnyInterior, World::Matched, "three states, sun on the interior mass"),
        (7, Kind::Wall, World::Quantised, "sensor in steps of 0.1 K"),
        (8, Kind::Wall, World::ColouredHeat, "coloured heat"),
        (9, Kind::Wall, World::Windows, "windows opened"),
        (10, Kind::Wall, World::SunFromAnotherSide, "sun from another side"),
        (11, Kind::Wall, World::Clock, "clock one hour off"),
        (12, Kind::Wall, World::People, "people unmeasured"),
        (13, Kind::Wall, World::Meter, "heat meter 10 % off"),
    ] {
        let is_wanted = |only: &str| only == name || (only == "worlds" && world != World::Matched);
        if only.as_deref().is_some_and(|only| !is_wanted(only)) {
            continue;
        }
        let count = if kind == Kind::Silent { houses / 4 } else { houses };
        let found: Vec<Outcome> = (first..first + count)
            .into_par_iter()
            .flat_map_iter(|house| of_house((kind, world), 10_000 * label + house))
            .collect();
        print_kind(name, &found);
    }
}

fn of_house((kind, world): (Kind, World), seed: u64) -> Vec<Outcome> {
    let mut random = Random::new(seed, 77);
    let house = House::random(kind, &mut random);
    let telemetry = house.simulate(world, &mut random);
    match identify(&telemetry, &IdentifySettings::default()) {
        Ok(found) => outcomes(&house, &found.report),
        Err(error) => {
            println!("seed {seed}: {error}");
            Vec::new()
        }
    }
}

fn print_kind(name: &str, found: &[Outcome]) {
    let houses = found.iter().filter(|outcome| outcome.quantity == "heat capacity");
    let states: Vec<usize> =
        (1..=3).map(|states| houses.clone().filter(|house| house.states == states).count()).collect();
    let sunlit = houses.clone().filter(|house| house.sunlit).count();
    println!("{name}: {} houses; 1, 2, 3 states chosen {states:?}, sun on a mass in {sunlit}", houses.clone().count());
    let warned = houses.clone().filter(|house| !house.causes.is_empty()).count();
    let of = |cause| houses.clone().filter(|house| house.causes.contains(&cause)).count();
    use SuspectedCause::{Clock, Halves, People, Sun, Windows};
    println!(
        "  warned of a wrong world {warned}: clock {}, sun {}, people {}, windows {}, halves {}",
        of(Clock),
        of(Sun),
        of(People),
        of(Windows),
        of(Halves)
    );
    for quantity in ["heat capacity", "conductance to outdoor", "aperture to the sun"] {
        let of: Vec<&Outcome> = found.iter().filter(|outcome| outcome.quantity == quantity).collect();
        let bounded: Vec<&&Outcome> =
            of.iter().filter(|it| it.interval.0.is_some() || it.interval.1.is_some()).collect();
        let holds = |it: &Outcome| {
            it.interval.0.is_none_or(|low| low <= it.truth) && it.interval.1.is_none_or(|high| it.truth <= high)
        };
        let by_states: Vec<String> = (1..=3)
            .map(|states| {
                let of: Vec<&&&Outcome> = bounded.iter().filter(|it| it.states == states).collect();
                format!("{}/{}", of.iter().filter(|it| holds(it)).count(), of.len())
            })
            .collect();
        let covered = bounded.iter().filter(|it| holds(it)).count();
        let identified: Vec<&&Outcome> = of.iter().filter(|it| it.confidence == Confidence::Identified).collect();
        let is_off = |it: &Outcome| it.value.is_none_or(|value| (value / it.truth - 1.0).abs() > 0.25);
        let wrong = identified.iter().filter(|it| is_off(it)).count();
        let outside = identified.iter().filter(|it| !holds(it)).count();
        let errors: Vec<f64> = of.iter().filter_map(|it| Some(it.value? / it.truth - 1.0)).collect();
        let largest = errors.iter().fold(0.0_f64, |largest, error| largest.max(error.abs()));
        println!(
            "  {quantity:24} {covered} of {} intervals hold the truth ({}); {} identified, of them {wrong} off by more than 25 %, \
             {outside} outside of their interval; largest error {:.0} %",
            bounded.len(),
            by_states.join(", "),
            identified.len(),
            100.0 * largest
        );
    }
}
