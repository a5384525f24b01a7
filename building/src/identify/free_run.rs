//! Free runs: the network simulated from a measured state, all zones together, as a planner would use it.
//!
//! Boundaries and heat are as measured; only the zones' temperatures are the model's. The term q is forecast in
//! several ways, from zero to daily profile and ARMA, so that the report shows how much each of them improves the prediction.

use std::ops::Range;

use schemars::JsonSchema;
use serde::Serialize;

use super::regression::{ResidualModel, ResidualSeries, ZoneModel};
use super::telemetry::Telemetry;

/// How the non-parametric term is forecast.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ResidualForecast {
    /// The term is zero: the network alone.
    None,
    /// The term is constant.
    Constant,
    /// By a constant and ARMA(r,1), the dissertation's residual model.
    Arma,
    /// By the daily profile.
    Profile,
    /// By the daily profile and ARMA(r,1).
    ProfileArma,
}

impl ResidualForecast {
    /// All forecasts, in the order of a report.
    pub const ALL: [Self; 5] = [Self::None, Self::Constant, Self::Arma, Self::Profile, Self::ProfileArma];
}

/// The model of a zone that a free run needs.
pub(super) struct RunZone {
    pub model: ZoneModel,
    pub coefficients: Vec<f64>,
    /// The residual model with a constant, applied to the measurements.
    pub constant: (ResidualModel, ResidualSeries),
    /// The same with a daily profile.
    pub daily: (ResidualModel, ResidualSeries),
}

impl RunZone {
    /// q expected in the steps from `start` on, given the measurements of the segment before.
    fn forecast(&self, forecast: ResidualForecast, start: usize, segment: &Range<usize>, steps: usize) -> Vec<f64> {
        let profile = |(_, series): &(ResidualModel, ResidualSeries)| series.profile[start..start + steps].to_vec();
        let with_arma = |fitted: &(ResidualModel, ResidualSeries)| {
            let (model, series) = fitted;
            let (past, last) = match start > segment.start {
                true => (&series.errors[segment.start..start], series.innovations[start - 1]),
                false => (&[][..], 0.0),
            };
            let expected = model.arma.forecast(past, last, steps);
            profile(fitted).iter().zip(expected).map(|(profile, error)| profile + error).collect()
        };
        match forecast {
            ResidualForecast::None => vec![0.0; steps],
            ResidualForecast::Constant => profile(&self.constant),
            ResidualForecast::Arma => with_arma(&self.constant),
            ResidualForecast::Profile => profile(&self.daily),
            ResidualForecast::ProfileArma => with_arma(&self.daily),
        }
    }
}

/// Temperatures of all zones \[step\]\[zone\], after each of `steps` steps from the measured state at `start`.
pub(super) fn run(
    telemetry: &Telemetry,
    zones: &[RunZone],
    forecast: ResidualForecast,
    segment: &Range<usize>,
    (start, steps): (usize, usize),
) -> Vec<Vec<f64>> {
    let expected: Vec<_> = zones.iter().map(|zone| zone.forecast(forecast, start, segment, steps)).collect();
    let mut state: Vec<f64> = telemetry.zones.iter().map(|zone| zone.temperature_c[start]).collect();
    (0..steps)
        .map(|step| {
            let change = |(zone, expected): (&RunZone, &Vec<f64>)| {
                zone.model.change_k(telemetry, start + step, &state, &zone.coefficients) + expected[step]
            };
            let changes: Vec<f64> = zones.iter().zip(&expected).map(change).collect();
            state.iter_mut().zip(changes).for_each(|(temperature, change)| *temperature += change);
            state.clone()
        })
        .collect()
}

pub(super) struct RunErrors {
    pub runs: usize,
    /// Root mean square error of each zone \[K\].
    errors_k: Vec<f64>,
}

impl RunErrors {
    /// The error of a zone \[K\]; `None` without a run.
    pub fn of_zone(&self, zone: usize) -> Option<f64> {
        (self.runs > 0).then(|| self.errors_k[zone])
    }
}

/// Root mean square errors of free runs.
///
/// Runs of `horizon` steps start every half horizon, the first when an eighth of a horizon has been measured. Segments that
/// are too short for one are left out.
pub(super) fn errors(
    telemetry: &Telemetry,
    zones: &[RunZone],
    forecast: ResidualForecast,
    segments: &[Range<usize>],
    horizon: usize,
) -> RunErrors {
    let mut squares = vec![0.0; zones.len()];
    let mut runs = 0;
    for segment in segments {
        let first = segment.start + (horizon / 8).max(4);
        for start in
            (first..segment.end).step_by((horizon / 2).max(1)).take_while(|start| start + horizon < segment.end)
        {
            runs += 1;
            for (step, state) in run(telemetry, zones, forecast, segment, (start, horizon)).iter().enumerate() {
                for (zone, sum) in squares.iter_mut().enumerate() {
                    let error = state[zone] - telemetry.zones[zone].temperature_c[start + step + 1];
                    *sum += error * error;
                }
            }
        }
    }
    let errors_k = squares.iter().map(|sum| (sum / (runs * horizon).max(1) as f64).sqrt()).collect();
    RunErrors { runs, errors_k }
}

/// Temperatures of one zone \[row\] when the model runs freely, from the measured state anew every `horizon` steps.
pub(super) fn restarted(
    telemetry: &Telemetry,
    zones: &[RunZone],
    forecast: ResidualForecast,
    horizon: usize,
) -> Vec<Vec<f64>> {
    let mut series: Vec<Vec<f64>> = telemetry.zones.iter().map(|zone| zone.temperature_c.clone()).collect();
    for segment in &telemetry.segments {
        for start in segment.clone().step_by(horizon.max(1)) {
            let steps = horizon.min(segment.end - 1 - start);
            for (step, state) in run(telemetry, zones, forecast, segment, (start, steps)).iter().enumerate() {
                for (zone, temperature) in state.iter().enumerate() {
                    series[zone][start + step + 1] = *temperature;
                }
            }
        }
    }
    series
}
