//! The run of a session: ticks, controls, and snapshots for rewinding.

use std::collections::VecDeque;
use std::sync::Arc;

use interplay_planners::drivers::external;
use interplay_planners::{Driver, State};
use interplay_presentation::stage::{Stage, StageFrame, StageObserver};
use interplay_scenarios::{Scenario, Vehicle};
use interplay_simulation::frame::Frame;
use interplay_simulation::report::Report;
use interplay_simulation::{Simulation, Snapshot};
use serde::Serialize;

use super::seat::{Controls, Seat, SessionError};

/// Interval between rewind snapshots \[s\].
const SNAPSHOT_INTERVAL_S: f64 = 1.0;
const MAX_SNAPSHOTS: usize = 20;

/// A run with people in some seats, and the record of their inputs.
pub struct Session {
    name: String,
    written: Arc<Scenario>,
    /// The scenario with its seats driven from outside.
    scenario: Arc<Scenario>,
    seats: Vec<Seat>,
    world: Simulation,
    observer: StageObserver,
    snapshots: VecDeque<RewindSnapshot>,
    ticks: usize,
}

/// A state that the run can be rewound to.
struct RewindSnapshot {
    snapshot: Snapshot,
    seats: Vec<Seat>,
    observer: StageObserver,
    ticks: usize,
}

/// The vehicles of a scenario that a person can drive.
pub(crate) fn seats_of(scenario: &Scenario) -> Vec<String> {
    let is_seat = |vehicle: &&Vehicle| {
        vehicle.obstacle.is_none() && vehicle.driver.record().is_none() && vehicle.driver.can_be_replaced()
    };
    scenario.vehicles.iter().filter(is_seat).map(|vehicle| vehicle.name.clone()).collect()
}

/// Checks the named seats of the scenario called `name`, and returns the indices of their vehicles.
///
/// # Errors
/// [`SessionError::NoVehicles`]; [`SessionError::NoSeat`] if a seat does not exist.
pub fn check_seats(name: &str, scenario: &Scenario, seats: &[&str]) -> Result<Vec<usize>, SessionError> {
    let possible = seats_of(scenario);
    if possible.is_empty() {
        return Err(SessionError::NoVehicles(name.to_owned()));
    }
    let index = |seat: &&str| {
        let found = possible.iter().any(|name| name == seat).then(|| scenario.index_of(seat)).flatten();
        found.ok_or_else(|| SessionError::NoSeat { seat: (*seat).to_owned(), seats: possible.join(", ") })
    };
    seats.iter().map(index).collect()
}

impl Session {
    /// A session of the scenario called `name`, before its first tick, with people in these seats.
    ///
    /// # Errors
    /// [`SessionError`] if a seat does not exist, or the simulation cannot be built.
    pub fn new(name: &str, scenario: &Scenario, seats: &[&str]) -> Result<Session, SessionError> {
        // A session simulates only the vehicles: the days of a building would come after the drive.
        let written = scenario.clone().without_counterfactuals().without_building();
        let indices = check_seats(name, &written, seats)?;
        let mut played = written.clone();
        for index in &indices {
            played.vehicles[*index].driver = Driver::External(external::Settings::default());
        }
        let world = Simulation::watched(name, &played, Vec::new())?;
        let mut session = Session {
            name: name.to_owned(),
            seats: indices.iter().zip(seats).map(|(index, name)| Seat::new(*index, name)).collect(),
            written: Arc::new(written),
            scenario: Arc::new(played),
            world,
            observer: StageObserver::default(),
            snapshots: VecDeque::new(),
            ticks: 0,
        };
        session.take_snapshot()?;
        Ok(session)
    }

    pub fn name(&self) -> &str {
        &self.name
    }

    pub fn seats(&self) -> impl Iterator<Item = &str> {
        self.seats.iter().map(|seat| seat.name.as_str())
    }

    /// The scenario without the recorded inputs of people.
    pub fn written(&self) -> &Scenario {
        &self.written
    }

    /// The world as a page draws it.
    pub fn stage(&self) -> Stage {
        Stage::of(&self.scenario)
    }

    pub fn goal(&self, seat: &str) -> PlayGoal {
        of(&self.written, self.written.index_of(seat).unwrap_or_default())
    }

    /// Simulated time so far \[s\].
    pub fn time_s(&self) -> f64 {
        self.ticks as f64 * self.scenario.step_s
    }

    /// Ticks so far.
    pub fn ticks(&self) -> usize {
        self.ticks
    }

