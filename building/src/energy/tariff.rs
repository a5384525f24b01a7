//! The price of electricity over time.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use interplay_common::setting::{self, SettingKey};

use super::HeatPump;

/// In the weights of a plan a price counts at least as this share of the mean one, so that cheap heat is not free: prices of
/// markets may be negative.
const MIN_PRICE_RATIO: f64 = 0.05;
const HOUR_S: f64 = 3600.0;
const DAY_S: f64 = 86_400.0;

/// Whether a ratio is a whole number of at least 1.
fn is_whole(ratio: f64) -> bool {
    ratio >= 0.5 && (ratio - ratio.round()).abs() < 1e-9
}

/// What a kilowatt-hour of electricity costs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Tariff {
    /// The currency, for reports.
    #[schemars(length(min = 1))]
    pub currency: String,
    /// The prices from the first midnight on, each for `interval_s` \[currency/kWh\]. After the last they begin again, so they are
    /// whole days, or fit a whole number of times into a day, or reach to the end of the run: of prices by the hour 1 holds always, 24
    /// are a day, 168 a week.
    #[schemars(
        inner(range(min = -1000.0, max = 1000.0)),
        length(max = 100000),
        example = vec![0.3],
        extend("x-unit" = "currency/kWh")
    )]
    pub prices_per_kwh: Vec<f64>,
    /// How long each price holds, such as 3600 or 900; a day must be a whole number of them. That of a `file` follows from its rows \[s\].
    #[schemars(range(min = 60.0, max = 86400.0))]
    pub interval_s: f64,
    /// A table of the prices as comma-separated values: a header `hour,price_per_kwh`, and rows at equal intervals from hour 0 of the
    /// first day on, such as hours 0, 0.25, 0.5, or instead of `hour` a column of dates with a time. The path is relative to the scenario
    /// or plan that states it, and in a flag to the current folder.
    #[schemars(example = &"prices.csv", extend("x-excludes" = ["prices_per_kwh"]))]
    pub file: Option<String>,
    /// Demand charge: what the highest electric power of all zones over a step of the run costs \[currency/kW\].
    #[schemars(range(min = 0.0, max = 100000.0), extend("x-unit" = "currency/kW"))]
    pub demand_per_kw: f64,
    /// Emissions of electricity in each hour from the first midnight on \[kg/kWh\], repeated as prices are; empty where they are not
    /// counted.
    #[schemars(
        inner(range(min = 0.0, max = 10.0)),
        length(max = 100000),
        example = vec![0.4],
        extend("x-unit" = "kg/kWh")
    )]
    pub emissions_kg_per_kwh: Vec<f64>,
}

impl Default for Tariff {
    fn default() -> Self {
        Self {
            currency: "EUR".to_owned(),
            prices_per_kwh: Vec::new(),
            interval_s: HOUR_S,
            file: None,
            demand_per_kw: 0.0,
            emissions_kg_per_kwh: Vec::new(),
        }
    }
}

/// Why a tariff is refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{problem}")]
pub struct TariffError {
    /// The key at fault, in the table of the tariff.
    pub key: SettingKey,
    /// What is wrong, and what would work.
    pub problem: String,
}

impl Tariff {
    /// Refuses a tariff that states no prices. They may be zero or negative.
    pub fn check(&self) -> Result<(), TariffError> {
        let refused = |key: &str, problem: String| Err(TariffError { key: key.into(), problem });
        if let Err(error) = setting::check(self) {
            return Err(TariffError { key: error.key.clone(), problem: error.to_string() });
        }
        // The reader of the file replaces its name by its prices.
        if self.file.is_some() {
            return Ok(());
        }
        if self.prices_per_kwh.is_empty() {
            let problem = "there are no prices: state `prices_per_kwh`, such as `[0.3]`, or a `file`".to_owned();
            return refused("prices_per_kwh", problem);
        }
        if !is_whole(DAY_S / self.interval_s) {
            let problem = format!("a day is not a whole number of {} s: 900, 1800 and 3600 work", self.interval_s);
            return refused("interval_s", problem);
        }
        Ok(())
    }

    /// The mean size of all prices \[currency/kWh\].
    pub fn mean_size_per_kwh(&self) -> f64 {
        mean_size(&self.prices_per_kwh)
    }

    /// The number of days that the prices cover.
    pub fn days(&self) -> f64 {
        self.prices_per_kwh.len() as f64 * self.interval_s / DAY_S
    }

    /// Refuses prices that, in a run of `days` days, would start again in the middle of a day.
    pub fn check_days(&self, days: usize) -> Result<(), TariffError> {
        let count = self.prices_per_kwh.len();
        if count == 0 || is_whole(self.days()) || is_whole(1.0 / self.days()) || self.days() >= days as f64 {
            return Ok(());
        }
        let per_day = DAY_S / self.interval_s;
        let problem = format!(
            "there are {count} prices, and the run takes {}: after the last they would begin anew in the middle of a day; \
             state whole days ({} or {} prices), or all of them",
            days as f64 * per_day,
            (self.days().floor().max(1.0)) * per_day,
            self.days().ceil().max(2.0) * per_day
        );
        Err(TariffError { key: "prices_per_kwh".into(), problem })
    }

