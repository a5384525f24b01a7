//! Where a vehicle is with respect to the lines between lanes: astride one, or on a lane of the opposite direction.
//!
//! The lane of a vehicle is the one that its centre is on: that of its route there, or one beside it. A footprint is across a line if
//! a corner is at least [`ACROSS_M`] beyond it. Lines with no lane behind them are edges of the road, not lines between lanes.

use std::sync::Arc;

use interplay_planners::road::centre_line::FrenetPoint;
use interplay_planners::road::network::{Lane, LaneNeighbour, NeighbourRelation, RoadNetwork};
use interplay_planners::{Body, State};
use interplay_scenarios::{Scenario, Vehicle};

/// A footprint is across a line if a corner is at least this far beyond it, for a real car \[m\].
const ACROSS_M: f64 = 0.2;
/// A vehicle is looked for at most this many lanes beside that of its route.
const MAX_LANES_BESIDE: usize = 8;

/// The lines that a footprint is across.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct LaneUse {
    /// Whether it is across a line between two lanes, in either direction of travel.
    pub is_astride: bool,
    /// Whether a part of it is on a lane of the opposite direction.
    pub is_oncoming: bool,
}

/// The lanes on which a vehicle may be.
#[derive(Clone, Debug)]
pub(super) enum LaneLines {
    /// Those of a network.
    Network(Arc<RoadNetwork>),
    /// Parallel lanes of one direction.
    Parallel {
        /// Lateral coordinate of the centre of lane 0 \[m\].
        first_m: f64,
        /// Width of each lane \[m\].
        width_m: f64,
    },
    /// The road has no lanes.
    None,
}

impl LaneLines {
    /// The lanes around a vehicle's route.
    pub fn of(scenario: &Scenario, vehicle: &Vehicle) -> LaneLines {
        if let Some(network) = &scenario.network {
            return LaneLines::Network(Arc::clone(network));
        }
        let first_m = scenario.road.lane_centre_m(vehicle.road, 0);
        first_m
            .map_or(LaneLines::None, |first_m| LaneLines::Parallel { first_m, width_m: scenario.road.lane_width_m() })
    }

    /// The lines that a vehicle's footprint is across; `along_m` is its arc length on its route \[m\].
    pub fn used_by(&self, vehicle: &Vehicle, state: &State, along_m: f64) -> LaneUse {
        let tolerance_m = ACROSS_M * vehicle.body.real_ratio();
        match self {
            LaneLines::Network(network) => {
                let Some(leg) = vehicle.route.leg(along_m) else { return LaneUse::default() };
                let Some(lane) = network.lane(&leg.lane) else { return LaneUse::default() };
                used_in_network(network, lane, along_m - leg.offset_m, &vehicle.body, state, tolerance_m)
            }
            LaneLines::Parallel { first_m, width_m } => {
                let at = vehicle.route.locate(state.position(), Some(along_m));
                let [low_m, high_m] = lateral_extent_m(&vehicle.body, state, &at);
                let edges_m = vehicle.route.edges_before_end_m(at.along_m);
                let lane = ((at.across_m - first_m) / width_m).round();
                let lines_m = [-0.5, 0.5].map(|side| first_m + (lane + side) * width_m);
                // Beyond a line is another lane if the edge of the road is further away than half of its width.
                let has_lane = [lines_m[0] - edges_m[0], edges_m[1] - lines_m[1]].map(|room_m| room_m > 0.5 * width_m);
                let is_astride =
                    has_lane[0] && low_m < lines_m[0] - tolerance_m || has_lane[1] && high_m > lines_m[1] + tolerance_m;
                LaneUse { is_astride, is_oncoming: false }
            }
            LaneLines::None => LaneUse::default(),
        }
    }
}

/// The lateral coordinates between which a footprint lies, beside a line that turns as it does at `at` \[m\].
fn lateral_extent_m(body: &Body, state: &State, at: &FrenetPoint) -> [f64; 2] {
    let (sin, cos) = libm::sincos(state.heading_rad - at.heading_rad);
    let laterals_m = body.local_corners().map(|[ahead, left]| {
        let along_m = ahead * cos - left * sin;
        at.across_m + ahead * sin + left * cos - 0.5 * at.curvature_1pm * along_m * along_m
    });
    laterals_m.into_iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], one| [low.min(one), high.max(one)])
}

