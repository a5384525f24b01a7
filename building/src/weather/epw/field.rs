//! The columns that are read, each with its marks for missing values and its range of possible values (EnergyPlus,
//! *Auxiliary Programs*, EPW data dictionary).

/// A column of an EPW file that a run can use.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Field {
    /// Dry-bulb temperature at the end of the interval \[°C\].
    DryBulb,
    /// Global radiation on a horizontal plane during the interval \[Wh/m²\].
    GlobalHorizontal,
    /// Direct radiation on a plane towards the sun during the interval \[Wh/m²\].
    DirectNormal,
    /// Diffuse radiation on a horizontal plane during the interval \[Wh/m²\].
    DiffuseHorizontal,
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
}

const fn specification(field: Field, column: usize, missing: f64, least: f64, greatest: f64) -> Specification {
    Specification { field, column, missing, least, greatest }
}

/// All fields, in the order of [`Field`].
pub(super) const FIELDS: [Specification; 4] = [
    specification(Field::DryBulb, 6, 99.9, -70.0, 70.0),
    specification(Field::GlobalHorizontal, 13, 9999.0, 0.0, 9999.0),
    specification(Field::DirectNormal, 14, 9999.0, 0.0, 9999.0),
    specification(Field::DiffuseHorizontal, 15, 9999.0, 0.0, 9999.0),
];

/// Columns that a row must have at least.
pub(super) const COLUMNS: usize = 23;

impl Field {
    /// The column's name.
    pub fn name(self) -> &'static str {
        match self {
            Self::DryBulb => "dry-bulb temperature",
            Self::GlobalHorizontal => "global horizontal radiation",
            Self::DirectNormal => "direct normal radiation",
            Self::DiffuseHorizontal => "diffuse horizontal radiation",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn specifications_of_epw_fields_are_in_the_order_of_the_fields() {
        assert!(FIELDS.iter().enumerate().all(|(i, specification)| specification.field as usize == i));
        assert!(FIELDS.iter().all(|specification| specification.column < COLUMNS));
    }
}
