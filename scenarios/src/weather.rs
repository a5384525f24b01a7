//! The weather of a scenario: synthetic, or from an EPW file.

use std::sync::Arc;

use interplay_building::calendar::Weekday;
use interplay_building::weather::{Climate, Epw, Forecast, TimeSeries, Weather};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The weather outside and its forecast; `kind` chooses.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum WeatherConfig {
    /// Synthetic weather, drawn from the scenario's seed; by default of a tropical climate.
    Synthetic(Synthetic),
    /// A file in the format of EnergyPlus.
    Epw(EpwFile),
}

impl Default for WeatherConfig {
    fn default() -> Self {
        WeatherConfig::Synthetic(Synthetic::default())
    }
}

/// Synthetic weather.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Synthetic {
    /// What the climate is like; by default like Singapore's.
    pub climate: Climate,
    /// How a day's temperatures are forecast at its start; by default without error.
    pub forecast: Forecast,
}

/// WeatherConfig from an EPW file, from a midnight on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EpwFile {
    /// The file, relative to the scenario or plan that states it, and in a flag to the current folder; or the name of one in the
    /// binary: `tropical-july.epw`.
    #[schemars(example = &"tropical-july.epw")]
    pub file: String,
    /// The month in which the first day lies; without month and day, the first day of the file.
    #[serde(default)]
    #[schemars(range(min = 1, max = 12), example = 7)]
    pub month: Option<u32>,
    /// The first day, in its month.
    #[serde(default)]
    #[schemars(range(min = 1, max = 31), example = 8)]
    pub day: Option<u32>,
    /// How a day's temperatures are forecast at its start; by default without error.
    #[serde(default)]
    pub forecast: Forecast,
    /// What the file says, once it was read.
    #[serde(skip)]
    pub(crate) content: Option<Arc<Epw>>,
}

impl EpwFile {
    /// Midnight at the start of the first day, as time after that of the file's first \[s\].
    pub(crate) fn start_s(&self, epw: &Epw) -> Option<f64> {
        match (self.month, self.day) {
            (None, None) => Some(0.0),
            (month, day) => epw.midnight_s(month.unwrap_or(1), day.unwrap_or(1)),
        }
    }
}

impl WeatherConfig {
    /// How a day's temperatures are forecast.
    pub fn forecast(&self) -> Forecast {
        match self {
            WeatherConfig::Synthetic(synthetic) => synthetic.forecast,
            WeatherConfig::Epw(file) => file.forecast,
        }
    }

    /// The weekday of the first day, if a weather file that was read states one.
    pub fn first_weekday(&self) -> Option<Weekday> {
        let WeatherConfig::Epw(file) = self else { return None };
        let epw = file.content.as_ref()?;
        epw.weekday(file.start_s(epw)?)
    }

    /// Returns the weather over `days` days as functions of the time since the first midnight. `None` only for an EPW
    /// file of a scenario that was not loaded.
    pub fn days(&self, days: usize, seed: u64) -> Option<Weather> {
        match self {
            WeatherConfig::Synthetic(synthetic) => Some(synthetic.climate.weather(seed, days)),
            WeatherConfig::Epw(file) => {
                let epw = file.content.as_ref()?;
                let start_s = file.start_s(epw)?;
                let shifted = |series: TimeSeries| TimeSeries { first_s: series.first_s - start_s, ..series };
                let Weather { ambient_c, sun_w_per_m2 } = epw.weather();
                Some(Weather { ambient_c: shifted(ambient_c), sun_w_per_m2: shifted(sun_w_per_m2) })
            }
        }
    }
}