    /// Whether the duration of the scenario has passed.
    pub fn is_over(&self) -> bool {
        self.ticks >= self.scenario.tick_count()
    }

    /// Whether every seat has reached its goal or has had a contact.
    pub fn is_decided(&self) -> bool {
        let measures = self.world.measures();
        let is_done = |seat: &Seat| {
            let has_contact = measures.collisions.iter().any(|contact| contact.between.contains(&seat.name));
            measures.vehicles[seat.vehicle].completion.completed_s.is_some() || has_contact
        };
        !self.seats.is_empty() && self.seats.iter().all(is_done)
    }

    /// The states of all vehicles now.
    pub fn states(&self) -> Vec<State> {
        self.world.states()
    }

    /// The frame of the last tick; `None` before the first tick.
    pub fn frame(&self) -> Option<&Frame> {
        self.world.frame()
    }

    /// The report of the run so far.
    pub fn report(&self) -> Report {
        self.world.report()
    }

    /// Sets the controls of a seat from the next plan on.
    ///
    /// # Errors
    /// [`SessionError::NoSeat`].
    pub fn set_controls(&mut self, seat: &str, controls: Controls) -> Result<(), SessionError> {
        self.seat(seat)?.controls = controls;
        Ok(())
    }

    /// The number of the last applied controls of a seat, and the planner at its wheel.
    pub fn wheel(&self, seat: &str) -> (u64, Option<&str>) {
        let found = self.seats.iter().find(|candidate| candidate.name == seat);
        found.map_or((0, None), |seat| (seat.applied, seat.planner.as_deref()))
    }

    /// Hands the wheel of a seat to a planner, or back to the person, from the next plan on.
    ///
    /// # Errors
    /// [`SessionError::NoSeat`]; [`SessionError::NoPlanner`].
    pub fn hand_over(&mut self, seat: &str, to: Option<&str>) -> Result<(), SessionError> {
        if let Some(kind) = to.filter(|kind| Driver::at_wheel(kind).is_none()) {
            return Err(SessionError::NoPlanner(kind.to_owned()));
        }
        self.seat(seat)?.handed_to = Some(to.map(str::to_owned));
        Ok(())
    }

    fn seat(&mut self, name: &str) -> Result<&mut Seat, SessionError> {
        let names: Vec<String> = self.seats.iter().map(|seat| seat.name.clone()).collect();
        let found = self.seats.iter_mut().find(|seat| seat.name == name);
        found.ok_or_else(|| SessionError::NoSeat { seat: name.to_owned(), seats: names.join(", ") })
    }

    /// Makes one tick. Returns `None` after the duration of the scenario.
    ///
    /// # Errors
    /// [`SessionError::Run`] if the simulation fails.
    pub fn tick(&mut self) -> Result<Option<StageFrame>, SessionError> {
        if self.is_over() {
            return Ok(None);
        }
        if self.ticks.is_multiple_of(self.scenario.ticks_per_plan) {
            let plan = self.ticks / self.scenario.ticks_per_plan;
            for seat in &mut self.seats {
                seat.decide(plan, &mut self.world)?;
            }
        }
        // Steps of a building between two ticks do not count.
        while self.world.step()?.is_some_and(|frame| frame.vehicles.is_empty()) {}
        self.ticks += 1;
        let Some(frame) = self.world.frame() else { return Ok(None) };
        let people = self.seats.iter().filter(|seat| seat.planner.is_none()).map(|seat| seat.vehicle);
        let stage_frame =
            self.observer.convert(&self.scenario, frame, &self.world.states(), &people.collect::<Vec<_>>());
        let every =
            (SNAPSHOT_INTERVAL_S / self.scenario.step_s).round().max(1.0) as usize * self.scenario.ticks_per_plan;
        if self.ticks.is_multiple_of(every) {
            self.take_snapshot()?;
        }
        Ok(Some(stage_frame))
    }

    fn take_snapshot(&mut self) -> Result<(), SessionError> {
        let (seats, observer) = (self.seats.clone(), self.observer.clone());
        self.snapshots.push_back(RewindSnapshot {
            snapshot: self.world.snapshot()?,
            seats,
            observer,
            ticks: self.ticks,
        });
        if self.snapshots.len() > MAX_SNAPSHOTS {
            // The snapshot of the start is kept.
            self.snapshots.remove(1);
        }
        Ok(())
    }

