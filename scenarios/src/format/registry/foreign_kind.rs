//! Kinds of drivers of other crates: how their settings are described and read.

use interplay_planners::{Driver, DriverKind, ForeignDriver};
use schemars::{JsonSchema, SchemaGenerator};
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Error, Map, Value as Json, json};

/// A kind of driver that another crate provides.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ForeignKind {
    /// Its word in a scenario file.
    pub kind: &'static str,
    /// What tells its results from those of earlier versions.
    pub version: &'static str,
    /// The schema of its settings; definitions that it refers to are left to the generator.
    settings: fn(&mut SchemaGenerator) -> Json,
    read: fn(Json) -> Result<ForeignDriver, Error>,
}

impl ForeignKind {
    /// The kind with these settings.
    pub fn of<S>() -> ForeignKind
    where
        S: DriverKind + Default + Serialize + DeserializeOwned + JsonSchema + 'static,
    {
        let (kind, version) = (S::default().kind(), S::default().version());
        let read = |table| ForeignDriver::new(serde_json::from_value::<S>(table)?);
        ForeignKind { kind, version, settings: |generator| S::json_schema(generator).to_value(), read }
    }

    /// The schema of a driver of this kind: its settings beside a `kind`.
    pub fn schema(&self, generator: &mut SchemaGenerator) -> Json {
        let settings = (self.settings)(generator);
        let kind = json!({ "type": "string", "const": self.kind });
        let mut properties = Map::from_iter([("kind".to_owned(), kind)]);
        properties.extend(settings["properties"].as_object().cloned().unwrap_or_default());
        json!({
            "type": "object",
            "properties": properties,
            "required": ["kind"],
            "description": settings["description"],
        })
    }

    /// The driver that a table of a scenario file describes; its `kind` is known to be this one.
    pub fn driver(&self, mut table: Map<String, Json>) -> Result<Driver, Error> {
        table.remove("kind");
        (self.read)(Json::Object(table)).map(Driver::Foreign)
    }
}
