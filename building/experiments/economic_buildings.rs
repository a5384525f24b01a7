//! Ten random buildings in winter, with a heat pump and prices by the hour: what each controller pays, at which discomfort.
//!
//! ```sh
//! cargo run --release -p interplay-building --example economic_buildings
//! ```
//!
//! Buildings have 2 to 12 zones; weather, people and their deviations, prices and forecast errors follow from the seed. The economic
//! controller wins in a building if no controller with at most its discomfort pays less.
//!
//! With `scales` as the second argument only the economic controller runs, in the same buildings with limits of 20, 1e3 and 1e6 kW,
//! and with prices multiplied by 1e-3 and 1e3: its money should be the same share of the optimum.

#![allow(clippy::print_stdout, reason = "an example talks to its user")]

mod closed_loop;

use std::error::Error;

use closed_loop::World;
use interplay_building::comfort::{Agenda, Setpoints};
use interplay_building::control::Controller;
use interplay_building::control::economic::EconomicSettings;
use interplay_building::control::predictive::PredictiveSettings;
use interplay_building::day::Surroundings;
use interplay_building::discretise::Model;
use interplay_building::energy::{CopPoint, HeatPump, Tariff};
use interplay_building::network::{AMBIENT, Network, Wall, Zone};
use interplay_building::occupancy::Occupancy;
use interplay_building::weather::{Climate, ErrorLevel, Forecast};
use interplay_common::random::Random;

const BUILDINGS: u64 = 10;
const DAYS: usize = 7;
/// What differs from a building as it is drawn.
#[derive(Clone, Copy)]
struct Variation {
    name: &'static str,
    /// Heating limit of all zones \[kW\].
    limit_kw: Option<f64>,
    /// Factor of all prices.
    price: f64,
}

const USUAL: Variation = Variation { name: "as drawn", limit_kw: None, price: 1.0 };
const SCALES: [Variation; 6] = [
    USUAL,
    Variation { name: "limits of 20 kW", limit_kw: Some(20.0), ..USUAL },
    Variation { name: "limits of 1e3 kW", limit_kw: Some(1e3), ..USUAL },
    Variation { name: "limits of 1e6 kW", limit_kw: Some(1e6), ..USUAL },
    Variation { name: "prices times 1e-3", price: 1e-3, ..USUAL },
    Variation { name: "prices times 1e3", price: 1e3, ..USUAL },
];

const STEP_S: f64 = 1800.0;
const STEPS: usize = 48;

/// Zones in a random tree of inner walls, each with an outer wall; two of three walls store heat.
fn network(random: &mut Random, count: usize, limit_kw: Option<f64>) -> Result<Network, Box<dyn Error>> {
    let name = |zone: usize| format!("z{zone}");
    let (mut zones, mut walls) = (Vec::new(), Vec::new());
    for zone in 0..count {
        let resistance = random.uniform(8.0, 25.0);
        let capacity_kj_per_k = random.uniform(800.0, 4000.0);
        // Twice what it takes to keep 20 K above the weather.
        let (heating_limit_kw, cooling_limit_kw) = (limit_kw.or(Some(40.0 / resistance)), Some(0.0));
        let solar_aperture_m2 = random.uniform(0.2, 1.5);
        zones.push(Zone {
            capacity_kj_per_k,
            heating_limit_kw,
            cooling_limit_kw,
            solar_aperture_m2,
            ..Zone::named(name(zone))
        });
        let outer = Wall::new(name(zone), AMBIENT, resistance);
        let heavy = random.uniform(3000.0, 15_000.0);
        walls.push(if random.chance(0.67) { outer.with_capacity_kj_per_k(heavy) } else { outer });
        if zone > 0 {
            let before = random.uniform(0.0, zone as f64) as usize;
            let inner = Wall::new(name(before), name(zone), random.uniform(8.0, 40.0));
            let heavy = random.uniform(1000.0, 5000.0);
            walls.push(if random.chance(0.67) { inner.with_capacity_kj_per_k(heavy) } else { inner });
        }
    }
    Ok(Network::new(&zones, &walls)?)
}

