//! What keeps a table from being a road.

/// What is wrong with a road, and where it is written.
#[derive(Clone, Debug, PartialEq)]
pub struct RoadFault {
    /// The path of the key below `road`; empty for the whole table.
    pub path: String,
    /// What stands beside the underlined text.
    pub label: String,
    /// What is wrong.
    pub message: String,
    /// What would work.
    pub help: String,
}

impl RoadFault {
    /// A fault of a key below `road`, without help.
    pub fn new(path: impl Into<String>, label: &str, message: String) -> RoadFault {
        RoadFault { path: path.into(), label: label.to_owned(), message, help: String::new() }
    }

    /// With what would work.
    pub fn help(self, help: impl Into<String>) -> RoadFault {
        RoadFault { help: help.into(), ..self }
    }
}

/// A length to the centimetre.
pub(crate) fn to_centimetres(length_m: f64) -> f64 {
    (100.0 * length_m).round() / 100.0
}
