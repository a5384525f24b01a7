//! Kinds of drivers, controllers or roads from other crates: the schema of their settings, and how the settings are read.

use std::fmt;
use std::sync::Arc;

use interplay_common::foreign::ForeignSettings;
use schemars::{JsonSchema, SchemaGenerator};
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Error, Map, Value as Json, json};

/// A kind that another crate provides; `Kind` is the trait of its settings.
pub(crate) struct ForeignKind<Kind: ?Sized> {
    /// Its word in a scenario file.
    pub kind: &'static str,
    /// Its version, which distinguishes its results from those of earlier ones.
    pub version: &'static str,
    /// The kind with the defaults of its settings.
    pub plain: Arc<Kind>,
    /// The schema of its settings; definitions that it refers to are left to the generator.
    settings: fn(&mut SchemaGenerator) -> Json,
    read: ReadSettings<Kind>,
}

type ReadSettings<Kind> = Arc<dyn Fn(Json) -> Result<ForeignSettings<Kind>, Error> + Send + Sync>;

impl<Kind: ?Sized + 'static> ForeignKind<Kind> {
    /// The kind with settings `S`: `share` makes them usable by their trait, and `about` returns the kind's word and version.
    pub fn of<S>(share: fn(S) -> Arc<Kind>, about: fn(&Kind) -> [&'static str; 2]) -> ForeignKind<Kind>
    where
        S: Default + Serialize + DeserializeOwned + JsonSchema + 'static,
    {
        let plain = share(S::default());
        let [kind, version] = about(&plain);
        let read = move |table| ForeignSettings::new(kind, serde_json::from_value::<S>(table)?, share);
        let settings = |generator: &mut SchemaGenerator| S::json_schema(generator).to_value();
        ForeignKind { kind, version, plain, settings, read: Arc::new(read) }
    }

    /// The schema of a table of this kind: its settings beside a `kind`.
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

    /// The settings that a table of a scenario file describes; its `kind` is known to be this one.
    pub fn settings(&self, mut table: Map<String, Json>) -> Result<ForeignSettings<Kind>, Error> {
        table.remove("kind");
        (self.read)(Json::Object(table))
    }
}

impl<Kind: ?Sized> Clone for ForeignKind<Kind> {
    fn clone(&self) -> Self {
        ForeignKind { plain: Arc::clone(&self.plain), read: Arc::clone(&self.read), ..*self }
    }
}

impl<Kind: ?Sized> fmt::Debug for ForeignKind<Kind> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("ForeignKind").field("kind", &self.kind).field("version", &self.version).finish()
    }
}
