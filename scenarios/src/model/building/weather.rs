//! The weather of a scenario: synthetic, from an EPW file, or from a table.

use std::sync::Arc;

use interplay_building::calendar::Weekday;
use interplay_building::weather::{Climate, Epw, Forecast, RecordedWeather, Weather, default_bridge_gaps_h};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Synthetic weather.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Synthetic {
    /// The climate; by default that of Singapore.
    pub climate: Climate,
    /// The forecast of a day's temperatures at its start; by default without error.
    pub forecast: Forecast,
}

/// The weather of an EPW file, from a midnight on.
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
    /// The forecast of a day's temperatures at its start; by default without error.
    #[serde(default)]
    pub forecast: Forecast,
    /// The longest gap in the used rows that is bridged, with a remark; a longer one is refused \[h\].
    #[serde(default = "default_bridge_gaps_h")]
    #[schemars(range(min = 0.0, max = 100000.0))]
    pub bridge_gaps_h: f64,
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

/// The weather around a building: how it is drawn, or the rows of a file.
#[derive(Clone, Debug, PartialEq)]
pub enum WeatherSource {
    /// Synthetic weather, drawn from the scenario's seed.
    Synthetic(Synthetic),
    /// The rows of an EPW file.
    Epw(EpwWeather),
    /// The rows of a table.
    Csv(CsvWeather),
}

/// An EPW file after reading, and the first day that is simulated.
#[derive(Clone, Debug, PartialEq)]
pub struct EpwWeather {
    /// Its statement in the file.
    pub stated: EpwFile,
    /// Where the file was found: an absolute path, or its name in the binary.
    pub found: String,
    /// Its content.
    pub rows: Arc<Epw>,
    /// Midnight at the start of the first day, as time after that of the file's first \[s\].
    pub start_s: f64,
}

/// A table of weather after reading.
#[derive(Clone, Debug, PartialEq)]
pub struct CsvWeather {
    /// Its statement in the file.
    pub stated: RecordedWeather,
    /// Where the table was found: an absolute path.
    pub found: String,
    /// Its rows for the run, from its first midnight on.
    pub weather: Arc<Weather>,
    /// The weekday of the first day, if the table has dates.
    pub first_weekday: Option<Weekday>,
}

impl Default for WeatherSource {
    fn default() -> Self {
        WeatherSource::Synthetic(Synthetic::default())
    }
}

impl WeatherSource {
    /// The forecast of a day's temperatures.
    pub fn forecast(&self) -> Forecast {
        match self {
            WeatherSource::Synthetic(synthetic) => synthetic.forecast,
            WeatherSource::Epw(weather) => weather.stated.forecast,
            WeatherSource::Csv(weather) => weather.stated.forecast,
        }
    }

    /// The weekday of the first day, if a weather file states one.
    pub fn first_weekday(&self) -> Option<Weekday> {
        match self {
            WeatherSource::Synthetic(_) => None,
            WeatherSource::Epw(weather) => weather.rows.weekday(weather.start_s),
            WeatherSource::Csv(weather) => weather.first_weekday,
        }
    }

    /// Returns the weather over `days` days as functions of the time since the first midnight.
    pub fn days(&self, days: usize, seed: u64) -> Weather {
        match self {
            WeatherSource::Synthetic(synthetic) => synthetic.climate.weather(seed, days),
            WeatherSource::Epw(weather) => weather.rows.weather().from_s(weather.start_s),
            WeatherSource::Csv(weather) => (*weather.weather).clone(),
        }
    }
}
