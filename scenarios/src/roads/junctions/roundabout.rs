//! A ring that several arms join.

use std::f64::consts::{FRAC_PI_2, TAU};

use interplay_planners::CentreLine;
use interplay_planners::road::centre_line::{CentreLineError, Piece};
use interplay_planners::road::network::{Lane, LaneNeighbour, NeighbourRelation, RightOfWay};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::super::form::{RoadFault, to_centimetres};
use super::ring::{Ring, RingJoint};
use super::{beside, lane, limit_in_turn_mps, numbered};

/// A roundabout around the origin, driven counter-clockwise; entering vehicles yield. Four arms are called `east`, `north`, `west`
/// and `south`, otherwise they are `arm-0` (to the east), `arm-1` and so on, counter-clockwise. Lanes are called `west-in`
/// and `west-out`, with `-0` and `-1` from the right where the ring has two lanes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Roundabout {
    /// Radius of the ring's middle \[m\].
    #[schemars(range(min = 0.001, max = 1000.0))]
    pub radius_m: f64,
    /// How many arms there are.
    #[schemars(range(min = 3, max = 6))]
    pub arms: usize,
    /// How many lanes the ring has, and each arm in each direction.
    #[schemars(range(min = 1, max = 2))]
    pub lane_count: usize,
    /// How far the arms reach from the middle of the ring \[m\].
    #[schemars(range(min = 0.001, max = 5000.0))]
    pub arm_length_m: f64,
    /// Width of each lane \[m\].
    #[schemars(range(min = 0.001, max = 40.0))]
    pub lane_width_m: f64,
    /// Highest permitted speed on the arms; where they turn it is at most the speed with a sideways acceleration of 2 m/s²
    /// \[m/s\].
    #[schemars(range(min = 0.001))]
    pub speed_limit_mps: f64,
    /// Highest permitted speed on the ring; by default the speed with a sideways acceleration of 2 m/s² \[m/s\].
    #[schemars(range(min = 0.001), example = 5.5)]
    pub ring_speed_limit_mps: Option<f64>,
}

impl Default for Roundabout {
    fn default() -> Self {
        Roundabout {
            radius_m: 15.0,
            arms: 4,
            lane_count: 1,
            arm_length_m: 100.0,
            lane_width_m: 3.5,
            speed_limit_mps: 13.9,
            ring_speed_limit_mps: None,
        }
    }
}

/// Smallest radius of entries, by the width of a lane.
const MIN_ENTRY_RATIO: f64 = 0.75;

const COMPASS: [&str; 4] = ["east", "north", "west", "south"];

impl Roundabout {
    /// The lanes of the ring and of the arms.
    ///
    /// # Errors
    /// For a ring that is too small for its arms, and arms that are too short.
    pub(crate) fn lanes(&self) -> Result<Vec<Lane>, RoadFault> {
        let joint = self.joint()?;
        let mut lanes = Vec::new();
        for arm in 0..self.arms {
            for number in 0..self.lane_count {
                self.add_arm(&joint, arm, number, &mut lanes)?;
            }
        }
        for arm in 0..self.arms {
            for number in 0..self.lane_count {
                self.add_ring(&joint, arm, number, &mut lanes)?;
            }
        }
        Ok(lanes)
    }

    fn spacing_rad(&self) -> f64 {
        TAU / self.arms as f64
    }

    /// Radius of the outer lane of the ring \[m\].
    fn outer_radius_m(&self) -> f64 {
        self.radius_m + 0.5 * (self.lane_count as f64 - 1.0) * self.lane_width_m
    }

    /// How the outer lanes of an arm join the ring. Other lanes are parallel to them.
    fn joint(&self) -> Result<RingJoint, RoadFault> {
        let width_m = self.lane_width_m;
        let outer_m = self.outer_radius_m();
        let inner_edge_m = outer_m - (self.lane_count as f64 - 0.5) * width_m;
        let ring = Ring {
            radius_m: outer_m,
            offset_m: (self.lane_count as f64 - 0.5) * width_m,
            arm_length_m: self.arm_length_m,
            yield_line_m: outer_m + width_m,
            spacing_rad: self.spacing_rad(),
        };
        let is_wide = |joint: &RingJoint| joint.radius_m > MIN_ENTRY_RATIO * width_m && inner_edge_m > 0.0;
        if let Some(joint) = ring.joint()?.filter(is_wide) {
            return Ok(joint);
        }
        // A test with a very long arm shows whether the ring or the arm causes the fault.
        let long = Ring { arm_length_m: 1e3 * (outer_m + width_m), ..ring }.joint()?.filter(is_wide);
        Err(match long {
            Some(joint) => {
                let enough_m = (2.0 * (outer_m + joint.radius_m)).ceil();
                let message =
                    format!("`road.arm_length_m` ({}) is too short for the entries", to_centimetres(self.arm_length_m));
                RoadFault::new("arm_length_m", "too short", message).help(format!("{enough_m} m works"))
            }
            None => {
                let message = format!(
                    "a ring with a radius of {} m is too small for {} arms of this width",
                    to_centimetres(self.radius_m),
                    self.arms
                );
                RoadFault::new("radius_m", "too small", message)
                    .help("a larger radius, fewer arms, fewer lanes or narrower lanes work")
            }
        })
    }

