//! A lane and what it says of other lanes.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::super::centre_line::CentreLine;
use super::super::profile::Profile;

/// A lane of a road, driven in the direction of its centre line.
#[derive(Clone, Debug, PartialEq)]
pub struct Lane {
    /// Its name, unique in a network.
    pub name: String,
    /// Its centre line; it has two ends.
    pub centre: CentreLine,
    /// Its width over the arc length of the centre line \[m\].
    pub width: Profile,
    /// Names of the lanes that begin where it ends.
    pub successors: Vec<String>,
    /// The lane to the left of it.
    pub left: Option<LaneNeighbour>,
    /// The lane to the right of it.
    pub right: Option<LaneNeighbour>,
    /// Highest permitted speed \[m/s\].
    pub speed_limit_mps: Option<f64>,
    /// Who goes first at its end.
    pub right_of_way: RightOfWay,
}

/// A lane beside another one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LaneNeighbour {
    /// Its name.
    pub lane: String,
    /// In which direction it is driven.
    pub relation: NeighbourRelation,
    /// Whether a vehicle may change into it.
    pub may_change: bool,
}

/// In which direction a neighbouring lane is driven.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NeighbourRelation {
    /// In the same direction.
    SameDirection,
    /// In the opposite direction.
    Oncoming,
}

/// Who goes first at the end of a lane.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RightOfWay {
    /// The vehicles on this lane.
    #[default]
    Priority,
    /// The vehicles on lanes that it crosses or joins.
    Yield,
    /// The same, and each vehicle on this lane stops at its end.
    Stop,
    /// Each vehicle stops, and they go in the order of their arrival.
    AllWayStop,
}

impl Lane {
    /// A lane of constant width \[m\] without successors, neighbours or a speed limit, with priority at its end.
    pub fn new(name: &str, centre: CentreLine, width_m: f64) -> Lane {
        Lane {
            name: name.to_owned(),
            centre,
            width: Profile::constant(width_m),
            successors: Vec::new(),
            left: None,
            right: None,
            speed_limit_mps: None,
            right_of_way: RightOfWay::Priority,
        }
    }

    /// Half of the width at an arc length \[m\].
    pub fn half_width_m(&self, along_m: f64) -> f64 {
        0.5 * self.width.value(along_m)
    }
}

impl Lane {
    /// Whether a vehicle may change from this lane to a lane beside it that is driven in the same direction.
    pub fn may_change_to(&self, lane: &str) -> bool {
        [&self.left, &self.right].into_iter().flatten().any(|neighbour| neighbour.is_open() && neighbour.lane == lane)
    }
}

impl LaneNeighbour {
    /// Whether the neighbour is driven in the same direction and one may change into it.
    pub fn is_open(&self) -> bool {
        self.relation == NeighbourRelation::SameDirection && self.may_change
    }
}
