//! Plan: every driver decides from what it has sensed and the plans that it knows, in the order and with the fallbacks of
//! [`interplay_planners::traffic`]; this phase measures planning times and turns failures into events.

use std::time::Instant;

use bevy_ecs::prelude::*;
use interplay_planners::traffic::{Decision, Origin, RoadUser};
use interplay_planners::{PlanError, PlanEventKind};

use crate::phases::external;
use crate::state::components::{CurrentFrame, CurrentTraffic, Driving, Fleet, HandedIn};
use crate::state::frame::{Event, Frame, Level};

/// Lets every driver decide.
pub fn plan(
    mut vehicles: Query<(&mut Driving, &mut HandedIn)>,
    fleet: Res<Fleet>,
    mut traffic: ResMut<CurrentTraffic>,
    mut current_frame: ResMut<CurrentFrame>,
) {
    let (traffic, frame) = (&mut traffic.0, &mut current_frame.0);
    change_detail(&mut vehicles, &fleet, &traffic.road_users, frame);
    let decisions = traffic.plan(|row, scene| {
        let Ok((mut driving, mut handed_in)) = vehicles.get_mut(fleet.0[row]) else {
            return Err(PlanError::BadInput("its entity was removed from the world".to_owned()));
        };
        if let Some(handed_in) = handed_in.take() {
            return external::plan(handed_in, scene);
        }
        let Driving { planner, sensor, sight, plan_ms, .. } = &mut *driving;
        let sensed = if scene.knowledge.is_of_motion() {
            sensor.as_mut().map(|sensor| sensor.sense(scene))
        } else {
            sight.as_ref().map(|sight| sight.apply_to(scene))
        };
        let began = Instant::now();
        let outcome = match &sensed {
            Some(sensed) => planner.plan_sensed(sensed),
            None => planner.plan(scene),
        };
        *plan_ms = 1e3 * began.elapsed().as_secs_f64();
        outcome
    });
    for decision in decisions {
        let user = &mut traffic.road_users[decision.vehicle];
        note(&decision, &user.agent.name, frame);
        if decision.plan.events.iter().any(|event| event.kind == PlanEventKind::LeavesRecord) {
            user.record = None;
        }
    }
}

/// Switches the drivers of vehicles that have come near the ego, or have moved away from it.
fn change_detail(
    vehicles: &mut Query<(&mut Driving, &mut HandedIn)>,
    fleet: &Fleet,
    road_users: &[RoadUser],
    frame: &mut Frame,
) {
    let states: Vec<_> = road_users.iter().map(|user| (!user.is_absent()).then_some(user.agent.state)).collect();
    for (row, entity) in fleet.0.iter().enumerate() {
        let Ok((mut driving, _)) = vehicles.get_mut(*entity) else { continue };
        let Some((planner, text)) = driving.detail.as_mut().and_then(|detail| detail.successor(row, &states)) else {
            continue;
        };
        driving.planner = planner;
        frame.events.push(Event { vehicle: road_users[row].agent.name.clone(), level: Level::Note, text });
    }
}

/// Logs a planner's report, or why it found no plan and which fallback applies.
fn note(decision: &Decision, vehicle: &str, frame: &mut Frame) {
    let event = |level, text| Event { vehicle: vehicle.to_owned(), level, text };
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
