//! Parallel lanes as lanelets, as long as the driven part of the road.

use super::DrivenVehicle;
use super::base::Base;
use super::lanelets::LaneletText;
use crate::model::scenario::Scenario;
use crate::roads::Branch;

/// How far lanelets extend beyond the positions of all vehicles \[m\].
const BEYOND_M: f64 = 50.0;
/// The largest distance between two points of a bound \[m\].
const POINTS_M: f64 = 2.0;
/// The most points of a bound.
const MAX_POINTS: f64 = 2000.0;

impl Base {
    /// Adds the lanes of a road without names, each from the rearmost to the foremost position of any vehicle.
    pub(super) fn add_parallel(&mut self, scenario: &Scenario, vehicles: &[DrivenVehicle]) {
        let Some(lanes) = scenario.road.parallel_lanes() else { return };
        for branch in [Branch::Main, Branch::Cross] {
            let exists = branch == Branch::Main || scenario.road.conflict_zone_m(branch).is_some();
            let Some(route) = scenario.road.route(branch).filter(|_| exists) else { continue };
            let states = vehicles.iter().flat_map(|vehicle| &vehicle.states);
            let along = states.map(|state| route.along(state.position()));
            let [from_m, to_m] = along.fold([0.0_f64, 0.0_f64], |[low, high], at_m| [low.min(at_m), high.max(at_m)]);
            let [from_m, to_m] = [from_m - BEYOND_M, to_m + BEYOND_M];
            let count = ((to_m - from_m) / POINTS_M).ceil().clamp(1.0, MAX_POINTS) as usize;
            let ids: Vec<u64> = (0..lanes.count).map(|_| self.ids.give(None)).collect();
            for (lane, id) in ids.iter().enumerate() {
                let Some(centre_m) = scenario.road.lane_centre_m(branch, lane) else { continue };
                let bounds = [0.5, -0.5].map(|side| {
                    let across_m = centre_m + side * lanes.width_m;
                    let place =
                        |index: usize| route.position(from_m + (to_m - from_m) * index as f64 / count as f64, across_m);
                    (0..=count).map(place).collect()
                });
                let beside = [ids.get(lane + 1), lane.checked_sub(1).and_then(|right| ids.get(right))];
                let beside = beside.map(|id| id.map(|id| (*id, true)));
                self.roads.push_str(&LaneletText { id: *id, bounds, beside, ..LaneletText::default() }.written());
            }
        }
    }
}
