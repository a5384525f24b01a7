//! How a vehicle travels: whether it has come and left, how far it drove, and what it lost to others.

use interplay_scenarios::Vehicle;

use crate::state::frame::VehicleFrame;

/// The travel of one vehicle so far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Travel {
    /// Time on the road \[s\].
    pub present_s: f64,
    /// Distance driven \[m\].
    pub distance_m: f64,
    /// The speed that it wants \[m/s\]; 0 if it wants to stand.
    pub wanted_mps: f64,
    /// Whether it is not on the road at the last tick.
    pub is_absent: bool,
}

impl Travel {
    /// A vehicle that has not travelled.
    pub fn new(vehicle: &Vehicle) -> Self {
        Travel { wanted_mps: vehicle.goal.speed_mps.unwrap_or(vehicle.start.speed_mps), ..Travel::default() }
    }

    /// Takes a tick of `step_s` \[s\].
    pub fn observe(&mut self, vehicle: &VehicleFrame, step_s: f64) {
        self.is_absent = vehicle.is_absent;
        if !vehicle.is_absent {
            self.present_s += step_s;
            self.distance_m += step_s * vehicle.state.speed_mps;
        }
    }

    /// Whether it has been on the road.
    pub fn has_come(&self) -> bool {
        self.present_s > 0.0
    }

    /// Time on the road beyond that at the wanted speed \[s\]; none if it wants to stand.
    pub fn delay_s(&self) -> Option<f64> {
        (self.wanted_mps > 0.0).then(|| (self.present_s - self.distance_m / self.wanted_mps).max(0.0))
    }
}
