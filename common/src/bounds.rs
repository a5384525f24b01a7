//! Bounds of settings. A bound is stated on the field, as a `schemars` attribute, and nowhere else.

use std::fmt;

use serde_json::Value as Json;

/// The largest magnitude of a setting: beyond it, squares and products of what is computed could overflow.
pub(crate) const LARGEST_SETTING: f64 = 1e9;

/// A bound of a number, as the JSON Schema of a setting states it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bound {
    /// The number is neither infinite nor NaN.
    Finite,
    /// The magnitude is at most this.
    Magnitude(f64),
    /// The number is at least this: `minimum` of the schema.
    AtLeast(f64),
    /// The number is above this: `exclusiveMinimum` of the schema.
    Above(f64),
    /// The number is at most this: `maximum` of the schema.
    AtMost(f64),
    /// The number is below this: `exclusiveMaximum` of the schema.
    Below(f64),
    /// The number is not this: `not = { const = … }` of the schema.
    OtherThan(f64),
}

impl Bound {
    /// Whether a number satisfies the bound.
    pub fn admits(self, value: f64) -> bool {
        match self {
            Self::Finite => value.is_finite(),
            Self::Magnitude(largest) => value.abs() <= largest,
            Self::AtLeast(bound) => value >= bound,
            Self::Above(bound) => value > bound,
            Self::AtMost(bound) => value <= bound,
            Self::Below(bound) => value < bound,
            Self::OtherThan(bound) => value != bound,
        }
    }

    /// The bounds that the schema of a number states.
    pub fn read(schema: &Json) -> impl Iterator<Item = Bound> {
        let bound = |keyword: &str| schema.get(keyword).and_then(Json::as_f64);
        let stated = [
            bound("minimum").map(Self::AtLeast),
            bound("exclusiveMinimum").map(Self::Above),
            bound("maximum").map(Self::AtMost),
            bound("exclusiveMaximum").map(Self::Below),
            schema["not"]["const"].as_f64().map(Self::OtherThan),
        ];
        stated.into_iter().flatten()
    }

    /// The bounds of every setting.
    pub fn of_every_setting() -> [Bound; 2] {
        [Self::Finite, Self::Magnitude(LARGEST_SETTING)]
    }
}

impl fmt::Display for Bound {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Finite => write!(f, "a finite number"),
            Self::Magnitude(largest) => write!(f, "between -{largest:e} and {largest:e}"),
            Self::AtLeast(bound) => write!(f, "at least {bound}"),
            Self::Above(bound) => write!(f, "above {bound}"),
            Self::AtMost(bound) => write!(f, "at most {bound}"),
            Self::Below(bound) => write!(f, "below {bound}"),
            Self::OtherThan(bound) => write!(f, "other than {bound}"),
        }
    }
}
