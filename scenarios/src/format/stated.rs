//! A table of settings as a file states it.

use std::borrow::Cow;
use std::marker::PhantomData;

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Number, Value as Json};

/// A table of settings as a file states it, with only the stated keys.
///
/// `Settings` is the table completed by the defaults of the format, at the size of the scenario and of
/// the vehicle's class. A table that states two keys therefore differs from a whole value, which states them all:
///
/// ```
/// use interplay_planners::Limits;
/// use interplay_scenarios::Stated;
///
/// let slow: Stated<Limits> = Stated::default().with("speed_max_mps", 8.3);
/// let whole = Stated::from(Limits { speed_max_mps: 8.3, ..Limits::default() });
/// assert_ne!(slow, whole);
/// ```
#[derive(Debug, Serialize, Deserialize)]
#[serde(transparent, bound = "")]
pub struct Stated<Settings> {
    keys: Map<String, Json>,
    settings: PhantomData<fn() -> Settings>,
}

impl<Settings> Stated<Settings> {
    /// A table that states its `kind` and leaves all other keys at the defaults of that kind.
    pub fn kind(kind: &str) -> Self {
        Stated::default().with("kind", kind)
    }

    /// The table with this key and value added, or with the value of the key replaced.
    #[must_use]
    pub fn with(mut self, key: &str, value: impl Into<Json>) -> Self {
        self.keys.insert(key.to_owned(), value.into());
        self
    }

    /// The value of a key, if it is stated.
    pub fn get(&self, key: &str) -> Option<&Json> {
        self.keys.get(key)
    }

    /// Takes the value of a key out of the table, if it is stated.
    pub(crate) fn take(&mut self, key: &str) -> Option<Json> {
        self.keys.remove(key)
    }

    pub(crate) fn into_keys(self) -> Map<String, Json> {
        self.keys
    }

    /// The settings that the table describes, once all size-dependent defaults were added to it.
    pub(crate) fn settings(self) -> Result<Settings, serde_json::Error>
    where
        Settings: DeserializeOwned,
    {
        serde_json::from_value(Json::Object(self.keys))
    }
}

/// The table that states every setting.
impl<Settings: Serialize> From<Settings> for Stated<Settings> {
    fn from(settings: Settings) -> Self {
        let keys = match stated_by(&settings) {
            Json::Object(keys) => keys,
            _ => Map::new(),
        };
        Stated { keys, settings: PhantomData }
    }
}

impl<Settings> Default for Stated<Settings> {
    fn default() -> Self {
        Stated { keys: Map::new(), settings: PhantomData }
    }
}

impl<Settings> Clone for Stated<Settings> {
    fn clone(&self) -> Self {
        Stated { keys: self.keys.clone(), settings: PhantomData }
    }
}

impl<Settings> PartialEq for Stated<Settings> {
    fn eq(&self, other: &Self) -> bool {
        self.keys == other.keys
    }
}

impl<Settings: JsonSchema> JsonSchema for Stated<Settings> {
    fn inline_schema() -> bool {
        Settings::inline_schema()
    }

    fn schema_name() -> Cow<'static, str> {
        Settings::schema_name()
    }

    fn schema_id() -> Cow<'static, str> {
        Settings::schema_id()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        Settings::json_schema(generator)
    }
}

/// The table of a value: keys without a value are left out, and a number that is not finite becomes a text, which the check refuses by its
/// key. JSON has neither.
pub(crate) fn stated_by(value: &impl Serialize) -> Json {
    match toml::Value::try_from(value) {
        Ok(value) => from_toml(value),
        // The table contains a whole number that TOML cannot represent. Such a table has no values that JSON cannot represent.
        Err(_) => serde_json::to_value(value).unwrap_or_default(),
    }
}

fn from_toml(value: toml::Value) -> Json {
    match value {
        toml::Value::String(text) => Json::String(text),
        toml::Value::Integer(integer) => Json::from(integer),
        toml::Value::Float(number) => Number::from_f64(number).map_or_else(|| number.to_string().into(), Json::Number),
        toml::Value::Boolean(truth) => Json::Bool(truth),
        toml::Value::Datetime(date) => Json::String(date.to_string()),
        toml::Value::Array(items) => items.into_iter().map(from_toml).collect(),
        toml::Value::Table(table) => table.into_iter().map(|(key, value)| (key, from_toml(value))).collect(),
    }
}
