//! Two roads that cross, the main one with priority.

use interplay_planners::road::network::{Lane, RightOfWay};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::super::form::RoadFault;
use super::arms::{Arm, Arms, Compass, Median};
use super::t_junction::MinorRoadRule;

/// Two roads with a lane in each direction that cross at the origin; the main one runs from west to east. Lanes are called
/// `west-in`, `west-out` and so on, connectors `west-to-north`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Crossing {
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
    /// Whether the main road has a lane of its own for turns to the left, `west-in-1` and `east-in-1`; `west-in-0` and
    /// `east-in-0` then lead straight on and to the right.
    pub turning_lanes: bool,
    /// The sign on the minor road.
    pub minor: MinorRoadRule,
}

impl Default for Crossing {
    fn default() -> Self {
        Crossing {
            arm_length_m: 100.0,
            lane_width_m: 3.5,
            speed_limit_mps: 13.9,
            turn_radius_m: 8.0,
            turning_lanes: false,
            minor: MinorRoadRule::default(),
        }
    }
}

impl Crossing {
    /// The lanes of both roads and of the crossing.
    ///
    /// # Errors
    /// For sizes that leave no room for the lanes.
    pub(crate) fn lanes(&self) -> Result<Vec<Lane>, RoadFault> {
        let arm = |compass: Compass| match compass {
            Compass::East | Compass::West => {
                let median = if self.turning_lanes { Median::TurningLane } else { Median::None };
                Arm { median, ..Arm::new(compass, RightOfWay::Priority) }
            }
            Compass::North | Compass::South => Arm::new(compass, self.minor.into()),
        };
        let arms = [Compass::East, Compass::North, Compass::West, Compass::South].map(arm);
        let Crossing { arm_length_m, lane_width_m, speed_limit_mps, turn_radius_m, .. } = *self;
        Arms { arms: &arms, arm_length_m, lane_width_m, speed_limit_mps, turn_radius_m }.lanes()
    }
}
