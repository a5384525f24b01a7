//! The data from which a page in a browser draws a world: shapes, and the frames of a run.
//!
//! The shapes are those of the animations (`body`, `road_shapes`, `palette`).

mod road;
mod vehicle;

use interplay_planners::State;
use interplay_scenarios::Scenario;
use interplay_simulation::frame::{Frame, Level, VehicleFrame};
use serde::Serialize;

use crate::camera::car_m;
use crate::palette::{GRASS, css, vehicle_colours};

use self::road::{RoadShape, StageLight};
use self::vehicle::StageVehicle;
use crate::passing_words::event_text;
use crate::requests::Requests;
use crate::signals::{indicator_side, is_braking};
use interplay_planners::scene::IndicatorSide;

/// A world as a page draws it; lengths in metres.
#[derive(Clone, Debug, Serialize)]
pub struct Stage {
    pub title: String,
    pub shows: String,
    /// Length of a tick \[s\].
    pub step_s: f64,
    /// Duration of the scenario \[s\].
    pub duration_s: f64,
    /// Length of a car, which determines the zoom.
    pub car_m: f64,
    /// The vehicles, in the scenario's order.
    pub vehicles: Vec<StageVehicle>,
    /// The road, in the order in which it is painted.
    pub road: Vec<RoadShape>,
    pub lights: Vec<StageLight>,
    pub grass: String,
}

impl Stage {
    /// The world of a scenario with vehicles.
    pub fn of(scenario: &Scenario) -> Stage {
        let colours = vehicle_colours(scenario);
        let vehicles = scenario.vehicles.iter().zip(&colours);
        let (road, lights) = road::shapes(scenario);
        Stage {
            title: scenario.title.clone(),
            shows: scenario.shows.clone(),
            step_s: scenario.step_s,
            duration_s: scenario.duration_s,
            car_m: car_m(scenario),
            vehicles: vehicles.map(|(vehicle, colour)| StageVehicle::of(vehicle, colour.rgb)).collect(),
            road,
            lights,
            grass: css(GRASS),
        }
    }
}

/// A tick as a page shows it; lists have an entry for each vehicle.
#[derive(Clone, Debug, Serialize)]
pub struct StageFrame {
    /// x, y, heading and speed at the end of the tick.
    pub states: Vec<[f64; 4]>,
    /// Acceleration and steering angle during it.
    pub inputs: Vec<[f64; 2]>,
    pub absent: Vec<bool>,
    /// Whether the brake lights are on.
    pub brakes: Vec<bool>,
    /// The side of the active indicator.
    pub turn: Vec<Option<&'static str>>,
    /// Planned positions; empty for vehicles driven by people.
    pub plans: Vec<Vec<[f64; 2]>>,
    pub proposals: Vec<StageProposal>,
    pub beliefs: Vec<StageBelief>,
    pub events: Vec<StageEvent>,
}

/// The motion that a vehicle requests of another.
#[derive(Clone, Debug, Serialize)]
pub struct StageProposal {
    pub from: String,
    pub to: String,
    /// The positions of the motion \[m\].
    pub points: Vec<[f64; 2]>,
    /// Acceptance from 0 to 1, if it is known.
    pub share: Option<f64>,
}

/// The belief of a driver about another one.
#[derive(Clone, Debug, Serialize)]
pub struct StageBelief {
    /// The driver with the belief.
    pub of: String,
    /// The other driver.
    pub about: String,
    /// The probability that the other driver is nice.
    pub nice: f64,
    /// The belief in words.
    pub text: String,
}

/// An event.
#[derive(Clone, Debug, Serialize)]
pub struct StageEvent {
    pub vehicle: String,
    /// `note`, `warning` or `alarm`.
    pub level: &'static str,
    pub text: String,
}

/// Converts the frames of a run for a page. It keeps the open requests.
#[derive(Clone, Debug, Default)]
pub struct StageObserver {
    requests: Requests,
}

impl StageObserver {
    /// The frame before the first tick, without plans.
    pub fn initial(states: &[State]) -> StageFrame {
        let count = states.len();
        StageFrame {
            states: states.iter().map(|state| state.to_array()).collect(),
            inputs: vec![[0.0; 2]; count],
            absent: vec![false; count],
            brakes: vec![false; count],
            turn: vec![None; count],
            plans: vec![Vec::new(); count],
            proposals: Vec::new(),
            beliefs: Vec::new(),
            events: Vec::new(),
        }
    }

    /// Converts the frame of a tick with the states at its end. The vehicles in `hidden`, which people drive, have no plans.
    pub fn convert(&mut self, scenario: &Scenario, frame: &Frame, states: &[State], hidden: &[usize]) -> StageFrame {
        self.requests.observe(scenario, frame);
        let vehicles = || frame.vehicles.iter().enumerate();
        let plan = |(index, vehicle): (usize, &VehicleFrame)| -> Vec<[f64; 2]> {
            if hidden.contains(&index) || vehicle.is_absent {
                return Vec::new();
            }
            vehicle.plan.trajectory.states.iter().skip(1).map(State::position).collect()
        };
        let side = |(index, vehicle): (usize, &VehicleFrame)| {
            indicator_side(scenario, &scenario.vehicles[index], vehicle).map(|side| match side {
                IndicatorSide::Left => "left",
                IndicatorSide::Right => "right",
            })
        };
        let proposals = vehicles().flat_map(|(index, vehicle)| {
            self.requests.proposals(frame, index).map(|proposal| StageProposal {
                from: vehicle.name.clone(),
                to: proposal.to.clone(),
                points: proposal.trajectory.states.iter().map(State::position).collect(),
                share: proposal.acceptance,
            })
        });
        let beliefs = frame.vehicles.iter().flat_map(|vehicle| {
            vehicle.plan.beliefs.iter().map(|belief| StageBelief {
                of: vehicle.name.clone(),
                about: belief.vehicle.clone(),
                nice: belief.probabilities[2],
                text: format!("takes {} for {}", belief.vehicle, belief.model.name()),
            })
        });
        let events = frame.events.iter().filter_map(|event| Some((event, event_text(scenario, frame, event)?))).map(
            |(event, text)| StageEvent {
                vehicle: event.vehicle.clone(),
                level: match event.level {
                    Level::Note => "note",
                    Level::Warning => "warning",
                    Level::Alarm => "alarm",
                },
                text,
            },
        );
        StageFrame {
            states: states.iter().map(|state| state.to_array()).collect(),
            inputs: frame.vehicles.iter().map(|vehicle| vehicle.input.to_array()).collect(),
            absent: frame.vehicles.iter().map(|vehicle| vehicle.is_absent).collect(),
            brakes: frame.vehicles.iter().map(|vehicle| is_braking(vehicle.input.acceleration_mps2)).collect(),
            turn: vehicles().map(side).collect(),
            plans: vehicles().map(plan).collect(),
            proposals: proposals.collect(),
            beliefs: beliefs.collect(),
            events: events.collect(),
        }
    }
}
