//! The road users that a lane is reserved for.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A kind of road user, for whom a lane may be kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum LaneUser {
    /// Cars and vans.
    Car,
    /// Buses.
    Bus,
    /// Lorries.
    Truck,
    /// Bicycles.
    Bicycle,
    /// People on foot.
    Pedestrian,
}
