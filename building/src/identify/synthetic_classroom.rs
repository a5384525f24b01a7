//! A synthetic classroom with known parameters, for Figs. 2.5 and 2.6 and for tests: the original measurements are not public.
//!
//! The classroom lies between two other rooms and the outdoors. An on-off thermostat cools it, with a set-point that changes
//! every two hours and so excites the temperatures. It is occupied on a known schedule, and disturbed by unmeasured heat. Parameters are those of Table 2.1 (1000 kJ/K, 31.25 K/kW outwards, 62.5 K/kW to each room), the
//! step is the dissertation's 15 minutes, and time is cut by forward Euler, as in eq. 2.3.

use interplay_common::random::Random;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::telemetry::{Boundary, Hold, MeasuredWall, MeasuredZone, Neighbour, Telemetry};

/// Sampling time \[s\].
pub const STEP_S: f64 = 900.0;
/// Heat capacity of each room \[kJ/K\].
pub const CAPACITY_KJ_PER_K: f64 = 1000.0;
/// Resistance between a room and the outdoors \[K/kW\].
pub const OUTDOOR_K_PER_KW: f64 = 31.25;
/// Resistance between the classroom and each room beside it \[K/kW\].
pub const ROOM_K_PER_KW: f64 = 62.5;
/// Temperature beyond the rooms beside the classroom \[°C\].
const BEYOND_C: f64 = 24.5;
/// Steps of a day of 86,400 s, each of `STEP_S`.
const STEPS_PER_DAY: usize = 96;

/// The settings of a simulated classroom.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Classroom {
    /// Number of simulated days.
    pub days: usize,
    /// Seed of all random numbers.
    pub seed: u64,
    /// Standard deviation of the noise of each temperature sensor \[K\].
    pub sensor_noise_k: f64,
    /// The disturbance of the room besides the sun.
    pub disturbance: RoomDisturbance,
}

/// The kind of disturbance of the room besides the sun.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RoomDisturbance {
    /// Smooth over some hours: what a kernel smoother takes out.
    Smooth,
    /// An ARMA(2,1) process, what the dissertation's residual model describes.
    #[default]
    Arma,
}

impl Default for Classroom {
    fn default() -> Self {
        Self { days: 27, seed: 1, sensor_noise_k: 0.02, disturbance: RoomDisturbance::Arma }
    }
}

impl Classroom {
    /// The telemetry of the simulated classroom: zone `classroom` between boundaries `outdoor`, `room-b` and `room-c`.
    pub fn simulate(&self) -> Telemetry {
        let rows = STEPS_PER_DAY * self.days + 1;
        let outdoor_c = outdoor(&mut Random::new(self.seed, 1), rows);
        let schedule_kw: Vec<f64> = (0..rows).map(|row| if occupied(row) { 0.32 } else { 0.02 }).collect();
        let disturbance_k = self.disturbance_k(&mut Random::new(self.seed, 2), rows);
        let rooms = simulate_rooms(&mut Random::new(self.seed, 3), &outdoor_c, &schedule_kw, &disturbance_k);
        let mut noise = Random::new(self.seed, 4);
        let mut measured =
            |series: &[f64]| series.iter().map(|value| value + noise.normal(0.0, self.sensor_noise_k)).collect();
        let zone = MeasuredZone {
            name: "classroom".into(),
            temperature_c: measured(&rooms.temperature_c[0]),
            power_kw: rooms.cooling_kw.iter().zip(&schedule_kw).map(|(cooling, people)| cooling + people).collect(),
            power_has_unit: true,
            power_hold: Hold::ZeroOrder,
            supply_air: Vec::new(),
            irradiance_kw_per_m2: None,
            irradiance_hold: Hold::FirstOrder,
        };
        let mut boundary =
            |name: &str, series| Boundary { name: name.into(), temperature_c: measured(series), hold: Hold::ZeroOrder };
        let boundaries = vec![
            boundary("outdoor", &outdoor_c),
            boundary("room-b", &rooms.temperature_c[1]),
            boundary("room-c", &rooms.temperature_c[2]),
        ];
        Telemetry {
            step_s: STEP_S,
            time_s: (0..rows).map(|row| row as f64 * STEP_S).collect(),
            segments: std::iter::once(0..rows).collect(),
            left_out_rows: 0,
            zones: vec![zone],
            boundaries,
            walls: (0..3).map(|boundary| MeasuredWall { zone: 0, other: Neighbour::Boundary(boundary) }).collect(),
        }
    }

    /// q \[K per step\]: sun by day, and what comes and goes.
    fn disturbance_k(&self, random: &mut Random, rows: usize) -> Vec<f64> {
        let sun = |row: usize| 0.03 * turn(hour(row) - 7.0, 24.0).0.max(0.0);
        let other = match self.disturbance {
            RoomDisturbance::Smooth => {
                let white: Vec<f64> = (0..rows + 80).map(|_| random.normal(0.0, 0.06)).collect();
                (0..rows).map(|row| gaussian_mean(&white[row..=row + 80], 10.0)).collect()
            }
            RoomDisturbance::Arma => arma_process(random, rows),
        };
        other.iter().enumerate().map(|(row, other): (usize, &f64)| other + sun(row)).collect()
    }
}

