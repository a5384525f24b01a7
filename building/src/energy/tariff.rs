//! The price of electricity, hour by hour.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use interplay_common::setting::{self, SettingKey};

/// In the weights of a plan a price counts at least as this share of the mean one, so that cheap heat is not free: prices of
/// markets may be negative.
const MIN_PRICE_RATIO: f64 = 0.05;
const HOUR_S: f64 = 3600.0;

/// What a kilowatt-hour of electricity costs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Tariff {
    /// The currency, for reports.
    #[schemars(length(min = 1))]
    pub currency: String,
    /// The price of each hour from the first midnight on \[currency/kWh\]. After the last they begin again: 1 price holds
    /// always, 24 are a day, 168 a week.
    #[schemars(
        inner(range(min = -1000.0, max = 1000.0)),
        length(max = 100000),
        example = vec![0.3],
        extend("x-unit" = "currency/kWh")
    )]
    pub prices_per_kwh: Vec<f64>,
    /// A table of the prices as comma-separated values: a header `hour,price_per_kwh`, and a row an hour from the first midnight
    /// on, counted from 0. The path is relative to the scenario or plan that states it, and in a flag to the current folder.
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
            file: None,
            demand_per_kw: 0.0,
            emissions_kg_per_kwh: Vec::new(),
        }
    }
}

/// A tariff without a price to compare others with.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{problem}")]
pub struct TariffError {
    /// The key at fault, in the table of the tariff.
    pub key: SettingKey,
    /// What is wrong, and what would work.
    pub problem: String,
}

impl Tariff {
    /// Refuses a tariff that states no prices, or with a mean price that is not positive.
    ///
    /// # Errors
    /// [`TariffError`].
    pub fn check(&self) -> Result<(), TariffError> {
        let refused = |key: &str, problem: String| Err(TariffError { key: key.into(), problem });
        if let Err(error) = setting::check(self) {
            return Err(TariffError { key: error.key.clone(), problem: error.to_string() });
        }
        // Whoever reads the file puts its prices in the place of its name.
        if self.file.is_some() {
            return Ok(());
        }
        if self.prices_per_kwh.is_empty() {
            let problem = "there are no prices: state `prices_per_kwh`, such as `[0.3]`, or a `file`".to_owned();
            return refused("prices_per_kwh", problem);
        }
        let mean = self.mean_per_kwh();
        if mean.partial_cmp(&0.0) != Some(std::cmp::Ordering::Greater) {
            return refused("prices_per_kwh", format!("the mean price is {:.6}; it must be above 0", mean));
        }
        Ok(())
    }

    /// The mean of all prices \[currency/kWh\].
    pub fn mean_per_kwh(&self) -> f64 {
        self.prices_per_kwh.iter().sum::<f64>() / self.prices_per_kwh.len().max(1) as f64
    }

    /// Whether one day has other prices or emissions than the next.
    pub fn days_differ(&self) -> bool {
        [&self.prices_per_kwh, &self.emissions_kg_per_kwh].iter().any(|hours| 24 % hours.len().max(1) != 0)
    }

    /// The price in each step of a day, counted from zero \[currency/kWh\]: the mean over the step.
    pub fn day_per_kwh(&self, day: usize, step_s: f64, steps: usize) -> Vec<f64> {
        by_step(&self.prices_per_kwh, day, step_s, steps)
    }

    /// The emissions in each step of a day, counted from zero \[kg/kWh\]; `None` where they are not stated.
    pub fn day_emissions(&self, day: usize, step_s: f64, steps: usize) -> Option<Vec<f64>> {
        let stated = &self.emissions_kg_per_kwh;
        (!stated.is_empty()).then(|| by_step(stated, day, step_s, steps))
    }
    /// How much more than on average a kilowatt-hour counts in a plan in each step of a day: the ratio of its price to the mean
    /// one, at least a twentieth.
    pub(crate) fn day_weights(&self, day_per_kwh: &[f64]) -> Vec<f64> {
        let mean_per_kwh = self.mean_per_kwh();
        day_per_kwh.iter().map(|price_per_kwh| (price_per_kwh / mean_per_kwh).max(MIN_PRICE_RATIO)).collect()
    }
}

/// The mean over each step of a day of a quantity that is stated by the hour and repeated.
fn by_step(hours: &[f64], day: usize, step_s: f64, steps: usize) -> Vec<f64> {
    let first_h = day * 24;
    let price = |hour: usize| hours[(first_h + hour) % hours.len()];
    let step_price = |step: usize| {
        let (from_s, to_s) = (step as f64 * step_s, (step + 1) as f64 * step_s);
        let hour = (from_s / HOUR_S + 1e-9).floor() as usize;
        let turn_s = (hour + 1) as f64 * HOUR_S;
        if to_s <= turn_s + 1e-6 {
            return price(hour);
        }
        // A step is at most an hour, so it lies in two hours at most.
        let share = (turn_s - from_s) / step_s;
        share * price(hour) + (1.0 - share) * price(hour + 1)
    };
    (0..steps).map(step_price).collect()
}
