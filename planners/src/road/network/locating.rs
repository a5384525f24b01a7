//! The lanes that hold a position.

use super::super::centre_line::FrenetPoint;
use super::road_network::{RoadNetwork, turn_rad};

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
