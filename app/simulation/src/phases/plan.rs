//! Plan: every driver decides on what it has sensed and is told, in the order and with the fallbacks of
//! [`interplay_planners::traffic`]; here planning is timed, and failures become events.

use std::time::Instant;

use bevy_ecs::prelude::*;
use interplay_planners::PlanEventKind;
use interplay_planners::traffic::{Decision, Origin, RoadUser, Traffic};

use crate::phases::external;
use crate::state::components::{Committed, CurrentFrame, Driving, HandedIn, Identity, Sensed, VehicleParameters};
use crate::state::frame::{Event, Frame, Level};

/// Lets every driver decide.
pub fn plan(
    mut vehicles: Query<(&Identity, &mut Driving, &mut HandedIn, &mut VehicleParameters, &mut Committed)>,
    mut sensed: ResMut<Sensed>,
    mut current_frame: ResMut<CurrentFrame>,
) {
    let mut drivers: Vec<_> = vehicles.iter_mut().collect();
    drivers.sort_by_key(|(identity, ..)| identity.index);
    let (traffic, frame) = (&mut sensed.0, &mut current_frame.0);
    change_detail(drivers.iter_mut().map(|(_, driving, ..)| &mut **driving), traffic, frame);
    let decisions = traffic.plan(|index, scene| {
        let (_, driving, handed_in, ..) = &mut drivers[index];
        if let Some(handed_in) = handed_in.take() {
            return external::plan(handed_in, scene);
        }
        let Driving { planner, sight, .. } = &mut **driving;
        let sensed = sight.as_ref().map(|sight| sight.apply_to(scene));
        let began = Instant::now();
        let outcome = match &sensed {
            Some(sensed) => planner.plan_sensed(sensed),
            None => planner.plan(scene),
        };
        frame.vehicles[index].plan_ms = 1e3 * began.elapsed().as_secs_f64();
        outcome
    });
    for decision in decisions {
        note(&decision, frame);
        if decision.plan.events.iter().any(|event| event.kind == PlanEventKind::LeavesRecord) {
            drivers[decision.vehicle].3.record = None;
        }
        let vehicle = &mut frame.vehicles[decision.vehicle];
        vehicle.origin = decision.origin;
        vehicle.plan = decision.plan;
    }
    let seen = frame.vehicles.iter_mut().zip(&traffic.road_users);
    for ((vehicle, user), (.., committed)) in seen.zip(&mut drivers) {
        vehicle.prediction = user.agent.prediction.clone();
        vehicle.rules = user.agent.rules.clone();
        vehicle.urgency = user.agent.urgency;
        committed.0 = user.committed.clone();
    }
}

/// Lets those change their drivers who have come near the ego, or are near no more.
fn change_detail<'w>(drivers: impl Iterator<Item = &'w mut Driving>, traffic: &Traffic, frame: &mut Frame) {
    let there = |user: &RoadUser| (!user.is_absent).then_some(user.agent.state);
    let states: Vec<_> = traffic.road_users.iter().map(there).collect();
    for (index, driving) in drivers.enumerate() {
        let Some((planner, text)) = driving.detail.as_mut().and_then(|detail| detail.successor(index, &states)) else {
            continue;
        };
        driving.planner = planner;
        frame.events.push(Event { vehicle: frame.vehicles[index].name.clone(), level: Level::Note, text });
    }
}

/// Notes what a planner reports, or why it found no plan and what happens instead.
fn note(decision: &Decision, frame: &mut Frame) {
    let vehicle = &frame.vehicles[decision.vehicle].name;
    let event = |level, text| Event { vehicle: vehicle.clone(), level, text };
    frame.events.extend(decision.plan.events.iter().map(|happened| event(Level::Note, happened.text.clone())));
    if let Some(failure) = &decision.failure {
        let instead = match decision.origin {
            Origin::Continued => "continues its previous plan",
            Origin::Evading => "evades, which is less harmful than braking",
            _ => "brakes",
        };
        frame.events.push(event(Level::Warning, format!("no plan ({failure}); {instead}")));
    }
}
