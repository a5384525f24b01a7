//! An object on or beside the road, as a file states it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::model::traffic::lane_reference::LaneReference;
use crate::model::traffic::obstacle::ObstacleKind;
use crate::text::name;

/// An object without a driver that stands on or beside the road or moves by a timetable: a parked car, a cone, a wall. Its position is
/// stated in a lane (`lane`, `along_m`) or in world coordinates (`x_m`, `y_m`); its shape by `length_m` and `width_m`, by `radius_m`, or
/// by `corners_m`, and by default by its kind.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Obstacle")]
pub struct ObstacleConfig {
    /// Its name, unique among obstacles and vehicles.
    #[schemars(extend("pattern" = name::pattern()), example = &"parked-1")]
    pub name: String,
    /// Its kind: its appearance, and its size where none is stated.
    #[serde(default)]
    pub kind: ObstacleKind,
    /// The lane beside whose middle it stands: its name, or its number from the right.
    #[schemars(example = &"east", extend("x-excludes" = ["x_m", "y_m"]))]
    pub lane: Option<LaneReference>,
    /// Position of its middle along the lane \[m\].
    #[schemars(range(min = -100_000.0, max = 100_000.0), example = 40.0, extend("x-excludes" = ["x_m", "y_m"]))]
    pub along_m: Option<f64>,
    /// Distance of its middle from that of the lane, positive to the left; it may be beside the lane \[m\].
    #[schemars(range(min = -100.0, max = 100.0), example = -1.9, extend("x-excludes" = ["x_m", "y_m"]))]
    pub lateral_offset_m: Option<f64>,
    /// Position of its middle along the world's x axis \[m\].
    #[schemars(range(min = -100_000_000.0, max = 100_000_000.0), example = 40.0)]
    pub x_m: Option<f64>,
    /// Position of its middle along the world's y axis \[m\].
    #[schemars(range(min = -100_000_000.0, max = 100_000_000.0), example = -1.9)]
    pub y_m: Option<f64>,
    /// The direction of its length, counter-clockwise: against the lane where one is stated, else against the x axis; 0 by default
    /// \[rad\].
    #[schemars(example = 0.1)]
    pub heading_rad: Option<f64>,
    /// Length of a box \[m\].
    #[schemars(range(min = 0.001, max = 1000.0), example = 4.5, extend("x-excludes" = ["radius_m", "corners_m"]))]
    pub length_m: Option<f64>,
    /// Width of a box \[m\].
    #[schemars(range(min = 0.001, max = 1000.0), example = 1.8, extend("x-excludes" = ["radius_m", "corners_m"]))]
    pub width_m: Option<f64>,
    /// Radius of a circle \[m\].
    #[schemars(range(min = 0.001, max = 1000.0), example = 0.2, extend("x-excludes" = ["corners_m"]))]
    pub radius_m: Option<f64>,
    /// Corners of a convex polygon, each `[along, aside]` from its middle, to the front and to the left, counter-clockwise \[m\].
    #[serde(default)]
    #[schemars(length(max = 64), example = vec![[1.0, -1.0], [1.0, 1.0], [-1.0, 0.0]])]
    pub corners_m: Vec<[f64; 2]>,
    /// Its motion, if it does not stand: rows of time \[s\], x and y \[m\] and heading \[rad\]. Between two rows it moves at constant
    /// velocity, and it stays at the last row.
    #[serde(default)]
    #[schemars(length(max = 10_000), example = vec![[0.0, 10.0, 5.0, 1.57], [8.0, 10.0, 9.0, 1.57]])]
    pub timetable: Vec<[f64; 4]>,
}
