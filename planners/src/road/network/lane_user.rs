//! For whom a lane is.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::lane::Lane;
use super::road_network::RoadNetwork;

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

impl RoadNetwork {
    /// Whether a lane is kept for some users.
    pub fn has_restricted_lanes(&self) -> bool {
        self.lanes().iter().any(|lane| !lane.users.is_empty())
    }

    /// The network as far as it is open to some user: without lanes that are kept for others.
    pub fn open_to(&self, user: LaneUser) -> RoadNetwork {
        self.with_lanes(|lane| lane.is_open_to(user))
    }

    /// The network with some of its lanes only.
    pub fn with_lanes(&self, is_kept: impl Fn(&Lane) -> bool) -> RoadNetwork {
        let mut lanes: Vec<Lane> = self.lanes().iter().filter(|lane| is_kept(lane)).cloned().collect();
        let names: Vec<String> = lanes.iter().map(|lane| lane.name.clone()).collect();
        for lane in &mut lanes {
            lane.successors.retain(|name| names.contains(name));
            lane.left = lane.left.take().filter(|neighbour| names.contains(&neighbour.lane));
            lane.right = lane.right.take().filter(|neighbour| names.contains(&neighbour.lane));
        }
        RoadNetwork::unchecked(lanes)
    }
}
