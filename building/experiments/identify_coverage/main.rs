//! How often the intervals of the method `state-space` hold the truth, and how often "identified" is wrong: houses with one, two
//! and three temperatures, simulated with random parameters, weather, heaters, disturbances and sampling times.
//!
//! ```sh
//! cargo run --release -p interplay-building --example identify_coverage -- 100
//! ```
//!
//! The first argument is the number of houses of each kind; the second one, if there is one, the number of the first house
//! (0), and the third one the only kind, or `worlds` for all but those with a right world. The houses are simulated in steps of
//! six seconds; telemetry is sampled every 5 to 60 minutes.
//!
//! - Heaters switch, or change their power, inside of rows ([`heater::Heater`]). Each house in the right world is also identified with the
//!   mean heat of each row held in it, for comparison.
//! - Houses with one, two and three temperatures.
//! - `two states, silent`: heated and mild all the time alike, so that the data say next to nothing of the capacity.
//! - 30 to 100 % of the sun fall on the wall, or on the interior mass.
//! - Worlds that differ from what the models take for granted ([`world::World`]).

#![allow(clippy::print_stdout, reason = "this is a program: its results go to standard output")]

mod heater;
mod house;
mod summary;
mod world;

use heater::Way;
use house::{House, Kind};
use interplay_building::identify::{
    Confidence, IdentificationReport, IdentifySettings, SuspectedCause, Telemetry, identify,
};
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
}

/// What one house showed.
struct HouseOutcome {
    quantities: Vec<Outcome>,
    /// The same quantities with the heat of each row held, in the right world.
    held: Vec<Outcome>,
    way: Way,
    states: usize,
    /// Whether the chosen model has sun on a mass.
    sunlit: bool,
    /// What the data are said to contradict, the most probable cause first.
    causes: Vec<SuspectedCause>,
}

fn quantities(house: &House, report: &IdentificationReport) -> Vec<Outcome> {
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
        (14, Kind::Wall, World::LateHeat, "heat late"),
        (15, Kind::Wall, World::Electricity, "electricity for heat"),
    ] {
        let is_wanted = |only: &str| only == name || (only == "worlds" && world != World::Matched);
        if only.as_deref().is_some_and(|only| !is_wanted(only)) {
            continue;
        }
        let count = if kind == Kind::Silent { houses / 4 } else { houses };
        let found: Vec<HouseOutcome> = (first..first + count)
            .into_par_iter()
            .filter_map(|house| of_house((kind, world), house, 10_000 * label + house))
            .collect();
        summary::print(name, world, &found);
    }
}

fn of_house((kind, world): (Kind, World), number: u64, seed: u64) -> Option<HouseOutcome> {
    let mut random = Random::new(seed, 77);
    let house = House::random(kind, &mut random);
    let way = Way::of_house(number);
    let [switching, held] = house.simulate(world, way, &mut random);
    let report = |telemetry: &Telemetry| match identify(telemetry, &IdentifySettings::default()) {
        Ok(found) => Some(found.report),
        Err(error) => {
            println!("seed {seed}: {error}");
            None
        }
    };
    let found = report(&switching)?;
    let held =
        if world == World::Matched && kind != Kind::Silent { quantities(&house, &report(&held)?) } else { Vec::new() };
    let chosen = found.models.iter().find(|model| model.chosen);
    Some(HouseOutcome {
        quantities: quantities(&house, &found),
        held,
        way,
        states: chosen.map_or(0, |model| model.states),
        sunlit: chosen.is_some_and(|model| model.model.contains("sun on")),
        causes: found.suspicions.iter().map(|it| it.cause).collect(),
    })
}
