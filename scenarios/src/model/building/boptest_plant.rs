//! A BOPTEST test case as the building.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::json;

/// The address of the BOPTEST test case, the test that is run, and the meaning of its signals for the zones of the file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BoptestPlantConfig {
    /// The server, as `http://host:port`; a path may follow. Traffic is not encrypted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(example = &"http://127.0.0.1:8080")]
    pub url: Option<String>,
    /// In place of a server: the case as a functional mock-up unit of FMI 2.0, for co-simulation or model exchange, with a library for
    /// Linux on x86-64, which `interplay` runs in a process of its own. The path is relative to the scenario or plan that states it, and
    /// in a flag to the current folder. Only our indicators are then computed, not those of BOPTEST.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(example = &"wrapped.fmu", length(min = 1), extend("x-excludes" = ["url"]))]
    pub fmu: Option<String>,
    /// With `fmu`: the time between its measurements, a whole number of communication steps \[s\]. A step of the building is a
    /// multiple of it.
    #[serde(default = "default_sampling_s")]
    #[schemars(range(min = 0.001, max = 86400.0), example = 30.0)]
    pub sampling_s: f64,
    /// The name of the test case, where the server has several; none for a server of one case. A name for the reader with `fmu`.
    #[serde(default)]
    #[schemars(example = &"bestest_hydronic_heat_pump", length(min = 1))]
    pub case: Option<String>,
    /// One of the case's periods, with its start and warm-up.
    #[serde(default)]
    #[schemars(example = &"peak_heat_day", length(min = 1), extend("x-excludes" = ["start_day", "warmup_days"]))]
    pub period: Option<String>,
    /// Without `period`: the day of the year on which the run begins, 0 for the first of January.
    #[serde(default)]
    #[schemars(range(max = 364), example = 30, extend("x-unit" = "d"))]
    pub start_day: usize,
    /// Without `period`: how long the case's own controller runs before.
    #[serde(default = "default_warmup_days")]
    #[schemars(range(max = 364), example = 7, extend("x-unit" = "d"))]
    pub warmup_days: usize,
    /// The prices of electricity by which BOPTEST computes the cost.
    #[serde(default)]
    pub prices: BoptestPrices,
    /// The role of each zone of the file in the case, in their order.
    #[schemars(length(min = 1, max = 1000), example = json!([{ "temperature": "reaTZon_y" }]))]
    pub zones: Vec<BoptestZone>,
    /// The signals from which we compute the indicators, too; without them only BOPTEST does.
    #[serde(default)]
    #[schemars(example = json!({ "area_m2": 192.0, "zones": ["1"] }))]
    pub indicators: Option<BoptestIndicators>,
    /// The forecasts that controllers get from the case; without them, weather, people, wanted temperatures and prices are the file's.
    #[serde(default)]
    #[schemars(example = json!({ "zones": ["1"] }))]
    pub forecast: Option<BoptestForecast>,
    /// The time limit for the server to accept a connection, and for each answer \[s\]; a warm-up is one answer.
    #[serde(default = "default_timeout_s")]
    #[schemars(range(min = 0.001, max = 86400.0), example = 600.0)]
    pub timeout_s: f64,
}

/// Price scenarios of BOPTEST.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum BoptestPrices {
    /// One price.
    #[default]
    Constant,
    /// A price by day and one by night.
    Dynamic,
    /// The price of a spot market.
    HighlyDynamic,
}

impl BoptestPrices {
    /// The word of BOPTEST's interface, and the end of the name of its price signal.
    pub fn words(self) -> (&'static str, &'static str) {
        match self {
            BoptestPrices::Constant => ("constant", "Constant"),
            BoptestPrices::Dynamic => ("dynamic", "Dynamic"),
            BoptestPrices::HighlyDynamic => ("highly_dynamic", "HighlyDynamic"),
        }
    }
}

/// A zone of the file in the test case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BoptestZone {
    /// The measurement of its temperature; BOPTEST states it in kelvin.
    #[schemars(example = &"reaTZon_y", length(min = 1))]
    pub temperature: String,
    /// The inputs that its heat overwrites; without any, the case's own controller keeps the zone.
    #[serde(default)]
    #[schemars(length(max = 100), example = json!([{ "name": "oveHeaPumY_u", "per_kw": 0.1 }]))]
    pub inputs: Vec<BoptestInput>,
}

