//! An FMU that answers the requests of BOPTEST's interface.

use std::fs;
use std::path::Path;
use std::time::Duration;

use interplay_fmu_host::{Causality, Host, HostProgram, Request, Unit, UnitVariable, VariableKind};
use interplay_scenarios::BoptestPlantConfig;
use serde_json::{Map, Value, json};

use super::CaseData;
use crate::plants::boptest::api::{Bench, Signals, UNIT, ZERO_CELSIUS_K};
use crate::plants::boptest::boptest_error::BoptestError;

const DAY_S: f64 = 86_400.0;
/// A period of BOPTEST begins this long before its middle day, and has a warm-up of the same length \[d\].
const DAYS_BEFORE: f64 = 7.0;

/// A test case in a separate process.
#[derive(Debug)]
pub struct FmuBench {
    host: Host,
    /// Its files; they are removed when it is dropped, after the process.
    unit: Unit,
    data: CaseData,
    inputs: Vec<UnitVariable>,
    /// Measurements: numbers first, then booleans.
    outputs: Vec<UnitVariable>,
    /// Interval of measurements \[s\].
    sampling_s: f64,
    step_s: f64,
    time_s: f64,
    /// Times \[s\] and measurements since the start of the test.
    times_s: Vec<f64>,
    rows: Vec<Vec<f64>>,
    is_initialized: bool,
}

impl FmuBench {
    /// Unpacks the FMU and starts its process.
    pub fn start(path: &Path, config: &BoptestPlantConfig, program: &HostProgram) -> Result<Self, BoptestError> {
        let unit = Unit::open(path)?;
        let timeout = Duration::try_from_secs_f64(config.timeout_s).unwrap_or(Duration::MAX);
        let host = Host::start(program, &unit, timeout)?;
        let data = CaseData::read(&unit.resources())?;
        let all = || unit.description().variables.iter();
        let inputs = all().filter(|variable| variable.causality == Causality::Input).cloned().collect();
        let outputs = |kind: VariableKind| all().filter(move |v| v.causality == Causality::Output && v.kind == kind);
        let outputs = outputs(VariableKind::Real).chain(outputs(VariableKind::Boolean)).cloned().collect();
        Ok(Self {
            host,
            data,
            inputs,
            outputs,
            sampling_s: config.sampling_s,
            step_s: 0.0,
            time_s: 0.0,
            times_s: Vec::new(),
            rows: Vec::new(),
            is_initialized: false,
            unit,
        })
    }

    fn references(&self, kind: VariableKind) -> Vec<u32> {
        self.outputs.iter().filter(|variable| variable.kind == kind).map(|variable| variable.reference).collect()
    }

    /// Simulates the warm-up, and begins the test at `start_s`.
    fn begin(&mut self, start_s: f64, warmup_s: f64) -> Result<Signals, BoptestError> {
        if self.is_initialized {
            self.host.ask(&Request::Reset)?;
        }
        self.is_initialized = true;
        self.time_s = start_s - warmup_s.min(start_s);
        self.host.ask(&Request::Initialize { start_s: self.time_s })?;
        while self.time_s < start_s - 1e-6 {
            let left_s = start_s - self.time_s;
            self.steps(self.step_s.min(left_s))?;
        }
        let (reals, booleans) = (self.references(VariableKind::Real), self.references(VariableKind::Boolean));
        let rows = self.host.ask(&Request::Get { reals, booleans, strings: Vec::new() })?.rows;
        (self.times_s, self.rows) = (Vec::new(), Vec::new());
        self.keep(rows, &[self.time_s])?;
        self.now()
    }

    /// Simulates for a duration, and records the measurements.
    fn steps(&mut self, duration_s: f64) -> Result<(), BoptestError> {
        let count = (duration_s / self.sampling_s).round().max(1.0) as usize;
        let step_s = duration_s / count as f64;
        let (reals, booleans) = (self.references(VariableKind::Real), self.references(VariableKind::Boolean));
        let read = self.host.ask(&Request::Steps { from_s: self.time_s, step_s, count, reals, booleans })?;
        let times_s: Vec<f64> = (1..=count).map(|step| self.time_s + step as f64 * step_s).collect();
        self.time_s += duration_s;
        self.keep(read.rows, &times_s)
    }

    fn keep(&mut self, rows: Vec<Vec<Option<f64>>>, times_s: &[f64]) -> Result<(), BoptestError> {
        let rows: Option<Vec<Vec<f64>>> = rows.into_iter().map(|row| row.into_iter().collect()).collect();
        let sound = |rows: &Vec<Vec<f64>>| {
            rows.len() == times_s.len() && rows.iter().all(|row| row.len() == self.outputs.len())
        };
        let rows = rows.filter(sound).ok_or_else(|| BoptestError::Case {
            reason: format!("a measurement before {} s is not a finite number", self.time_s),
        })?;
        let in_kelvin = |row: Vec<f64>| {
            let values = row.into_iter().zip(&self.outputs);
            values.map(|(value, output)| if is_celsius(output) { value + ZERO_CELSIUS_K } else { value }).collect()
        };
        self.rows.extend(rows.into_iter().map(in_kelvin).collect::<Vec<Vec<f64>>>());
        self.times_s.extend(times_s);
        Ok(())
    }