fn world(seed: u64, variation: Variation) -> Result<World, Box<dyn Error>> {
    let mut random = Random::new(seed, 77);
    let count = 2 + (seed as usize * 7) % 11;
    let model = Model::exact(&network(&mut random, count, variation.limit_kw)?, STEP_S)?;
    let setpoints = Setpoints {
        occupied_c: (0..count).map(|_| random.uniform(20.5, 22.5)).collect(),
        from_h: 7.0,
        to_h: 20.0,
        band_k: 1.0,
        input_weight: 0.1,
        ..Setpoints::default()
    };
    let climate = Climate {
        mean_c: random.uniform(-2.0, 6.0),
        day_deviation_k: 2.0,
        storm_probability: 0.0,
        ..Climate::default()
    };
    let prices_per_kwh = (0..24 * DAYS)
        .map(|hour| {
            let hour = (hour % 24) as f64;
            let peaks = libm::exp(-(hour - 8.0).powi(2) / 6.0) + 1.3 * libm::exp(-(hour - 18.5).powi(2) / 6.0);
            variation.price * (0.16 + 0.16 * peaks + random.normal(0.0, 0.02))
        })
        .collect();
    let tariff = Tariff { prices_per_kwh, ..Tariff::default() };
    let point = |outdoor_c, cop| CopPoint { outdoor_c, cop };
    let heat_pump =
        HeatPump { heating: vec![point(-10.0, 2.0), point(0.0, 2.8), point(10.0, 3.9)], cooling: Vec::new() };
    Ok(World {
        agenda: Agenda::new(setpoints, count, STEP_S, STEPS)?.supplied(Some(tariff), Some(heat_pump)),
        surroundings: Surroundings::new(
            climate.weather(seed, DAYS + 1),
            (Forecast::Uncertain { level: ErrorLevel::Medium }, seed),
            Occupancy::default().people(count, seed),
            model.network(),
        ),
        believed: model.clone(),
        model,
        steps: STEPS,
        initial_c: 20.0,
        days: DAYS,
    })
}

/// The economic controller under each variation of each building.
fn scales(buildings: u64) -> Result<(), Box<dyn Error>> {
    println!("| building | zones | variation | money over its factor | discomfort [K·h] | above the optimum |");
    println!("|---|---|---|---|---|---|");
    for seed in 0..buildings {
        for variation in SCALES {
            let world = world(seed, variation)?;
            let totals = world.run(&Controller::EconomicMpc(EconomicSettings::default()))?;
            let best = world.least_money(&totals)?;
            println!(
                "| {} | {} | {} | {:.4} | {:.3} | {:.2} % |",
                seed + 1,
                world.model.network().zone_count(),
                variation.name,
                totals.money / variation.price,
                totals.discomfort_k_h,
                100.0 * (totals.money / best.energy_cost - 1.0)
            );
        }
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let economic = EconomicSettings::default();
    let predictive = PredictiveSettings::default();
    let controllers = [
        ("economic-mpc", Controller::EconomicMpc(economic)),
        (
            "economic-mpc, nothing learned",
            Controller::EconomicMpc(EconomicSettings { learn_forecast: false, ..economic }),
        ),
        ("thermostat", Controller::Thermostat(Default::default())),
        ("pid", Controller::Pid(Default::default())),
        ("iterative-learning", Controller::IterativeLearning(Default::default())),
        ("model-predictive", Controller::ModelPredictive(predictive)),
        ("iterative", Controller::Iterative(Default::default())),
        ("concurrent", Controller::Concurrent(Default::default())),
        ("distributed", Controller::Distributed(Default::default())),
    ];
    let buildings = std::env::args().nth(1).map_or(Ok(BUILDINGS), |count| count.parse())?;
    if std::env::args().nth(2).is_some_and(|mode| mode == "scales") {
        return scales(buildings);
    }
    let mut wins = 0;
    println!("| building | zones | controller | EUR | discomfort [K·h] | above the optimum | design of a day [ms] |");
    println!("|---|---|---|---|---|---|---|");
    for seed in 0..buildings {
        let world = world(seed, USUAL)?;
        let (mut own, mut is_beaten) = ((f64::INFINITY, 0.0), false);
        for (place, (name, controller)) in controllers.iter().enumerate() {
            let head = format!("| {} | {} | {name} |", seed + 1, world.model.network().zone_count());
            let totals = match world.run(controller) {
                Ok(totals) => totals,
                Err(error) => {
                    println!("{head} refused: {error} | | | |");
                    continue;
                }
            };
            let best = world.least_money(&totals)?;
            let (money, discomfort) = (totals.money, totals.discomfort_k_h);
            if place == 0 {
                own = (money, discomfort);
            } else if place > 1 {
                is_beaten |= money < own.0 && discomfort <= own.1;
            }
            let above = 100.0 * (money / best.energy_cost - 1.0);
            println!("{head} {money:.2} | {discomfort:.3} | {above:.1} % | {:.1} |", 1e3 * totals.design_s);
        }
        wins += u64::from(!is_beaten);
    }
    println!("\nEconomic MPC wins in {wins} of {buildings} buildings.");
    Ok(())
}
