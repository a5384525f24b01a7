//! A tick as a page shows it.

use interplay_planners::State;
use interplay_scenarios::Scenario;
use interplay_simulation::frame::{Frame, Level, VehicleFrame};
use serde::Serialize;

use crate::answer::Requests;
use crate::passing_words::event_text;
use crate::signals::{Turn, is_braking, turn};

/// A tick as a page shows it; lists have an entry for each vehicle.
#[derive(Clone, Debug, Serialize)]
pub struct StageMoment {
    /// x, y, heading and speed at the end of the tick.
    pub states: Vec<[f64; 4]>,
    /// Acceleration and steering angle during it.
    pub inputs: Vec<[f64; 2]>,
    /// Who is not on the road.
    pub absent: Vec<bool>,
    /// Whose brake lights are on.
    pub brakes: Vec<bool>,
    /// Which indicator is on.
    pub turn: Vec<Option<&'static str>>,
    /// Planned positions; empty of whom nothing is to be shown.
    pub plans: Vec<Vec<[f64; 2]>>,
    /// What one asks of another.
    pub proposals: Vec<StageProposal>,
    /// What one takes another for.
    pub beliefs: Vec<StageBelief>,
    /// What happened that is worth a line.
    pub events: Vec<StageEvent>,
}

/// The motion that a vehicle asks another for.
#[derive(Clone, Debug, Serialize)]
pub struct StageProposal {
    /// Who asks.
    pub from: String,
    /// Who is asked.
    pub to: String,
    /// The positions of the motion \[m\].
    pub points: Vec<[f64; 2]>,
    /// The share of it that is accepted, where that is known.
    pub share: Option<f64>,
}

/// What a driver takes another for.
#[derive(Clone, Debug, Serialize)]
pub struct StageBelief {
    /// Who believes it.
    pub of: String,
    /// Of whom.
    pub about: String,
    /// The probability that the other is nice.
    pub nice: f64,
    /// The same in words.
    pub text: String,
}

/// Something that happened.
#[derive(Clone, Debug, Serialize)]
pub struct StageEvent {
    /// Whose doing it is.
    pub vehicle: String,
    /// `note`, `warning` or `alarm`.
    pub level: &'static str,
    /// What happened, in words.
    pub text: String,
}

/// Whoever watches a run for a page: it remembers who was asked.
#[derive(Clone, Debug, Default)]
pub struct StageWitness {
    requests: Requests,
}

impl StageWitness {
    /// A moment at which nobody has planned yet.
    pub fn standing(states: &[State]) -> StageMoment {
        let count = states.len();
        StageMoment {
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

    /// The tick with the states at its end. Of the vehicles in `hidden` no plan is shown: people drive them.
    pub fn tick(&mut self, scenario: &Scenario, frame: &Frame, states: &[State], hidden: &[usize]) -> StageMoment {
        self.requests.tick(scenario, frame);
        let vehicles = || frame.vehicles.iter().enumerate();
        let plan = |(index, vehicle): (usize, &VehicleFrame)| -> Vec<[f64; 2]> {
            if hidden.contains(&index) || vehicle.is_absent {
                return Vec::new();
            }
            vehicle.plan.trajectory.states.iter().skip(1).map(State::position).collect()
        };
        let side = |(index, vehicle): (usize, &VehicleFrame)| {
            turn(scenario, &scenario.vehicles[index], vehicle).map(|turn| match turn {
                Turn::Left => "left",
                Turn::Right => "right",
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
        StageMoment {
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
