//! The run itself: ticks, wishes, and what is kept of it.

use std::collections::VecDeque;
use std::sync::Arc;

use interplay_planners::drivers::external;
use interplay_planners::{Driver, State};
use interplay_presentation::stage::{Stage, StageMoment, StageWitness};
use interplay_scenarios::{Scenario, Vehicle};
use interplay_simulation::frame::Frame;
use interplay_simulation::report::Report;
use interplay_simulation::{Simulation, Snapshot};

use super::error::SessionError;
use super::goal::{self, PlayGoal};
use super::seat::{Seat, Wish};

/// A moment to come back to is kept this often \[s\],
const KEEP_EVERY_S: f64 = 1.0;
/// and so many of them.
const MOST_KEPT: usize = 20;

/// A run in which people have some seats, with all that they did.
pub struct Session {
    name: String,
    /// As it is written, and with its seats driven from outside.
    written: Arc<Scenario>,
    scenario: Arc<Scenario>,
    seats: Vec<Seat>,
    world: Simulation,
    witness: StageWitness,
    kept: VecDeque<KeptMoment>,
    ticks: usize,
}

/// A moment to come back to.
struct KeptMoment {
    snapshot: Snapshot,
    seats: Vec<Seat>,
    witness: StageWitness,
    ticks: usize,
}

/// The vehicles of a scenario that a person can drive.
pub(crate) fn seats_of(scenario: &Scenario) -> Vec<String> {
    let is_seat = |vehicle: &&Vehicle| {
        vehicle.obstacle.is_none() && vehicle.driver.record().is_none() && vehicle.driver.kind() != "walker"
    };
    scenario.vehicles.iter().filter(is_seat).map(|vehicle| vehicle.name.clone()).collect()
}

/// The vehicles of seats of a scenario, called `name`, by index.
///
/// # Errors
/// [`SessionError::NoVehicles`]; [`SessionError::NoSeat`] if a seat is none.
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
    /// A session of a scenario, called `name`, before its first tick, with people in these seats.
    ///
    /// # Errors
    /// [`SessionError`] if a seat is none, or the world cannot be built.
    pub fn new(name: &str, scenario: &Scenario, seats: &[&str]) -> Result<Session, SessionError> {
        // Nobody sits in a building, and its days come after the drive.
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
            witness: StageWitness::default(),
            kept: VecDeque::new(),
            ticks: 0,
        };
        session.keep()?;
        Ok(session)
    }

    /// The name of the scenario.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The seats in which people are.
    pub fn seats(&self) -> impl Iterator<Item = &str> {
        self.seats.iter().map(|seat| seat.name.as_str())
    }

    /// The scenario as it is written.
    pub fn written(&self) -> &Scenario {
        &self.written
    }

    /// What is drawn of it.
    pub fn stage(&self) -> Stage {
        Stage::of(&self.scenario)
    }

    /// What a seat wants to reach.
    pub fn goal(&self, seat: &str) -> PlayGoal {
        goal::of(&self.written, self.written.index_of(seat).unwrap_or_default())
    }

    /// Simulated time so far \[s\].
    pub fn time_s(&self) -> f64 {
        self.ticks as f64 * self.scenario.step_s
    }

    /// Ticks so far.
    pub fn ticks(&self) -> usize {
        self.ticks
    }

    /// Whether the time of the scenario is over.
    pub fn is_over(&self) -> bool {
        self.ticks >= self.scenario.tick_count()
    }

    /// Whether everybody in a seat has reached the goal or touched somebody.
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

    /// The last tick; none before the first. Others are not kept: the run is repeated where they are needed.
    pub fn frame(&self) -> Option<&Frame> {
        self.world.frame()
    }

    /// What was measured so far.
    pub fn report(&self) -> Report {
        self.world.report()
    }

    /// What a person wishes from the next plan on.
    ///
    /// # Errors
    /// [`SessionError::NoSeat`].
    pub fn wish(&mut self, seat: &str, wish: Wish) -> Result<(), SessionError> {
        self.seat(seat)?.wish = wish;
        Ok(())
    }

    /// The number of the last wish of a seat that was applied, and who has its wheel.
    pub fn wheel(&self, seat: &str) -> (u64, Option<&str>) {
        let found = self.seats.iter().find(|candidate| candidate.name == seat);
        found.map_or((0, None), |seat| (seat.applied, seat.planner.as_deref()))
    }

    /// A planner takes the wheel of a seat from the next plan on, or the person again.
    ///
    /// # Errors
    /// [`SessionError::NoSeat`]; [`SessionError::NoPlanner`].
    pub fn hand_over(&mut self, seat: &str, to: Option<&str>) -> Result<(), SessionError> {
        if let Some(kind) = to.filter(|kind| Driver::of_kind(kind).is_none()) {
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

    /// One tick; none once the time of the scenario is over.
    ///
    /// # Errors
    /// [`SessionError::Run`] if the world cannot go on.
    pub fn tick(&mut self) -> Result<Option<StageMoment>, SessionError> {
        if self.is_over() {
            return Ok(None);
        }
        if self.ticks.is_multiple_of(self.scenario.ticks_per_plan) {
            let plan = self.ticks / self.scenario.ticks_per_plan;
            for seat in &mut self.seats {
                seat.decide(plan, &mut self.world)?;
            }
        }
        // Steps of a building between two ticks are no ticks.
        while self.world.step()?.is_some_and(|frame| frame.vehicles.is_empty()) {}
        self.ticks += 1;
        let Some(frame) = self.world.frame() else { return Ok(None) };
        let people = self.seats.iter().filter(|seat| seat.planner.is_none()).map(|seat| seat.vehicle);
        let moment = self.witness.tick(&self.scenario, frame, &self.world.states(), &people.collect::<Vec<_>>());
        let every = (KEEP_EVERY_S / self.scenario.step_s).round().max(1.0) as usize * self.scenario.ticks_per_plan;
        if self.ticks.is_multiple_of(every) {
            self.keep()?;
        }
        Ok(Some(moment))
    }

    fn keep(&mut self) -> Result<(), SessionError> {
        let (seats, witness) = (self.seats.clone(), self.witness.clone());
        self.kept.push_back(KeptMoment { snapshot: self.world.snapshot()?, seats, witness, ticks: self.ticks });
        if self.kept.len() > MOST_KEPT {
            // The start stays.
            self.kept.remove(1);
        }
        Ok(())
    }

    /// Goes back by at least so many seconds, or to the start. What was done since then was never done.
    ///
    /// # Errors
    /// [`SessionError::Run`] if the world cannot be resumed.
    pub fn rewind(&mut self, seconds: f64) -> Result<(), SessionError> {
        let until_s = self.time_s() - seconds.max(0.0);
        let step_s = self.scenario.step_s;
        let is_before = |kept: &KeptMoment| kept.ticks as f64 * step_s <= until_s + 1e-9;
        let place = self.kept.iter().rposition(is_before).unwrap_or(0);
        self.kept.truncate(place + 1);
        let Some(kept) = self.kept.back() else { return Ok(()) };
        self.world.restore(&kept.snapshot)?;
        let wishes: Vec<Wish> = self.seats.iter().map(|seat| seat.wish).collect();
        self.seats.clone_from(&kept.seats);
        for (seat, wish) in self.seats.iter_mut().zip(wishes) {
            seat.wish = wish;
        }
        self.witness = kept.witness.clone();
        self.ticks = kept.ticks;
        Ok(())
    }

    /// What was played until now as a scenario: `interplay run` gives the same run, digest for digest.
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
