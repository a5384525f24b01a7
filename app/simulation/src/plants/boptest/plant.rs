//! The plant: heat becomes inputs of the case, and its measurements become temperatures of zones.

use std::path::Path;
use std::time::{Duration, Instant};

use interplay_building::discretise::Model;
use interplay_fmu_host::HostProgram;
use interplay_scenarios::{BoptestInput, BoptestPlantConfig, BoptestZone};
use serde_json::{Value, json};

use super::super::error::PlantError;
use super::super::interface::{Benchmark, Foreseen, StepInputs, ThermalPlant};
use super::super::walls;
use super::api::{Bench, Signals, Test, celsius, check_temperature, number};
use super::fmu::FmuBench;
use super::forecast::foresee;
use super::indicators::Known;
use crate::plants::boptest::boptest_error::BoptestError;
use crate::state::day::Metered;
use crate::state::detail::NotCopied;

const DAY_S: f64 = 86_400.0;
/// Maximum number of the case's names that an error lists.
const SHOWN_NAMES: usize = 12;

/// A test case of BOPTEST as the plant. The temperatures of walls are estimated with the controller's model.
#[derive(Debug)]
pub struct BoptestPlant {
    config: BoptestPlantConfig,
    believed: Model,
    /// Number of steps of the run.
    steps: usize,
    steps_per_day: usize,
    /// Mean outdoor temperature of the first day, for unmeasured walls \[°C\].
    mean_outdoor_c: f64,
    test: Option<Box<dyn Bench>>,
    known: Option<Known>,
    foreseen: Option<Foreseen>,
    /// Start time of the first step \[s\].
    start_s: f64,
    metered: Option<Metered>,
    /// Time of the last answer, and the durations of the decisions after each \[s\].
    answered: Option<Instant>,
    control_s: Vec<f64>,
    benchmark: Option<Benchmark>,
    /// Accumulated heat that each input with `least_on` has held back, zone after zone \[unit of the input\].
    held_back: Vec<f64>,
}

impl BoptestPlant {
    /// The plant of a run of `steps` steps. It connects to the test case when the run begins. `outdoor_c` are the
    /// outdoor temperatures of the first day \[°C\].
    pub fn new(config: &BoptestPlantConfig, believed: Model, steps: usize, outdoor_c: &[f64]) -> Self {
        let mean_outdoor_c = outdoor_c.iter().sum::<f64>() / outdoor_c.len().max(1) as f64;
        let steps_per_day = ((DAY_S / believed.step_s()).round() as usize).max(1);
        let held_back = vec![0.0; config.zones.iter().map(|zone| zone.inputs.len()).sum()];
        Self {
            config: config.clone(),
            believed,
            steps,
            steps_per_day,
            mean_outdoor_c,
            test: None,
            known: None,
            foreseen: None,
            start_s: 0.0,
            metered: None,
            answered: None,
            control_s: Vec::new(),
            benchmark: None,
            held_back,
        }
    }

    /// The running case: on a server, or as a local FMU.
    fn bench(&self) -> Result<Box<dyn Bench>, BoptestError> {
        if let Some(fmu) = &self.config.fmu {
            return Ok(Box::new(FmuBench::start(Path::new(fmu), &self.config, &HostProgram::default())?));
        }
        let timeout = Duration::try_from_secs_f64(self.config.timeout_s).unwrap_or(Duration::MAX);
        let url = self.config.url.as_deref().unwrap_or_default();
        Ok(Box::new(Test::select(url, self.config.case.as_deref(), timeout)?))
    }

