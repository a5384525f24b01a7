//! Wanted temperatures of the zones over a day.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::bounds::Bound;
use crate::setting::{self, SettingError, SettingKey, check_bound};

/// Wanted temperatures and what it costs to miss them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Setpoints {
    /// Wanted temperature of each zone while it is occupied \[°C\], in the order of the zones; one for all if there is only
    /// one.
    #[schemars(inner(range(min = -50.0, max = 100.0)), length(min = 1))]
    pub occupied_c: Vec<f64>,
    /// When occupation begins \[h\].
    #[schemars(range(min = 0.0, max = 24.0))]
    pub from_h: f64,
    /// When occupation ends \[h\].
    #[schemars(range(min = 0.0, max = 24.0))]
    pub to_h: f64,
    /// Wanted temperature at other times \[°C\]. Without it, or with `other_weight` 0, the temperature is then free.
    #[schemars(range(min = -50.0, max = 100.0), example = 28.0)]
    pub other_c: Option<f64>,
    /// W_e while occupied: cost of a squared kelvin for a step.
    #[schemars(range(min = 0.0), extend("x-unit" = "1/K²"))]
    pub occupied_weight: f64,
    /// W_e at other times.
    #[schemars(range(min = 0.0), extend("x-unit" = "1/K²"))]
    pub other_weight: f64,
    /// W_u: cost of a squared kilowatt for a step.
    #[schemars(range(min = 0.0), extend("x-unit" = "1/kW²"))]
    pub input_weight: f64,
    /// Deviations up to this are comfortable \[K\].
    #[schemars(range(min = 0.0))]
    pub band_k: f64,
}

impl Default for Setpoints {
    /// The hours and weights of chapter 3 (Table 3.1), free at night, and one temperature for all zones.
    fn default() -> Self {
        Self {
            occupied_c: vec![25.0],
            from_h: 8.0,
            to_h: 19.0,
            other_c: None,
            occupied_weight: 1.0,
            other_weight: 1.0,
            input_weight: 1.0,
            band_k: 0.5,
        }
    }
}

/// Setpoints that are out of range, or do not fit a building.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SetpointsError {
    /// Neither one temperature for all zones nor one for each.
    #[error("occupied_c has {found} temperatures for {zones} zones: give one for each, or one for all")]
    Count {
        /// How many temperatures there are.
        found: usize,
        /// How many zones there are.
        zones: usize,
    },
    /// A setting is out of range.
    #[error(transparent)]
    Setting(#[from] SettingError),
}

/// [`Setpoints`] for the steps of a day. Stacked quantities belong to the temperatures T(1) … T(N) at the ends of the
/// steps, time-major: entry (t − 1)·n + i is zone i at the end of step t.
#[derive(Clone, Debug, PartialEq)]
pub struct Targets {
    /// n, how many zones there are.
    pub zones: usize,
    /// Wanted temperatures \[°C\], stacked; also where the weight is zero.
    pub reference_c: Vec<f64>,
    /// W_e, stacked: cost of a squared kelvin; zero where the temperature is free.
    pub error_weight: Vec<f64>,
    /// Whether zones are occupied, one for each of the N temperatures.
    pub occupied: Vec<bool>,
    /// W_u: cost of a squared kilowatt.
    pub input_weight: f64,
    /// Deviations up to this are comfortable while occupied \[K\].
    pub band_k: f64,
}

impl SetpointsError {
    /// The key of the setting at fault, in the table of the setpoints.
    pub fn key(&self) -> SettingKey {
        match self {
            Self::Count { .. } => "occupied_c".into(),
            Self::Setting(error) => error.key.clone(),
        }
    }
}

