//! The network alone: simulated from a filtered state with the measured boundaries, heat and sun, and nothing else.

use std::ops::Range;

use nalgebra::DMatrix;

use super::exponential::Number;
use super::likelihood::{Filtered, Observations, numbers};
use super::linear_model::SampledModel;
use super::selection::Fit;
use crate::identify::telemetry::Telemetry;

/// A fitted network with the states that the filter found.
pub(super) struct NetworkRun<'a> {
    telemetry: &'a Telemetry,
    observations: &'a Observations,
    fit: &'a Fit,
    sampled: SampledModel,
    filtered: &'a Filtered,
}

/// Root mean square errors of free runs, one a zone \[K\].
pub(super) struct FreeRunErrors {
    pub runs: usize,
    pub network_k: Vec<f64>,
    /// Of the mean of the data in their place.
    pub mean_k: Vec<f64>,
}

impl<'a> NetworkRun<'a> {
    /// Prepares runs of the fitted network; `None` if the model has no discrete form.
    pub fn new(
        telemetry: &'a Telemetry,
        observations: &'a Observations,
        fit: &'a Fit,
        filtered: &'a Filtered,
    ) -> Option<Self> {
        let sampled = fit.structure.model(&numbers(&fit.maximum.theta)).sampled(observations.step_s)?;
        Some(Self { telemetry, observations, fit, sampled, filtered })
    }

    fn nodes(&self) -> usize {
        self.fit.structure.nodes.len()
    }

    /// Temperatures of the zones \[step\]\[zone\] after each of `steps` steps from the filtered state at `start`.
    pub fn run(&self, start: usize, steps: usize) -> Vec<Vec<f64>> {
        let (n, m) = (self.nodes(), self.observations.widths.1);
        let zones = self.telemetry.zones.len();
        let mut state = self.filtered.states[start * n..(start + 1) * n].to_vec();
        (start..start + steps)
            .map(|row| {
                let mut inputs = self.observations.inputs[row * m..(row + 1) * m].to_vec();
                for (zone, column) in self.fit.structure.layout.heat.iter().enumerate() {
                    if let Some(column) = column {
                        // The heat of supply air depends on the zone temperature, which here is that of the model.
                        inputs[*column] = self.telemetry.zones[zone].heat_kw(row, state[zone]);
                    }
                }
                let slopes = &self.observations.slopes[row * m..(row + 1) * m];
                let row_of = |matrix: &DMatrix<Number>, i: usize, values: &[f64]| -> f64 {
                    values.iter().enumerate().map(|(j, value)| matrix[(i, j)].re * value).sum()
                };
                let next = |i: usize| {
                    row_of(&self.sampled.transition, i, &state)
                        + row_of(&self.sampled.gain, i, &inputs)
                        + row_of(&self.sampled.slope_gain, i, slopes)
                };
                state = (0..n).map(next).collect();
                state[..zones].to_vec()
            })
            .collect()
    }

    /// Errors of runs of `horizon` steps, which start every half horizon within `segments`; `mean_c` has one mean a zone.
    pub fn errors(&self, segments: &[Range<usize>], horizon: usize, mean_c: &[f64]) -> FreeRunErrors {
        let zones = self.telemetry.zones.len();
        let mut sums = vec![(0.0, 0.0, 0_usize); zones];
        let mut runs = 0;
        for segment in segments {
            let first = segment.start + (horizon / 8).max(4);
            let starts = (first..segment.end).step_by((horizon / 2).max(1));
            for start in starts.take_while(|start| start + horizon < segment.end) {
                if !self.filtered.states[start * self.nodes()].is_finite() {
                    continue;
                }
                runs += 1;
                for (step, state) in self.run(start, horizon).iter().enumerate() {
                    for (zone, sum) in sums.iter_mut().enumerate() {
                        let measured = self.telemetry.zones[zone].temperature_c[start + step + 1];
                        if measured.is_finite() {
                            let (error, of_mean) = (state[zone] - measured, mean_c[zone] - measured);
                            *sum = (sum.0 + error * error, sum.1 + of_mean * of_mean, sum.2 + 1);
                        }
                    }
                }
            }
        }
        let root = |sum: f64, count: usize| libm::sqrt(sum / count.max(1) as f64);
        FreeRunErrors {
            runs,
            network_k: sums.iter().map(|&(sum, _, count)| root(sum, count)).collect(),
            mean_k: sums.iter().map(|&(_, sum, count)| root(sum, count)).collect(),
        }
    }

    /// Temperatures of every zone \[zone\]\[row\] when the network runs freely, from the filtered state anew every `horizon` steps.
    pub fn restarted(&self, horizon: usize) -> Vec<Vec<f64>> {
        let mut series: Vec<Vec<f64>> = self.telemetry.zones.iter().map(|zone| zone.temperature_c.clone()).collect();
        for segment in &self.observations.segments {
            for start in segment.clone().step_by(horizon.max(1)) {
                let steps = horizon.min(segment.end - 1 - start);
                for (step, state) in self.run(start, steps).iter().enumerate() {
                    for (zone, temperature) in state.iter().enumerate() {
                        series[zone][start + step + 1] = *temperature;
                    }
                }
            }
        }
        series
    }
}
