//! The columns that are read, with what marks a value as missing and what is possible (EnergyPlus, *Auxiliary Programs*,
//! EPW data dictionary).

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

/// How gaps are filled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fill {
    /// Linearly between the values around the gap.
    Linear,
    /// With the value before, where the mean of two values means nothing.
    Previous,
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

impl Fill {
    /// Replaces what is not a number. Returns how many values were replaced, or `None` if there is nothing to go by.
    pub(super) fn apply(self, values: &mut [f64]) -> Option<usize> {
        let first = values.iter().position(|value| !value.is_nan())?;
        let (mut before, mut filled) = (first, first);
        for i in 0..first {
            values[i] = values[first];
        }
        while let Some(gap) = values[before..].iter().position(|value| value.is_nan()).map(|i| before + i) {
            let end = values[gap..].iter().position(|value| !value.is_nan()).map_or(values.len(), |i| gap + i);
            let from = values[gap - 1];
            let to = if self == Self::Linear && end < values.len() { values[end] } else { from };
            let width = (end - gap + 1) as f64;
            for i in gap..end {
                values[i] = from + (to - from) * (i - gap + 1) as f64 / width;
            }
            filled += end - gap;
            before = end - 1;
        }
        Some(filled)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gaps_are_bridged() {
        const NONE: f64 = f64::NAN;
        let mut values = [NONE, 1.0, NONE, NONE, 4.0, 5.0, NONE, 9.0, NONE];
        assert_eq!(Fill::Linear.apply(&mut values), Some(5));
        assert_eq!(values, [1.0, 1.0, 2.0, 3.0, 4.0, 5.0, 7.0, 9.0, 9.0]);
        let mut values = [350.0, NONE, 10.0];
        assert_eq!(Fill::Previous.apply(&mut values), Some(1));
        assert_eq!(values, [350.0, 350.0, 10.0]);
        assert_eq!(Fill::Linear.apply(&mut [NONE, NONE]), None);
        assert_eq!(Fill::Linear.apply(&mut [2.0]), Some(0));
    }

    #[test]
    fn the_table_is_in_the_order_of_the_fields() {
        assert!(FIELDS.iter().enumerate().all(|(i, specification)| specification.field as usize == i));
        assert!(FIELDS.iter().all(|specification| specification.column < COLUMNS));
    }
}