/// An input of the case as a linear function of the heat of a zone, between bounds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BoptestInput {
    /// The input, such as `oveHeaPumY_u`; its activation, `oveHeaPumY_activate`, is set with it. An FMU that is not a BOPTEST case may
    /// have inputs with other endings and without activation.
    #[schemars(example = &"oveHeaPumY_u", length(min = 1))]
    pub name: String,
    /// Its value without heat.
    #[serde(default)]
    #[schemars(range(min = -1e6, max = 1e6), example = 0.0, extend("x-unit" = "unit of the input"))]
    pub at_zero: f64,
    /// What a kilowatt adds to it; a large number makes a switch.
    #[schemars(range(min = -1e6, max = 1e6), example = 0.1, extend("x-unit" = "unit of the input/kW"))]
    pub per_kw: f64,
    /// The least value.
    #[serde(default)]
    #[schemars(range(min = -1e6, max = 1e6), example = 0.0, extend("x-unit" = "unit of the input"))]
    pub min: f64,
    /// The greatest value.
    #[serde(default = "default_max")]
    #[schemars(range(min = -1e6, max = 1e6), example = 1.0, extend("x-unit" = "unit of the input"))]
    pub max: f64,
    /// Equipment that runs badly at part load gets at least this or nothing; the heat held back is added to later steps, so that
    /// the mean is the requested heat.
    #[serde(default)]
    #[schemars(range(min = -1e6, max = 1e6), example = 0.8, extend("x-unit" = "unit of the input"))]
    pub least_on: Option<f64>,
}

/// The measurements from which indicators are computed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BoptestIndicators {
    /// The floor area of the case \[m²\].
    #[schemars(range(min = 0.001, max = 1e7), example = 192.0)]
    pub area_m2: f64,
    /// BOPTEST's identifiers of the zones, in their order, as in `LowerSetp[1]`; an empty one for a zone that the case does not judge.
    #[schemars(example = json_list("1"), length(min = 1, max = 1000))]
    pub zones: Vec<String>,
    /// Measurements of carbon dioxide, by zone in the order of `zones`.
    #[serde(default)]
    #[schemars(example = json_list("reaCO2RooAir_y"), length(max = 1000))]
    pub carbon_dioxide: Vec<String>,
    /// Measurements of electric power.
    #[serde(default)]
    #[schemars(example = json_list("reaPHeaPum_y"), length(max = 1000))]
    pub electricity: Vec<String>,
    /// Measurements of the power of gas.
    #[serde(default)]
    #[schemars(example = json_list("reaPBoi_y"), length(max = 1000))]
    pub gas: Vec<String>,
    /// Measurements of the power of district heat.
    #[serde(default)]
    #[schemars(example = json_list("reaPDis_y"), length(max = 1000))]
    pub district_heat: Vec<String>,
}

fn json_list(entry: &str) -> Vec<String> {
    vec![entry.to_owned()]
}

fn default_warmup_days() -> usize {
    7
}

fn default_timeout_s() -> f64 {
    600.0
}

/// The sampling time of BOPTEST's measurements.
fn default_sampling_s() -> f64 {
    30.0
}

fn default_max() -> f64 {
    1.0
}

impl BoptestPlantConfig {
    /// The first fault of the settings for a building of `zones` zones: the key below `building.plant`, and the problem.
    pub(crate) fn fault(&self, zones: usize) -> Option<(String, String)> {
        if let Some(fault) = self.fault_of_source() {
            return Some(fault);
        }
        if self.zones.len() != zones {
            let problem = format!("has {} entries; wanted is one for each of the {zones} zones", self.zones.len());
            return Some(("zones".to_owned(), problem));
        }
        for (zone, settings) in self.zones.iter().enumerate() {
            for (input, settings) in settings.inputs.iter().enumerate() {
                let key = |last: &str| format!("zones.{zone}.inputs.{input}.{last}");
                if self.fmu.is_none() && !settings.name.ends_with("_u") {
                    return Some((key("name"), "does not end in `_u`, as inputs of BOPTEST do".to_owned()));
                }
                if settings.min > settings.max {
                    return Some((key("min"), format!("is above `max`, {}", settings.max)));
                }
            }
        }
        self.fault_of_signals(zones)
    }