impl Setpoints {
    /// The targets of a day of `steps` steps. Both ends of the occupation count as occupied.
    ///
    /// # Errors
    /// [`SetpointsError`].
    pub fn targets(&self, zones: usize, step_s: f64, steps: usize) -> Result<Targets, SetpointsError> {
        self.check(zones)?;
        const ROUNDING_H: f64 = 1e-9;
        let occupied: Vec<bool> = (1..=steps)
            .map(|t| {
                let hour = t as f64 * step_s / 3600.0;
                self.from_h - ROUNDING_H <= hour && hour <= self.to_h + ROUNDING_H
            })
            .collect();
        let mut reference_c = Vec::with_capacity(zones * steps);
        let mut error_weight = Vec::with_capacity(zones * steps);
        for &occupied in &occupied {
            for zone in 0..zones {
                let wanted_c = self.occupied_c[zone.min(self.occupied_c.len() - 1)];
                let (reference_c_now, weight) = match (occupied, self.other_c) {
                    (true, _) => (wanted_c, self.occupied_weight),
                    (false, Some(other_c)) => (other_c, self.other_weight),
                    (false, None) => (wanted_c, 0.0),
                };
                reference_c.push(reference_c_now);
                error_weight.push(weight);
            }
        }
        let (input_weight, band_k) = (self.input_weight, self.band_k);
        Ok(Targets { zones, reference_c, error_weight, occupied, input_weight, band_k })
    }

    fn check(&self, zones: usize) -> Result<(), SetpointsError> {
        let found = self.occupied_c.len();
        if found == 0 || (found != 1 && found != zones) {
            return Err(SetpointsError::Count { found, zones });
        }
        setting::check(self)?;
        Ok(check_bound("to_h", self.to_h, Bound::AtLeast(self.from_h))?)
    }
}

impl Targets {
    /// N, how many steps the day has.
    pub fn steps(&self) -> usize {
        self.occupied.len()
    }

    /// Wanted temperatures at the start of step t \[°C\], one per zone. Midnight belongs to both days, so at t = 0 they are
    /// those of the day's end.
    ///
    /// # Panics
    /// When t is not below N.
    pub fn reference_at(&self, t: usize) -> &[f64] {
        &self.reference_c[self.row(t)]
    }

    /// W_e at the start of step t, one per zone.
    ///
    /// # Panics
    /// When t is not below N.
    pub fn weight_at(&self, t: usize) -> &[f64] {
        &self.error_weight[self.row(t)]
    }

    /// The targets of the `steps` steps from step `t` of the day on. After midnight the same day begins again.
    #[must_use]
    pub fn ahead(&self, t: usize, steps: usize) -> Self {
        let hours = (t..t + steps).map(|later| later % self.steps());
        let stacked = |series: &[f64]| -> Vec<f64> {
            hours.clone().flat_map(|t| &series[t * self.zones..(t + 1) * self.zones]).copied().collect()
        };
        Self {
            reference_c: stacked(&self.reference_c),
            error_weight: stacked(&self.error_weight),
            occupied: hours.clone().map(|t| self.occupied[t]).collect(),
            ..*self
        }
    }

    fn row(&self, t: usize) -> std::ops::Range<usize> {
        assert!(t < self.steps(), "step {t} of a day of {}", self.steps());
        let row = if t == 0 { self.steps() - 1 } else { t - 1 };
        row * self.zones..(row + 1) * self.zones
    }

    /// J = Σ W_e e² + W_u u² (eq. 3.2), for stacked temperatures and inputs.
    ///
    /// # Panics
    /// When a slice has not n·N numbers.
    pub fn cost(&self, temperatures_c: &[f64], heat_kw: &[f64]) -> f64 {
        assert_eq!(temperatures_c.len(), self.reference_c.len(), "one temperature per step and zone");
        assert_eq!(heat_kw.len(), self.reference_c.len(), "one input per step and zone");
        let mut cost = 0.0;
        for (i, (temperature_c, heat_kw)) in temperatures_c.iter().zip(heat_kw).enumerate() {
            let error_k = self.reference_c[i] - temperature_c;
            cost += self.error_weight[i] * error_k * error_k + self.input_weight * heat_kw * heat_kw;
        }
        cost
    }
}
