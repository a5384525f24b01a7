//! Junctions of straight arms along the axes.

use std::f64::consts::{FRAC_PI_2, PI};

use interplay_planners::road::network::{Lane, LaneNeighbour, NeighbourRelation, RightOfWay};

use super::super::form::{RoadFault, to_centimetres};
use super::connector::{Connector, LanePose, connector, tangent_ratio};
use super::{beside, lane, limit_in_turn_mps, numbered, straight};

/// The direction in which an arm leads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Compass {
    East,
    North,
    West,
    South,
}

/// A straight road that ends at a junction.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arm {
    pub compass: Compass,
    /// The right of way at the end of its lanes.
    pub right_of_way: RightOfWay,
    pub median: Median,
}

/// The strip between the directions of an arm.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Median {
    None,
    /// A lane that leads to the left.
    TurningLane,
    /// An unused strip of a lane's width opposite a turning lane.
    Island,
}

/// Arms that meet, and their sizes.
pub(super) struct Arms<'a> {
    /// They are in the order of [`Compass`], and opposite arms are equally wide.
    pub arms: &'a [Arm],
    /// How far they reach from the middle of the junction \[m\].
    pub arm_length_m: f64,
    pub lane_width_m: f64,
    pub speed_limit_mps: f64,
    /// Smallest radius of turns to the right \[m\].
    pub turn_radius_m: f64,
}

impl Compass {
    pub fn name(self) -> &'static str {
        match self {
            Compass::East => "east",
            Compass::North => "north",
            Compass::West => "west",
            Compass::South => "south",
        }
    }

    /// Direction of the arm from the middle of the junction \[rad\].
    pub fn heading_rad(self) -> f64 {
        match self {
            Compass::East => 0.0,
            Compass::North => FRAC_PI_2,
            Compass::West => PI,
            Compass::South => -FRAC_PI_2,
        }
    }

    fn opposite(self) -> Compass {
        match self {
            Compass::East => Compass::West,
            Compass::North => Compass::South,
            Compass::West => Compass::East,
            Compass::South => Compass::North,
        }
    }

    fn is_beside(self, other: Compass) -> bool {
        let along_x = |compass: Compass| matches!(compass, Compass::East | Compass::West);
        along_x(self) != along_x(other)
    }
}

/// Exact directions along the axes: cosine and sine.
fn axis(compass: Compass) -> [f64; 2] {
    match compass {
        Compass::East => [1.0, 0.0],
        Compass::North => [0.0, 1.0],
        Compass::West => [-1.0, 0.0],
        Compass::South => [0.0, -1.0],
    }
}

impl Arm {
    /// An arm with one lane in each direction.
    pub fn new(compass: Compass, right_of_way: RightOfWay) -> Arm {
        Arm { compass, right_of_way, median: Median::None }
    }

    fn lanes_in(&self) -> usize {
        if self.median == Median::TurningLane { 2 } else { 1 }
    }

    /// Distance of the outer lanes from the middle of the arm, in lane widths.
    fn outer_lanes(&self) -> f64 {
        if self.median == Median::None { 0.5 } else { 1.0 }
    }

    /// The lane beside another one in the opposite direction; `None` across an island.
    fn oncoming(&self, lane: &str) -> Option<LaneNeighbour> {
        if self.median == Median::Island { None } else { beside(lane, NeighbourRelation::Oncoming, false) }
    }

    fn name_in(&self, number: usize) -> String {
        numbered(&format!("{}-in", self.compass.name()), number, self.lanes_in())
    }

    fn name_out(&self) -> String {
        format!("{}-out", self.compass.name())
    }
}

