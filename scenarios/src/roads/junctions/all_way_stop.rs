//! Two roads that cross at an all-way stop.

use interplay_planners::road::network::{Lane, RightOfWay};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::super::form::RoadFault;
use super::arms::{Arm, Arms, Compass};

/// Two roads with a lane in each direction that cross at the origin. All vehicles stop, and go in the order of arrival. Lanes
/// are called `west-in`, `west-out` and so on, connectors `west-to-north`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct AllWayStop {
    /// How far the arms reach from the middle of the crossing \[m\].
    #[schemars(range(min = 0.001, max = 5000.0))]
    pub arm_length_m: f64,
    /// Width of each lane \[m\].
    #[schemars(range(min = 0.001, max = 40.0))]
    pub lane_width_m: f64,
    /// Highest permitted speed on the arms; in turns it is at most the speed with a sideways acceleration of 2 m/s² \[m/s\].
    #[schemars(range(min = 0.001))]
    pub speed_limit_mps: f64,
    /// Smallest radius of turns to the right, in the middle of the lane \[m\].
    #[schemars(range(min = 0.001, max = 1000.0))]
    pub turn_radius_m: f64,
}

impl Default for AllWayStop {
    fn default() -> Self {
        AllWayStop { arm_length_m: 100.0, lane_width_m: 3.5, speed_limit_mps: 13.9, turn_radius_m: 8.0 }
    }
}

impl AllWayStop {
    /// The lanes of both roads and of the crossing.
    ///
    /// # Errors
    /// For sizes that leave no room for the lanes.
    pub(crate) fn lanes(&self) -> Result<Vec<Lane>, RoadFault> {
        let arms = [Compass::East, Compass::North, Compass::West, Compass::South]
            .map(|compass| Arm::new(compass, RightOfWay::AllWayStop));
        let AllWayStop { arm_length_m, lane_width_m, speed_limit_mps, turn_radius_m } = *self;
        Arms { arms: &arms, arm_length_m, lane_width_m, speed_limit_mps, turn_radius_m }.lanes()
    }
}
