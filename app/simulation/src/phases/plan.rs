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
/// All vehicles with what decides for them.
type Seats<'w, 's> = Query<'w, 's, (&'static TrafficRow, &'static mut Driving, &'static mut HandedIn)>;

/// Lets every driver decide. Decisions that do not depend on each other are made on all threads of [`DecidingThreads`], with the same bits
/// on any number.
pub fn plan(
    mut vehicles: Seats<'_, '_>,
    (fleet, threads): (Res<Fleet>, Res<DecidingThreads>),
    (measured, watchers): (Res<MeasuredParts>, Res<Watchers>),
    mut traffic: ResMut<CurrentTraffic>,
    mut current_frame: ResMut<CurrentFrame>,
) {
    let (traffic, frame) = (&mut traffic.0, &mut current_frame.0);
    change_detail(&mut vehicles, &fleet, &traffic.road_users, frame);
    let is_described = measured.plans || watchers.are_there();
    let mut asked = Asked { vehicles, fleet: &fleet.0, pool: threads.0.as_deref() };
    traffic.react(|traffic, rows, answers| {
        asked.answer(rows, answers, |row, seat| react(traffic, row, seat, is_described).ok());
    });
    if is_described {
        traffic.describe_reactions();
        let events =
            traffic.road_users.iter().filter(|user| user.reaction.is_some()).flat_map(|user| {
                user.plan.events.iter().map(|happened| (user.agent.name.clone(), happened.text.clone()))
            });
        frame.events.extend(events.map(|(vehicle, text)| Event { vehicle, level: Level::Note, text }));
    }
    let decisions = traffic.plan_in_sets(|traffic, rows| {
        let mut answers = Vec::with_capacity(rows.len());
        asked.answer(rows, &mut answers, |row, seat| decide(traffic, row, seat));
        answers
    });
    for decision in decisions {
        let user = &mut traffic.road_users[decision.vehicle];
        note(&decision, &user.agent.name, frame);
        if decision.plan.events.iter().any(|event| event.kind == PlanEventKind::LeavesRecord) {
            user.record = None;
        }
    }
}

/// The vehicles that are asked, and the threads on which they may answer.
struct Asked<'a, 'w, 's> {
    vehicles: Seats<'w, 's>,
    fleet: &'a [Entity],
    pool: Option<&'a rayon::ThreadPool>,
}

impl Asked<'_, '_, '_> {
    /// Adds an answer for each of some rows, in their order; answers in parallel if there are threads and several rows.
    fn answer<T: Send>(
        &mut self,
        rows: &[usize],
        answers: &mut Vec<T>,
        answer: impl Fn(usize, Option<&mut Seat<'_>>) -> T + Sync,
    ) {
        let Some(pool) = self.pool.filter(|_| rows.len() > 1) else {
            let fleet = self.fleet;
            let each = rows.iter().map(|row| answer(*row, self.vehicles.get_mut(fleet[*row]).ok().as_mut()));
            return answers.extend(each);
        };
        let mut seats: Vec<Option<Seat<'_>>> = (0..self.fleet.len()).map(|_| None).collect();
        for seat in &mut self.vehicles {
            let row = seat.0.0;
            seats[row] = Some(seat);
        }
        let mut chosen: Vec<_> = rows.iter().map(|row| (*row, seats[*row].take())).collect();
        pool.install(|| chosen.par_iter_mut().map(|(row, seat)| answer(*row, seat.as_mut())).collect_into_vec(answers));
    }
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
fn change_detail(vehicles: &mut Seats<'_, '_>, fleet: &Fleet, road_users: &[RoadUser], frame: &mut Frame) {
    if vehicles.iter().all(|(_, driving, _)| driving.detail.is_none()) {
        return;
    }
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