impl Arms<'_> {
    /// The lanes of all arms, and the lanes that connect them.
    ///
    /// # Errors
    /// [`RoadFault`] if the stated sizes leave no room for the lanes.
    pub fn lanes(&self) -> Result<Vec<Lane>, RoadFault> {
        let half_m = 0.5 * self.lane_width_m;
        if self.turn_radius_m <= half_m {
            let message = format!(
                "`road.turn_radius_m` ({}) is not above half of a lane's width: the inner edge would cross itself",
                self.turn_radius_m
            );
            return Err(RoadFault::new("turn_radius_m", "too tight", message)
                .help(format!("more than {half_m} m works; a car needs about 5.5 m")));
        }
        for arm in self.arms {
            let least_m = self.end_m(arm)?;
            if self.arm_length_m <= least_m {
                let message =
                    format!("`road.arm_length_m` ({}) is all within the junction", to_centimetres(self.arm_length_m));
                return Err(RoadFault::new("arm_length_m", "too short", message).help(format!(
                    "more than {} m works; a smaller `turn_radius_m` makes the junction smaller",
                    to_centimetres(least_m)
                )));
            }
        }
        let mut lanes = Vec::new();
        for arm in self.arms {
            self.add_arm(arm, &mut lanes)?;
        }
        for arm in self.arms {
            self.add_connectors(arm, &mut lanes)?;
        }
        Ok(lanes)
    }

    /// Distance from the middle at which the lanes of an arm end \[m\].
    fn end_m(&self, arm: &Arm) -> Result<f64, RoadFault> {
        let crossed = self.arms.iter().filter(|other| other.compass.is_beside(arm.compass));
        let outer_m = crossed.map(|other| other.outer_lanes() * self.lane_width_m).fold(0.0, f64::max);
        Ok(outer_m + self.turn_radius_m * tangent_ratio(FRAC_PI_2)?)
    }

    /// The point on an arm at a distance from the middle, shifted to the right of the leaving direction \[m\].
    fn place(arm: &Arm, along_m: f64, right_m: f64) -> [f64; 2] {
        let [cos, sin] = axis(arm.compass);
        [cos * along_m + sin * right_m, sin * along_m - cos * right_m]
    }

    /// Where a lane of an arm enters the junction.
    fn entering(&self, arm: &Arm, number: usize) -> Result<LanePose, RoadFault> {
        let left_m = (arm.outer_lanes() - number as f64) * self.lane_width_m;
        let position = Arms::place(arm, self.end_m(arm)?, -left_m);
        Ok(LanePose { position, heading_rad: arm.compass.opposite().heading_rad() })
    }

    /// Where the lane of an arm leaves the junction.
    fn leaving(&self, arm: &Arm) -> Result<LanePose, RoadFault> {
        let position = Arms::place(arm, self.end_m(arm)?, arm.outer_lanes() * self.lane_width_m);
        Ok(LanePose { position, heading_rad: arm.compass.heading_rad() })
    }

    fn add_arm(&self, arm: &Arm, lanes: &mut Vec<Lane>) -> Result<(), RoadFault> {
        let length_m = self.arm_length_m - self.end_m(arm)?;
        let count = arm.lanes_in();
        for number in 0..count {
            let end = self.entering(arm, number)?;
            let [cos, sin] = axis(arm.compass);
            let begin = [end.position[0] + length_m * cos, end.position[1] + length_m * sin];
            let centre = straight(begin, end.heading_rad, length_m)?;
            let is_last = number + 1 == count;
            lanes.push(Lane {
                successors: self.connected(arm, number).map(|to| connector_name(arm, to)).collect(),
                left: if is_last {
                    arm.oncoming(&arm.name_out())
                } else {
                    beside(&arm.name_in(number + 1), NeighbourRelation::SameDirection, true)
                },
                right: number
                    .checked_sub(1)
                    .and_then(|before| beside(&arm.name_in(before), NeighbourRelation::SameDirection, true)),
                right_of_way: arm.right_of_way,
                ..lane(&arm.name_in(number), centre, self.lane_width_m, self.speed_limit_mps)
            });
        }
        let begin = self.leaving(arm)?;
        let centre = straight(begin.position, begin.heading_rad, length_m)?;
        lanes.push(Lane {
            left: arm.oncoming(&arm.name_in(count - 1)),
            ..lane(&arm.name_out(), centre, self.lane_width_m, self.speed_limit_mps)
        });
        Ok(())
    }

    /// The arms to which a lane of an arm leads. If there is a lane for turns to the left, the other one leads elsewhere.
    fn connected<'a>(&'a self, from: &'a Arm, number: usize) -> impl Iterator<Item = &'a Arm> {
        let to_left = |to: &Arm| {
            let ([x, y], [to_x, to_y]) = (axis(from.compass), axis(to.compass));
            // Entering vehicles drive against the direction of the arm.
            to_x * y - to_y * x > 0.5
        };
        let is_served = move |to: &Arm| from.median != Median::TurningLane || to_left(to) == (number == 1);
        self.arms.iter().filter(move |to| to.compass != from.compass && is_served(to))
    }

    fn add_connectors(&self, from: &Arm, lanes: &mut Vec<Lane>) -> Result<(), RoadFault> {
        for number in 0..from.lanes_in() {
            for to in self.connected(from, number) {
                let Connector { centre, radius_m } = connector(self.entering(from, number)?, self.leaving(to)?)?;
                let limit_mps = limit_in_turn_mps(radius_m, self.speed_limit_mps);
                lanes.push(Lane {
                    successors: vec![to.name_out()],
                    ..lane(&connector_name(from, to), centre, self.lane_width_m, limit_mps)
                });
            }
        }
        Ok(())
    }
}

fn connector_name(from: &Arm, to: &Arm) -> String {
    format!("{}-to-{}", from.compass.name(), to.compass.name())
}
