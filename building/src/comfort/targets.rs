//! Wanted temperatures of the zones over a day.

use std::borrow::Cow;

use interplay_common::bounds::Bound;
use interplay_common::setting::{self, SettingError, SettingKey, check_bound};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::energy::EnergySupply;

/// Wanted temperatures and what it costs to miss them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Setpoints {
    /// Wanted temperature of each zone while it is occupied \[°C\], in the order of the zones; one for all if there is only
    /// one.
    #[schemars(inner(range(min = -50.0, max = 100.0)), length(min = 1))]
    pub occupied_c: Vec<f64>,
    /// Hour of the day at which occupation begins \[h\].
    #[schemars(range(min = 0.0, max = 24.0))]
    pub from_h: f64,
    /// Hour of the day at which occupation ends \[h\].
    #[schemars(range(min = 0.0, max = 24.0))]
    pub to_h: f64,
    /// Wanted temperature at other times \[°C\]. Without it, or with `other_weight` 0, the temperature is then free.
    #[schemars(range(min = -50.0, max = 100.0), example = 28.0)]
    pub other_c: Option<f64>,
    /// Weight W_e while occupied: cost of a squared kelvin of deviation in a step.
    #[schemars(range(min = 0.0), extend("x-unit" = "1/K²"))]
    pub occupied_weight: f64,
    /// Weight W_e at other times: cost of a squared kelvin of deviation in a step.
    #[schemars(range(min = 0.0), extend("x-unit" = "1/K²"))]
    pub other_weight: f64,
    /// Weight W_u: cost of a squared kilowatt of heat in a step.
    #[schemars(range(min = 0.0), extend("x-unit" = "1/kW²"))]
    pub input_weight: f64,
    /// Deviations up to this are comfortable \[K\].
    #[schemars(range(min = 0.0))]
    pub band_k: f64,
    /// Whether W_u is larger where electricity is expensive and smaller where the heat pump works well. Reports state what
    /// energy costs in either case.
    pub weigh_energy: bool,
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
            weigh_energy: true,
        }
    }
}

