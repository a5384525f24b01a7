//! A minor road that ends at a main one.

use interplay_planners::road::network::{Lane, RightOfWay};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::super::form::RoadFault;
use super::arms::{Arm, Arms, Compass, Median};

/// A main road from west to east, with a lane in each direction, and a minor one that joins it from the south at the origin.
/// Lanes are called `west-in`, `west-out` and so on, connectors `west-to-south`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct TJunction {
    /// How far the arms reach from the middle of the junction \[m\].
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
    /// Whether the main road has a lane of its own for turns to the left into the minor one, `east-in-1`; `east-in-0` then leads
    /// straight on. To the west of the junction, an island of the same width lies between both directions.
    pub turning_lanes: bool,
    /// The sign on the minor road.
    pub right_of_way: MinorRoadRule,
}

/// The sign on a minor road that meets a main one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum MinorRoadRule {
    /// Let the main road go first.
    #[default]
    Yield,
    /// The same, and stop at the end of the lane.
    Stop,
}

impl From<MinorRoadRule> for RightOfWay {
    fn from(rule: MinorRoadRule) -> RightOfWay {
        match rule {
            MinorRoadRule::Yield => RightOfWay::Yield,
            MinorRoadRule::Stop => RightOfWay::Stop,
        }
    }
}

impl Default for TJunction {
    fn default() -> Self {
        TJunction {
            arm_length_m: 100.0,
            lane_width_m: 3.5,
            speed_limit_mps: 13.9,
            turn_radius_m: 8.0,
            turning_lanes: false,
            right_of_way: MinorRoadRule::default(),
        }
    }
}

impl TJunction {
    /// The lanes of both roads and of the junction.
    ///
    /// # Errors
    /// For sizes that leave no room for the lanes.
    pub(crate) fn lanes(&self) -> Result<Vec<Lane>, RoadFault> {
        // Only vehicles from the east turn to the left.
        let medians = if self.turning_lanes { [Median::TurningLane, Median::Island] } else { [Median::None; 2] };
        let main = [(Compass::East, medians[0]), (Compass::West, medians[1])]
            .map(|(compass, median)| Arm { median, ..Arm::new(compass, RightOfWay::Priority) });
        let arms = [main[0], main[1], Arm::new(Compass::South, self.right_of_way.into())];
        let TJunction { arm_length_m, lane_width_m, speed_limit_mps, turn_radius_m, .. } = *self;
        Arms { arms: &arms, arm_length_m, lane_width_m, speed_limit_mps, turn_radius_m }.lanes()
    }
}
