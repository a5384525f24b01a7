//! A vehicle as faults are judged.

use std::sync::Arc;

use interplay_planners::{Body, Route, State};
use interplay_scenarios::Vehicle;

/// A vehicle that has stood for this time is not at fault, for a real car \[s\].
const STOOD_S: f64 = 1.0;
/// A body is out of its lane if it is beyond the line by this share of its width.
const OUT_WIDTHS: f64 = 0.1;
/// For how long a gap that was too short, and a duty to wait, count, for a real car \[s\].
const REMEMBERED_S: f64 = 5.0;

/// A vehicle, with the time for which it has stood \[s\].
#[derive(Clone, Debug)]
pub(super) struct RoadUser {
    pub name: String,
    pub body: Body,
    pub route: Arc<Route>,
    /// Whether it drives like people, who owe one another gaps.
    pub knows_comfort: bool,
    pub stood_s: f64,
}

impl RoadUser {
    /// A vehicle at its start, which has not stood yet.
    pub fn new(vehicle: &Vehicle) -> RoadUser {
        RoadUser {
            name: vehicle.name.clone(),
            body: vehicle.body,
            route: Arc::clone(&vehicle.route),
            knows_comfort: vehicle.limits.comfort.is_some(),
            stood_s: 0.0,
        }
    }

    pub fn time_ratio(&self) -> f64 {
        self.body.real_ratio().sqrt()
    }

    /// For how long a gap that was too short, and a duty to wait, count against it \[s\].
    pub fn remembered_s(&self) -> f64 {
        REMEMBERED_S * self.time_ratio()
    }

    pub fn length_m(&self) -> f64 {
        self.body.front_m + self.body.rear_m
    }

    pub fn has_stood(&self) -> bool {
        self.stood_s >= STOOD_S * self.time_ratio()
    }

    /// Arc lengths of rear and front on its route \[m\].
    pub fn reach_m(&self, state: &State) -> [f64; 2] {
        let along_m = self.route.along(state.position());
        [along_m - self.body.rear_m, along_m + self.body.front_m]
    }

    pub fn is_out_of_lane(&self, state: &State) -> bool {
        let at = self.route.locate(state.position(), None);
        let beyond_m = at.across_m.abs() + 0.5 * self.body.width_m - self.route.half_width.value(at.along_m);
        beyond_m > OUT_WIDTHS * self.body.width_m
    }
}
