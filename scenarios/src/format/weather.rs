//! The weather of a scenario as a file states it.

use interplay_building::weather::RecordedWeather;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::model::building::weather::{EpwFile, Synthetic, WeatherSource};

/// The weather outside and its forecast; `kind` chooses.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum WeatherConfig {
    /// Synthetic weather, drawn from the scenario's seed; by default of a tropical climate.
    Synthetic(Synthetic),
    /// A file in the format of EnergyPlus.
    Epw(EpwFile),
    /// A table of comma-separated values.
    Csv(RecordedWeather),
}

impl Default for WeatherConfig {
    fn default() -> Self {
        WeatherConfig::Synthetic(Synthetic::default())
    }
}

impl WeatherSource {
    /// What a file states of it.
    pub(crate) fn config(&self) -> WeatherConfig {
        match self {
            WeatherSource::Synthetic(synthetic) => WeatherConfig::Synthetic(*synthetic),
            WeatherSource::Epw(weather) => {
                WeatherConfig::Epw(EpwFile { file: weather.found.clone(), ..weather.stated.clone() })
            }
            WeatherSource::Csv(weather) => {
                WeatherConfig::Csv(RecordedWeather { file: weather.found.clone(), ..weather.stated.clone() })
            }
        }
    }
}
