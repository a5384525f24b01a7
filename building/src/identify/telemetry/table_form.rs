//! The form of a table: its separators, and the meaning of its texts.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::units::TemperatureUnit;

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
