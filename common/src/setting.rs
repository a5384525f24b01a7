//! Checks that settings are within their ranges, and names their keys in a file.
//!
//! The bound of a setting is stated on its field, as a `schemars` attribute; [`check`] reads it from there.
//!
//! ```
//! use interplay_common::setting::check;
//!
//! #[derive(serde::Serialize, schemars::JsonSchema)]
//! struct Heater {
//!     #[schemars(range(min = 0.0, max = 5.0))]
//!     limit_kw: f64,
//! }
//!
//! assert!(check(&Heater { limit_kw: 2.0 }).is_ok());
//! let error = check(&Heater { limit_kw: -2.0 }).expect_err("negative");
//! assert_eq!(error.to_string(), "`limit_kw` is -2; it must be at least 0");
//! ```

use std::fmt;

use schemars::{JsonSchema, SchemaGenerator};
use serde::Serialize;
use serde_json::Value as Json;
use toml::Value as Toml;

use crate::bounds::Bound;
use crate::json_schema::{definition_of, kind_of};

/// The key of a setting, relative to the table that is being read: names of nested tables and numbers of list entries
/// (from zero) are joined by dots, as in `feedback.integral_kw_per_k_h` or `occupied_c.2`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SettingKey(String);

impl SettingKey {
    /// The key as text.
    pub fn as_str(&self) -> &str {
        &self.0
    }

    /// The key of entry `index` of the list that has this key.
    #[must_use]
    pub fn entry(&self, index: usize) -> Self {
        self.key(&index.to_string())
    }

    /// The key `name` in the table that has this key.
    #[must_use]
    pub fn key(&self, name: &str) -> Self {
        if self.0.is_empty() { name.into() } else { Self(format!("{}.{name}", self.0)) }
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
#[error("`{key}` is {value}; it must be {bound}")]
pub struct SettingError {
    /// Key of the setting.
    pub key: SettingKey,
    /// Value of the setting.
    pub value: f64,
    /// The bound that the value breaks.
    pub bound: Bound,
}

/// Checks settings against the bounds of their fields. Every number must also be finite, and not huge.
///
/// # Errors
/// [`SettingError`] for the first number that breaks a bound, in the order of the fields.
///
/// # Panics
/// When the settings are not plain data: tables, lists, texts and numbers.
pub fn check<T: Serialize + JsonSchema>(settings: &T) -> Result<(), SettingError> {
    check_each(std::slice::from_ref(settings)).map_err(|(_, error)| error)
}

/// As [`check`], for each of several tables.
///
/// # Errors
/// The number of the first table with a setting out of range, from zero, and its error.
///
/// # Panics
/// As [`check`].
pub fn check_each<T: Serialize + JsonSchema>(tables: &[T]) -> Result<(), (usize, SettingError)> {
    let root = SchemaGenerator::default().into_root_schema_for::<T>().to_value();
    tables.iter().enumerate().try_for_each(|(index, table)| {
        let value = Toml::try_from(table).expect("settings are plain data");
        check_value(&root, &root, &value, &SettingKey::default()).map_err(|error| (index, error))
    })
}

/// Checks a setting against a bound that depends on other settings.
pub fn check_bound(key: &str, value: f64, bound: Bound) -> Result<(), SettingError> {
    if bound.admits(value) { Ok(()) } else { Err(SettingError { key: key.into(), value, bound }) }
}

fn check_value(root: &Json, schema: &Json, value: &Toml, key: &SettingKey) -> Result<(), SettingError> {
    let schema = description_of(root, schema, value);
    let number = |value: f64| {
        let mut bounds = Bound::of_every_setting().into_iter().chain(Bound::read(schema));
        let broken = bounds.find(|bound| !bound.admits(value));
        broken.map_or(Ok(()), |bound| Err(SettingError { key: key.clone(), value, bound }))
    };
    match value {
        Toml::Float(float) => number(*float),
        Toml::Integer(integer) => number(*integer as f64),
        Toml::Array(entries) => {
            let mut entries = entries.iter().enumerate();
            entries.try_for_each(|(index, entry)| check_value(root, &schema["items"], entry, &key.entry(index)))
        }
        Toml::Table(table) => {
            let properties = schema["properties"].as_object().into_iter().flatten();
            let mut stated = properties.filter_map(|(name, schema)| Some((name, schema, table.get(name)?)));
            stated.try_for_each(|(name, schema, value)| check_value(root, schema, value, &key.key(name)))
        }
        Toml::String(_) | Toml::Boolean(_) | Toml::Datetime(_) => Ok(()),
    }
}

/// The part of a schema that describes a value: without `$ref`, and of several kinds of table the one that it is.
fn description_of<'a>(root: &'a Json, schema: &'a Json, value: &Toml) -> &'a Json {
    let schema = definition_of(root, schema);
    let alternatives = ["oneOf", "anyOf"].iter().filter_map(|keyword| schema[*keyword].as_array()).flatten();
    let kind = value.get("kind").and_then(Toml::as_str);
    let mut fitting = alternatives.filter(|one| {
        let wanted = kind_of(one);
        one["type"] != "null" && (wanted.is_none() || wanted == kind)
    });
    fitting.next().map_or(schema, |alternative| description_of(root, alternative, value))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Serialize, JsonSchema)]
    struct Outer {
        #[schemars(range(min = 1))]
        count: usize,
        inner: Option<Inner>,
    }

    #[derive(Serialize, JsonSchema)]
    #[serde(tag = "kind", rename_all = "kebab-case")]
    enum Inner {
        Plain(Shares),
        Listed(Temperatures),
    }

    #[derive(Serialize, JsonSchema)]
    struct Shares {
        #[schemars(extend("exclusiveMinimum" = 0.0), range(max = 1.0))]
        share: f64,
    }

    #[derive(Serialize, JsonSchema)]
    struct Temperatures {
        #[schemars(inner(range(max = 100.0)))]
        wanted_c: Vec<f64>,
        other_c: Option<f64>,
    }

    fn refused(count: usize, inner: Inner) -> String {
        check(&Outer { count, inner: Some(inner) }).expect_err("out of range").to_string()
    }

    #[test]
    fn bounds_are_checked_in_nested_tables_and_lists() {
        assert_eq!(check(&Outer { count: 1, inner: None }), Ok(()));
        assert_eq!(check(&Outer { count: 1, inner: Some(Inner::Plain(Shares { share: 1.0 })) }), Ok(()));
        assert_eq!(refused(0, Inner::Plain(Shares { share: 1.0 })), "`count` is 0; it must be at least 1");
        assert_eq!(refused(1, Inner::Plain(Shares { share: 0.0 })), "`inner.share` is 0; it must be above 0");
        assert_eq!(refused(1, Inner::Plain(Shares { share: 1.1 })), "`inner.share` is 1.1; it must be at most 1");
        let warm = Temperatures { wanted_c: vec![20.0, 297.0], other_c: None };
        assert_eq!(refused(1, Inner::Listed(warm)), "`inner.wanted_c.1` is 297; it must be at most 100");
    }

    #[test]
    fn numbers_that_are_not_finite_are_refused() {
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let message = refused(1, Inner::Plain(Shares { share: value }));
            assert!(message.ends_with("it must be a finite number"), "{message}");
            let other = Temperatures { wanted_c: Vec::new(), other_c: Some(value) };
            assert!(refused(1, Inner::Listed(other)).starts_with("`inner.other_c`"));
        }
        let huge = Temperatures { wanted_c: Vec::new(), other_c: Some(-1e10) };
        assert!(refused(1, Inner::Listed(huge)).ends_with("it must be between -1e9 and 1e9"));
    }
}
