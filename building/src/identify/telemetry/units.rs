//! The units that a table may use, converted to the units of this crate.

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
