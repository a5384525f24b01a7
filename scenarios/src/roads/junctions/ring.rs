//! The geometry of a roundabout: the places and curves at which arms join its ring.

use std::f64::consts::{FRAC_PI_2, PI};

use interplay_planners::CentreLine;
use interplay_planners::road::centre_line::{CentreLineError, Piece};

/// How the lanes of an arm join a ring.
#[derive(Clone, Copy, Debug)]
pub(super) struct RingJoint {
    ring: Ring,
    /// Angle between the arm and the points where its lanes meet the ring \[rad\].
    pub joint_rad: f64,
    /// Radius of the curves on which vehicles enter and leave \[m\].
    pub radius_m: f64,
    /// Length of the straight part of the arm \[m\].
    straight_m: f64,
}

pub(super) struct ArmLines {
    /// From the end of the arm to the yield line, and on to the ring.
    pub inwards: [CentreLine; 2],
    /// From the ring to the point beside the yield line, and on to the end of the arm.
    pub outwards: [CentreLine; 2],
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Ring {
    /// Radius of the ring \[m\].
    pub radius_m: f64,
    /// Distance of both lanes of the arm from its middle \[m\].
    pub offset_m: f64,
    /// How far the arm reaches from the middle of the ring \[m\].
    pub arm_length_m: f64,
    /// Distance of the yield line from the middle of the ring \[m\].
    pub yield_line_m: f64,
    /// Angle between neighbouring arms \[rad\].
    pub spacing_rad: f64,
}

/// Share of the angle between two arms at which their lanes join the ring.
const JOINT_SHARE: f64 = 0.45;

/// Largest angle between an arm and the points where its lanes join the ring \[rad\].
const MAX_JOINT_RAD: f64 = 0.66;

/// Length of the first clothoid of an entry, by its radius.
const CLOTHOID_RATIO: f64 = 0.5;

/// Radii of entries that are tried, by the radius of the ring.
const RADIUS_RANGE: [f64; 2] = [0.01, 20.0];

const HALVINGS: usize = 80;

impl Ring {
    /// How the lanes of an arm join the ring; `None` if the ring is too small for them, or the arm too short.
    ///
    /// An entry turns to the right with a radius `r`, and its curvature then changes linearly to that of the ring. `r` is found
    /// by bisection, such that the entry begins at the distance `offset_m` from the middle of the arm.
    ///
    /// # Errors
    /// Those of [`CentreLine::from_pieces`], for sizes that are not numbers.
    pub fn joint(self) -> Result<Option<RingJoint>, CentreLineError> {
        let joint_rad = (JOINT_SHARE * self.spacing_rad).min(MAX_JOINT_RAD);
        let [mut low_m, mut high_m] = RADIUS_RANGE.map(|ratio| ratio * self.radius_m);
        if !(self.excess_m(joint_rad, low_m)? < 0.0 && self.excess_m(joint_rad, high_m)? > 0.0) {
            return Ok(None);
        }
        for _ in 0..HALVINGS {
            let middle_m = 0.5 * (low_m + high_m);
            if self.excess_m(joint_rad, middle_m)? < 0.0 {
                low_m = middle_m;
            } else {
                high_m = middle_m;
            }
        }
        let curve = CentreLine::from_pieces([0.0; 2], PI, &self.entry(joint_rad, low_m))?;
        let begin_m = self.radius_m * libm::cos(joint_rad) - curve.at(curve.length_m()).position[0];
        let straight_m = self.arm_length_m - begin_m;
        let has_room = straight_m > 0.0 && self.yield_line_m < self.arm_length_m;
        Ok(has_room.then_some(RingJoint { ring: self, joint_rad, radius_m: low_m, straight_m }))
    }

