//! The strip beside the centre line of a route.

use super::super::centre_line::{CentreLine, LinePoint};
use super::super::profile::Profile;
use super::lane::{Lane, LaneNeighbour};
use super::road_network::RoadNetwork;
use super::route::RouteLeg;

/// The edges of a route and its own half width, over the arc length of its centre line.
pub(super) struct Strip {
    pub right: Profile,
    pub left: Profile,
    pub half_width: Profile,
    /// The same edges, without lanes that are driven in the opposite direction.
    pub same_direction: [Profile; 2],
}

/// Most by which an edge moves sideways per metre where a neighbour begins or ends.
const MAX_EDGE_SLOPE: f64 = 0.2;

/// Distance of the places where edges are computed, by the width of the lane.
const SPACING_RATIO: f64 = 0.5;

/// Most places where edges are computed.
const MAX_PLACES: usize = 5_000;

/// Steps of the search for an edge: each leaves about the square of the angle between both lines of the error before.
const EDGE_STEPS: usize = 5;

/// Least cosine of the angle between a route and a lane beside it: lanes at a larger angle are not beside it.
const LEAST_COSINE: f64 = 0.5;

/// Edges that differ by less are equal, by the width of the lane: projections are exact to rounding.
const EQUAL_RATIO: f64 = 1e-7;

/// Computes edges at places along a route and smooths them.
///
/// `sections_m` says where the centre line follows the lane of each leg; between, it leads from one lane to the next, and the
/// strip holds what belongs to either.
pub(super) fn strip(network: &RoadNetwork, centre: &CentreLine, legs: &[RouteLeg], sections_m: &[[f64; 2]]) -> Strip {
    let length_m = centre.length_m();
    let lanes: Vec<&Lane> = legs.iter().filter_map(|leg| network.lane(&leg.lane)).collect();
    let narrowest_m =
        lanes.iter().map(|lane| lane.width.extremes(0.0, lane.centre.length_m())[0]).fold(f64::INFINITY, f64::min);
    let count = ((length_m / (SPACING_RATIO * narrowest_m)).ceil() as usize).clamp(2, MAX_PLACES);
    let mut right = Vec::with_capacity(count + 1);
    let mut left = Vec::with_capacity(count + 1);
    let mut half_width = Vec::with_capacity(count + 1);
    let mut same_direction: [Vec<[f64; 2]>; 2] = Default::default();
    for place in 0..=count {
        let along_m = length_m * place as f64 / count as f64;
        let mut edges_m = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        let mut half_m = f64::INFINITY;
        for (index, lane) in lanes.iter().enumerate() {
            let begin_m = index.checked_sub(1).map_or(f64::NEG_INFINITY, |before| sections_m[before][1]);
            let end_m = sections_m.get(index + 1).map_or(f64::INFINITY, |after| after[0]);
            if along_m >= begin_m && along_m <= end_m {
                let point = centre.at(along_m);
                let near = Place { network, centre, along_m, point, width_m: narrowest_m };
                for (edges_m, with_oncoming) in edges_m.iter_mut().zip([true, false]) {
                    let (right_m, left_m) =
                        (near.edge_m(lane, -1.0, with_oncoming), near.edge_m(lane, 1.0, with_oncoming));
                    *edges_m = [edges_m[0].min(right_m), edges_m[1].max(left_m)];
                }
                half_m = half_m.min(lane.half_width_m(lane.centre.project(point.position, None).along_m));
            }
        }
        right.push([along_m, -edges_m[0][0]]);
        left.push([along_m, edges_m[0][1]]);
        same_direction[0].push([along_m, -edges_m[1][0]]);
        same_direction[1].push([along_m, edges_m[1][1]]);
        half_width.push([along_m, half_m]);
    }
    let smoothed =
        |knots: Vec<[f64; 2]>, sign: f64| smooth_edge(knots, EQUAL_RATIO * narrowest_m, sign, MAX_EDGE_SLOPE);
    let [own_right, own_left] = same_direction;
    Strip {
        right: smoothed(right, -1.0),
        left: smoothed(left, 1.0),
        half_width: smoothed(half_width, 1.0),
        same_direction: [smoothed(own_right, -1.0), smoothed(own_left, 1.0)],
    }
}

struct Place<'a> {
    network: &'a RoadNetwork,
    centre: &'a CentreLine,
    along_m: f64,
    point: LinePoint,
    /// Width of the narrowest lane of the route \[m\].
    width_m: f64,
}

