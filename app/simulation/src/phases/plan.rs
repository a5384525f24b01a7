//! Plan: every driver decides from what it has sensed and the plans that it knows, in the order and with the fallbacks of
//! [`interplay_planners::traffic`]; this phase measures planning times and turns failures into events.

use std::time::Instant;

use bevy_ecs::prelude::*;
use interplay_planners::drivers::reaction::Reaction;
use interplay_planners::traffic::{Decided, Decision, Origin, RoadUser, Traffic};
use interplay_planners::{Plan, PlanError, PlanEventKind, Scene};
use rayon::prelude::*;

use crate::phases::external;
use crate::phases::watch::Watchers;
use crate::state::components::{
    CurrentFrame, CurrentTraffic, DecidingThreads, Driving, Fleet, HandedIn, MeasuredParts, TrafficRow,
};
use crate::state::frame::{Event, Frame, Level};

/// A vehicle with what decides for it.
type Seat<'a> = (&'a TrafficRow, Mut<'a, Driving>, Mut<'a, HandedIn>);

/// Lets every driver decide. Decisions that do not depend on each other are made on all threads of [`DecidingThreads`], with the same bits
/// on any number.
pub fn plan(
    mut vehicles: Query<(&TrafficRow, &mut Driving, &mut HandedIn)>,
    (fleet, threads): (Res<Fleet>, Res<DecidingThreads>),
    (measured, watchers): (Res<MeasuredParts>, Res<Watchers>),
    mut traffic: ResMut<CurrentTraffic>,
    mut current_frame: ResMut<CurrentFrame>,
) {
    let (traffic, frame) = (&mut traffic.0, &mut current_frame.0);
    change_detail(&mut vehicles, &fleet, &traffic.road_users, frame);
    let mut seats: Vec<Option<Seat<'_>>> = (0..traffic.road_users.len()).map(|_| None).collect();
    for seat in &mut vehicles {
        let row = seat.0.0;
        seats[row] = Some(seat);
    }
    let is_described = measured.plans || watchers.are_there();
    traffic
        .react(|traffic, rows| each(&mut seats, rows, &threads, |row, seat| react(traffic, row, seat, is_described)));
    if is_described {
        traffic.describe_reactions();
        let events =
            traffic.road_users.iter().filter(|user| user.reaction.is_some()).flat_map(|user| {
                user.plan.events.iter().map(|happened| (user.agent.name.clone(), happened.text.clone()))
            });
        frame.events.extend(events.map(|(vehicle, text)| Event { vehicle, level: Level::Note, text }));
    }
    let decisions =
        traffic.plan_in_sets(|traffic, rows| each(&mut seats, rows, &threads, |row, seat| decide(traffic, row, seat)));
    for decision in decisions {
        let user = &mut traffic.road_users[decision.vehicle];
        note(&decision, &user.agent.name, frame);
        if decision.plan.events.iter().any(|event| event.kind == PlanEventKind::LeavesRecord) {
            user.record = None;
        }
    }
}

/// Does something for each of some rows, in parallel if there are threads and several rows; answers in the order of the rows.
fn each<T: Send>(
    seats: &mut [Option<Seat<'_>>],
    rows: &[usize],
    threads: &DecidingThreads,
    answer: impl Fn(usize, Option<&mut Seat<'_>>) -> T + Sync,
) -> Vec<T> {
    let Some(pool) = threads.0.as_ref().filter(|_| rows.len() > 1) else {
        return rows.iter().map(|row| answer(*row, seats[*row].as_mut())).collect();
    };
    let mut free: Vec<Option<&mut Option<Seat<'_>>>> = seats.iter_mut().map(Some).collect();
    let chosen: Vec<_> = rows.iter().map(|row| (*row, free[*row].take())).collect();
    let answered = |(row, seat): (usize, Option<&mut Option<Seat<'_>>>)| answer(row, seat.and_then(Option::as_mut));
    pool.install(|| chosen.into_par_iter().map(answered).collect())
}

/// Why a vehicle cannot decide whose entity is gone.
fn removed() -> PlanError {
    PlanError::BadInput("its entity was removed from the world".to_owned())
}

/// The answer of a driver that reacts.
fn react(traffic: &Traffic, row: usize, seat: Option<&mut Seat<'_>>, is_timed: bool) -> Result<Reaction, PlanError> {
    let Some((_, driving, _)) = seat else { return Err(removed()) };
    if !driving.planner.reacts() {
        // Its driver has changed since it was asked.
        return Err(PlanError::NoInput);
    }
    let began = is_timed.then(Instant::now);
    let reaction = traffic.at_moment(row, |moment| driving.planner.react(moment));
    driving.plan_ms = began.map_or(0.0, |began| 1e3 * began.elapsed().as_secs_f64());
    reaction
}

/// What a driver decides that plans, or the caller for it.
fn decide(traffic: &Traffic, row: usize, seat: Option<&mut Seat<'_>>) -> Decided {
    let Some((_, driving, handed_in)) = seat else { return traffic.decide(row, |_, _| Err(removed())) };
    traffic.decide(row, |_, scene| match handed_in.take() {
        Some(handed_in) => external::plan(handed_in, scene),
        None => planned(driving, scene),
    })
}

fn planned(driving: &mut Driving, scene: &Scene) -> Result<Plan, PlanError> {
    let Driving { planner, sensor, sight, plan_ms, .. } = driving;
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
}

/// Switches the drivers of vehicles that have come near the ego, or have moved away from it.
fn change_detail(
    vehicles: &mut Query<(&TrafficRow, &mut Driving, &mut HandedIn)>,
    fleet: &Fleet,
    road_users: &[RoadUser],
    frame: &mut Frame,
) {
    let states: Vec<_> = road_users.iter().map(|user| (!user.is_absent()).then_some(user.agent.state)).collect();
    for (row, entity) in fleet.0.iter().enumerate() {
        let Ok((_, mut driving, _)) = vehicles.get_mut(*entity) else { continue };
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
