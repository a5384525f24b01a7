//! Forms of roads that other crates provide.

use std::fmt;

use interplay_planners::road::network::Lane;

use super::fault::RoadFault;

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
