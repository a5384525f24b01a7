//! The reference optima and the days they belong to.

use interplay_building::comfort::{Setpoints, Targets};
use interplay_building::control::{Control, DayRecord, Disturbance};
use interplay_building::day::{Surroundings, run_day};
use interplay_building::discretise::Model;
use interplay_building::lifted::Lifted;
use interplay_building::network::{AMBIENT, Network, Wall, Zone};
use interplay_building::occupancy::Occupancy;
use interplay_building::weather::{Climate, ErrorLevel, Forecast};
use serde_json::Value;

pub const STEP_S: f64 = 1800.0;
pub const STEPS: usize = 48;

/// The optima of independent code.
pub fn optima() -> Value {
    serde_json::from_str(include_str!("../data/optima.json")).expect("part of the repository")
}

pub fn floats(value: &Value) -> Vec<f64> {
    match value {
        Value::Array(items) => items.iter().flat_map(floats).collect(),
        number => vec![number.as_f64().expect("a number")],
    }
}

pub fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

/// The testbed with the two walls of 10000 K·min/kJ that Table 2.1 lists and the preset leaves out, with its capacities,
/// inner and outer resistances multiplied.
pub fn testbed_scaled(capacity: f64, inner: f64, outer: f64) -> Model {
    let zones: Vec<Zone> =
        ["1", "2", "3", "4"].map(|name| Zone { capacity_kj_per_k: 1000.0 * capacity, ..Zone::named(name) }).to_vec();
    let wall = |(a, b), resistance| Wall::new(a, b, resistance);
    let mut walls: Vec<Wall> =
        [("1", "2"), ("1", "3"), ("2", "4"), ("3", "4")].map(|ends| wall(ends, 62.5 * inner)).to_vec();
    walls.extend([("1", "4"), ("2", "3")].map(|ends| wall(ends, 600_000.0)));
    walls.extend(["1", "2", "3", "4"].map(|zone| Wall::new(zone, AMBIENT, 31.25 * outer)));
    Model::euler(&Network::new(&zones, &walls).expect("valid"), STEP_S).expect("stable")
}

pub fn testbed() -> Model {
    testbed_scaled(1.0, 1.0, 1.0)
}

pub fn lifted() -> Lifted {
    Lifted::new(&testbed(), STEPS)
}

/// Forecast and reality of a day of `days.json`.
pub fn day(day: usize) -> (Disturbance, Disturbance) {
    let days: Value = serde_json::from_str(include_str!("../data/days.json")).expect("part of the repository");
    let of = |ambient: &str, gains: &str| Disturbance {
        ambient_c: floats(&days[ambient][day]),
        gains_kw: floats(&days[gains][day]),
    };
    (of("T0_fc", "w_fc"), of("T0_real", "w_real"))
}

/// Targets of chapter 3, with 30 °C at night at this weight.
pub fn chapter_3(night_weight: f64) -> Targets {
    let setpoints = Setpoints {
        occupied_c: vec![24.0, 25.0, 26.0, 27.0],
        other_c: Some(30.0),
        other_weight: night_weight,
        ..Setpoints::default()
    };
    setpoints.targets(4, STEP_S, STEPS).expect("valid")
}

/// Targets of chapter 4, free at night.
pub fn chapter_4() -> Targets {
    let setpoints = Setpoints {
        occupied_c: vec![22.5, 22.0, 23.0, 23.5],
        from_h: 7.5,
        to_h: 18.0,
        occupied_weight: 2.0,
        ..Setpoints::default()
    };
    setpoints.targets(4, STEP_S, STEPS).expect("valid")
}

/// Targets of chapter 5, free at night.
pub fn chapter_5(wanted_c: Vec<f64>, zones: usize) -> Targets {
    let setpoints = Setpoints { occupied_c: wanted_c, occupied_weight: 2.0, band_k: 1.0, ..Setpoints::default() };
    setpoints.targets(zones, STEP_S, STEPS).expect("valid")
}

pub fn run(
    plant: &Model,
    initial_c: f64,
    controller: &mut dyn Control,
    targets: &Targets,
    days: &[(Disturbance, Disturbance)],
) -> Vec<DayRecord> {
    let mut temperatures_c = vec![initial_c; plant.network().node_count()];
    days.iter()
        .map(|(forecast, actual)| {
            run_day(plant, &mut temperatures_c, controller, targets, forecast, actual).expect("the run goes on")
        })
        .collect()
}

pub fn assert_close(got: f64, want: f64, relative: f64) {
    assert!((got - want).abs() <= relative * want.abs(), "{got} instead of {want}: {:e}", got / want - 1.0);
}

/// Days of a synthetic climate with a forecast of medium error, and people who deviate from their schedule.
pub fn synthetic(seed: u64, days: usize, zones: usize) -> Vec<(Disturbance, Disturbance)> {
    let forecast = Forecast::Uncertain { level: ErrorLevel::Medium };
    // The zones have no windows: of the model, only the step matters.
    let model = Model::exact(&Network::grid(1, zones), STEP_S).expect("stable");
    let (weather, people) = (Climate::default().weather(seed, days), Occupancy::default().people(zones, seed));
    let surroundings = Surroundings::new(weather, (forecast, seed), people, model.network());
    (0..days).map(|day| (surroundings.forecast(&model, STEPS, day), surroundings.actual(&model, STEPS, day))).collect()
}

/// Independent standard normal numbers, the same every time (Irwin and Hall's sum of twelve).
pub fn normal_numbers(count: usize) -> Vec<f64> {
    super::numbers(12 * count, 0.5).chunks_exact(12).map(|twelve| twelve.iter().sum()).collect()
}
