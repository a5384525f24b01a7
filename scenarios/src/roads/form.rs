//! Forms of roads that other crates provide.

use std::fmt;

use interplay_planners::road::network::Lane;

use super::fault::RoadFault;

/// A form of road: a table with a few numbers, of which it makes the lanes of a network. The schema of its settings says what a file may
/// state; a key `lane_width_m` with a default also tells the size of the road.
pub trait RoadForm: fmt::Debug + Send + Sync {
    /// The word for this form in a scenario file: small letters, digits and hyphens.
    fn kind(&self) -> &'static str;

    /// What tells the results of this form from those of its earlier versions, such as `env!("CARGO_PKG_VERSION")`.
    fn version(&self) -> &'static str {
        ""
    }

    /// The lanes of the network.
    ///
    /// # Errors
    /// [`RoadFault`] for numbers of which no lanes can be made.
    fn lanes(&self) -> Result<Vec<Lane>, RoadFault>;

    /// Width of one lane; where lanes differ, of the first of them where it begins \[m\].
    fn lane_width_m(&self) -> f64;
}
