//! The columns that are read, with what marks a value as missing and what is possible (EnergyPlus, *Auxiliary Programs*,
//! EPW data dictionary).

use crate::series::Fill;

/// A column of an EPW file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Field {
    /// Dry-bulb temperature at the end of the interval \[°C\].
    DryBulb,
    /// Dew-point temperature at the end of the interval \[°C\].
    DewPoint,
    /// Relative humidity at the end of the interval \[%\].
    RelativeHumidity,
    /// Air pressure at the station at the end of the interval \[Pa\].
    Pressure,
    /// Infrared radiation from the sky on a horizontal plane during the interval \[Wh/m²\].
    HorizontalInfrared,
    /// Global radiation on a horizontal plane during the interval \[Wh/m²\].
    GlobalHorizontal,
    /// Direct radiation on a plane towards the sun during the interval \[Wh/m²\].
    DirectNormal,
    /// Diffuse radiation on a horizontal plane during the interval \[Wh/m²\].
    DiffuseHorizontal,
    /// Where the wind comes from at the end of the interval, clockwise from north \[°\].
    WindDirection,
    /// Wind speed at the end of the interval \[m/s\].
    WindSpeed,
    /// Sky covered by clouds at the end of the interval \[tenths\].
    SkyCover,
}

/// What the data dictionary says about a field.
#[derive(Clone, Copy, Debug)]
pub(super) struct Specification {
    pub(super) field: Field,
    /// Position in a row, from zero.
    pub(super) column: usize,
    /// A value from here on stands for a missing one.
    pub(super) missing: f64,
    pub(super) least: f64,
    pub(super) greatest: f64,
    pub(super) fill: Fill,
}

const fn specification(field: Field, column: usize, missing: f64, least: f64, greatest: f64) -> Specification {
    Specification { field, column, missing, least, greatest, fill: Fill::Linear }
}

/// All fields, in the order of [`Field`].
pub(super) const FIELDS: [Specification; 11] = [
    specification(Field::DryBulb, 6, 99.9, -70.0, 70.0),
    specification(Field::DewPoint, 7, 99.9, -70.0, 70.0),
    specification(Field::RelativeHumidity, 8, 999.0, 0.0, 110.0),
    specification(Field::Pressure, 9, 999_999.0, 31_000.0, 120_000.0),
    specification(Field::HorizontalInfrared, 12, 9999.0, 0.0, 9999.0),
    specification(Field::GlobalHorizontal, 13, 9999.0, 0.0, 9999.0),
    specification(Field::DirectNormal, 14, 9999.0, 0.0, 9999.0),
    specification(Field::DiffuseHorizontal, 15, 9999.0, 0.0, 9999.0),
    Specification { fill: Fill::Previous, ..specification(Field::WindDirection, 20, 999.0, 0.0, 360.0) },
    specification(Field::WindSpeed, 21, 999.0, 0.0, 40.0),
    specification(Field::SkyCover, 22, 99.0, 0.0, 10.0),
];

/// Columns that a row must have at least.
pub(super) const COLUMNS: usize = 23;

impl Field {
    /// The column's name.
    pub fn name(self) -> &'static str {
        match self {
            Self::DryBulb => "dry-bulb temperature",
            Self::DewPoint => "dew-point temperature",
            Self::RelativeHumidity => "relative humidity",
            Self::Pressure => "air pressure",
            Self::HorizontalInfrared => "horizontal infrared radiation",
            Self::GlobalHorizontal => "global horizontal radiation",
            Self::DirectNormal => "direct normal radiation",
            Self::DiffuseHorizontal => "diffuse horizontal radiation",
            Self::WindDirection => "wind direction",
            Self::WindSpeed => "wind speed",
            Self::SkyCover => "total sky cover",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_in_the_order_of_the_fields() {
        assert!(FIELDS.iter().enumerate().all(|(i, specification)| specification.field as usize == i));
        assert!(FIELDS.iter().all(|specification| specification.column < COLUMNS));
    }
}
