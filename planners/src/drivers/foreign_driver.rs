//! A driver of a kind that another crate provides.

use std::sync::Arc;

use serde::{Serialize, Serializer};
use serde_json::{Error, Map, Value as Json};

use crate::drivers::drive::DriverKind;

/// The settings of a driver whose kind another crate provides.
#[derive(Clone, Debug)]
pub struct ForeignDriver {
    settings: Arc<dyn DriverKind>,
    /// The same as a table of a scenario file, its `kind` included.
    table: Map<String, Json>,
}

impl ForeignDriver {
    /// A driver with these settings.
    ///
    /// # Errors
    /// If the settings cannot be written as JSON.
    pub fn new(settings: impl DriverKind + Serialize + 'static) -> Result<ForeignDriver, Error> {
        let mut table = Map::from_iter([("kind".to_owned(), settings.kind().into())]);
        if let Json::Object(stated) = serde_json::to_value(&settings)? {
            table.extend(stated);
        }
        Ok(ForeignDriver { settings: Arc::new(settings), table })
    }

    /// The settings.
    pub fn settings(&self) -> &(dyn DriverKind + 'static) {
        &*self.settings
    }
}

/// Two drivers are the same if their tables in a scenario file are.
impl PartialEq for ForeignDriver {
    fn eq(&self, other: &Self) -> bool {
        self.table == other.table
    }
}

impl Serialize for ForeignDriver {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.table.serialize(serializer)
    }
}