    fn arm_name(&self, arm: usize) -> String {
        let arm = arm % self.arms;
        if self.arms == COMPASS.len() { COMPASS[arm].to_owned() } else { format!("arm-{arm}") }
    }

    fn name(&self, arm: usize, part: &str, number: usize) -> String {
        numbered(&format!("{}-{part}", self.arm_name(arm)), number, self.lane_count)
    }

    /// The part of the ring in front of an arm.
    fn ring_name(&self, arm: usize, number: usize) -> String {
        numbered(&format!("ring-{}", self.arm_name(arm)), number, self.lane_count)
    }

    /// The part of the ring between an arm and the next one.
    fn ring_on_name(&self, arm: usize, number: usize) -> String {
        let name = format!("ring-{}-to-{}", self.arm_name(arm), self.arm_name(arm + 1));
        numbered(&name, number, self.lane_count)
    }

    fn add_arm(&self, joint: &RingJoint, arm: usize, number: usize, lanes: &mut Vec<Lane>) -> Result<(), RoadFault> {
        let left_m = number as f64 * self.lane_width_m;
        let lines = joint.lines(self.spacing_rad() * arm as f64)?;
        let curve_mps = limit_in_turn_mps(joint.radius_m + left_m, self.speed_limit_mps);
        let add = |part: &str, line: &CentreLine, limit_mps: f64, successor: Option<String>| {
            let line = if number == 0 { line.clone() } else { line.parallel(left_m)? };
            let plain = lane(&self.name(arm, part, number), line, self.lane_width_m, limit_mps);
            Ok::<Lane, CentreLineError>(Lane { successors: successor.into_iter().collect(), ..plain })
        };
        let beside_in = |other: usize| self.name(arm, "in", other);
        let beside_out = |other: usize| self.name(arm, "out", other);
        let [inwards, entry] = &lines.inwards;
        let [exit, outwards] = &lines.outwards;
        lanes.push(Lane {
            left: self
                .left_of(number, beside_in)
                .or_else(|| beside(&self.name(arm, "out", self.lane_count - 1), NeighbourRelation::Oncoming, false)),
            right: right_of(number, beside_in),
            right_of_way: RightOfWay::Yield,
            ..add("in", inwards, self.speed_limit_mps, Some(self.name(arm, "entry", number)))?
        });
        lanes.push(add("entry", entry, curve_mps, Some(self.ring_on_name(arm, number)))?);
        lanes.push(add("exit", exit, curve_mps, Some(self.name(arm, "out", number)))?);
        lanes.push(Lane {
            left: self
                .left_of(number, beside_out)
                .or_else(|| beside(&self.name(arm, "in", self.lane_count - 1), NeighbourRelation::Oncoming, false)),
            right: right_of(number, beside_out),
            ..add("out", outwards, self.speed_limit_mps, None)?
        });
        Ok(())
    }

    fn add_ring(&self, joint: &RingJoint, arm: usize, number: usize, lanes: &mut Vec<Lane>) -> Result<(), RoadFault> {
        let radius_m = self.outer_radius_m() - number as f64 * self.lane_width_m;
        let limit_mps = self.ring_speed_limit_mps.unwrap_or(limit_in_turn_mps(radius_m, f64::INFINITY));
        let angle_rad = self.spacing_rad() * arm as f64;
        let arc = |from_rad: f64, to_rad: f64| {
            let (sin, cos) = libm::sincos(from_rad);
            let piece = Piece::Arc { length_m: radius_m * (to_rad - from_rad), curvature_1pm: 1.0 / radius_m };
            CentreLine::from_pieces([radius_m * cos, radius_m * sin], from_rad + FRAC_PI_2, &[piece])
        };
        let joint_rad = joint.joint_rad;
        let in_front = arc(angle_rad - joint_rad, angle_rad + joint_rad)?;
        let onwards = arc(angle_rad + joint_rad, angle_rad + self.spacing_rad() - joint_rad)?;
        let beside_front = |other: usize| self.ring_name(arm, other);
        let beside_on = |other: usize| self.ring_on_name(arm, other);
        lanes.push(Lane {
            successors: vec![self.ring_on_name(arm, number)],
            left: self.left_of(number, beside_front),
            right: right_of(number, beside_front),
            ..lane(&self.ring_name(arm, number), in_front, self.lane_width_m, limit_mps)
        });
        lanes.push(Lane {
            successors: vec![self.ring_name(arm + 1, number), self.name(arm + 1, "exit", number)],
            left: self.left_of(number, beside_on),
            right: right_of(number, beside_on),
            ..lane(&self.ring_on_name(arm, number), onwards, self.lane_width_m, limit_mps)
        });
        Ok(())
    }

    /// The lane to the left of one, if it is driven in the same direction.
    fn left_of(&self, number: usize, name: impl Fn(usize) -> String) -> Option<LaneNeighbour> {
        let is_inside = number + 1 < self.lane_count;
        is_inside.then(|| beside(&name(number + 1), NeighbourRelation::SameDirection, true)).flatten()
    }
}

/// The lane to the right of one, if there is one.
fn right_of(number: usize, name: impl Fn(usize) -> String) -> Option<LaneNeighbour> {
    beside(&name(number.checked_sub(1)?), NeighbourRelation::SameDirection, true)
}
