//! The units that a table may use, converted to the units of this crate.

use std::fmt;

use interplay_common::json_schema::type_in_words;
use interplay_common::spelling::listed;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Heat capacity of air at about 20 °C and sea level, per volume \[kJ/(m³·K)\].
const AIR_KJ_PER_M3_K: f64 = 1.204 * 1.006;
/// Heat capacity of air, per mass \[kJ/(kg·K)\].
const AIR_KJ_PER_KG_K: f64 = 1.006;
/// Heat capacity of water at about 10 to 40 °C, per litre \[kJ/(l·K)\].
const WATER_KJ_PER_L_K: f64 = 4.18;

/// A unit of temperature.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum TemperatureUnit {
    /// °C
    Celsius,
    /// K
    Kelvin,
    /// °F
    Fahrenheit,
}

impl TemperatureUnit {
    /// A temperature of this unit in °C.
    pub(crate) fn to_celsius(self, value: f64) -> f64 {
        match self {
            Self::Celsius => value,
            Self::Kelvin => value - 273.15,
            Self::Fahrenheit => (value - 32.0) / 1.8,
        }
    }
}

/// A unit of power.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum PowerUnit {
    /// kW
    Kw,
    /// W
    W,
    /// In proportion to power, by an unknown factor: capacities and resistances then have no absolute scale.
    Unknown,
}

impl PowerUnit {
    /// This unit in kW; 1 where the factor is unknown.
    pub fn kw(self) -> f64 {
        match self {
            Self::Kw | Self::Unknown => 1.0,
            Self::W => 1e-3,
        }
    }
}

/// A unit of energy.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum EnergyUnit {
    /// kWh
    Kwh,
    /// Wh
    Wh,
    /// MWh
    Mwh,
    /// MJ
    Mj,
    /// GJ
    Gj,
}

impl EnergyUnit {
    /// This unit in kJ.
    pub(crate) fn kj(self) -> f64 {
        match self {
            Self::Kwh => 3600.0,
            Self::Wh => 3.6,
            Self::Mwh => 3.6e6,
            Self::Mj => 1e3,
            Self::Gj => 1e6,
        }
    }
}

/// A unit of irradiance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum IrradianceUnit {
    /// W/m²
    WPerM2,
    /// kW/m²
    KwPerM2,
}

impl IrradianceUnit {
    /// This unit in kW/m².
    pub(crate) fn kw_per_m2(self) -> f64 {
        match self {
            Self::WPerM2 => 1e-3,
            Self::KwPerM2 => 1.0,
        }
    }
}

/// A unit of air flow.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum AirFlowUnit {
    /// m³/s
    M3PerS,
    /// m³/min
    M3PerMin,
    /// m³/h
    M3PerH,
    /// kg/s
    KgPerS,
    /// kW/K, the heat that the flow carries
    KwPerK,
}

impl AirFlowUnit {
    /// Heat per kelvin that one such unit of air flow carries, ṁ c_p \[kW/K\].
    pub fn kw_per_k(self) -> f64 {
        match self {
            Self::M3PerS => AIR_KJ_PER_M3_K,
            Self::M3PerMin => AIR_KJ_PER_M3_K / 60.0,
            Self::M3PerH => AIR_KJ_PER_M3_K / 3600.0,
            Self::KgPerS => AIR_KJ_PER_KG_K,
            Self::KwPerK => 1.0,
        }
    }
}

/// A unit of water flow.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum WaterFlowUnit {
    /// l/s
    LPerS,
    /// l/min
    LPerMin,
    /// m³/h
    M3PerH,
}

impl WaterFlowUnit {
    /// Heat per kelvin that one such unit of water flow carries \[kW/K\].
    pub fn kw_per_k(self) -> f64 {
        match self {
            Self::LPerS => WATER_KJ_PER_L_K,
            Self::LPerMin => WATER_KJ_PER_L_K / 60.0,
            Self::M3PerH => WATER_KJ_PER_L_K / 3.6,
        }
    }
}

/// The shape that the value of a key must have. Displays as `a table with …`, `one of …` or `a number`.
pub(super) enum ValueShape {
    /// With the keys that it may have.
    Table(Vec<String>),
    /// A table whose `kind`, one of these, says which other keys it has.
    TableOfAKind(Vec<String>),
    List {
        min_entries: usize,
        max_entries: Option<usize>,
    },
    OneOf(Vec<String>),
    Text,
    Character {
        ascii: bool,
    },
    Truth,
    WholeNumber,
    Number,
}

impl fmt::Display for ValueShape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let type_name = match self {
            Self::TableOfAKind(kinds) => {
                return write!(f, "a table whose `kind` is one of {}", listed(kinds));
            }
            Self::OneOf(words) => return write!(f, "one of {}", listed(words)),
            Self::Character { ascii: true } => return write!(f, "a text of one ASCII character"),
            Self::Character { ascii: false } => return write!(f, "a text of one character"),
            Self::Table(_) => "object",
            Self::List { .. } => "array",
            Self::Text => "string",
            Self::Truth => "boolean",
            Self::WholeNumber => "integer",
            Self::Number => "number",
        };
        write!(f, "{}", type_in_words(Some(type_name)))?;
        match self {
            Self::Table(keys) => write!(f, " with {}", listed(keys)),
            Self::List { min_entries: min, max_entries: Some(max) } if min == max => write!(f, " of {}", entries(*min)),
            Self::List { min_entries: min, max_entries: Some(max) } => write!(f, " of {min} to {}", entries(*max)),
            Self::List { min_entries: min @ 1.., max_entries: None } => write!(f, " of at least {}", entries(*min)),
            _ => Ok(()),
        }
    }
}

fn entries(count: usize) -> String {
    if count == 1 { "1 entry".into() } else { format!("{count} entries") }
}

/// The form of the table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct TableForm {
    /// Lines before the header, which are not read: a title, the name of a logger.
    pub skip_rows: usize,
    /// The separator of fields: an ASCII character other than the decimal sign.
    #[schemars(extend("x-ascii" = true))]
    pub separator: char,
    /// The decimal sign.
    pub decimal: DecimalSign,
    /// Texts that stand for "no value", such as `NA`; an empty field always does.
    pub missing: Vec<String>,
    /// The unit of all temperatures.
    pub temperature_unit: TemperatureUnit,
}

impl Default for TableForm {
    fn default() -> Self {
        Self {
            skip_rows: 0,
            separator: ',',
            decimal: DecimalSign::Point,
            missing: Vec::new(),
            temperature_unit: TemperatureUnit::Celsius,
        }
    }
}

/// The decimal sign of numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum DecimalSign {
    /// `21.5`.
    #[serde(rename = ".")]
    Point,
    /// `21,5`.
    #[serde(rename = ",")]
    Comma,
}

impl DecimalSign {
    /// The character of the sign.
    pub fn character(self) -> char {
        match self {
            Self::Point => '.',
            Self::Comma => ',',
        }
    }
}