    /// The entry that turns by a right angle less the angle of the joint, with a radius \[rad, m\].
    fn entry(&self, joint_rad: f64, radius_m: f64) -> [Piece; 3] {
        let turn_rad = FRAC_PI_2 - joint_rad;
        let (outer_1pm, ring_1pm) = (-1.0 / radius_m, 1.0 / self.radius_m);
        let first_m = CLOTHOID_RATIO * radius_m;
        // The harmonic mean of both radii, halved: with it the clothoid turns by less than half a radian.
        let second_m = radius_m * self.radius_m / (radius_m + self.radius_m);
        let turned_rad = -0.5 * (first_m * outer_1pm + second_m * (outer_1pm + ring_1pm));
        [
            Piece::Clothoid { length_m: first_m, from_1pm: 0.0, to_1pm: outer_1pm },
            Piece::Arc { length_m: (turn_rad - turned_rad) * radius_m, curvature_1pm: outer_1pm },
            Piece::Clothoid { length_m: second_m, from_1pm: outer_1pm, to_1pm: ring_1pm },
        ]
    }

    /// The distance by which an entry with this radius ends too far to the left of the arm, seen from the middle \[m\].
    fn excess_m(&self, joint_rad: f64, radius_m: f64) -> Result<f64, CentreLineError> {
        let curve = CentreLine::from_pieces([0.0; 2], PI, &self.entry(joint_rad, radius_m))?;
        let [_, y] = curve.at(curve.length_m()).position;
        Ok(self.offset_m + y - self.radius_m * libm::sin(joint_rad))
    }
}

impl RingJoint {
    /// The lines of an arm in a direction \[rad\].
    ///
    /// # Errors
    /// Those of [`CentreLine::between`] if the arm ends before the yield line.
    pub fn lines(&self, angle_rad: f64) -> Result<ArmLines, CentreLineError> {
        let Ring { radius_m, offset_m, arm_length_m, .. } = self.ring;
        let (sin, cos) = libm::sincos(angle_rad);
        let turned = |[x, y]: [f64; 2]| [cos * x - sin * y, sin * x + cos * y];
        let entry = self.ring.entry(self.joint_rad, self.radius_m);
        let straight = Piece::Straight { length_m: self.straight_m };
        let pieces: Vec<Piece> = [straight].into_iter().chain(entry).collect();
        let inwards = CentreLine::from_pieces(turned([arm_length_m, offset_m]), libm::atan2(-sin, -cos), &pieces)?;
        let (joint_sin, joint_cos) = libm::sincos(self.joint_rad);
        let begin = turned([radius_m * joint_cos, -radius_m * joint_sin]);
        let exit = entry.map(reversed).into_iter().rev();
        let pieces: Vec<Piece> = exit.chain([straight]).collect();
        let outwards = CentreLine::from_pieces(begin, angle_rad + FRAC_PI_2 - self.joint_rad, &pieces)?;
        let (length_m, cut_m) = (inwards.length_m(), self.yield_line_on(&inwards));
        Ok(ArmLines {
            inwards: [inwards.between(0.0, cut_m)?, inwards.between(cut_m, length_m)?],
            outwards: [outwards.between(0.0, length_m - cut_m)?, outwards.between(length_m - cut_m, length_m)?],
        })
    }

    /// The point where the entering lane meets the circle of the yield line \[m\].
    fn yield_line_on(&self, inwards: &CentreLine) -> f64 {
        let [mut low_m, mut high_m] = [0.0, inwards.length_m()];
        for _ in 0..HALVINGS {
            let middle_m = 0.5 * (low_m + high_m);
            let [x, y] = inwards.at(middle_m).position;
            if libm::hypot(x, y) > self.ring.yield_line_m {
                low_m = middle_m;
            } else {
                high_m = middle_m;
            }
        }
        low_m
    }
}

/// A piece driven in the other direction, mirrored.
fn reversed(piece: Piece) -> Piece {
    match piece {
        Piece::Clothoid { length_m, from_1pm, to_1pm } => {
            Piece::Clothoid { length_m, from_1pm: to_1pm, to_1pm: from_1pm }
        }
        same @ (Piece::Straight { .. } | Piece::Arc { .. }) => same,
    }
}