    /// The first fault of the address or the file, and of the time of the test.
    fn fault_of_source(&self) -> Option<(String, String)> {
        match (&self.url, &self.fmu) {
            (Some(url), None) => {
                let authority = url.strip_prefix("http://").and_then(|rest| rest.split('/').next()).unwrap_or_default();
                let plain = |character: char| character.is_ascii_alphanumeric() || "-._:[]".contains(character);
                let path = |character: char| character.is_ascii_graphic();
                if authority.is_empty() || !authority.chars().all(plain) || !url.chars().all(path) {
                    return Some(("url".to_owned(), "is not an address such as `http://127.0.0.1:8080`".to_owned()));
                }
            }
            (None, Some(_)) => {}
            _ => return Some(("url".to_owned(), "or `building.plant.fmu` must be stated, and not both".to_owned())),
        }
        let word = |character: char| character.is_ascii_alphanumeric() || "-_".contains(character);
        if self.case.as_ref().is_some_and(|case| !case.chars().all(word)) {
            return Some(("case".to_owned(), "may only contain letters, digits, `_` and `-`".to_owned()));
        }
        if self.period.is_some() && self.start_day != 0 {
            return Some((
                "start_day".to_owned(),
                "is stated beside `period`, which has a start of its own".to_owned(),
            ));
        }
        None
    }

    /// The first fault of the signals of indicators and forecasts.
    fn fault_of_signals(&self, zones: usize) -> Option<(String, String)> {
        let wanted = || format!("must have one entry for each of the {zones} zones");
        if let Some(listed) = &self.indicators {
            if listed.zones.len() != zones {
                return Some(("indicators.zones".to_owned(), wanted()));
            }
            if listed.zones.iter().all(String::is_empty) {
                return Some(("indicators.zones".to_owned(), "names no zone that the case judges".to_owned()));
            }
            if listed.carbon_dioxide.len() > zones {
                return Some((
                    "indicators.carbon_dioxide".to_owned(),
                    "has more entries than there are zones".to_owned(),
                ));
            }
        }
        let foretold = self.forecast.as_ref()?;
        if !foretold.zones.is_empty() && foretold.zones.len() != zones {
            return Some(("forecast.zones".to_owned(), wanted()));
        }
        None
    }
}

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

#[cfg(test)]
mod tests {
    use super::*;

    fn config(url: &str) -> BoptestPlantConfig {
        let input =
            BoptestInput { name: "oveY_u".to_owned(), at_zero: 0.0, per_kw: 0.1, min: 0.0, max: 1.0, least_on: None };
        BoptestPlantConfig {
            url: Some(url.to_owned()),
            fmu: None,
            sampling_s: 30.0,
            case: None,
            period: None,
            start_day: 0,
            warmup_days: 7,
            prices: BoptestPrices::Constant,
            zones: vec![BoptestZone { temperature: "reaT_y".to_owned(), inputs: vec![input] }],
            indicators: None,
            forecast: None,
            timeout_s: 1.0,
        }
    }

    #[test]
    fn a_boptest_address_has_a_scheme_and_a_host() {
        for sound in ["http://127.0.0.1:8080", "http://localhost", "http://[::1]:80/api/v1"] {
            assert_eq!(config(sound).fault(1), None, "{sound}");
        }
        for bad in
            ["", "localhost:80", "https://api.boptest.net", "http://", "http:///x", "http://a b", "http://a/\r\n"]
        {
            assert_eq!(config(bad).fault(1).map(|(key, _)| key).as_deref(), Some("url"), "{bad}");
        }
    }

    #[test]
    fn boptest_settings_that_do_not_fit_the_zones_are_named() {
        let fault = |change: fn(&mut BoptestPlantConfig)| {
            let mut wrong = config("http://localhost");
            change(&mut wrong);
            wrong.fault(1).map(|(key, _)| key).unwrap_or_default()
        };
        assert_eq!(fault(|_| ()), "");
        assert_eq!(fault(|config| config.zones.clear()), "zones");
        assert_eq!(fault(|config| config.url = None), "url");
        assert_eq!(fault(|config| config.fmu = Some("a.fmu".to_owned())), "url");
        assert_eq!(fault(|config| (config.period, config.start_day) = (Some("a".to_owned()), 3)), "start_day");
        assert_eq!(fault(|config| config.case = Some("../x".to_owned())), "case");
        assert_eq!(fault(|config| config.zones[0].inputs[0].name = "oveY".to_owned()), "zones.0.inputs.0.name");
        assert_eq!(fault(|config| config.zones[0].inputs[0].min = 2.0), "zones.0.inputs.0.min");
        let two = || BoptestForecast { zones: vec!["1".to_owned(), String::new()], ..BoptestForecast::default() };
        let mut wrong = config("http://localhost");
        wrong.forecast = Some(two());
        assert_eq!(wrong.fault(1).map(|(key, _)| key).as_deref(), Some("forecast.zones"));
    }
}
