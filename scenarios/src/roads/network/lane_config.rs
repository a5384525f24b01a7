//! A lane as a file states it.

use interplay_planners::Profile;
use interplay_planners::road::network::{LaneNeighbour, LaneUser, NeighbourRelation, RightOfWay};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::json;

use super::super::curve::CurvePiece;
use super::super::form::RoadFault;
use crate::text::name;

/// A lane: a line with a width. The line is stated by `start` and `pieces`, or by `points`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LaneConfig {
    /// Its name, unique in the network.
    #[schemars(extend("pattern" = name::pattern()), example = &"main-0")]
    pub name: String,
    /// The first point of the lane's middle, and its direction.
    #[serde(default)]
    #[schemars(example = json!({ "x_m": 0.0, "y_m": 0.0, "heading_deg": 0.0 }), extend("x-excludes" = ["points"]))]
    pub start: Option<LanePlaceConfig>,
    /// The pieces of the lane's middle, one after the other, each straight or a turn. Where they meet, a smooth curve takes the
    /// place of a short part of both.
    #[serde(default)]
    #[schemars(
        length(max = 200),
        extend("x-excludes" = ["points"]),
        example = json!([{ "straight_m": 30.0 }, { "turn_deg": 90.0, "radius_m": 8.0 }])
    )]
    pub pieces: Vec<CurvePiece>,
    /// Points of the lane's middle, each `[x, y]`; a smooth curve leads through them \[m\].
    #[serde(default)]
    #[schemars(length(max = 5000), example = json!([[0.0, 0.0], [20.0, 1.0], [40.0, 4.0]]))]
    pub points: Vec<[f64; 2]>,
    /// The largest distance between the curve and `points`, except at the first and the last, in order to bend less \[m\].
    #[serde(default = "defaults::tolerance_m")]
    #[schemars(range(min = 0.0, max = 10.0))]
    pub tolerance_m: f64,
    /// Width of the lane: a number, or a list of `[along_m, width_m]` in the order of the distance along the lane \[m\].
    #[schemars(example = 3.5)]
    pub width_m: LaneWidth,
    /// The lanes that begin where it ends.
    #[serde(default)]
    #[schemars(length(max = 64), example = vec!["main-1"])]
    pub successors: Vec<String>,
    /// The lane to its left: its name, or `{ lane, oncoming, may_change }`.
    #[serde(default)]
    #[schemars(example = &"main-1")]
    pub left: Option<NeighbourConfig>,
    /// The lane to its right, in the same way.
    #[serde(default)]
    #[schemars(example = json!({ "lane": "against", "oncoming": true, "may_change": false }))]
    pub right: Option<NeighbourConfig>,
    /// Highest permitted speed; by default unknown \[m/s\].
    #[serde(default)]
    #[schemars(range(min = 0.001), example = 13.9)]
    pub speed_limit_mps: Option<f64>,
    /// The right of way at its end.
    #[serde(default)]
    pub right_of_way: RightOfWay,
    /// The road users that may use the lane; by default all. Others do not get routes along it and do not change into it.
    #[serde(default)]
    #[schemars(length(max = 5), example = json!(["bus"]))]
    pub users: Vec<LaneUser>,
    /// Whether it is a zebra crossing: a pedestrian on it, or coming to it, goes first, whatever the signs of the lanes that it crosses.
    #[serde(default)]
    pub zebra: bool,
}

impl LaneConfig {
    /// A lane through points, each `[x, y]` \[m\], of a constant width \[m\], without a successor or a neighbour.
    pub fn through(name: &str, points: &[[f64; 2]], width_m: f64) -> LaneConfig {
        LaneConfig {
            name: name.to_owned(),
            start: None,
            pieces: Vec::new(),
            points: points.to_vec(),
            tolerance_m: defaults::tolerance_m(),
            width_m: LaneWidth::Constant(width_m),
            successors: Vec::new(),
            left: None,
            right: None,
            speed_limit_mps: None,
            right_of_way: RightOfWay::default(),
            users: Vec::new(),
            zebra: false,
        }
    }
}

mod defaults {
    pub fn tolerance_m() -> f64 {
        0.02
    }
    pub fn may_change() -> bool {
        true
    }
}

/// A position in world coordinates and a direction.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LanePlaceConfig {
    /// Position along the world's x axis \[m\].
    #[schemars(example = 0.0)]
    pub x_m: f64,
    /// Position along the world's y axis \[m\].
    #[schemars(example = 0.0)]
    pub y_m: f64,
    /// Direction, counter-clockwise from the x axis \[deg\].
    #[serde(default)]
    pub heading_deg: f64,
}

/// The width of a lane.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum LaneWidth {
    /// The same everywhere \[m\].
    Constant(#[schemars(range(min = 0.001, max = 40.0))] f64),
    /// Pairs of a distance along the lane and the width there \[m\].
    Knots(#[schemars(length(min = 1, max = 5000))] Vec<[f64; 2]>),
}

/// A lane beside another one.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum NeighbourConfig {
    /// Its name: it is driven in the same direction, and vehicles may change into it.
    Name(String),
    /// Its name, and the keys that differ.
    Table(NeighbourTable),
}

/// A lane beside another one, with its direction.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NeighbourTable {
    /// Its name.
    #[schemars(example = &"main-1")]
    pub lane: String,
    /// Whether it is driven in the opposite direction.
    #[serde(default)]
    pub oncoming: bool,
    /// Whether a vehicle may change into it.
    #[serde(default = "defaults::may_change")]
    pub may_change: bool,
}

impl NeighbourConfig {
    pub(crate) fn neighbour(&self) -> LaneNeighbour {
        let (lane, oncoming, may_change) = match self {
            NeighbourConfig::Name(lane) => (lane, false, true),
            NeighbourConfig::Table(table) => (&table.lane, table.oncoming, table.may_change),
        };
        let relation = if oncoming { NeighbourRelation::Oncoming } else { NeighbourRelation::SameDirection };
        LaneNeighbour { lane: lane.clone(), relation, may_change }
    }
}

impl LaneWidth {
    /// The width at the start of the lane \[m\].
    pub(crate) fn first_m(&self) -> f64 {
        match self {
            LaneWidth::Constant(width_m) => *width_m,
            LaneWidth::Knots(knots) => knots.first().map_or(0.0, |[_, width_m]| *width_m),
        }
    }

    /// The width over the distance along the lane; `path` is that of the lane below `road`.
    pub(super) fn profile(&self, path: &str) -> Result<Profile, RoadFault> {
        let knots = match self {
            LaneWidth::Constant(width_m) => return Ok(Profile::constant(*width_m)),
            LaneWidth::Knots(knots) => knots,
        };
        if let Some(knot) = knots.iter().position(|[_, width_m]| *width_m < MIN_WIDTH_M) {
            let path = format!("{path}.width_m.{knot}.1");
            let message = format!("a lane has the width {} m", knots[knot][1]);
            return Err(RoadFault::new(path, "no width", message)
                .help(format!("widths are at least {MIN_WIDTH_M} m everywhere; 3.5 m is a usual one")));
        }
        Profile::through(knots).map_err(|error| {
            RoadFault::new(format!("{path}.width_m"), "no width", format!("the width of a lane is invalid: {error}"))
                .help("write pairs of increasing distances and widths, such as `[[0.0, 3.5], [20.0, 3.0]]`")
        })
    }
}

/// Least width of a lane \[m\].
const MIN_WIDTH_M: f64 = 0.001;
