//! Houses with random parameters, and their telemetry in a world.

use interplay_building::identify::{Boundary, Hold, MeasuredWall, MeasuredZone, Neighbour, Telemetry};
use interplay_common::random::Random;

use super::heater::{Heat, Heater, Way};
use super::world::{Unmeasured, World};

const MINUTES_PER_DAY: usize = 1440;
/// Steps of Euler's method in a minute.
const SUBSTEPS: u32 = 10;
const STEPS_S: [f64; 5] = [300.0, 600.0, 900.0, 1800.0, 3600.0];

#[derive(Clone, Copy, PartialEq)]
pub enum Kind {
    Air,
    Wall,
    WallAndInterior,
    /// As `Wall`, but heated by a constant power in weather that does not change.
    Silent,
    /// As `Wall`, with sun on the wall.
    SunnyWall,
    /// As `WallAndInterior`, with sun on the interior mass.
    SunnyInterior,
}

/// True parameters [kJ/K], [kW/K], [m²].
pub struct House {
    kind: Kind,
    air: f64,
    wall: f64,
    interior: f64,
    inner: f64,
    outer: f64,
    interior_conductance: f64,
    aperture: f64,
    /// Share of the sun that falls on the wall or the interior mass.
    on_mass: f64,
    step_s: f64,
    days: usize,
}

impl House {
    pub fn random(kind: Kind, random: &mut Random) -> Self {
        let ua = libm::exp(random.uniform(libm::log(0.08), libm::log(0.4)));
        let hours = random.uniform(20.0, 80.0);
        let total = ua * hours * 3600.0;
        let inside = random.uniform(0.1, 0.25);
        // Inside of the wall's mass there is the smaller part of its resistance.
        let share = random.uniform(0.1, 0.4);
        let step_s = STEPS_S[(random.uniform(0.0, 5.0) as usize).min(4)];
        let (air, wall, interior) = match kind {
            Kind::Air => (total, 0.0, 0.0),
            Kind::Wall | Kind::Silent | Kind::SunnyWall => (inside * total, (1.0 - inside) * total, 0.0),
            Kind::WallAndInterior | Kind::SunnyInterior => {
                (0.5 * inside * total, 0.6 * total, (0.4 - 0.5 * inside) * total)
            }
        };
        Self {
            kind,
            air,
            wall,
            interior,
            inner: ua / share,
            outer: ua / (1.0 - share),
            interior_conductance: ua * random.uniform(4.0, 10.0),
            aperture: 10.0 * ua * random.uniform(0.5, 1.5),
            on_mass: match kind {
                Kind::SunnyWall | Kind::SunnyInterior => random.uniform(0.3, 1.0),
                _ => 0.0,
            },
            step_s,
            days: 14,
        }
    }

    pub fn ua(&self) -> f64 {
        self.inner * self.outer / (self.inner + self.outer)
    }

    /// What reaches the air of the sun in a steady state, as an aperture.
    pub fn effective_aperture(&self) -> f64 {
        let lost = match self.kind {
            Kind::SunnyWall => self.on_mass * self.outer / (self.inner + self.outer),
            _ => 0.0,
        };
        self.aperture * (1.0 - lost)
    }

    pub fn capacity(&self) -> f64 {
        self.air + self.wall + self.interior
    }

