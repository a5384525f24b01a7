//! A plant in another program: each step is a JSON line to it and one back, over TCP.
//!
//! `docs/guide/foreign-plants.md` describes the protocol.

use std::time::Duration;

use interplay_building::day::Surroundings;
use interplay_building::discretise::Model;
use interplay_scenarios::SocketPlantConfig;
use serde::Serialize;

use super::answer::{PROTOCOL, Question};
use super::error::PlantError;
use super::interface::{StepInputs, ThermalPlant};
use super::lines::Lines;
use super::walls;
use crate::state::detail::NotCopied;

/// Space for a number and for the rest of an answer \[bytes\].
const NUMBER_BYTES: usize = 64;
const REST_BYTES: usize = 64 * 1024;

#[derive(Debug, Serialize)]
#[serde(tag = "message", rename_all = "kebab-case")]
enum Request<'a> {
    Start {
        protocol: u32,
        scenario: &'a str,
        zones: &'a [String],
        heating_limits_kw: &'a [f64],
        cooling_limits_kw: &'a [f64],
        step_s: f64,
        steps_per_day: usize,
        days: usize,
        initial_c: f64,
    },
    /// A step is to be simulated.
    Step {
        step: usize,
        time_s: f64,
        heat_kw: &'a [f64],
        people_kw: &'a [f64],
        gains_kw: &'a [f64],
        ambient_c: f64,
        sun_w_per_m2: f64,
    },
    End,
}

/// The data of a run that a plant behind a socket gets before its first step.
#[derive(Clone, Debug)]
pub struct SocketPlantStart {
    /// The title of the scenario.
    pub scenario: String,
    /// Number of steps of a day.
    pub steps_per_day: usize,
    /// Number of days of the run.
    pub days: usize,
    /// The temperature of everything that the scenario states \[°C\].
    pub initial_c: f64,
}

/// A day of all influences on the building besides its equipment.
#[derive(Debug)]
struct OutsideDay {
    day: usize,
    /// Heat of people and machines \[kW\], stacked.
    people_kw: Vec<f64>,
    sun_w_per_m2: Vec<f64>,
}

/// Another program as the plant. The temperatures of walls are estimated with the controller's model.
#[derive(Debug)]
pub struct SocketPlant {
    lines: Lines,
    /// The controller's model of the building.
    believed: Model,
    surroundings: Surroundings,
    told: SocketPlantStart,
    today: Option<OutsideDay>,
}

impl SocketPlant {
    /// Connects to the program.
    ///
    /// # Errors
    /// [`PlantError::Connect`].
    pub fn connect(
        config: &SocketPlantConfig,
        believed: Model,
        surroundings: Surroundings,
        told: SocketPlantStart,
    ) -> Result<Self, PlantError> {
        let limit = REST_BYTES + NUMBER_BYTES * believed.network().zone_count();
        let timeout = Duration::try_from_secs_f64(config.timeout_s).unwrap_or(Duration::MAX);
        let lines = Lines::connect(&config.address, timeout, limit)?;
        Ok(Self { lines, believed, surroundings, told, today: None })
    }

    /// The influences of a day, drawn once.
    fn outside(&mut self, day: usize) -> &OutsideDay {
        let (step_s, steps) = (self.believed.step_s(), self.told.steps_per_day);
        let surroundings = &self.surroundings;
        let weather = &surroundings.weather;
        let zones = self.believed.network().zone_count();
        let draw = || OutsideDay {
            day,
            people_kw: surroundings.people_kw(day, zones, step_s, steps),
            sun_w_per_m2: weather.sun_steps_w_per_m2(day as f64 * step_s * steps as f64, step_s, steps),
        };
        let kept = self.today.take().filter(|outside| outside.day == day);
        self.today.insert(kept.unwrap_or_else(draw))
    }

    /// Requests the temperatures of the zones.
    fn ask(&mut self, words: String, step: Option<usize>, request: &str) -> Result<Vec<f64>, PlantError> {
        let line = self.lines.ask(&words, request)?;
        Question { words, step, zones: &self.believed.network().names()[..self.zones()] }.temperatures_c(&line)
    }

    fn zones(&self) -> usize {
        self.believed.network().zone_count()
    }
}

/// A message as a line. Its numbers are finite, so serialisation cannot fail; the plant would refuse an empty line.
fn text(request: &Request<'_>) -> String {
    serde_json::to_string(request).unwrap_or_default()
}

impl ThermalPlant for SocketPlant {
    fn start(&mut self) -> Result<Vec<f64>, PlantError> {
        let network = self.believed.network();
        let request = text(&Request::Start {
            protocol: PROTOCOL,
            scenario: &self.told.scenario,
            zones: &network.names()[..network.zone_count()],
            heating_limits_kw: &network.limits().heating_kw,
            cooling_limits_kw: &network.limits().cooling_kw,
            step_s: self.believed.step_s(),
            steps_per_day: self.told.steps_per_day,
            days: self.told.days,
            initial_c: self.told.initial_c,
        });
        let zones_c = self.ask("the start of the run".to_owned(), None, &request)?;
        let (step_s, steps) = (self.believed.step_s(), self.told.steps_per_day);
        let ambient_c = self.surroundings.weather.ambient_steps_c(0.0, step_s, steps);
        let mean_c = ambient_c.iter().sum::<f64>() / ambient_c.len().max(1) as f64;
        Ok(walls::at_rest_c(self.believed.network(), &zones_c, mean_c))
    }

    fn step(&mut self, inputs: &StepInputs<'_>, nodes_c: &mut [f64]) -> Result<(), PlantError> {
        let StepInputs { step, heat_kw, gains_kw, ambient_c } = *inputs;
        let (zones, steps) = (self.zones(), self.told.steps_per_day);
        let time_s = step as f64 * self.believed.step_s();
        let step_of_day = step % steps;
        let words = format!("step {step} (step {step_of_day} of day {})", step / steps + 1);
        let sums_kw = heat_kw.iter().zip(gains_kw).map(|(heat, gains)| heat + gains);
        if let Some((zone, _)) = self.believed.network().names().iter().zip(sums_kw).find(|(_, sum)| !sum.is_finite()) {
            return Err(PlantError::NotFinite { question: words, zone: zone.clone() });
        }
        let outside = self.outside(step / steps);
        let request = text(&Request::Step {
            step,
            time_s,
            heat_kw,
            people_kw: &outside.people_kw[step_of_day * zones..(step_of_day + 1) * zones],
            gains_kw: &gains_kw[..zones],
            ambient_c,
            sun_w_per_m2: outside.sun_w_per_m2[step_of_day],
        });
        let zones_c = self.ask(words, Some(step), &request)?;
        self.believed.step(nodes_c, heat_kw, ambient_c, gains_kw);
        nodes_c[..zones].copy_from_slice(&zones_c);
        Ok(())
    }

    fn is_foreign(&self) -> bool {
        true
    }

    fn fork(&self) -> Result<Box<dyn ThermalPlant>, NotCopied> {
        let why = "its state is in another program, behind a socket".to_owned();
        Err(NotCopied { who: "the plant of the building".to_owned(), why })
    }
}

impl Drop for SocketPlant {
    fn drop(&mut self) {
        // The run is over, whether or not the program still listens.
        let _ = self.lines.send(&text(&Request::End));
    }
}
