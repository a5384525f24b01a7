//! Pictures of a run whose vehicles all are of flows: none stands out, so the view stands still, and colours tell the flows apart.

use interplay_scenarios::{Scenario, Vehicle};
use interplay_simulation::frame::Frame;

use crate::camera::{CameraView, ViewFormat, car_m};
use crate::palette::{BLUE, Colour, NamedColour, OBSTACLE, OLIVE, ORANGE, PURPLE, SKY};
use crate::rectangle::extent;

/// Least length of a car \[px\].
const CAR_PX: f64 = 4.0;
/// Colours of flows, which are seen on asphalt from afar.
const FLOWS: [NamedColour; 5] = [ORANGE, SKY, PURPLE, OLIVE, BLUE];

/// One colour a vehicle: that of its flow.
pub fn colours(scenario: &Scenario) -> Vec<Colour> {
    let colour = |(index, vehicle): (usize, &Vehicle)| {
        let flow = scenario.flows.of(&vehicle.name);
        let number = scenario.flows.names().position(|name| Some(name) == flow).unwrap_or(index);
        if vehicle.obstacle.is_some() { OBSTACLE.rgb } else { FLOWS[number % FLOWS.len()].rgb }
    };
    scenario.vehicles.iter().enumerate().map(colour).collect()
}

/// The view of a flow, which stands still: all places at which vehicles are, or the middle of them if cars would be too small.
pub fn view(scenario: &Scenario, frames: &[&Frame], format: &ViewFormat) -> CameraView {
    let vehicles = || frames.iter().flat_map(|frame| &frame.vehicles);
    let [low, high] = extent(vehicles().filter(|seen| !seen.is_absent).map(|seen| seen.state.position()));
    let car_m = car_m(scenario);
    let (wide_m, high_m) = (high[0] - low[0] + 3.0 * car_m, high[1] - low[1] + 6.0 * car_m);
    let [least, _] = format.straight_height_px;
    let [_, most] = format.height_px;
    let fit = (format.width_px / wide_m).min(most / high_m);
    let px_per_m = fit.clamp(CAR_PX / car_m, format.car_px[1] / car_m);
    let height_px = 2.0 * (0.5 * (px_per_m * high_m).clamp(least, most)).ceil();
    let size_px = [format.width_px, height_px];
    CameraView { centre_m: [0, 1].map(|axis| 0.5 * (low[axis] + high[axis])), px_per_m, size_px }
}
