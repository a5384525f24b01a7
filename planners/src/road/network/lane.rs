//! A lane and its references to other lanes.

use std::sync::Arc;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::super::centre_line::CentreLine;
use super::super::profile::Profile;
use super::light::LightCycle;

/// A lane of a road, driven in the direction of its centre line.
#[derive(Clone, Debug, PartialEq)]
pub struct Lane {
    /// Name of the lane, unique in a network.
    pub name: String,
    /// Centre line of the lane, with two ends.
    pub centre: CentreLine,
    /// Width of the lane over the arc length of its centre line \[m\].
    pub width: Profile,
    /// Names of the lanes that begin where this one ends.
    pub successors: Vec<String>,
    /// The neighbouring lane on the left.
    pub left: Option<LaneNeighbour>,
    /// The neighbouring lane on the right.
    pub right: Option<LaneNeighbour>,
    /// Speed limit; `None` without one \[m/s\].
    pub speed_limit_mps: Option<f64>,
    /// Who goes first at the end of this lane.
    pub right_of_way: RightOfWay,
    /// The traffic light at the end of this lane.
    pub light: Option<Arc<LightCycle>>,
    /// For whom the lane is; empty where it is for all.
    pub users: Vec<LaneUser>,
    /// Whether it is a zebra crossing: pedestrians on it, or coming to it, go first, whatever the signs.
    pub is_zebra: bool,
}

/// A lane's reference to a neighbouring lane.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LaneNeighbour {
    /// Name of the neighbouring lane.
    pub lane: String,
    /// The direction in which the neighbouring lane is driven.
    pub relation: NeighbourRelation,
    /// Whether a vehicle may change into it.
    pub may_change: bool,
}

/// In which direction a neighbouring lane is driven.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NeighbourRelation {
    /// The neighbouring lane is driven in the same direction.
    SameDirection,
    /// The neighbouring lane is driven in the opposite direction.
    Oncoming,
}

/// Who goes first at the end of a lane.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RightOfWay {
    /// The vehicles on this lane go first.
    #[default]
    Priority,
    /// The vehicles on lanes that this one crosses or joins go first.
    Yield,
    /// As [`RightOfWay::Yield`], and each vehicle on this lane stops at its end.
    Stop,
    /// Each vehicle stops, and vehicles go in the order of their arrival.
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
            light: None,
            users: Vec::new(),
            is_zebra: false,
        }
    }

    /// Half of the width at an arc length \[m\].
    pub fn half_width_m(&self, along_m: f64) -> f64 {
        0.5 * self.width.value(along_m)
    }
}

impl Lane {
    /// Whether the lane is reserved for pedestrians.
    pub fn is_path(&self) -> bool {
        self.users == [LaneUser::Pedestrian]
    }

    /// Whether a road user may use the lane.
    pub fn is_open_to(&self, user: LaneUser) -> bool {
        self.users.is_empty() || self.users.contains(&user)
    }

    /// Whether a vehicle may change from this lane to a lane beside it that is driven in the same direction.
    pub fn may_change_to(&self, lane: &str) -> bool {
        [&self.left, &self.right].into_iter().flatten().any(|neighbour| neighbour.is_open() && neighbour.lane == lane)
    }
}

impl LaneNeighbour {
    /// Whether the neighbour is driven in the same direction and vehicles may change into it.
    pub fn is_open(&self) -> bool {
        self.relation == NeighbourRelation::SameDirection && self.may_change
    }
}

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
