//! Settings that are out of range, and the keys that they have in a file.

use std::fmt;
use std::ops::RangeInclusive;

/// The key of a setting, relative to the table that is being read: names of nested tables and numbers of list entries
/// (from zero) are joined by dots, as in `feedback.integral_kw_per_k_h` or `occupied_c.2`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SettingKey(String);

impl SettingKey {
    /// The key as text.
    pub fn as_str(&self) -> &str {
        &self.0
    }

    /// The key of entry `index` of the list that has this key.
    pub fn entry(self, index: usize) -> Self {
        Self(format!("{}.{index}", self.0))
    }
}

impl From<&str> for SettingKey {
    fn from(key: &str) -> Self {
        Self(key.to_owned())
    }
}

impl fmt::Display for SettingKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// A setting that is out of range.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("`{key}` is {value}; it must be {wanted}")]
pub struct SettingError {
    /// The setting.
    pub key: SettingKey,
    /// Its value.
    pub value: f64,
    /// The values that are allowed, in words.
    pub wanted: &'static str,
}

impl SettingError {
    /// The same error, where the settings are the nested table `table` of the one that is being read.
    pub fn within(self, table: &str) -> Self {
        Self { key: SettingKey(format!("{table}.{}", self.key)), ..self }
    }
}

/// Refuses a setting outside an interval; a NaN lies in none.
pub(crate) fn check_within(
    key: impl Into<SettingKey>,
    value: f64,
    interval: RangeInclusive<f64>,
    wanted: &'static str,
) -> Result<(), SettingError> {
    if interval.contains(&value) { Ok(()) } else { Err(SettingError { key: key.into(), value, wanted }) }
}

/// Refuses settings that are negative or not finite.
pub(crate) fn check_not_negative(settings: &[(&str, f64)]) -> Result<(), SettingError> {
    settings.iter().try_for_each(|&(key, value)| check_within(key, value, 0.0..=f64::MAX, "a number, at least 0"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_of_nested_tables_and_of_lists_are_joined_by_dots() {
        let error = check_not_negative(&[("right", 0.0), ("wrong", -1.0)]).expect_err("it is negative");
        assert_eq!(error.to_string(), "`wrong` is -1; it must be a number, at least 0");
        assert_eq!(error.within("inner").within("outer").key.as_str(), "outer.inner.wrong");
        assert_eq!(SettingKey::from("list").entry(2).as_str(), "list.2");
    }

    #[test]
    fn what_is_not_a_finite_number_is_refused() {
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert!(check_not_negative(&[("value", value)]).is_err(), "{value}");
            assert!(check_within("value", value, 0.0..=1.0, "a share").is_err(), "{value}");
        }
    }
}
