//! The episode of an agent, and how it ended.

use std::f64::consts::TAU;

use interplay_planners::State;
use interplay_scenarios::{Scenario, Vehicle};

use super::reward::TermValues;
use super::{EnvironmentSettings, RewardTerm};
use crate::measure::{Measures, ObservedMoment, Subscriptions, VehicleMeasures, time_gap_s};
use crate::physics::gap_m;
use crate::state::frame::{Collision, Frame};

/// The metrics of an agent of which its reward and its ending are made; who is at fault stands in the contacts.
const METRICS: [&str; 5] = [EMERGENCIES, BROKEN, LEAVES_ROAD, ASTRIDE, "contacts_at_fault"];
const EMERGENCIES: &str = "emergency_braking";
const BROKEN: &str = "rules_broken";
const LEAVES_ROAD: &str = "leaves_road";
const ASTRIDE: &str = "astride_s";

impl EnvironmentSettings {
    /// What the rewards and endings of agents are made of, which are indices of vehicles; with a report, everything.
    pub(super) fn subscriptions(&self, agents: impl Iterator<Item = usize>) -> Subscriptions {
        if self.report {
            Subscriptions::everything()
        } else {
            Subscriptions::only(&METRICS, &agents.collect::<Vec<_>>())
        }
    }
}

/// How an episode ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// The vehicle reached its goal.
    Goal,
    /// The vehicle touched another one.
    Contact,
    /// A corner of the vehicle is off the road.
    OffRoad,
    /// The time of the scenario is over.
    Time,
}

impl Ending {
    /// The name of the ending.
    pub fn name(self) -> &'static str {
        match self {
            Ending::Goal => "goal",
            Ending::Contact => "contact",
            Ending::OffRoad => "off_road",
            Ending::Time => "time",
        }
    }
}

/// The episode of one agent.
#[derive(Clone, Debug, Default)]
pub struct Episode {
    /// The terms of the reward of the last decision, in the order of [`RewardTerm::ALL`].
    pub terms: TermValues,
    /// How it ended, if it did.
    pub ending: Option<Ending>,
    /// Number of decisions so far.
    pub decisions: usize,
    before: Counts,
}

/// Measures of a vehicle that terms of the reward count.
#[derive(Clone, Copy, Debug, Default)]
struct Counts {
    along_m: f64,
    emergencies: f64,
    broken: f64,
    astride_s: f64,
    acceleration_mps2: f64,
}

impl Episode {
    /// Whether the episode has ended.
    pub fn is_over(&self) -> bool {
        self.ending.is_some()
    }

    /// Whether an event ended the episode, and not its time limit.
    pub fn is_terminated(&self) -> bool {
        self.ending.is_some_and(|ending| ending != Ending::Time)
    }

    pub(super) fn begin_decision(&mut self) {
        self.terms = TermValues::default();
        self.decisions += 1;
    }

    /// The episode of a vehicle at its start.
    pub(super) fn begin(vehicle: &Vehicle, start: &State) -> Episode {
        let before = Counts { along_m: vehicle.route.along(start.position()), ..Counts::default() };
        Episode { before, ..Episode::default() }
    }

