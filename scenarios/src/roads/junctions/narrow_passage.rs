//! A road with a lane in each direction that narrows to the width of one.

use std::f64::consts::PI;

use interplay_planners::CentreLine;
use interplay_planners::road::centre_line::{CentreLineError, LineSection};
use interplay_planners::road::network::{Lane, NeighbourRelation, RightOfWay};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::super::form::RoadFault;
use super::{beside, changing_width, lane, straight};

/// A straight road along x. In its middle, around the origin, both directions share the width of one lane. Lanes are called
/// `east-in`, `east-passage` and `east-out` for vehicles that drive to the east, and `west-in` and so on for the others.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct NarrowPassage {
    /// Length of the passage \[m\].
    #[schemars(range(min = 0.001, max = 5000.0))]
    pub passage_m: f64,
    /// Width of the passage \[m\].
    #[schemars(range(min = 0.001, max = 40.0))]
    pub passage_width_m: f64,
    /// Length of the road on either side of the passage \[m\].
    #[schemars(range(min = 0.001, max = 5000.0))]
    pub approach_m: f64,
    /// Length of the part of the approach on which the lanes move to the middle \[m\].
    #[schemars(range(min = 0.001, max = 5000.0))]
    pub taper_m: f64,
    /// Width of each lane outside of the passage \[m\].
    #[schemars(range(min = 0.001, max = 40.0))]
    pub lane_width_m: f64,
    /// Highest permitted speed \[m/s\].
    #[schemars(range(min = 0.001))]
    pub speed_limit_mps: f64,
    /// The direction that goes first: vehicles that drive to the east, or to the west; by default neither has priority.
    #[schemars(example = &"east")]
    pub priority_to: Option<DrivingDirection>,
}

/// A direction in which vehicles drive.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum DrivingDirection {
    /// To the east.
    East,
    /// To the west.
    West,
}

impl Default for NarrowPassage {
    fn default() -> Self {
        NarrowPassage {
            passage_m: 30.0,
            passage_width_m: 3.2,
            approach_m: 100.0,
            taper_m: 25.0,
            lane_width_m: 3.5,
            speed_limit_mps: 13.9,
            priority_to: None,
        }
    }
}

impl DrivingDirection {
    fn name(self) -> &'static str {
        match self {
            DrivingDirection::East => "east",
            DrivingDirection::West => "west",
        }
    }

    fn other(self) -> DrivingDirection {
        match self {
            DrivingDirection::East => DrivingDirection::West,
            DrivingDirection::West => DrivingDirection::East,
        }
    }

    /// A point ahead of the origin and to the right of it, as seen in this direction \[m\].
    fn place(self, ahead_m: f64, right_m: f64) -> [f64; 2] {
        match self {
            DrivingDirection::East => [ahead_m, -right_m],
            DrivingDirection::West => [-ahead_m, right_m],
        }
    }

    fn heading_rad(self) -> f64 {
        match self {
            DrivingDirection::East => 0.0,
            DrivingDirection::West => PI,
        }
    }
}

impl NarrowPassage {
    /// The lanes of both directions.
    ///
    /// # Errors
    /// For a taper that is longer than the approach.
    pub(crate) fn lanes(&self) -> Result<Vec<Lane>, RoadFault> {
        if self.taper_m >= self.approach_m {
            let message = format!("`road.taper_m` ({}) is not within the approach", self.taper_m);
            return Err(RoadFault::new("taper_m", "too long", message)
                .help(format!("less than `approach_m`, {} m, works", self.approach_m)));
        }
        let mut lanes = Vec::new();
        for direction in [DrivingDirection::East, DrivingDirection::West] {
            self.add_direction(direction, &mut lanes)?;
        }
        Ok(lanes)
    }

    fn add_direction(&self, direction: DrivingDirection, lanes: &mut Vec<Lane>) -> Result<(), RoadFault> {
        let name = |part: &str| format!("{}-{part}", direction.name());
        let other = |part: &str| format!("{}-{part}", direction.other().name());
        let (half_m, widths_m) = (0.5 * self.passage_m, [self.lane_width_m, self.passage_width_m]);
        let limit_mps = self.speed_limit_mps;
        let (straight_m, shifted_m) = (self.approach_m - self.taper_m, 0.5 * self.lane_width_m);
        let places = [half_m, half_m, half_m + self.taper_m, half_m + self.approach_m];
        let outwards = NarrowPassage::shifted(direction, places, [0.0, shifted_m])?;
        let [end_m, _, to_m, begin_m] = places.map(|place_m| -place_m);
        let inwards = NarrowPassage::shifted(direction, [begin_m, to_m, end_m, end_m], [shifted_m, 0.0])?;
        let passage = straight(direction.place(-half_m, 0.0), direction.heading_rad(), self.passage_m)?;
        let yields = self.priority_to.is_some_and(|first| first != direction);
        let narrowing = changing_width([straight_m, self.approach_m], widths_m);
        let widening = changing_width([0.0, self.taper_m], [widths_m[1], widths_m[0]]);
        lanes.push(Lane {
            width: narrowing,
            successors: vec![name("passage")],
            left: beside(&other("out"), NeighbourRelation::Oncoming, false),
            right_of_way: if yields { RightOfWay::Yield } else { RightOfWay::Priority },
            ..lane(&name("in"), inwards, self.lane_width_m, limit_mps)
        });
        lanes.push(Lane {
            successors: vec![name("out")],
            ..lane(&name("passage"), passage, self.passage_width_m, limit_mps)
        });
        lanes.push(Lane {
            width: widening,
            left: beside(&other("in"), NeighbourRelation::Oncoming, false),
            ..lane(&name("out"), outwards, self.lane_width_m, limit_mps)
        });
        Ok(())
    }

    /// A line along the road from the first of four points ahead of the origin to the last. Between the two in the middle it
    /// moves from one distance from the middle of the road to another \[m\].
    fn shifted(
        direction: DrivingDirection,
        [begin_m, from_m, to_m, end_m]: [f64; 4],
        right_m: [f64; 2],
    ) -> Result<CentreLine, CentreLineError> {
        let part = |begin_m: f64, end_m: f64, right_m: f64| {
            straight(direction.place(begin_m, right_m), direction.heading_rad(), end_m - begin_m)
        };
        let before = part(begin_m - BEYOND_M, from_m, right_m[0])?;
        let after = part(to_m, end_m + BEYOND_M, right_m[1])?;
        let section = |line| LineSection { line, from_m: 0.0, to_m: CentreLine::length_m(line) };
        let joined = CentreLine::joined(&[section(&before), section(&after)])?.line;
        joined.between(BEYOND_M, joined.length_m() - BEYOND_M)
    }
}

/// The length by which the line of a lane is extended at both ends before it is cut, so that both parts of it have a length \[m\].
const BEYOND_M: f64 = 1.0;
