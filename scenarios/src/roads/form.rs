//! Forms of roads that other crates provide.

use std::fmt;

use interplay_planners::road::network::Lane;

/// A form of road: a table with a few numbers that determine the lanes of a network. The schema of its settings lists its
/// keys; a key `lane_width_m` with a default also determines the size of the road.
pub trait RoadForm: fmt::Debug + Send + Sync {
    /// The word for this form in a scenario file: small letters, digits and hyphens.
    fn kind(&self) -> &'static str;

    /// The version that distinguishes the results of this form from earlier ones, such as `env!("CARGO_PKG_VERSION")`.
    fn version(&self) -> &'static str {
        ""
    }

    /// The lanes of the network.
    ///
    /// # Errors
    /// [`RoadFault`] for numbers that do not determine valid lanes.
    fn lanes(&self) -> Result<Vec<Lane>, RoadFault>;

    /// Width of one lane; where lanes differ, of the first of them where it begins \[m\].
    fn lane_width_m(&self) -> f64;
}

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

pub(crate) fn to_centimetres(length_m: f64) -> f64 {
    (100.0 * length_m).round() / 100.0
}