    /// Telemetry under a heater that is controlled in this way, and the same with the mean heat of each row held in it.
    ///
    /// Weather is a straight line over a sampling step, and random heat acts on the air.
    pub fn simulate(&self, world: World, way: Way, random: &mut Random) -> [Telemetry; 2] {
        let stride = (self.step_s / 60.0) as usize;
        let silent = self.kind == Kind::Silent;
        let rows = self.days * MINUTES_PER_DAY / stride + 1;
        let design_kw = self.ua() * 20.0;
        let (mut drift_c, mut cloud) = (0.0, 0.5);
        let (mut outdoor_c, mut sun_kw, mut true_sun_kw) = (Vec::new(), Vec::new(), Vec::new());
        let step_h = self.step_s / 3600.0;
        for row in 0..rows {
            let hour = row as f64 * step_h % 24.0;
            drift_c += -drift_c * step_h / 40.0 + random.normal(0.0, 0.5 * libm::sqrt(step_h));
            cloud = (cloud + random.normal(0.0, 0.15 * libm::sqrt(step_h))).clamp(0.1, 1.0);
            let height = libm::sin(std::f64::consts::PI * (hour - 7.0) / 10.0);
            let day = if (7.0..17.0).contains(&hour) { height } else { 0.0 };
            let true_day = if world == World::SunFromAnotherSide { World::other_side(hour) } else { day };
            outdoor_c.push(if silent {
                5.0
            } else {
                4.0 + 3.5 * libm::sin(std::f64::consts::TAU * (hour - 9.0) / 24.0) + drift_c
            });
            sun_kw.push(if silent { 0.0 } else { 0.4 * cloud * day });
            true_sun_kw.push(if silent { 0.0 } else { 0.4 * cloud * true_day });
        }
        let minutes = (rows - 1) * stride + 1;
        let unmeasured = Unmeasured::new(world, minutes, self.ua(), random);
        let meter = world.meter(random);
        let late = world.clock_rows(self.step_s, random);
        let heater = Heater::random(way, design_kw, random);
        let weather = (outdoor_c.as_slice(), true_sun_kw.as_slice());
        let steady = vec![0.75 * design_kw; rows];
        let heat = if silent { Heat::Held(&steady) } else { Heat::Heater(heater) };
        let mut again = random.clone();
        let (switching_c, heat_kw) = self.temperatures(random, stride, weather, (design_kw, world, &unmeasured), heat);
        let held = Heat::Held(&heat_kw);
        let (held_c, _) = self.temperatures(&mut again, stride, weather, (design_kw, world, &unmeasured), held);
        let recorded_kw = world.recorded_kw(&heat_kw, &outdoor_c, self.step_s, meter);
        let (outdoor_c, sun_kw) = (World::shifted(&outdoor_c, late), World::shifted(&sun_kw, late));
        [switching_c, held_c].map(|temperature_c| {
            let sensed_c = temperature_c.into_iter().map(|value| world.sensed_c(value)).collect();
            self.telemetry(sensed_c, recorded_kw.clone(), outdoor_c.clone(), sun_kw.clone())
        })
    }

    fn telemetry(
        &self,
        temperature_c: Vec<f64>,
        heat_kw: Vec<f64>,
        outdoor_c: Vec<f64>,
        sun_kw: Vec<f64>,
    ) -> Telemetry {
        let rows = temperature_c.len();
        let zone = MeasuredZone {
            name: "house".into(),
            temperature_c,
            power_kw: heat_kw,
            power_has_unit: true,
            power_hold: Hold::ZeroOrder,
            supply_air: Vec::new(),
            irradiance_kw_per_m2: Some(sun_kw),
            irradiance_hold: Hold::FirstOrder,
        };
        Telemetry {
            step_s: self.step_s,
            time_s: (0..rows).map(|row| row as f64 * self.step_s).collect(),
            segments: std::iter::once(0..rows).collect(),
            left_out_rows: 0,
            zones: vec![zone],
            boundaries: vec![Boundary { name: "outdoor".into(), temperature_c: outdoor_c, hold: Hold::FirstOrder }],
            walls: vec![MeasuredWall { zone: 0, other: Neighbour::Boundary(0) }],
        }
    }