    /// The present measurements, with the time.
    fn now(&self) -> Result<Signals, BoptestError> {
        let row = self.rows.last().map(Vec::as_slice).unwrap_or_default();
        let mut signals: Signals =
            self.outputs.iter().zip(row).map(|(output, value)| (output.name.clone(), json!(value))).collect();
        signals.insert("time".to_owned(), json!(self.time_s));
        Ok(signals)
    }

    /// Sets the inputs of a request, and leaves the others to the case's own controller.
    fn overwrite(&mut self, body: &Map<String, Value>) -> Result<(), BoptestError> {
        let (mut reals, mut booleans) = (Vec::new(), Vec::new());
        for input in &self.inputs {
            let value = body.get(&input.name).and_then(Value::as_f64);
            match (input.kind, value) {
                (VariableKind::Boolean, value) => {
                    booleans.push((input.reference, value.is_some_and(|value| value != 0.0)))
                }
                (VariableKind::Real, Some(value)) => reals.push((input.reference, value)),
                (VariableKind::Real, None) => {}
            }
        }
        self.host.ask(&Request::Set { reals, booleans })?;
        Ok(())
    }

    /// The first day of a period, from the resources.
    fn period_start_s(&self, period: &str) -> Result<f64, BoptestError> {
        let text = fs::read_to_string(self.unit.resources().join("days.json")).unwrap_or_default();
        let days: Map<String, Value> = serde_json::from_str(&text).unwrap_or_default();
        let day = days.get(period).and_then(Value::as_f64).ok_or_else(|| {
            let known: Vec<&str> = days.keys().map(String::as_str).collect();
            BoptestError::Case { reason: format!("it has no period `{period}`; it has {}", known.join(", ")) }
        })?;
        Ok((day - DAYS_BEFORE).max(0.0) * DAY_S)
    }

    fn names(&self, variables: &[UnitVariable]) -> Signals {
        variables.iter().map(|variable| (variable.name.clone(), json!({ UNIT: variable.unit }))).collect()
    }

    /// The requested series, from now on.
    fn forecast(&self, body: &Value) -> Result<Signals, BoptestError> {
        let interval_s = wanted(body, "interval")?;
        let count = (wanted(body, "horizon")? / interval_s + 1e-6).floor() as usize;
        let times_s: Vec<f64> = (0..=count).map(|index| self.time_s + index as f64 * interval_s).collect();
        let mut signals = Signals::new();
        for name in listed(body) {
            signals.insert(name.to_owned(), json!(self.data.at(name, &times_s)?));
        }
        signals.insert("time".to_owned(), json!(times_s));
        Ok(signals)
    }

    /// The measurements between two times.
    fn results(&self, body: &Value) -> Result<Signals, BoptestError> {
        let (from_s, to_s) = (wanted(body, "start_time")?, wanted(body, "final_time")?);
        let first = self.times_s.partition_point(|time_s| *time_s < from_s - 1e-6);
        let last = self.times_s.partition_point(|time_s| *time_s <= to_s + 1e-6);
        let mut signals = Signals::new();
        for name in listed(body) {
            let index = self.outputs.iter().position(|output| output.name == name);
            let index =
                index.ok_or_else(|| BoptestError::Case { reason: format!("it has no measurement `{name}`") })?;
            let values: Vec<f64> = self.rows[first..last].iter().map(|row| row[index]).collect();
            signals.insert(name.to_owned(), json!(values));
        }
        signals.insert("time".to_owned(), json!(self.times_s[first..last]));
        Ok(signals)
    }
}

impl Bench for FmuBench {
    fn ask(&mut self, _: &str, name: &str, body: Option<&Value>) -> Result<Signals, BoptestError> {
        let nothing = Value::Null;
        let body = body.unwrap_or(&nothing);
        match name {
            "inputs" => Ok(self.names(&self.inputs)),
            "measurements" => Ok(self.names(&self.outputs)),
            "step" => {
                self.step_s = wanted(body, "step")?;
                Ok(Signals::new())
            }
            "scenario" => match body.get("time_period").and_then(Value::as_str) {
                None => Ok(Signals::new()),
                Some(period) => {
                    let start_s = self.period_start_s(period)?;
                    let signals = self.begin(start_s, DAYS_BEFORE * DAY_S)?;
                    Ok(Signals::from_iter([("time_period".to_owned(), Value::Object(signals))]))
                }
            },
            "initialize" => self.begin(wanted(body, "start_time")?, wanted(body, "warmup_period")?),
            "advance" => {
                self.overwrite(body.as_object().unwrap_or(&Map::new()))?;
                self.steps(self.step_s)?;
                self.now()
            }
            "forecast" => self.forecast(body),
            "results" => self.results(body),
            // An FMU does not compute indicators.
            _ => Ok(Signals::new()),
        }
    }

    fn stop(&mut self) {
        // The run is over, so the answer does not matter.
        let _ = self.host.ask(&Request::End);
    }
}

fn is_celsius(output: &UnitVariable) -> bool {
    output.unit.as_deref() == Some("degC")
}

fn wanted(body: &Value, key: &str) -> Result<f64, BoptestError> {
    let found = body.get(key).and_then(Value::as_f64);
    found.ok_or_else(|| BoptestError::Case { reason: format!("a request without `{key}` was made of it") })
}

fn listed(body: &Value) -> impl Iterator<Item = &str> {
    body.get("point_names").and_then(Value::as_array).into_iter().flatten().filter_map(Value::as_str)
}
