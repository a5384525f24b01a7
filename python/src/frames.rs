//! The ticks of a run as arrays.

use interplay_scenarios::Scenario;
use interplay_simulation::frame::{BuildingFrame, Frame, VehicleFrame, ZoneFrame};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::shaped;

/// The columns of each vehicle at each tick: name with unit, and how the value is read.
const VEHICLE: [(&str, fn(&VehicleFrame) -> f64); 7] = [
    ("x_m", |vehicle| vehicle.state.x_m),
    ("y_m", |vehicle| vehicle.state.y_m),
    ("heading_rad", |vehicle| vehicle.state.heading_rad),
    ("speed_mps", |vehicle| vehicle.state.speed_mps),
    ("acceleration_mps2", |vehicle| vehicle.input.acceleration_mps2),
    ("steering_rad", |vehicle| vehicle.input.steering_rad),
    ("urgency", |vehicle| vehicle.urgency),
];

/// The same of each zone at each step of the building.
const ZONE: [(&str, fn(&ZoneFrame) -> f64); 7] = [
    ("temperature_c", |zone| zone.temperature_c),
    ("next_c", |zone| zone.next_c),
    ("reference_c", |zone| zone.reference_c.unwrap_or(f64::NAN)),
    ("band_k", |zone| zone.band_k.unwrap_or(f64::NAN)),
    ("requested_kw", |zone| zone.requested_kw),
    ("heat_kw", |zone| zone.heat_kw),
    ("gains_kw", |zone| zone.gains_kw),
];

/// Arrays of the frames by name; the first axis is the tick. Numbers of vehicles that are not on the road are NaN.
pub fn arrays<'py>(py: Python<'py>, scenario: &Scenario, frames: &[Frame]) -> PyResult<Bound<'py, PyDict>> {
    let arrays = PyDict::new(py);
    let ticks: Vec<&Frame> = frames.iter().filter(|frame| !frame.vehicles.is_empty()).collect();
    if !scenario.vehicles.is_empty() {
        of_vehicles(&arrays, scenario, &ticks)?;
    }
    let steps: Vec<(f64, &BuildingFrame)> =
        frames.iter().filter_map(|frame| Some((frame.time_s, frame.building.as_ref()?))).collect();
    if scenario.building.is_some() {
        of_zones(&arrays, &steps)?;
    }
    Ok(arrays)
}

fn of_vehicles(arrays: &Bound<'_, PyDict>, scenario: &Scenario, ticks: &[&Frame]) -> PyResult<()> {
    let (py, count) = (arrays.py(), scenario.vehicles.len());
    let names: Vec<&str> = scenario.vehicles.iter().map(|vehicle| vehicle.name.as_str()).collect();
    arrays.set_item("vehicles", names)?;
    let times: Vec<f64> = ticks.iter().map(|frame| frame.time_s).collect();
    arrays.set_item("time_s", shaped(py, times, &[ticks.len()])?)?;
    let vehicles = || ticks.iter().flat_map(|frame| &frame.vehicles);
    for (name, read) in VEHICLE {
        let numbers = vehicles().map(|vehicle| if vehicle.is_absent { f64::NAN } else { read(vehicle) });
        arrays.set_item(name, shaped(py, numbers.collect(), &[ticks.len(), count])?)?;
    }
    let present = vehicles().map(|vehicle| !vehicle.is_absent).collect();
    arrays.set_item("is_present", shaped(py, present, &[ticks.len(), count])?)?;
    let gaps = ticks.iter().map(|frame| frame.gap_m.unwrap_or(f64::NAN)).collect();
    arrays.set_item("gap_m", shaped(py, gaps, &[ticks.len()])?)?;
    let horizon = scenario.horizon_steps + 1;
    let plan = |vehicle: &VehicleFrame| {
        let states = &vehicle.plan.trajectory.states;
        let state =
            |t: usize| states.get(t).filter(|_| !vehicle.is_absent).map_or([f64::NAN; 4], |state| state.to_array());
        (0..horizon).flat_map(state).collect::<Vec<f64>>()
    };
    arrays.set_item("plan", shaped(py, vehicles().flat_map(plan).collect(), &[ticks.len(), count, horizon, 4])?)
}

fn of_zones(arrays: &Bound<'_, PyDict>, steps: &[(f64, &BuildingFrame)]) -> PyResult<()> {
    let py = arrays.py();
    let zones = steps.first().map_or(0, |(_, step)| step.zones.len());
    let times: Vec<f64> = steps.iter().map(|(time_s, _)| *time_s).collect();
    arrays.set_item("building_time_s", shaped(py, times, &[steps.len()])?)?;
    for (name, read) in ZONE {
        let numbers = steps.iter().flat_map(|(_, step)| step.zones.iter().map(read)).collect();
        arrays.set_item(name, shaped(py, numbers, &[steps.len(), zones])?)?;
    }
    for (name, read) in
        [("ambient_c", (|step| step.ambient_c) as fn(&BuildingFrame) -> f64), ("forecast_c", |step| step.forecast_c)]
    {
        arrays.set_item(name, shaped(py, steps.iter().map(|(_, step)| read(step)).collect(), &[steps.len()])?)?;
    }
    Ok(())
}
