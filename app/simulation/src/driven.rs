//! The trajectories of a run, from which a scenario can be written.

use interplay_scenarios::{DrivenVehicle, Scenario};

use crate::report::Report;
use crate::state::frame::Frame;

/// The trajectory of every vehicle while it was on the road, from the frames of all ticks of a run and its report.
///
/// Frames hold the state at the start of each tick; the state at the end of the last tick is in the report.
pub fn driven(scenario: &Scenario, frames: &[Frame], report: &Report) -> Vec<DrivenVehicle> {
    let vehicles = scenario.vehicles.iter().zip(&report.vehicles).enumerate();
    vehicles
        .map(|(index, (vehicle, reported))| {
            let seen = frames.iter().filter_map(|frame| frame.vehicles.get(index)).enumerate();
            let present: Vec<_> = seen.filter(|(_, seen)| !seen.is_absent).collect();
            let first_step = present.first().map_or(0, |(step, _)| *step);
            let end = present.last().map(|_| reported.last);
            DrivenVehicle {
                name: vehicle.name.clone(),
                class: vehicle.class,
                body: vehicle.body,
                first_step,
                states: present.iter().map(|(_, seen)| seen.state).chain(end).collect(),
                steering_rad: present.iter().map(|(_, seen)| seen.input.steering_rad).collect(),
            }
        })
        .collect()
}