    /// Begins the test; returns the measurements at the first midnight.
    fn begin(&self, test: &mut dyn Bench) -> Result<(&'static str, Signals), BoptestError> {
        let step_s = self.believed.step_s();
        test.ask("PUT", "step", Some(&json!({ "step": step_s })))?;
        let (price, _) = self.config.prices.words();
        let Some(period) = &self.config.period else {
            test.ask("PUT", "scenario", Some(&json!({ "electricity_price": price })))?;
            let start_s = self.config.start_day as f64 * DAY_S;
            let warmup_s = self.config.warmup_days as f64 * DAY_S;
            let body = json!({ "start_time": start_s, "warmup_period": warmup_s });
            return Ok(("PUT /initialize", test.ask("PUT", "initialize", Some(&body))?));
        };
        let body = json!({ "electricity_price": price, "time_period": period });
        let mut payload = test.ask("PUT", "scenario", Some(&body))?;
        match payload.remove("time_period") {
            Some(Value::Object(signals)) => Ok(("PUT /scenario", signals)),
            _ => Err(BoptestError::Invalid {
                request: "PUT /scenario".to_owned(),
                reason: format!("it has no measurements for the period `{period}`"),
            }),
        }
    }

    /// Refuses names in the scenario that the case does not have.
    fn check_names(&self, test: &mut dyn Bench) -> Result<(), BoptestError> {
        let (inputs, measurements) = (test.ask("GET", "inputs", None)?, test.ask("GET", "measurements", None)?);
        let found = |what, names: &Signals, name: &str, key: String| {
            if names.contains_key(name) {
                return Ok(());
            }
            let known: Vec<&str> = names.keys().take(SHOWN_NAMES).map(String::as_str).collect();
            Err(BoptestError::UnknownName { what, name: name.to_owned(), key, known: known.join(", ") })
        };
        for (index, zone) in self.config.zones.iter().enumerate() {
            let key = format!("building.plant.zones.{index}");
            found("measurement", &measurements, &zone.temperature, format!("{key}.temperature"))?;
            check_temperature(&measurements, &zone.temperature)?;
            for (input, settings) in zone.inputs.iter().enumerate() {
                found("input", &inputs, &settings.name, format!("{key}.inputs.{input}.name"))?;
            }
        }
        let Some(listed) = &self.config.indicators else { return Ok(()) };
        let lists = [
            ("carbon_dioxide", &listed.carbon_dioxide),
            ("electricity", &listed.electricity),
            ("gas", &listed.gas),
            ("district_heat", &listed.district_heat),
        ];
        for (key, name) in lists.iter().flat_map(|(key, names)| names.iter().map(move |name| (key, name))) {
            found("measurement", &measurements, name, format!("building.plant.indicators.{key}"))?;
        }
        Ok(())
    }

    fn zones_c(&self, request: &str, signals: &Signals) -> Result<Vec<f64>, BoptestError> {
        let zone_c =
            |zone: &BoptestZone| celsius(request, &zone.temperature, number(request, signals, &zone.temperature)?);
        self.config.zones.iter().map(zone_c).collect()
    }

    /// The body of an `advance` request for the heat of all zones.
    fn overwritten(&mut self, heat_kw: &[f64]) -> Value {
        let mut held_back = self.held_back.iter_mut();
        let mut body = serde_json::Map::new();
        for (zone, heat_kw) in self.config.zones.iter().zip(heat_kw) {
            for input in &zone.inputs {
                let wanted = input_value(input, *heat_kw);
                let value = held_back.next().map_or(wanted, |held_back| in_pulses(input, wanted, held_back));
                body.insert(input.name.clone(), json!(value));
                if let Some(stem) = input.name.strip_suffix("_u") {
                    body.insert(format!("{stem}_activate"), json!(1));
                }
            }
        }
        Value::Object(body)
    }

    /// Reads the meter at the end of a day, and the indicators at the end of the test.
    fn end_of_step(&mut self, step: usize, test: &mut dyn Bench) -> Result<(), BoptestError> {
        if (step + 1).is_multiple_of(self.steps_per_day) {
            let end_s = self.start_s + (step + 1) as f64 * self.believed.step_s();
            self.metered = match &self.known {
                Some(known) => known.metered(&self.config, test, end_s - DAY_S, end_s)?,
                None => None,
            };
        }
        if step + 1 == self.steps { self.finish(test) } else { Ok(()) }
    }

