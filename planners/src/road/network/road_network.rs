//! A list of lanes that has been checked.

use std::collections::BTreeMap;

use super::super::centre_line::FrenetPoint;
use super::error::{LaneFault, RoadNetworkError};
use super::lane::{Lane, LaneUser};
use super::neighbours::is_beside;

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

/// A position on a lane.
#[derive(Clone, Debug, PartialEq)]
pub struct LanePlace {
    /// The name of the lane.
    pub lane: String,
    /// Frenet coordinates on the lane.
    pub point: FrenetPoint,
    /// Heading minus that of the lane at this place, between −π and π \[rad\].
    pub heading_error_rad: f64,
}

/// Positions that are nearer to an edge or an end than this are on the lane: projections are exact to rounding \[m\].
const EDGE_TOLERANCE_M: f64 = 1e-6;

impl RoadNetwork {
    /// The lanes that contain a position, edges and ends included, sorted by the difference between their direction and
    /// a heading \[m, rad\], then by the distance of their centre.
    pub fn locate(&self, position: [f64; 2], heading_rad: f64) -> Vec<LanePlace> {
        let mut places: Vec<LanePlace> = Vec::new();
        for lane in self.lanes() {
            let point = lane.centre.project(position, None);
            let beyond_m = (-point.along_m).max(point.along_m - lane.centre.length_m());
            let beside_m = point.across_m.abs() - lane.half_width_m(point.along_m);
            if beyond_m <= EDGE_TOLERANCE_M && beside_m <= EDGE_TOLERANCE_M {
                let heading_error_rad = turn_rad(point.heading_rad, heading_rad);
                places.push(LanePlace { lane: lane.name.clone(), point, heading_error_rad });
            }
        }
        let order = |place: &LanePlace| (place.heading_error_rad.abs(), place.point.across_m.abs());
        places.sort_by(|a, b| {
            let ((a_turn, a_across), (b_turn, b_across)) = (order(a), order(b));
            a_turn.total_cmp(&b_turn).then(a_across.total_cmp(&b_across))
        });
        places
    }
}

/// Two places overlap if they are nearer across the lane than this share of its width.
const OVERLAP_RATIO: f64 = 0.9;

/// Least cosine of the angle between two parts of a lane that run side by side: those at a larger angle cross, which can be driven.
const MIN_COS: f64 = 0.866;

const MAX_PLACES: f64 = 20_000.0;

/// A place of a lane that is compared with others.
#[derive(Clone, Copy)]
struct LanePart {
    along_m: f64,
    position: [f64; 2],
    heading_rad: f64,
    half_m: f64,
}

/// Two arc lengths at which a lane covers the same place in about the same direction, or the opposite one; none if it does so
/// nowhere \[m\].
///
/// In a turn whose inner edge does not cross itself, places at least `π/2` widths apart are at least a width apart. A lane that is
/// its own successor may end where it begins.
pub(super) fn self_overlap_m(lane: &Lane) -> Option<[f64; 2]> {
    let length_m = lane.centre.length_m();
    let widest_m = lane.width.extremes(0.0, length_m)[1];
    let count = (2.0 * length_m / widest_m).ceil().clamp(1.0, MAX_PLACES);
    let step_m = length_m / count;
    let near_m = 0.5 * std::f64::consts::PI * widest_m + step_m;
    let cell_m = widest_m.max(step_m);
    let is_ring = lane.successors.contains(&lane.name);
    let mut cells: BTreeMap<[i64; 2], Vec<LanePart>> = BTreeMap::new();
    for index in 0..=count as usize {
        let along_m = step_m * index as f64;
        let point = lane.centre.at(along_m);
        let half_m = lane.half_width_m(along_m);
        let part = LanePart { along_m, position: point.position, heading_rad: point.heading_rad, half_m };
        let cell = part.position.map(|coordinate| (coordinate / cell_m).floor() as i64);
        for (x, y) in (-1..=1).flat_map(|x| (-1..=1).map(move |y| (x, y))) {
            let mut others = cells.get(&[cell[0] + x, cell[1] + y]).into_iter().flatten();
            let is_met = |earlier: &&LanePart| {
                let closes = is_ring && length_m - (along_m - earlier.along_m) <= near_m;
                along_m - earlier.along_m > near_m && !closes && overlap(earlier, &part, step_m)
            };
            if let Some(earlier) = others.find(is_met) {
                return Some([earlier.along_m, along_m]);
            }
        }
        cells.entry(cell).or_default().push(part);
    }
    None
}

/// Whether two parts of a lane, no longer than a step, lie on each other and run side by side \[m\].
fn overlap(one: &LanePart, other: &LanePart, step_m: f64) -> bool {
    let (sin, cos) = libm::sincos(one.heading_rad);
    let [x, y] = [other.position[0] - one.position[0], other.position[1] - one.position[1]];
    let (along_m, across_m) = (x * cos + y * sin, y * cos - x * sin);
    libm::cos(other.heading_rad - one.heading_rad).abs() >= MIN_COS
        && along_m.abs() <= step_m
        && across_m.abs() < OVERLAP_RATIO * (one.half_m + other.half_m)
}

impl RoadNetwork {
    /// Whether a lane is reserved for some road users.
    pub fn has_restricted_lanes(&self) -> bool {
        self.lanes().iter().any(|lane| !lane.users.is_empty())
    }

    /// The network without the lanes that are closed to this road user.
    pub fn open_to(&self, user: LaneUser) -> RoadNetwork {
        self.with_lanes(|lane| lane.is_open_to(user))
    }

    /// The network with only the lanes that `is_kept` selects.
    pub fn with_lanes(&self, is_kept: impl Fn(&Lane) -> bool) -> RoadNetwork {
        let mut lanes: Vec<Lane> = self.lanes().iter().filter(|lane| is_kept(lane)).cloned().collect();
        let names: Vec<String> = lanes.iter().map(|lane| lane.name.clone()).collect();
        for lane in &mut lanes {
            lane.successors.retain(|name| names.contains(name));
            lane.left = lane.left.take().filter(|neighbour| names.contains(&neighbour.lane));
            lane.right = lane.right.take().filter(|neighbour| names.contains(&neighbour.lane));
        }
        RoadNetwork::unchecked(lanes)
    }
}
