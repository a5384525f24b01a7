//! How long one plan of the economic controller takes: 100 zones, 96 steps of a quarter of an hour.
//!
//! ```sh
//! cargo bench -p interplay-building --bench economic
//! ```

#![allow(clippy::print_stdout, reason = "a benchmark talks to its user")]

use std::time::Instant;

use interplay_building::comfort::Setpoints;
use interplay_building::control::economic::EconomicSettings;
use interplay_building::control::{Controller, DayAhead, Disturbance, Observation};
use interplay_building::discretise::Model;
use interplay_building::network::{AMBIENT, Network, Wall, Zone};

const STEP_S: f64 = 900.0;
const STEPS: usize = 96;
const PLANS: usize = 3;

/// Rooms in a square that are heated and not cooled.
fn heated_grid(side: usize) -> Network {
    let name = |row: usize, column: usize| format!("{row} {column}");
    let (mut zones, mut walls) = (Vec::new(), Vec::new());
    for (row, column) in (0..side).flat_map(|row| (0..side).map(move |column| (row, column))) {
        let here = name(row, column);
        zones.push(Zone { heating_limit_kw: Some(2.0), cooling_limit_kw: Some(0.0), ..Zone::named(&here) });
        walls.push(Wall::new(&here, AMBIENT, 31.25));
        for (row, column) in [(row + 1, column), (row, column + 1)] {
            if row < side && column < side {
                walls.push(Wall::new(&here, name(row, column), 62.5));
            }
        }
    }
    Network::new(&zones, &walls).expect("valid")
}

fn main() {
    let settings = EconomicSettings::default();
    let cases = [
        ("every step has an input", EconomicSettings { block_h: 0.0, ..settings }),
        ("blocks of an hour after 6 h", settings),
    ];
    println!("| zones | plan | s, the fastest of {PLANS} |\n|---|---|---|");
    for side in [3, 5, 10] {
        for (name, settings) in cases {
            let model = Model::exact(&heated_grid(side), STEP_S).expect("valid");
            let zones = side * side;
            let setpoints = Setpoints { occupied_c: vec![21.0], band_k: 1.0, ..Setpoints::default() };
            let targets = setpoints.targets(zones, STEP_S, STEPS).expect("valid");
            let hour = |t: usize| t as f64 / STEPS as f64 * std::f64::consts::TAU;
            let day = Disturbance {
                ambient_c: (0..STEPS).map(|t| 8.0 - 4.0 * hour(t).cos()).collect(),
                gains_kw: (0..zones * STEPS).map(|i| 0.02 * (i % 7) as f64).collect(),
            };
            let initial_c = vec![20.0; zones];
            let mut controller = Controller::EconomicMpc(settings).controller(&model, STEPS).expect("valid");
            let ahead =
                DayAhead { initial_c: &initial_c, targets: &targets, forecast: &day, outlook: None, actual: None };
            controller.start_of_day(&ahead).expect("fits");
            let fastest_s = (0..PLANS)
                .map(|_| {
                    let began = Instant::now();
                    controller.act(&Observation { step: 0, temperatures_c: &initial_c, targets: &targets });
                    assert!(controller.trouble().is_none(), "{:?}", controller.trouble());
                    began.elapsed().as_secs_f64()
                })
                .fold(f64::INFINITY, f64::min);
            println!("| {zones} | {name} | {fastest_s:.3} |");
        }
    }
}