/// Why setpoints are refused: a value is out of range, or they do not fit the building.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SetpointsError {
    /// The number of wanted temperatures is neither 1 nor that of the zones.
    #[error("occupied_c has {found} temperatures for {zones} zones: give one for each, or one for all")]
    Count {
        /// Number of stated temperatures.
        found: usize,
        /// Number of zones.
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
    /// Number of zones, n.
    pub zones: usize,
    /// Wanted temperatures \[°C\], stacked; also where the weight is zero.
    pub reference_c: Vec<f64>,
    /// Weights W_e, stacked: cost of a squared kelvin of deviation; zero where the temperature is free.
    pub error_weight: Vec<f64>,
    /// Whether the zone is occupied, stacked.
    pub occupied: Vec<bool>,
    /// Weights W_u, stacked: entry t·n + i is the cost of a squared kilowatt in zone i during step t.
    pub input_weight: Vec<f64>,
    /// Deviations up to this are comfortable while occupied \[K\], stacked.
    pub band_k: Vec<f64>,
    /// Prices and equipment: the electricity that heat takes and what it costs.
    pub supply: EnergySupply,
    /// The targets of the next day, where it differs; without them the next day is like this one.
    pub tomorrow: Option<Box<Targets>>,
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
        let occupied = occupied.iter().flat_map(|&occupied| std::iter::repeat_n(occupied, zones)).collect();
        let size = zones * steps;
        let supply = EnergySupply::default();
        let (input_weight, band_k) = (vec![self.input_weight; size], vec![self.band_k; size]);
        Ok(Targets { zones, reference_c, error_weight, occupied, input_weight, band_k, supply, tomorrow: None })
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
    /// Number of steps of the day, N.
    pub fn steps(&self) -> usize {
        self.reference_c.len() / self.zones.max(1)
    }

    /// Amount by which a temperature is beyond the comfort band \[K\]; 0 within the band, and while the zone is not
    /// occupied. `i` is an index of stacked quantities.
    ///
    /// # Panics
    /// When `i` is out of range.
    pub fn beyond_k(&self, i: usize, temperature_c: f64) -> f64 {
        if !self.occupied[i] {
            return 0.0;
        }
        ((self.reference_c[i] - temperature_c).abs() - self.band_k[i]).max(0.0)
    }

    /// Whether any zone is occupied at the end of each step.
    pub fn any_occupied(&self) -> Vec<bool> {
        self.occupied.chunks_exact(self.zones.max(1)).map(|zones| zones.contains(&true)).collect()
    }

    /// Wanted temperatures at the start of step t \[°C\], one per zone. Midnight belongs to both days, so at t = 0 they are
    /// those of the day's end.
    ///
    /// # Panics
    /// When t is not below N.
    pub fn reference_at(&self, t: usize) -> &[f64] {
        &self.reference_c[self.row(t)]
    }

    /// Weights W_e at the start of step t, one per zone.
    ///
    /// # Panics
    /// When t is not below N.
    pub fn weight_at(&self, t: usize) -> &[f64] {
        &self.error_weight[self.row(t)]
    }

    /// The comfort band at the start of step t \[K\], one per zone; `None` where the zone is not occupied.
    ///
    /// # Panics
    /// When t is not below N.
    pub fn band_at(&self, t: usize) -> Vec<Option<f64>> {
        self.row(t).map(|i| self.occupied[i].then_some(self.band_k[i])).collect()
    }

    /// The same targets at the outdoor temperature `outdoor_c` of each step: with a heat pump, the cost of heat rises
    /// where the COP is low.
    #[must_use]
    pub fn under(&self, outdoor_c: &[f64]) -> Cow<'_, Self> {
        if self.supply.heat_pump.is_none() {
            return Cow::Borrowed(self);
        }
        let mut targets = self.clone();
        targets.supply.outdoor_c = outdoor_c.to_vec();
        for (i, input_weight) in targets.input_weight.iter_mut().enumerate() {
            // Without price weights, the COP has no effect either.
            let (Some(weight), Some(outdoor_c)) = (self.supply.price_weight.get(i), outdoor_c.get(i / self.zones))
            else {
                break;
            };
            *input_weight = weight * self.supply.cop_weight(self.reference_c[i], *outdoor_c);
        }
        targets.tomorrow = self.tomorrow.as_ref().map(|tomorrow| Box::new(tomorrow.under(outdoor_c).into_owned()));
        Cow::Owned(targets)
    }

    /// The targets of the next `steps` steps, from step `t` of the day on. After midnight they are those of tomorrow,
    /// repeated as often as needed.
    #[must_use]
    pub fn ahead(&self, t: usize, steps: usize) -> Self {
        let tomorrow = self.tomorrow.as_deref().unwrap_or(self);
        let entries = (t..t + steps).flat_map(|later| {
            let day = if later < self.steps() { self } else { tomorrow };
            let step = later % self.steps();
            (step * self.zones..(step + 1) * self.zones).map(move |i| (day, i))
        });
        let stacked = |of: fn(&Self) -> &[f64]| -> Vec<f64> { entries.clone().map(|(day, i)| of(day)[i]).collect() };
        Self {
            zones: self.zones,
            reference_c: stacked(|day| &day.reference_c),
            error_weight: stacked(|day| &day.error_weight),
            occupied: entries.clone().map(|(day, i)| day.occupied[i]).collect(),
            input_weight: stacked(|day| &day.input_weight),
            band_k: stacked(|day| &day.band_k),
            supply: EnergySupply::default(),
            tomorrow: None,
        }
    }

    /// Prices, emissions and equipment of the `steps` steps from step `t` of the day on, with the days of [`Targets::ahead`]. The outdoor
    /// temperature is not known.
    #[must_use]
    pub(crate) fn supply_ahead(&self, t: usize, steps: usize) -> EnergySupply {
        let tomorrow = self.tomorrow.as_deref().unwrap_or(self);
        let stacked = |of: fn(&EnergySupply) -> &Option<Vec<f64>>| -> Option<Vec<f64>> {
            (t..t + steps)
                .map(|later| {
                    let day = if later < self.steps() { self } else { tomorrow };
                    of(&day.supply).as_ref()?.get(later % self.steps()).copied()
                })
                .collect()
        };
        EnergySupply {
            price_per_kwh: stacked(|supply| &supply.price_per_kwh),
            emissions_kg_per_kwh: stacked(|supply| &supply.emissions_kg_per_kwh),
            demand_per_kw: self.supply.demand_per_kw,
            heat_pump: self.supply.heat_pump.clone(),
            outdoor_c: Vec::new(),
            price_weight: Vec::new(),
        }
    }

    fn row(&self, t: usize) -> std::ops::Range<usize> {
        assert!(t < self.steps(), "step {t} of a day of {}", self.steps());
        let row = if t == 0 { self.steps() - 1 } else { t - 1 };
        row * self.zones..(row + 1) * self.zones
    }

    /// The cost J = Σ W_e e² + W_u u² (eq. 3.2) of stacked temperatures and inputs.
    ///
    /// # Panics
    /// When a slice has not n·N numbers.
    pub fn cost(&self, temperatures_c: &[f64], heat_kw: &[f64]) -> f64 {
        assert_eq!(temperatures_c.len(), self.reference_c.len(), "one temperature per step and zone");
        assert_eq!(heat_kw.len(), self.reference_c.len(), "one input per step and zone");
        let mut cost = 0.0;
        for (i, (temperature_c, heat_kw)) in temperatures_c.iter().zip(heat_kw).enumerate() {
            let error_k = self.reference_c[i] - temperature_c;
            cost += self.error_weight[i] * error_k * error_k + self.input_weight[i] * heat_kw * heat_kw;
        }
        cost
    }
}