/// Temperatures of the classroom and the rooms beside it, and the classroom's cooling.
struct Rooms {
    temperature_c: [Vec<f64>; 3],
    cooling_kw: Vec<f64>,
}

fn simulate_rooms(random: &mut Random, outdoor_c: &[f64], schedule_kw: &[f64], disturbance_k: &[f64]) -> Rooms {
    let (out, between, gain) = (1.0 / OUTDOOR_K_PER_KW, 1.0 / ROOM_K_PER_KW, STEP_S / CAPACITY_KJ_PER_K);
    let mut now = [25.0, 26.0, 25.5];
    let mut thermostats = [Thermostat::new(24.0), Thermostat::new(24.0), Thermostat::new(25.0)];
    let mut rooms = Rooms { temperature_c: Default::default(), cooling_kw: Vec::new() };
    for row in 0..outdoor_c.len() {
        let cooling_kw: Vec<f64> =
            thermostats.iter_mut().zip(now).map(|(thermostat, now)| thermostat.cooling_kw(random, row, now)).collect();
        rooms.temperature_c.iter_mut().zip(now).for_each(|(series, now)| series.push(now));
        rooms.cooling_kw.push(cooling_kw[0]);
        let people = schedule_kw[row];
        let flow = |room: usize, neighbours: [f64; 2]| {
            let walls: f64 = neighbours.iter().map(|other| between * (other - now[room])).sum();
            out * (outdoor_c[row] - now[room]) + walls + cooling_kw[room]
        };
        now = [
            now[0] + gain * (flow(0, [now[1], now[2]]) + people) + disturbance_k[row] + random.normal(0.0, 0.01),
            now[1]
                + gain * (flow(1, [now[0], BEYOND_C]) + 0.9 * people)
                + 0.5 * disturbance_k[row]
                + random.normal(0.0, 0.02),
            now[2]
                + gain * (flow(2, [now[0], BEYOND_C]) + 0.9 * people)
                + 0.5 * disturbance_k[row]
                + random.normal(0.0, 0.02),
        ];
    }
    rooms
}

/// Cools at about 1.4 kW, or not at all, around a set-point that changes every two hours.
struct Thermostat {
    usual_c: f64,
    set_c: f64,
    on: bool,
}

impl Thermostat {
    fn new(usual_c: f64) -> Self {
        Self { usual_c, set_c: usual_c, on: false }
    }

    fn cooling_kw(&mut self, random: &mut Random, row: usize, temperature_c: f64) -> f64 {
        if row.is_multiple_of(8) {
            let choice = random.uniform(0.0, 4.0);
            self.set_c = self.usual_c + libm::floor(choice) - 1.5;
        }
        self.on = if self.on { temperature_c >= self.set_c - 0.3 } else { temperature_c > self.set_c + 0.3 };
        // The number is drawn even if it is not used, so that the state of one room does not change the random numbers of another.
        let power_kw = 1.4 * random.normal(1.0, 0.2);
        if self.on { -power_kw } else { 0.0 }
    }
}

/// Outdoor temperature \[°C\]: daily harmonics, and weather that comes and goes over days.
fn outdoor(random: &mut Random, rows: usize) -> Vec<f64> {
    let (keep, deviation): (f64, f64) = (0.97, 0.9);
    let mut weather = 0.0;
    (0..rows)
        .map(|row| {
            weather = keep * weather + random.normal(0.0, deviation * (1.0 - keep * keep).sqrt());
            28.3 + 3.0 * turn(hour(row) - 14.2, 24.0).1 + 0.5 * turn(hour(row) - 13.0, 12.0).1 + weather
        })
        .collect()
}

/// v_t = 1.55 v_{t−1} − 0.6 v_{t−2} + e_t + 0.4 e_{t−1}, with e of 0.004 K.
fn arma_process(random: &mut Random, rows: usize) -> Vec<f64> {
    let (mut v1, mut v2, mut e1) = (0.0, 0.0, 0.0);
    (0..rows)
        .map(|_| {
            let e = random.normal(0.0, 0.004);
            let v = 1.55 * v1 - 0.6 * v2 + e + 0.4 * e1;
            (v2, v1, e1) = (v1, v, e);
            v
        })
        .collect()
}

/// The mean of a window, weighted by a Gaussian about its centre.
fn gaussian_mean(window: &[f64], bandwidth: f64) -> f64 {
    let centre = (window.len() / 2) as f64;
    let weight = |index: usize| {
        let distance = (index as f64 - centre) / bandwidth;
        libm::exp(-0.5 * distance * distance)
    };
    let total: f64 = (0..window.len()).map(weight).sum();
    window.iter().enumerate().map(|(index, value)| weight(index) * value).sum::<f64>() / total
}

/// Hour of the day at a row.
fn hour(row: usize) -> f64 {
    (row % STEPS_PER_DAY) as f64 * STEP_S / 3600.0
}

/// Whether classes are held.
fn occupied(row: usize) -> bool {
    let hour = hour(row);
    8.0 < hour && hour < 19.0
}

/// Sine and cosine of a part of a period.
fn turn(time: f64, period: f64) -> (f64, f64) {
    let angle = std::f64::consts::TAU * time / period;
    (libm::sin(angle), libm::cos(angle))
}