    /// Reads the indicators of the completed test.
    fn finish(&mut self, test: &mut dyn Bench) -> Result<(), BoptestError> {
        let official = test.ask("GET", "kpi", None)?;
        let ours = match &self.known {
            Some(known) => Some(known.compute(&self.config, test)?),
            None => None,
        };
        let indicator = |(name, value): (&String, &Value)| match value.as_f64() {
            None if !value.is_null() => Err(BoptestError::Invalid {
                request: "GET /kpi".to_owned(),
                reason: format!("`{name}` is neither a number nor null"),
            }),
            number => Ok((name.clone(), number)),
        };
        let named = official.iter().map(indicator).collect::<Result<_, BoptestError>>()?;
        self.benchmark = Some(Benchmark::new(named, ours, &self.control_s, self.believed.step_s()));
        Ok(())
    }
}

/// The value of an input for the heat of its zone.
fn input_value(input: &BoptestInput, heat_kw: f64) -> f64 {
    (input.at_zero + input.per_kw * heat_kw).max(input.min).min(input.max)
}

/// The applied value with `least_on`: zero, or at least that. `held_back` accumulates the difference to the wanted
/// value, at most one pulse either way.
fn in_pulses(input: &BoptestInput, wanted: f64, held_back: &mut f64) -> f64 {
    let Some(least) = input.least_on else { return wanted };
    let (pulse, excess) = (least - input.at_zero, wanted - input.at_zero);
    if excess >= pulse {
        return wanted;
    }
    *held_back += excess;
    if *held_back < 0.5 * pulse {
        return input.at_zero;
    }
    *held_back = (*held_back - pulse).max(-pulse);
    least
}

impl BoptestPlant {
    fn begun(&mut self) -> Result<Vec<f64>, PlantError> {
        let mut bench = self.bench()?;
        let test = &mut *bench;
        self.check_names(test)?;
        let (request, signals) = self.begin(test)?;
        let zones_c = self.zones_c(request, &signals)?;
        let horizon_s = self.believed.step_s() * self.steps as f64;
        if let Some(listed) = &self.config.indicators {
            self.start_s = number(request, &signals, "time")?;
            self.known = Some(Known::ask(listed, self.config.prices, test, self.start_s, horizon_s)?);
        }
        if let Some(settings) = &self.config.forecast {
            let foreseen = foresee(settings, self.config.prices, test, horizon_s + DAY_S)?;
            let outdoor_c = foreseen.weather.ambient_steps_c(0.0, self.believed.step_s(), self.steps_per_day);
            self.mean_outdoor_c = outdoor_c.iter().sum::<f64>() / outdoor_c.len().max(1) as f64;
            self.foreseen = Some(foreseen);
        }
        self.test = Some(bench);
        self.answered = Some(Instant::now());
        Ok(walls::at_rest_c(self.believed.network(), &zones_c, self.mean_outdoor_c))
    }

    fn stepped(&mut self, inputs: &StepInputs<'_>, nodes_c: &mut [f64]) -> Result<(), PlantError> {
        let StepInputs { step, heat_kw, gains_kw, ambient_c } = *inputs;
        let names = self.believed.network().names();
        if let Some((zone, _)) = names.iter().zip(heat_kw).find(|(_, heat)| !heat.is_finite()) {
            return Err(PlantError::NotFinite { question: format!("step {step}"), zone: zone.clone() });
        }
        let Some(mut test) = self.test.take() else {
            return Err(PlantError::Closed { question: format!("step {step}") });
        };
        if let Some(answered) = self.answered {
            self.control_s.push(answered.elapsed().as_secs_f64());
        }
        let body = self.overwritten(heat_kw);
        let answer = test.ask("POST", "advance", Some(&body));
        self.answered = Some(Instant::now());
        let zones_c = answer.and_then(|signals| self.zones_c("POST /advance", &signals));
        let ended = match &zones_c {
            Ok(_) => self.end_of_step(step, &mut *test),
            Err(_) => Ok(()),
        };
        self.test = Some(test);
        let zones_c = zones_c?;
        ended?;
        self.believed.step(nodes_c, heat_kw, ambient_c, gains_kw);
        nodes_c[..zones_c.len()].copy_from_slice(&zones_c);
        Ok(())
    }