    /// Rewinds by at least this many seconds, or to the start. Later inputs are discarded.
    ///
    /// # Errors
    /// [`SessionError::Run`] if the simulation cannot be resumed.
    pub fn rewind(&mut self, seconds: f64) -> Result<(), SessionError> {
        let until_s = self.time_s() - seconds.max(0.0);
        let step_s = self.scenario.step_s;
        let is_before = |kept: &RewindSnapshot| kept.ticks as f64 * step_s <= until_s + 1e-9;
        let place = self.snapshots.iter().rposition(is_before).unwrap_or(0);
        self.snapshots.truncate(place + 1);
        let Some(kept) = self.snapshots.back() else { return Ok(()) };
        self.world.restore(&kept.snapshot)?;
        let controls: Vec<Controls> = self.seats.iter().map(|seat| seat.controls).collect();
        self.seats.clone_from(&kept.seats);
        for (seat, controls) in self.seats.iter_mut().zip(controls) {
            seat.controls = controls;
        }
        self.observer = kept.observer.clone();
        self.ticks = kept.ticks;
        Ok(())
    }

    /// The run so far as a scenario, which `interplay run` repeats bit for bit.
    pub fn played(&self) -> Scenario {
        let mut played = (*self.scenario).clone();
        for seat in &self.seats {
            played.vehicles[seat.vehicle].driver = Driver::Inputs(seat.record.clone());
        }
        let seats = self.seats().collect::<Vec<_>>().join(", ");
        played.title = format!("{} (played as {seats})", self.written.title);
        played.duration_s = self.time_s().max(self.scenario.step_s);
        played.expect = Default::default();
        played
    }
}

/// The goal of a person in a seat.
#[derive(Clone, Debug, Serialize)]
pub struct PlayGoal {
    /// `lane`, `cross`, `last-lane` or `drive`.
    pub kind: &'static str,
    pub text: String,
    /// The line to cross \[m\].
    pub line: Option<[[f64; 2]; 2]>,
    /// The middle of the lane to reach \[m\].
    pub lane: Option<Vec<[f64; 2]>>,
}

/// Length of the mark of a lane, in lengths of the vehicle.
const MARK_LENGTHS: f64 = 30.0;

const MARK_POINTS: usize = 24;

pub(super) fn of(scenario: &Scenario, index: usize) -> PlayGoal {
    let vehicle = &scenario.vehicles[index];
    let route = &vehicle.route;
    let start_m = [route.along(vehicle.start.position()), route.across(vehicle.start.position())];
    let line = |along_m: f64| {
        let half_m = route.half_width.value(along_m).max(0.5 * scenario.road.lane_width_m());
        Some([-half_m, half_m].map(|across_m| route.position(along_m, across_m)))
    };
    if let Some([_, end_m]) = scenario.road.conflict_zone_m(vehicle.road) {
        let text = "Cross the other road".to_owned();
        return PlayGoal { kind: "cross", text, line: line(end_m + vehicle.body.rear_m), lane: None };
    }
    let last = route.legs.last().filter(|_| scenario.road.parallel_lanes().is_none() && route.legs.len() > 1);
    if let Some(leg) = last {
        let text = format!("Drive to the end of your route: {}", leg.lane.replace(['-', '_'], " "));
        return PlayGoal { kind: "last-lane", text, line: line(leg.from_m + vehicle.body.rear_m), lane: None };
    }
    let across_m = route.across(vehicle.target(&scenario.road).position());
    let is_elsewhere = (across_m - start_m[1]).abs() > 0.5 * vehicle.body.width_m;
    let text = match (is_elsewhere, across_m > start_m[1]) {
        (false, _) => "Stay in your lane and drive on. Other drivers may want to merge: let them in or not".to_owned(),
        (true, true) => "Change to the lane on your left".to_owned(),
        (true, false) => "Change to the lane on your right".to_owned(),
    };
    let lane = is_elsewhere.then(|| mark(vehicle, start_m[0], across_m));
    PlayGoal { kind: if is_elsewhere { "lane" } else { "drive" }, text, line: None, lane }
}

/// The middle of a lane, from beside the start on \[m\].
fn mark(vehicle: &Vehicle, from_m: f64, across_m: f64) -> Vec<[f64; 2]> {
    let reach_m = MARK_LENGTHS * (vehicle.body.front_m + vehicle.body.rear_m);
    let place = |place: usize| from_m + reach_m * place as f64 / MARK_POINTS as f64;
    (0..=MARK_POINTS).map(|at| vehicle.route.position(place(at), across_m)).collect()
}
