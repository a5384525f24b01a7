//! A straight road with a lane in each direction.

use std::f64::consts::PI;

use interplay_planners::road::network::{Lane, NeighbourRelation};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::super::form::RoadFault;
use super::{beside, lane, straight};

/// Which vehicles of a two-way road may use the lane of the other direction, to overtake and to pass what stands in their lane.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
#[schemars(inline)]
pub enum Overtaking {
    /// Those on lane `east`, or none.
    East(bool),
    /// Those of both directions.
    Both(BothDirections),
}

/// The word for both directions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[schemars(inline)]
pub enum BothDirections {
    /// Vehicles of both directions.
    Both,
}

/// A straight road along x with its middle at the origin. Lane `east` leads to the east and lane `west` to the west.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(rename = "TwoWayRoad")]
pub struct TwoWay {
    /// Length of the road \[m\].
    #[schemars(range(min = 0.001, max = 10000.0))]
    pub length_m: f64,
    /// Width of each lane \[m\].
    #[schemars(range(min = 0.001, max = 40.0))]
    pub lane_width_m: f64,
    /// Highest permitted speed \[m/s\].
    #[schemars(range(min = 0.001))]
    pub speed_limit_mps: f64,
    /// Whether vehicles on lane `east` may use lane `west` to overtake and to pass what stands in their lane (`true`), none may
    /// (`false`), or those of both directions may use the lane of the other (`"both"`, the default among people).
    pub overtaking: Overtaking,
}

impl Default for TwoWay {
    fn default() -> Self {
        TwoWay { length_m: 600.0, lane_width_m: 3.5, speed_limit_mps: 27.8, overtaking: Overtaking::East(true) }
    }
}

impl TwoWay {
    /// Both lanes.
    ///
    /// # Errors
    /// For sizes that are not numbers.
    pub(crate) fn lanes(&self) -> Result<Vec<Lane>, RoadFault> {
        let TwoWay { length_m, lane_width_m, speed_limit_mps, overtaking } = *self;
        let (begin_m, side_m) = (-0.5 * length_m, -0.5 * lane_width_m);
        let east = straight([begin_m, side_m], 0.0, length_m)?;
        let west = straight([-begin_m, -side_m], PI, length_m)?;
        let [east_may, west_may] = match overtaking {
            Overtaking::East(may) => [may, false],
            Overtaking::Both(BothDirections::Both) => [true, true],
        };
        Ok(vec![
            Lane {
                left: beside("west", NeighbourRelation::Oncoming, east_may),
                ..lane("east", east, lane_width_m, speed_limit_mps)
            },
            Lane {
                left: beside("east", NeighbourRelation::Oncoming, west_may),
                ..lane("west", west, lane_width_m, speed_limit_mps)
            },
        ])
    }
}