    /// Whether prices or emissions differ between days.
    pub fn days_differ(&self) -> bool {
        let has_prices = !self.prices_per_kwh.is_empty();
        (has_prices && !is_whole(1.0 / self.days())) || 24 % self.emissions_kg_per_kwh.len().max(1) != 0
    }

    /// The price in each step of a day, counted from zero \[currency/kWh\]: the mean over the step.
    pub fn day_per_kwh(&self, day: usize, step_s: f64, steps: usize) -> Vec<f64> {
        by_step((&self.prices_per_kwh, self.interval_s), day, step_s, steps)
    }

    /// The emissions in each step of a day, counted from zero \[kg/kWh\]; `None` where they are not stated.
    pub(crate) fn day_emissions(&self, day: usize, step_s: f64, steps: usize) -> Option<Vec<f64>> {
        let stated = &self.emissions_kg_per_kwh;
        (!stated.is_empty()).then(|| by_step((stated, HOUR_S), day, step_s, steps))
    }
    /// How much more than on average a kilowatt-hour counts in a plan in each step of a day: the ratio of its price to the mean
    /// size of prices, at least a twentieth; 1 where all prices are zero.
    pub(crate) fn day_weights(&self, day_per_kwh: &[f64]) -> Vec<f64> {
        let mean_per_kwh = self.mean_size_per_kwh();
        let weight = |price_per_kwh: &f64| match mean_per_kwh > 0.0 {
            true => (price_per_kwh / mean_per_kwh).max(MIN_PRICE_RATIO),
            false => 1.0,
        };
        day_per_kwh.iter().map(weight).collect()
    }
}

/// The mean size of prices, which is positive unless all of them are zero.
pub(crate) fn mean_size(prices: &[f64]) -> f64 {
    prices.iter().map(|price| price.abs()).sum::<f64>() / prices.len().max(1) as f64
}

/// The mean over each step of a day of a quantity that is stated for intervals of such a length \[s\], and repeated.
fn by_step((stated, interval_s): (&[f64], f64), day: usize, step_s: f64, steps: usize) -> Vec<f64> {
    let first = day * (DAY_S / interval_s).round() as usize;
    let price = |interval: usize| stated[(first + interval) % stated.len()];
    let step_price = |step: usize| {
        let (from_s, to_s) = (step as f64 * step_s, (step + 1) as f64 * step_s);
        let interval = (from_s / interval_s + 1e-9).floor() as usize;
        let turn_s = (interval + 1) as f64 * interval_s;
        if to_s <= turn_s + 1e-6 {
            return price(interval);
        }
        let (mut sum, mut from_s, mut interval) = (0.0, from_s, interval);
        while from_s < to_s - 1e-6 {
            let until_s = ((interval + 1) as f64 * interval_s).min(to_s);
            sum += (until_s - from_s) / step_s * price(interval);
            (from_s, interval) = (until_s, interval + 1);
        }
        sum
    };
    (0..steps).map(step_price).collect()
}

/// Prices and outdoor temperatures of the steps of a day, with the equipment that turns electricity into heat.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EnergySupply {
    /// The price of electricity in each step \[currency/kWh\]; none without a tariff.
    pub price_per_kwh: Option<Vec<f64>>,
    /// Emissions of electricity in each step \[kg/kWh\]; none where the tariff does not state them.
    pub emissions_kg_per_kwh: Option<Vec<f64>>,
    /// What the highest electric power of the run costs \[currency/kW\]; 0 without a demand charge.
    pub demand_per_kw: f64,
    /// The heat pump; without it a kilowatt of heat takes a kilowatt of electricity.
    pub heat_pump: Option<HeatPump>,
    /// The outdoor temperature of each step \[°C\]; empty as long as it is not known.
    pub outdoor_c: Vec<f64>,
    /// Weights W_u with the prices and without the heat pump, stacked; empty without a heat pump, and where energy has
    /// no weight.
    pub price_weight: Vec<f64>,
}

impl EnergySupply {
    /// Electric power of the equipment that adds `heat_kw` to a zone or, if negative, removes it \[kW\].
    pub fn electric_kw(&self, step: usize, heat_kw: f64) -> f64 {
        match (&self.heat_pump, self.outdoor_c.get(step)) {
            (Some(heat_pump), Some(outdoor_c)) => heat_kw.abs() / heat_pump.cop(heat_kw > 0.0, *outdoor_c),
            _ => heat_kw.abs(),
        }
    }

    /// The cost of `electric_kwh` in a step \[currency\]; `None` without a tariff.
    pub fn money(&self, step: usize, electric_kwh: f64) -> Option<f64> {
        Some(self.price_per_kwh.as_ref()?.get(step)? * electric_kwh)
    }

    /// How much more than on average a kilowatt of heat counts in a plan, by the COP alone. A zone is expected to be heated
    /// where it is colder outdoors than wanted, and cooled where it is not.
    pub(crate) fn cop_weight(&self, wanted_c: f64, outdoor_c: f64) -> f64 {
        self.heat_pump.as_ref().map_or(1.0, |heat_pump| heat_pump.relative(outdoor_c < wanted_c, outdoor_c))
    }
}