    /// Measured temperature and mean heat in each row. Random heat changes every minute.
    fn temperatures(
        &self,
        random: &mut Random,
        stride: usize,
        (outdoor_c, sun_kw): (&[f64], &[f64]),
        (design_kw, world, unmeasured): (f64, World, &Unmeasured),
        mut heat: Heat<'_>,
    ) -> (Vec<f64>, Vec<f64>) {
        // The stream of the heater is its own, so that the same house with its heat held has the same random heat.
        let mut chance = Random::new(1 + (1e6 * self.aperture) as u64, 78);
        let mut given_kw = vec![0.0; outdoor_c.len()];
        let (colour_h, mut colour) = (random.uniform(1.0, 4.0), 0.0);
        let (disturbance_kw, sensor_k) = (design_kw * random.uniform(0.01, 0.05), random.uniform(0.01, 0.05));
        let (mut air, mut wall, mut interior) = (18.0, 13.0, 18.5);
        let mut measured = Vec::with_capacity(outdoor_c.len());
        // The settled state is reached before the first row: two days go by unseen under the first hours' inputs.
        for minute in 0..2 * MINUTES_PER_DAY + (outdoor_c.len() - 1) * stride + 1 {
            let seen = minute.saturating_sub(2 * MINUTES_PER_DAY);
            let (row, part) = (seen / stride, (seen % stride) as f64 / stride as f64);
            let next = (row + 1).min(outdoor_c.len() - 1);
            if minute >= 2 * MINUTES_PER_DAY && seen % stride == 0 {
                measured.push(air + random.normal(0.0, sensor_k));
            }
            let outdoor = outdoor_c[row] + part * (outdoor_c[next] - outdoor_c[row]);
            let sun = sun_kw[row] + part * (sun_kw[next] - sun_kw[row]);
            // White heat of `disturbance_kw` in hourly means.
            let white = random.normal(0.0, 1.0);
            let keep = libm::exp(-1.0 / (60.0 * colour_h));
            colour = keep * colour + libm::sqrt(1.0 - keep * keep) * white;
            let noise = match world {
                World::ColouredHeat => disturbance_kw * colour,
                _ => disturbance_kw * libm::sqrt(60.0) * white,
            };
            let lost = unmeasured.conductance_kw_per_k[seen.min(unmeasured.heat_kw.len() - 1)] * (outdoor - air);
            let noise = noise + unmeasured.heat_kw[seen.min(unmeasured.heat_kw.len() - 1)] + lost;
            let on_mass = self.on_mass * self.aperture * sun;
            let heat_kw = match &mut heat {
                Heat::Heater(heater) => heater.next_kw(minute, air, &mut chance),
                // Before the first row the mean of a day, in place of a row that may be off or fully on.
                Heat::Held(kw) if minute < 2 * MINUTES_PER_DAY => mean(&kw[..(MINUTES_PER_DAY / stride).min(kw.len())]),
                Heat::Held(kw) => kw[row],
            };
            if minute >= 2 * MINUTES_PER_DAY {
                given_kw[row] += heat_kw / stride as f64;
            }
            let gains = heat_kw + (self.aperture * sun - on_mass) + noise;
            for _ in 0..SUBSTEPS {
                [air, wall, interior] = self.next([air, wall, interior], (gains, on_mass), outdoor);
            }
        }
        (measured, given_kw)
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

impl House {
    /// Temperatures of air, wall and interior mass after a part of a minute, by Euler's method.
    fn next(&self, [air, wall, interior]: [f64; 3], (gains_kw, on_mass_kw): (f64, f64), outdoor: f64) -> [f64; 3] {
        let step_s = 60.0 / f64::from(SUBSTEPS);
        let to_wall = match self.kind {
            Kind::Air => self.ua() * (air - outdoor),
            _ => self.inner * (air - wall),
        };
        let to_interior = if self.interior > 0.0 { self.interior_conductance * (air - interior) } else { 0.0 };
        let (on_wall_kw, on_interior_kw) = if self.interior > 0.0 { (0.0, on_mass_kw) } else { (on_mass_kw, 0.0) };
        let change = |heat_kw: f64, capacity: f64| if capacity > 0.0 { step_s * heat_kw / capacity } else { 0.0 };
        [
            air + change(gains_kw - to_wall - to_interior, self.air),
            wall + change(to_wall + on_wall_kw - self.outer * (wall - outdoor), self.wall),
            interior + change(to_interior + on_interior_kw, self.interior),
        ]
    }
}
