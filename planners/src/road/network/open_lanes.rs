//! The parts of a network that are open to some users.

use super::lane::Lane;
use super::lane_user::LaneUser;
use super::road_network::RoadNetwork;

impl RoadNetwork {
    /// Whether a lane is reserved for some road users.
    pub fn has_restricted_lanes(&self) -> bool {
        self.lanes().iter().any(|lane| !lane.users.is_empty())
    }

    /// The network without the lanes that are closed to this road user.
    pub fn open_to(&self, user: LaneUser) -> RoadNetwork {
        self.with_lanes(|lane| lane.is_open_to(user))
    }

    /// The network with only the lanes that `is_kept` selects.
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