    /// An error in the words of what runs: a unit or a server.
    fn told(&self, error: PlantError) -> PlantError {
        match error {
            PlantError::Boptest(error) if self.config.fmu.is_some() => error.of_unit().into(),
            other => other,
        }
    }
}

impl ThermalPlant for BoptestPlant {
    fn start(&mut self) -> Result<Vec<f64>, PlantError> {
        self.begun().map_err(|error| self.told(error))
    }

    fn step(&mut self, inputs: &StepInputs<'_>, nodes_c: &mut [f64]) -> Result<(), PlantError> {
        self.stepped(inputs, nodes_c).map_err(|error| self.told(error))
    }

    fn is_foreign(&self) -> bool {
        true
    }

    fn foreseen(&self) -> Option<&Foreseen> {
        self.foreseen.as_ref()
    }

    fn metered(&self) -> Option<Metered> {
        self.metered
    }

    fn benchmark(&self) -> Option<&Benchmark> {
        self.benchmark.as_ref()
    }

    fn fork(&self) -> Result<Box<dyn ThermalPlant>, NotCopied> {
        let why = "its state is in another program, a server of BOPTEST or an FMU".to_owned();
        Err(NotCopied { who: "the plant of the building".to_owned(), why })
    }
}

impl Drop for BoptestPlant {
    fn drop(&mut self) {
        if let Some(test) = &mut self.test {
            test.stop();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn input(least_on: Option<f64>) -> BoptestInput {
        BoptestInput { name: "oveY_u".to_owned(), at_zero: 0.0, per_kw: 0.1, min: 0.0, max: 1.0, least_on }
    }

    #[test]
    fn heat_is_scaled_and_bounded_as_an_input_of_the_case() {
        let values = [-5.0, 0.0, 4.0, 10.0, 25.0].map(|heat_kw| input_value(&input(None), heat_kw));
        assert_eq!(values, [0.0, 0.0, 0.4, 1.0, 1.0]);
    }

    #[test]
    fn equipment_without_part_load_pulses_with_the_wanted_mean() {
        for wanted in [0.05, 0.3, 0.55, 0.79] {
            let (mut held_back, mut sum) = (0.0, 0.0);
            for _ in 0..1000 {
                let given = in_pulses(&input(Some(0.8)), wanted, &mut held_back);
                assert!(given == 0.0 || given == 0.8, "{given}");
                sum += given;
            }
            assert!((sum / 1000.0 - wanted).abs() < 1e-3, "{sum} for {wanted}");
        }
        assert_eq!(in_pulses(&input(Some(0.8)), 0.9, &mut 0.0), 0.9);
    }
    #[test]
    fn a_zone_needs_a_unit_of_temperature_and_errors_name_the_unit() {
        let listed = json!({
            "a": { "Unit": "K" }, "b": { "Unit": "degC" }, "c": {}, "power": { "Unit": "W" }, "plain": { "Unit": null },
        });
        let listed = listed.as_object().expect("an object");
        for name in ["a", "b", "c"] {
            check_temperature(listed, name).expect(name);
        }
        for (name, said) in [("power", "has the unit `W`"), ("plain", "has no unit")] {
            let error = check_temperature(listed, name).expect_err(name).of_unit().to_string();
            assert!(error.contains(said) && error.contains("FMU") && !error.contains("BOPTEST"), "{error}");
        }
    }
}
