//! Settings of kinds of drivers, controllers and roads that another crate provides, read from and written to tables of a scenario file.

use std::fmt;
use std::sync::Arc;

use serde::{Serialize, Serializer};
use serde_json::{Error, Map, Value as Json};

/// The settings of a kind of driver, controller or road that another crate provides; `Kind` is the trait through which they are used.
pub struct ForeignSettings<Kind: ?Sized> {
    settings: Arc<Kind>,
    /// The same as a table of a scenario file, its `kind` included.
    table: Map<String, Json>,
}

impl<Kind: ?Sized> ForeignSettings<Kind> {
    /// The settings of the kind that a scenario file calls `kind`; `share` makes them usable by their trait.
    ///
    /// # Errors
    /// If the settings cannot be written as JSON.
    pub fn new<S: Serialize>(kind: &str, settings: S, share: impl FnOnce(S) -> Arc<Kind>) -> Result<Self, Error> {
        let mut table = Map::from_iter([("kind".to_owned(), kind.into())]);
        if let Json::Object(stated) = serde_json::to_value(&settings)? {
            table.extend(stated);
        }
        Ok(ForeignSettings { settings: share(settings), table })
    }

    /// The settings.
    pub fn settings(&self) -> &Kind {
        &self.settings
    }
}

impl<Kind: ?Sized> Clone for ForeignSettings<Kind> {
    fn clone(&self) -> Self {
        ForeignSettings { settings: Arc::clone(&self.settings), table: self.table.clone() }
    }
}

impl<Kind: ?Sized> fmt::Debug for ForeignSettings<Kind> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_tuple("ForeignSettings").field(&self.table).finish()
    }
}

/// Two settings are the same if their tables in a scenario file are.
impl<Kind: ?Sized> PartialEq for ForeignSettings<Kind> {
    fn eq(&self, other: &Self) -> bool {
        self.table == other.table
    }
}

impl<Kind: ?Sized> Serialize for ForeignSettings<Kind> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.table.serialize(serializer)
    }
}

/// A table of a scenario file that states a `kind` together with its settings.
#[derive(Serialize)]
pub struct KindTable<'a, Settings> {
    /// The word for the kind.
    pub kind: &'a str,
    /// The settings.
    #[serde(flatten)]
    pub settings: &'a Settings,
}
