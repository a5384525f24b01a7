//! Reasons why a table is not a valid road.

/// A fault of a road, and its place.
#[derive(Clone, Debug, PartialEq)]
pub struct RoadFault {
    /// The path of the key below `road`; empty for the whole table.
    pub path: String,
    /// The label of the underlined text.
    pub label: String,
    /// The problem.
    pub message: String,
    /// What would work.
    pub help: String,
}

impl RoadFault {
    /// A fault of a key below `road`, without help.
    pub fn new(path: impl Into<String>, label: &str, message: String) -> RoadFault {
        RoadFault { path: path.into(), label: label.to_owned(), message, help: String::new() }
    }

    /// The same fault with a help text.
    pub fn help(self, help: impl Into<String>) -> RoadFault {
        RoadFault { help: help.into(), ..self }
    }
}

/// A length to the centimetre.
pub(crate) fn to_centimetres(length_m: f64) -> f64 {
    (100.0 * length_m).round() / 100.0
}