/// A vehicle on a network, of whose route `lane` is part at the arc length `near_m` of the lane \[m\].
fn used_in_network(
    network: &RoadNetwork,
    lane: &Lane,
    near_m: f64,
    body: &Body,
    state: &State,
    tolerance_m: f64,
) -> LaneUse {
    let (mut lane, mut is_opposite) = (lane, false);
    let mut at = lane.centre.project(state.position(), Some(near_m));
    for _ in 0..MAX_LANES_BESIDE {
        let half_m = lane.half_width_m(at.along_m);
        let beside = if at.across_m > half_m {
            &lane.left
        } else if at.across_m < -half_m {
            &lane.right
        } else {
            break;
        };
        let Some((next, relation)) = beside.as_ref().and_then(|beside| neighbour(network, beside)) else { break };
        is_opposite ^= relation == NeighbourRelation::Oncoming;
        lane = next;
        at = lane.centre.project(state.position(), None);
    }
    let half_m = lane.half_width_m(at.along_m);
    let [low_m, high_m] = lateral_extent_m(body, state, &at);
    let [right, left] = [(&lane.right, low_m < -half_m - tolerance_m), (&lane.left, high_m > half_m + tolerance_m)]
        .map(|(beside, is_across)| {
            beside
                .as_ref()
                .filter(|_| is_across)
                .and_then(|beside| neighbour(network, beside))
                .map(|(_, relation)| relation)
        });
    let reaches_oncoming = |relation: NeighbourRelation| match relation {
        NeighbourRelation::SameDirection => is_opposite,
        NeighbourRelation::Oncoming => !is_opposite,
    };
    LaneUse {
        is_astride: right.is_some() || left.is_some(),
        is_oncoming: is_opposite || [right, left].into_iter().flatten().any(reaches_oncoming),
    }
}

fn neighbour<'a>(network: &'a RoadNetwork, beside: &LaneNeighbour) -> Option<(&'a Lane, NeighbourRelation)> {
    network.lane(&beside.lane).map(|lane| (lane, beside.relation))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use interplay_scenarios::load;

    use super::*;

    /// A car of 1.8 m on lane `east`, which is 3.5 m wide and whose left line is at y = 0.
    fn used(y_m: f64, heading_rad: f64) -> [bool; 2] {
        let scenario = load("streets/truck/0", &[]).expect("a street");
        let vehicle = &scenario.vehicles[0];
        let state = State { x_m: 0.0, y_m, heading_rad, speed_mps: 10.0 };
        let along_m = vehicle.route.along(state.position());
        let LaneUse { is_astride, is_oncoming } = LaneLines::of(&scenario, vehicle).used_by(vehicle, &state, along_m);
        [is_astride, is_oncoming]
    }

    #[test]
    fn a_footprint_is_across_a_line_if_a_corner_is_20_cm_beyond_it() {
        assert_eq!(used(-1.75, 0.0), [false, false], "in its lane");
        assert_eq!(used(-2.9, 0.0), [false, false], "across the edge of the road");
        assert_eq!(used(-0.75, 0.0), [false, false], "15 cm across");
        assert_eq!(used(-0.65, 0.0), [true, true], "25 cm across");
        assert_eq!(used(0.65, 0.0), [true, true], "its centre is across");
        assert_eq!(used(1.75, 0.0), [false, true], "in the oncoming lane");
        assert_eq!(used(1.75, PI), [false, true], "whatever its heading");
        assert_eq!(used(-1.3, 0.3), [true, true], "a corner of a turned body is across");
    }

    #[test]
    fn parallel_lanes_have_lines_between_them_and_edges_beside_them() {
        let scenario = load("lane-change/front-nice", &[]).expect("authored");
        let (vehicle, width_m) = (&scenario.vehicles[0], scenario.road.lane_width_m());
        let first_m = scenario.road.lane_centre_m(vehicle.road, 0).expect("parallel lanes");
        let used = |lanes: f64| {
            let [x_m, y_m] = vehicle.route.position(1.0, first_m + lanes * width_m);
            let state = State { x_m, y_m, heading_rad: vehicle.route.heading_at([x_m, y_m]), speed_mps: 1.0 };
            LaneLines::of(&scenario, vehicle).used_by(vehicle, &state, 1.0).is_astride
        };
        assert_eq!([-0.4, 0.0, 0.4, 0.6, 1.0, 1.4].map(used), [false, false, true, true, false, false]);
    }
}
