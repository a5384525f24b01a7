//! An identified network as zones and walls that a scenario can hold.

use crate::network::{Wall, Zone};

/// An identified network with its uncertainty.
#[derive(Debug, Clone, PartialEq)]
pub struct IdentifiedNetwork {
    /// The zones, as estimated; the limits are the largest heat that was measured.
    pub zones: Vec<Zone>,
    /// The walls, as estimated; the first boundary, and any other, is the air outside.
    pub walls: Vec<Wall>,
    /// The uncertainty of the estimates.
    pub uncertainty: NetworkUncertainty,
    /// Mean temperature of the zones and of the first boundary over the record \[°C\].
    pub mean_c: (f64, Option<f64>),
    /// Remarks that a reader must know before using the network.
    pub remarks: Vec<String>,
}

/// Ends of 95 % intervals as multiples of the estimates; of several zones or walls the widest one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NetworkUncertainty {
    /// Interval of heat capacities.
    pub capacity: (f64, f64),
    /// Interval of resistances between zones.
    pub inner_resistance: (f64, f64),
    /// Interval of resistances to the air outside.
    pub outer_resistance: (f64, f64),
}
