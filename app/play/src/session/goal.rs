//! The goal of a seat, in words and as a mark on the road.

use interplay_scenarios::{Scenario, Vehicle};
use serde::Serialize;

/// The goal of a person in a seat.
#[derive(Clone, Debug, Serialize)]
pub struct PlayGoal {
    /// `lane`, `cross`, `last-lane` or `drive`.
    pub kind: &'static str,
    /// The goal in words.
    pub text: String,
    /// The line to cross \[m\].
    pub line: Option<[[f64; 2]; 2]>,
    /// The middle of the lane to reach \[m\].
    pub lane: Option<Vec<[f64; 2]>>,
}

/// Length of the mark of a lane, in lengths of the vehicle.
const MARK_LENGTHS: f64 = 30.0;
const MARK_POINTS: usize = 24;

pub(super) fn of(scenario: &Scenario, index: usize) -> PlayGoal {
    let vehicle = &scenario.vehicles[index];
    let route = &vehicle.route;
    let start_m = [route.along(vehicle.start.position()), route.across(vehicle.start.position())];
    let line = |along_m: f64| {
        let half_m = route.half_width.value(along_m).max(0.5 * scenario.road.lane_width_m());
        Some([-half_m, half_m].map(|across_m| route.position(along_m, across_m)))
    };
    if let Some([_, end_m]) = scenario.road.conflict_zone_m(vehicle.road) {
        let text = "Cross the other road".to_owned();
        return PlayGoal { kind: "cross", text, line: line(end_m + vehicle.body.rear_m), lane: None };
    }
    let last = route.legs.last().filter(|_| scenario.road.parallel_lanes().is_none() && route.legs.len() > 1);
    if let Some(leg) = last {
        let text = format!("Drive to the end of your route: {}", leg.lane.replace(['-', '_'], " "));
        return PlayGoal { kind: "last-lane", text, line: line(leg.from_m + vehicle.body.rear_m), lane: None };
    }
    let across_m = route.across(vehicle.target(&scenario.road).position());
    let is_elsewhere = (across_m - start_m[1]).abs() > 0.5 * vehicle.body.width_m;
    let text = match (is_elsewhere, across_m > start_m[1]) {
        (false, _) => "Stay in your lane and drive on. Other drivers may want to merge: let them in or not".to_owned(),
        (true, true) => "Change to the lane on your left".to_owned(),
        (true, false) => "Change to the lane on your right".to_owned(),
    };
    let lane = is_elsewhere.then(|| mark(vehicle, start_m[0], across_m));
    PlayGoal { kind: if is_elsewhere { "lane" } else { "drive" }, text, line: None, lane }
}

/// The middle of a lane, from beside the start on \[m\].
fn mark(vehicle: &Vehicle, from_m: f64, across_m: f64) -> Vec<[f64; 2]> {
    let reach_m = MARK_LENGTHS * (vehicle.body.front_m + vehicle.body.rear_m);
    let place = |place: usize| from_m + reach_m * place as f64 / MARK_POINTS as f64;
    (0..=MARK_POINTS).map(|at| vehicle.route.position(place(at), across_m)).collect()
}
