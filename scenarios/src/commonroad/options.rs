//! Options of an import.

/// Options of an import.
#[derive(Clone, Debug, Default)]
pub struct ImportOptions {
    /// The kind of driver of the ego; a nice human without one.
    pub ego: Option<String>,
    /// Drivers that take the place of records.
    pub replace: Vec<Replacement>,
}

/// A driver that takes the place of a record.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Replacement {
    /// The id or the name of the vehicle; all vehicles without one.
    pub vehicle: Option<String>,
    /// The kind of the driver.
    pub kind: String,
    /// Its style, of a human.
    pub style: Option<String>,
}
