//! A list of lanes that has been checked.

use std::collections::BTreeMap;

use super::error::{LaneFault, RoadNetworkError};
use super::lane::Lane;
use super::neighbours::is_beside;
use super::self_overlap::self_overlap_m;

/// Lanes that form a valid network: every named lane exists, successors touch, and no lane overlaps itself.
#[derive(Clone, Debug, PartialEq)]
pub struct RoadNetwork {
    lanes: Vec<Lane>,
    /// Index of each lane by its name.
    numbers: BTreeMap<String, usize>,
}

/// A lane touches its successor if their ends are nearer than this share of its width. Maps of real roads are off by some
/// centimetres.
const MAX_GAP_RATIO: f64 = 0.1;

/// Most by which the heading changes where a lane touches its successor \[rad\]: in maps of real roads, lanes that fork begin
/// with headings up to 28° apart. A route joins them by a curve, which must not be too tight for its vehicle.
const MAX_KINK_RAD: f64 = 30.0 * std::f64::consts::PI / 180.0;

/// How many places of a lane are checked between two knots of its centre line.
const CHECKS_PER_KNOT: usize = 4;

impl RoadNetwork {
    /// Checks lanes and joins them to a network.
    ///
    /// # Errors
    /// The first fault that is found, in the order of the lanes, with the lane and the field:
    /// - `name`: empty, or used twice,
    /// - `centre`: without ends, or the lane comes back onto itself in about the same or the opposite direction,
    /// - `width`: not positive and finite everywhere, or so large that an edge crosses itself (`|κ| w/2 ≥ 1`),
    /// - `speed_limit_mps`: not positive and finite,
    /// - `successors`: unknown, named twice, more than a tenth of the width away, or turned by more than 30°,
    /// - `left`, `right`: unknown, the lane itself, in the wrong direction, on the wrong side anywhere, or nowhere side by side with
    ///   the lane: more than two fifths of its width on it, or more than half of its width away.
    pub fn new(lanes: Vec<Lane>) -> Result<RoadNetwork, RoadNetworkError> {
        let mut numbers = BTreeMap::new();
        for (index, lane) in lanes.iter().enumerate() {
            let fault = if lane.name.is_empty() {
                Some(LaneFault::NoName)
            } else {
                numbers.insert(lane.name.clone(), index).map(|_| LaneFault::SameName)
            };
            if let Some(fault) = fault {
                return Err(RoadNetworkError { lane: lane.name.clone(), index, field: "name", fault });
            }
        }
        let network = RoadNetwork { lanes, numbers };
        // Each lane is checked alone before lanes are compared, because a comparison needs lanes with valid ends.
        for check in [RoadNetwork::check_alone, RoadNetwork::check_beside_others] {
            for (index, lane) in network.lanes.iter().enumerate() {
                check(&network, lane).map_err(|(field, fault)| RoadNetworkError {
                    lane: lane.name.clone(),
                    index,
                    field,
                    fault,
                })?;
            }
        }
        Ok(network)
    }

    /// A network of lanes that were checked before.
    pub(super) fn unchecked(lanes: Vec<Lane>) -> RoadNetwork {
        let numbers = lanes.iter().enumerate().map(|(index, lane)| (lane.name.clone(), index)).collect();
        RoadNetwork { lanes, numbers }
    }

    /// All lanes, in the order in which they were stated.
    pub fn lanes(&self) -> &[Lane] {
        &self.lanes
    }

    /// The lane with this name, if there is one.
    pub fn lane(&self, name: &str) -> Option<&Lane> {
        self.numbers.get(name).map(|number| &self.lanes[*number])
    }

    fn check_alone(&self, lane: &Lane) -> Result<(), (&'static str, LaneFault)> {
        let length_m = lane.centre.length_m();
        if !length_m.is_finite() {
            return Err(("centre", LaneFault::NoEnds));
        }
        let is_positive = |value: f64| value.is_finite() && value > 0.0;
        if let Some(value) = lane.speed_limit_mps.filter(|limit_mps| !is_positive(*limit_mps)) {
            return Err(("speed_limit_mps", LaneFault::NotPositive { value, along_m: 0.0 }));
        }
        let knots_m = lane.centre.knots_m();
        let places = knots_m.windows(2).flat_map(|pair| {
            (0..=CHECKS_PER_KNOT).map(|part| pair[0] + (pair[1] - pair[0]) * part as f64 / CHECKS_PER_KNOT as f64)
        });
        for along_m in places {
            let width_m = lane.width.value(along_m);
            if !is_positive(width_m) {
                return Err(("width", LaneFault::NotPositive { value: width_m, along_m }));
            }
            let curvature_1pm = lane.centre.at(along_m).curvature_1pm.abs();
            if 0.5 * width_m * curvature_1pm >= 1.0 {
                let radius_m = 1.0 / curvature_1pm;
                return Err(("width", LaneFault::EdgesCross { along_m, width_m, radius_m }));
            }
        }
        let [narrowest_m, _] = lane.width.extremes(0.0, length_m);
        if !is_positive(narrowest_m) {
            return Err(("width", LaneFault::NotPositive { value: narrowest_m, along_m: length_m }));
        }
        let meeting_m = self_overlap_m(lane);
        meeting_m.map_or(Ok(()), |[first_m, again_m]| Err(("centre", LaneFault::MeetsItself { first_m, again_m })))
    }

    fn check_beside_others(&self, lane: &Lane) -> Result<(), (&'static str, LaneFault)> {
        for (place, name) in lane.successors.iter().enumerate() {
            let fault = match self.lane(name) {
                None => Some(LaneFault::UnknownLane { other: name.clone() }),
                Some(_) if lane.successors[..place].contains(name) => {
                    Some(LaneFault::NamedTwice { other: name.clone() })
                }
                Some(successor) => touches(lane, successor),
            };
            if let Some(fault) = fault {
                return Err(("successors", fault));
            }
        }
        for (field, neighbour, side) in [("left", &lane.left, 1.0), ("right", &lane.right, -1.0)] {
            let Some(neighbour) = neighbour else { continue };
            let fault = match self.lane(&neighbour.lane) {
                None => Some(LaneFault::UnknownLane { other: neighbour.lane.clone() }),
                Some(_) if neighbour.lane == lane.name => Some(LaneFault::OwnNeighbour),
                Some(other) => is_beside(lane, neighbour, other, side),
            };
            if let Some(fault) = fault {
                return Err((field, fault));
            }
        }
        Ok(())
    }
}

/// What keeps a lane from being followed by another one.
fn touches(lane: &Lane, successor: &Lane) -> Option<LaneFault> {
    let (end, begin) = (lane.centre.at(lane.centre.length_m()), successor.centre.at(0.0));
    let [x, y] = [0, 1].map(|axis| begin.position[axis] - end.position[axis]);
    let (gap_m, most_m) = (libm::hypot(x, y), MAX_GAP_RATIO * lane.width.value(lane.centre.length_m()));
    let other = successor.name.clone();
    if gap_m > most_m {
        return Some(LaneFault::Gap { other, gap_m, most_m });
    }
    let turn_rad = turn_rad(end.heading_rad, begin.heading_rad).abs();
    let (turn_deg, most_deg) = (turn_rad.to_degrees(), MAX_KINK_RAD.to_degrees());
    (turn_rad > MAX_KINK_RAD).then_some(LaneFault::Kink { other, turn_deg, most_deg })
}

/// The difference of two headings between −π and π \[rad\].
pub(super) fn turn_rad(from_rad: f64, to_rad: f64) -> f64 {
    let (sin, cos) = libm::sincos(to_rad - from_rad);
    libm::atan2(sin, cos)
}
