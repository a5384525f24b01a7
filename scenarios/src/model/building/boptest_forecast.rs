//! The forecasts of a BOPTEST test case for its own run.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The forecasts of the case that replace the file's weather, people, wanted temperatures and prices. They are exact, as BOPTEST's
/// are by default, and reach to the end of the day after the last; `weather.forecast` still states the error of the outdoor temperature
/// that controllers see.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct BoptestForecast {
    /// The signal of the outdoor temperature; BOPTEST states it in kelvin.
    #[schemars(length(min = 1))]
    pub outdoor: String,
    /// The signal of the global radiation on a horizontal plane, in W/m².
    #[schemars(length(min = 1))]
    pub sun: String,
    /// BOPTEST's identifier of each zone of the file, in their order, as in `LowerSetp[1]`; an empty one for a zone that the case does not
    /// judge, which is then free. Their bounds replace wanted temperatures where they are closest together, and there the zone
    /// counts as occupied; at other times `setpoints.other_c` holds. An empty list leaves the wanted temperatures to the file.
    #[schemars(example = vec!["1".to_owned()], length(max = 1000))]
    pub zones: Vec<String>,
    /// The distance of the wanted temperature above the lower bound; without it, it is the middle of both bounds. The band reaches down to
    /// the lower bound and as far up \[K\].
    #[schemars(range(min = 0.0, max = 20.0), example = 0.6)]
    pub wanted_above_lower_k: Option<f64>,
    /// Whether the heat of people and machines is that of the case: `InternalGainsCon` and `InternalGainsRad` of each of `zones`.
    pub people: bool,
    /// Whether prices and emissions of electricity are those of the case, as `prices` of the plant says. A `[tariff]` is then refused.
    pub tariff: bool,
}

impl Default for BoptestForecast {
    fn default() -> Self {
        Self {
            outdoor: "TDryBul".to_owned(),
            sun: "HGloHor".to_owned(),
            zones: Vec::new(),
            wanted_above_lower_k: None,
            people: true,
            tariff: true,
        }
    }
}