impl Place<'_> {
    /// Lateral coordinate of the outer edge of a lane or of the last open neighbour on a side of it: 1 for the left, −1 for
    /// the right. A lane in the opposite direction counts `with_oncoming` if one may use it, and is the last one \[m\].
    fn edge_m(&self, lane: &Lane, side: f64, with_oncoming: bool) -> f64 {
        let (mut lane, mut edge_m) = (lane, self.lane_edge_m(lane, side).1);
        // A lane has a neighbour at most once on each side, unless neighbours form a ring.
        for _ in self.network.lanes() {
            let neighbour: Option<&LaneNeighbour> = if side > 0.0 { lane.left.as_ref() } else { lane.right.as_ref() };
            let is_usable = |next: &&LaneNeighbour| next.is_open() || (with_oncoming && next.may_change);
            let Some(neighbour) = neighbour.filter(is_usable) else { break };
            let Some(next) = self.network.lane(&neighbour.lane) else { break };
            let Some(next_edge_m) = self.beside(next, side) else { break };
            edge_m = if side > 0.0 { edge_m.max(next_edge_m) } else { edge_m.min(next_edge_m) };
            if !neighbour.is_open() {
                break;
            }
            lane = next;
        }
        edge_m
    }

    /// Lateral coordinate of the edge of a lane on a side, if the lane lies beside this place, or one that continues it does:
    /// lanes side by side need not begin and end at the same place \[m\].
    fn beside(&self, lane: &Lane, side: f64) -> Option<f64> {
        let (is_beside, edge_m) = self.lane_edge_m(lane, side);
        if is_beside {
            return Some(edge_m);
        }
        let after = lane.successors.iter().filter_map(|name| self.network.lane(name));
        let before = self.network.lanes().iter().filter(|other| other.successors.contains(&lane.name));
        let edges = after.chain(before).map(|other| self.lane_edge_m(other, side));
        edges.filter(|(is_beside, _)| *is_beside).map(|(_, edge_m)| edge_m).next()
    }

    /// Whether a lane lies beside this place, neither before nor behind it, and where the normal of the route meets its edge
    /// on a side: the lateral coordinate \[m\].
    fn lane_edge_m(&self, lane: &Lane, side: f64) -> (bool, f64) {
        let mut edge_m = 0.0;
        let mut beside = lane.centre.project(self.point.position, None);
        for _ in 0..EDGE_STEPS {
            let cos = libm::cos(beside.heading_rad - self.point.heading_rad);
            // The left side of a lane in the opposite direction is on the right.
            let direction = if cos < 0.0 { -1.0 } else { 1.0 };
            let missing_m = direction * side * lane.half_width_m(beside.along_m) - beside.across_m;
            edge_m += direction * missing_m / (direction * cos).max(LEAST_COSINE);
            beside = lane.centre.project(self.centre.position(self.along_m, edge_m), Some(beside.along_m));
        }
        let beyond_m = (-beside.along_m).max(beside.along_m - lane.centre.length_m());
        (beyond_m < EQUAL_RATIO * self.width_m, edge_m)
    }
}

/// A profile that is nowhere beyond an edge and nowhere steeper than `slope`, times `sign`.
pub(super) fn smooth_edge(places: Vec<[f64; 2]>, equal_m: f64, sign: f64, slope: f64) -> Profile {
    let mut knots = places.clone();
    // Where an edge jumps between two positions, both get the inner value, because the jump may be anywhere between them.
    for pair in 0..places.len().saturating_sub(1) {
        let (before, after) = (places[pair], places[pair + 1]);
        if (after[1] - before[1]).abs() > slope * (after[0] - before[0]) {
            knots[pair][1] = knots[pair][1].min(after[1]);
            knots[pair + 1][1] = knots[pair + 1][1].min(before[1]);
        }
    }
    let limit = |knots: &mut Vec<[f64; 2]>, from: usize, to: usize| {
        let most = knots[from][1] + slope * (knots[to][0] - knots[from][0]).abs();
        knots[to][1] = knots[to][1].min(most);
    };
    for index in 1..knots.len() {
        limit(&mut knots, index - 1, index);
    }
    for index in (1..knots.len()).rev() {
        limit(&mut knots, index, index - 1);
    }
    // Neighbouring values that differ by rounding become one value, so that a constant width stays constant.
    for index in 1..knots.len() {
        if (knots[index][1] - knots[index - 1][1]).abs() < equal_m {
            knots[index][1] = knots[index - 1][1];
        }
    }
    let edge: Vec<[f64; 2]> = knots.iter().map(|[along_m, value]| [*along_m, sign * value]).collect();
    // The places increase and are finite, so there is a profile; without places the edge is the centre line.
    Profile::through(&edge).unwrap_or(Profile::constant(0.0))
}