    /// Adds the terms of a tick, and sets the ending, if the episode ended.
    pub(super) fn observe(&mut self, scenario: &Scenario, index: usize, measures: &Measures, frame: &Frame) {
        let (vehicle, measured) = (&scenario.vehicles[index], &measures.vehicles[index]);
        let now = Counts {
            along_m: measures.along_m()[index],
            emergencies: measured.metrics.number(EMERGENCIES),
            broken: measured.metrics.number(BROKEN),
            astride_s: measured.metrics.number(ASTRIDE),
            acceleration_mps2: frame.vehicles[index].input.acceleration_mps2,
        };
        let wanted_mps = vehicle.target(&scenario.road).speed_mps;
        let full_mps = if wanted_mps > 0.0 { wanted_mps } else { vehicle.limits.speed_max_mps };
        let has_contact = frame.collisions.iter().any(|contact| contact.between.contains(&vehicle.name));
        let is_off_road = measured.metrics.number(LEAVES_ROAD) > 0.0;
        let reaches_goal = measured.completion.completed_s.is_some();
        let mut add = |term: RewardTerm, value: f64| self.terms[term as usize] += value;
        add(RewardTerm::Progress, (now.along_m - self.before.along_m) / full_mps);
        add(RewardTerm::HardBraking, now.emergencies - self.before.emergencies);
        add(RewardTerm::RuleBroken, now.broken - self.before.broken);
        add(RewardTerm::Gap, scenario.step_s * closeness(vehicle, index, &measures.vehicles, scenario, frame));
        add(RewardTerm::Goal, f64::from(reaches_goal));
        add(RewardTerm::Contact, f64::from(has_contact));
        add(RewardTerm::OffRoad, f64::from(is_off_road));
        let is_at_fault =
            |contact: &Collision| contact.fault.as_ref().is_some_and(|fault| fault.vehicle == vehicle.name);
        let (braking_mps2, speed_mps) = (vehicle.limits.acceleration_min_mps2.abs(), measured.last.speed_mps);
        let turned_rad = libm::remainder(measured.last.heading_rad - frame.vehicles[index].state.heading_rad, TAU);
        add(RewardTerm::Speed, scenario.step_s * (speed_mps / full_mps).clamp(0.0, 1.0));
        add(RewardTerm::Jerk, (now.acceleration_mps2 - self.before.acceleration_mps2).abs() / braking_mps2);
        add(RewardTerm::Lateral, (speed_mps * turned_rad).abs() / braking_mps2);
        add(RewardTerm::TimeGap, scenario.step_s * time_closeness(scenario, index, measures, frame));
        add(RewardTerm::Astride, now.astride_s - self.before.astride_s);
        add(RewardTerm::Fault, f64::from(frame.collisions.iter().any(is_at_fault)));
        self.before = now;
        self.ending = match (has_contact, is_off_road, reaches_goal) {
            (true, ..) => Some(Ending::Contact),
            (_, true, _) => Some(Ending::OffRoad),
            (.., true) => Some(Ending::Goal),
            _ => None,
        };
    }

    /// Ends the episode because the scenario is over.
    pub(super) fn time_is_over(&mut self) {
        self.ending = self.ending.or(Some(Ending::Time));
    }
}

/// By how much the time gap of a vehicle to its leader is below 1 s of a real car, as a share of that time.
fn time_closeness(scenario: &Scenario, index: usize, measures: &Measures, frame: &Frame) -> f64 {
    let states: Vec<State> = measures.vehicles.iter().map(|measured| measured.last).collect();
    let (vehicles, along_m) = (&scenario.vehicles, measures.along_m());
    let end = ObservedMoment { time_s: frame.time_s, vehicles, states: &states, along_m };
    let near_s = vehicles[index].body.real_ratio().sqrt();
    time_gap_s(frame, &end, index).map_or(0.0, |gap_s| (1.0 - gap_s / near_s).max(0.0))
}

/// By how much a vehicle is closer to the nearest other one than half the length of its body, as a share of that length.
fn closeness(vehicle: &Vehicle, index: usize, measured: &[VehicleMeasures], scenario: &Scenario, frame: &Frame) -> f64 {
    let near_m = 0.5 * (vehicle.body.front_m + vehicle.body.rear_m);
    let own = &measured[index].last;
    let others = scenario.vehicles.iter().zip(measured).enumerate().filter(|(other, (stated, measured))| {
        let reach_m = near_m
            + [&vehicle.body, &stated.body]
                .map(|body| body.front_m.max(body.rear_m) + body.width_m)
                .iter()
                .sum::<f64>();
        let [dx, dy] = [measured.last.x_m - own.x_m, measured.last.y_m - own.y_m];
        *other != index && !frame.vehicles[*other].is_absent && libm::hypot(dx, dy) < reach_m
    });
    let gaps_m = others.map(|(_, (stated, measured))| gap_m((&vehicle.body, own), (&stated.body, &measured.last)));
    gaps_m.map(|gap_m| (1.0 - gap_m / near_m).max(0.0)).fold(0.0, f64::max)
}
