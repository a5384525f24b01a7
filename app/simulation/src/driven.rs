//! What every vehicle did in a run, for whoever writes it as a scenario.

use interplay_planners::{Bicycle, State};
use interplay_scenarios::{DrivenVehicle, Scenario};

use crate::frame::Frame;

/// What every vehicle did, from the frames of all ticks of a run.
///
/// Frames have the state at the begin of each tick. Where a vehicle is at the end of the last one follows from its record or from the
/// bicycle.
pub fn driven(scenario: &Scenario, frames: &[Frame]) -> Vec<DrivenVehicle> {
    let vehicles = scenario.vehicles.iter().enumerate();
    vehicles
        .map(|(index, vehicle)| {
            let seen = || frames.iter().filter_map(|frame| Some((frame.time_s, frame.vehicles.get(index)?)));
            let mut states: Vec<State> = seen().map(|(_, vehicle)| vehicle.state).collect();
            if let Some((time_s, last)) = seen().next_back() {
                let record = vehicle.driver.record().and_then(|record| record.state_at(time_s + scenario.step_s));
                let stepped = || Bicycle::new(&vehicle.body, scenario.step_s).step(&last.state, &last.input);
                states.push(record.unwrap_or_else(stepped));
            }
            let steering_rad = seen().map(|(_, vehicle)| vehicle.input.steering_rad).collect();
            DrivenVehicle { name: vehicle.name.clone(), class: vehicle.class, body: vehicle.body, states, steering_rad }
        })
        .collect()
}
