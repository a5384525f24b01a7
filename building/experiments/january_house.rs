//! The house with a heat pump in January: what each controller pays, and the optimum of the whole run.
//!
//! ```sh
//! cargo run --release -p interplay-building --example january_house -- january-house.toml DEU_Mannheim.epw prices.csv
//! ```
//!
//! Scenario, weather and prices are files of the caller. Lines on standard error are what `optimum_by_highs.py` needs to find the
//! optimum of a run with a perfect forecast by independent code.

#![allow(clippy::print_stdout, clippy::print_stderr, reason = "an example talks to its user")]

mod closed_loop;

use std::error::Error;
use std::fs;

use closed_loop::World;
use interplay_building::calendar::Calendar;
use interplay_building::comfort::{Agenda, Setpoints};
use interplay_building::control::Controller;
use interplay_building::control::economic::EconomicSettings;
use interplay_building::control::predictive::PredictiveSettings;
use interplay_building::day::Surroundings;
use interplay_building::discretise::Model;
use interplay_building::energy::{HeatPump, Tariff};
use interplay_building::network::{Network, Wall, Zone};
use interplay_building::occupancy::{Deviation, Occupancy};
use interplay_building::schedule::{Timetable, ZoneSchedule};
use interplay_building::weather::{Epw, ErrorLevel, Forecast, TimeSeries, Weather};
use serde::de::DeserializeOwned;
use toml::{Table, Value};

const STEP_S: f64 = 900.0;
const STEPS: usize = 96;
/// The seeds that the application makes of the scenario's seed 3.
const OCCUPANCY_SEED: u64 = 3 ^ (1 << 40);
const FORECAST_SEED: u64 = 3 ^ (2 << 40);

fn part<T: DeserializeOwned>(table: &Table, key: &str) -> Result<T, Box<dyn Error>> {
    Ok(table.get(key).cloned().unwrap_or(Value::Table(Table::new())).try_into()?)
}

fn world(files: &[String], forecast: Forecast, deviation: Deviation) -> Result<World, Box<dyn Error>> {
    let scenario: Table = fs::read_to_string(&files[0])?.parse()?;
    let building: Table = part(&scenario, "building")?;
    let zones: Vec<Zone> = part(&building, "zone")?;
    let walls: Vec<Wall> = part(&building, "wall")?;
    let model = Model::exact(&Network::new(&zones, &walls)?, STEP_S)?;
    let epw = Epw::parse(&String::from_utf8_lossy(&fs::read(&files[1])?))?;
    let start_s = epw.midnight_s(1, 14).ok_or("no 14th of January")?;
    let shifted = |series: TimeSeries| TimeSeries { first_s: series.first_s - start_s, ..series };
    let Weather { ambient_c, sun_w_per_m2, .. } = epw.weather();
    let weather = Weather { ambient_c: shifted(ambient_c), sun_w_per_m2: shifted(sun_w_per_m2), sky: None };
    let days = part::<Calendar>(&scenario, "calendar")?.days(None)?;
    let schedules: Vec<ZoneSchedule> = part(&scenario, "schedule")?;
    let names = model.network().names()[..zones.len()].to_vec();
    let timetable = Timetable::new(&schedules, &names, days)?;
    let prices = fs::read_to_string(&files[2])?;
    let prices_per_kwh = prices.lines().skip(1).filter_map(|line| line.split(',').nth(1)?.parse().ok()).collect();
    let tariff = Tariff { prices_per_kwh, ..Tariff::default() };
    let heat_pump: HeatPump = part(&scenario, "heat_pump")?;
    let setpoints: Setpoints = part(&scenario, "setpoints")?;
    let people = Occupancy { deviation, ..Occupancy::default() }
        .people(zones.len(), OCCUPANCY_SEED)
        .following(timetable.clone());
    Ok(World {
        agenda: Agenda::new(setpoints, zones.len(), STEP_S, STEPS)?
            .following(timetable)
            .supplied(Some(tariff), Some(heat_pump)),
        surroundings: Surroundings::new(weather, (forecast, FORECAST_SEED), people, model.network()),
        believed: model.clone(),
        model,
        steps: STEPS,
        initial_c: 20.0,
        days: 14,
    })
}

fn main() -> Result<(), Box<dyn Error>> {
    let files: Vec<String> = std::env::args().skip(1).collect();
    if files.len() < 3 {
        return Err("state the scenario, the weather file and the prices".into());
    }
    let predictive = PredictiveSettings { horizon_h: 24.0, ..PredictiveSettings::default() };
    let economic = EconomicSettings::default();
    let controllers = [
        ("thermostat", Controller::Thermostat(Default::default())),
        ("pid", Controller::Pid(Default::default())),
        ("model-predictive", Controller::ModelPredictive(predictive)),
        ("economic-mpc", Controller::EconomicMpc(economic)),
        ("without margin", Controller::EconomicMpc(EconomicSettings { margin_k: Some(0.0), ..economic })),
        ("without learning", Controller::EconomicMpc(EconomicSettings { learn_forecast: false, ..economic })),
        ("without blocks", Controller::EconomicMpc(EconomicSettings { block_h: 0.0, ..economic })),
        ("12 h ahead", Controller::EconomicMpc(EconomicSettings { horizon_h: 12.0, ..economic })),
    ];
    println!(
        "| forecast | controller | EUR | discomfort [K·h] | optimum of the run [EUR] | above it | design of a day [ms] |"
    );
    println!("|---|---|---|---|---|---|---|");
    let uncertain = Forecast::Uncertain { level: ErrorLevel::Medium };
    let cases = [
        ("perfect", Forecast::Exact, Deviation::NONE),
        ("perfect weather", Forecast::Exact, Deviation::default()),
        ("as in the file", uncertain, Deviation::default()),
    ];
    for (word, forecast, deviation) in cases {
        let world = world(&files, forecast, deviation)?;
        for (name, controller) in &controllers {
            let totals = world.run(controller)?;
            let best = world.least_money(&totals)?;
            let above = 100.0 * (totals.money / best.energy_cost - 1.0);
            println!(
                "| {word} | {name} | {:.2} | {:.2} | {:.2} | {above:.1} % | {:.1} |",
                totals.money,
                totals.discomfort_k_h,
                best.energy_cost,
                1e3 * totals.design_s
            );
            let end_c: Vec<String> = totals.end_c.iter().map(f64::to_string).collect();
            eprintln!("{word}, {name}: end {} optimum {}", end_c.join(" "), best.energy_cost);
        }
    }
    Ok(())
}
