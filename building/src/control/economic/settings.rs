//! Settings of the economic model predictive controller.

use interplay_common::bounds::Bound;
use interplay_common::setting::{self, SettingError};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::control::money_stages::EMPTY_ROOM_C;

/// Economic model predictive control: at every step the plan that costs the least money within the comfort band.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct EconomicSettings {
    /// How far each plan looks ahead \[h\]. The forecast of a midnight reaches to the end of the next day; beyond, it is taken once more.
    #[schemars(range(min = 0.25, max = 48.0))]
    pub horizon_h: f64,
    /// The first hours of a plan, in which every step has an input of its own \[h\]. Later inputs are held for `block_h`.
    #[schemars(range(min = 0.0, max = 48.0))]
    pub fine_h: f64,
    /// How long an input is held after the first hours of a plan (move blocking) \[h\]; the comfort band then holds at the ends of
    /// blocks. A value up to a step holds none.
    #[schemars(range(min = 0.0, max = 6.0))]
    pub block_h: f64,
    /// Price of discomfort: a kelvin beyond the band of a zone for an hour \[currency/(K·h)\]. Left out, it is 25 times what the zone loses
    /// for a kelvin in an hour costs at the mean price of the day, or 25 kilowatt-hours if that is more.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0), example = 5.0, extend("x-unit" = "currency/(K·h)"))]
    pub discomfort_price: Option<f64>,
    /// How far plans stay within the comfort band \[K\], at most half of it: room for errors of the forecast. Left out, it is twice the
    /// standard deviation of what the last day's predictions missed by the next step, zone by zone.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 5.0), example = 0.1)]
    pub margin_k: Option<f64>,
    /// Least temperature of empty rooms, against frost \[°C\].
    #[schemars(range(min = -50.0, max = 100.0))]
    pub frost_c: f64,
    /// Largest temperature of empty rooms, against overheating \[°C\]; above `frost_c`.
    #[schemars(range(min = -50.0, max = 200.0))]
    pub overheating_c: f64,
    /// Price of emissions, added to that of electricity \[currency/kg\]; `tariff.emissions_kg_per_kwh` states them.
    #[schemars(range(min = 0.0), extend("x-unit" = "currency/kg"))]
    pub emission_price_per_kg: f64,
    /// How long heat that the forecast missed is expected to go on \[h\]: after this time a share of 1/e is left.
    #[schemars(range(min = 0.1, max = 1000.0))]
    pub persistence_h: f64,
    /// Standard deviation of the missed heat of a zone that is new in an hour \[kW\], for the Kalman filter. Beside `wall_noise_k` it says
    /// what an unexpected temperature is put down to.
    #[schemars(range(min = 0.0001, max = 1000.0))]
    pub heat_noise_kw: f64,
    /// Standard deviation of what the model misses of a wall's temperature in an hour \[K\], for the Kalman filter.
    #[schemars(range(min = 0.0001, max = 100.0))]
    pub wall_noise_k: f64,
    /// Standard deviation of a measured temperature's error \[K\], for the Kalman filter.
    #[schemars(range(min = 0.0001, max = 10.0))]
    pub sensor_noise_k: f64,
    /// Whether the forecast of the disturbance is learned: heat that it missed at an hour of earlier days is expected again, as far as it
    /// repeats.
    pub learn_forecast: bool,
    /// Share of a day in what is learned of the forecast.
    #[schemars(range(min = 0.0, max = 1.0), extend("x-unit" = "dimensionless"))]
    pub learning_rate: f64,
}

impl Default for EconomicSettings {
    fn default() -> Self {
        Self {
            horizon_h: 24.0,
            fine_h: 6.0,
            block_h: 1.0,
            discomfort_price: None,
            margin_k: None,
            frost_c: EMPTY_ROOM_C.0,
            overheating_c: EMPTY_ROOM_C.1,
            emission_price_per_kg: 0.0,
            persistence_h: 6.0,
            heat_noise_kw: 0.1,
            wall_noise_k: 0.02,
            sensor_noise_k: 0.02,
            learn_forecast: true,
            learning_rate: 0.3,
        }
    }
}

impl EconomicSettings {
    /// Refuses settings that are out of range.
    pub(super) fn check(&self) -> Result<(), SettingError> {
        setting::check(self)?;
        setting::check_bound("overheating_c", self.overheating_c, Bound::AtLeast(self.frost_c))
    }

    /// The number of steps of `step_s` in a plan, at least one.
    pub fn horizon(&self, step_s: f64) -> usize {
        steps(self.horizon_h, step_s).max(1)
    }

    /// How many steps each stage of a plan takes that begins at step `step` of the day: single ones first, then blocks that end at
    /// multiples of their length.
    pub(super) fn spans(&self, step: usize, step_s: f64) -> Vec<usize> {
        let (horizon, fine) = (self.horizon(step_s), steps(self.fine_h, step_s).max(1));
        let block = steps(self.block_h, step_s).max(1);
        let mut spans = Vec::new();
        let mut done = 0;
        while done < horizon {
            let aligned = (step + done).is_multiple_of(block);
            let span = if done >= fine && aligned { block.min(horizon - done) } else { 1 };
            spans.push(span);
            done += span;
        }
        spans
    }
}

fn steps(hours: f64, step_s: f64) -> usize {
    (hours * 3600.0 / step_s).round() as usize
}
