//! Measures how long vehicles that want to move are stationary, for which vehicles they wait, and which are deadlocked ([`Standing`]).

use std::collections::{BTreeMap, BTreeSet};

use interplay_planners::PassingSide;
use interplay_scenarios::Scenario;
use serde::Serialize;

use crate::state::components::to_nanosecond;
use crate::state::frame::{Event, Frame, Level};
use crate::state::standing::{Standing, StandingReason};

/// Shorter stops are not reported, for a real car \[s\].
const LEAST_S: f64 = 0.5;
/// Vehicles that wait for one another this long are deadlocked, for a real car \[s\]: setting off takes a moment.
const CIRCLE_S: f64 = 3.0;
/// A vehicle that stands this long without a visible reason is stuck, for a real car \[s\].
pub(super) const STUCK_S: f64 = 10.0;

/// A vehicle that stands at most this long after its reason has ended is setting off, for a real car \[s\].
const SETTING_OFF_S: f64 = 2.0;
/// Reasons are recorded for vehicles below this speed, for a real car \[m/s\].
const SLOW_MPS: f64 = 2.0;

/// Total time for which a vehicle stood for one reason.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Wait {
    /// Duration \[s\].
    pub waited_s: f64,
    /// The vehicles for which it waited; empty if there were none.
    pub waits_for: Vec<String>,
    /// The reason, or the last one before it sets off, in a few words: `priority`, `sign`, `traffic light`, `ahead of it`,
    /// `in its way`, `to leave the passage`, `before it passes van`, `no room beside van`, `does not pass van`,
    /// `they wait for each other`, `lets ego pass`, `after a collision`, `as its script says`, or `no reason found`.
    pub reason: String,
}

/// Vehicles that are deadlocked.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Deadlock {
    /// Time at which the deadlock was detected \[s\].
    pub time_s: f64,
    /// The deadlocked vehicles: all that wait for one another, or one that stands without a visible reason.
    pub vehicles: Vec<String>,
    /// What is wrong, in a few words, as of [`Wait::reason`].
    pub reason: String,
}

/// Measures of stationary vehicles.
#[derive(Clone, Debug)]
pub struct Waits {
    /// Scale of times of each vehicle relative to a real car: the square root of that of lengths.
    times: Vec<f64>,
    /// For each vehicle, how long it stood, by reason.
    waited: Vec<Vec<Wait>>,
    /// For each vehicle, its last visible reason to stop, and when \[s\].
    last: Vec<Option<(StandingReason, f64)>>,
    /// How long each set of vehicles has waited for one another \[s\].
    circles_s: BTreeMap<Vec<usize>, f64>,
    /// How long each vehicle has stood without a visible reason \[s\].
    unexplained_s: Vec<f64>,
    /// The names of the vehicles that each has touched.
    touched: Vec<BTreeSet<String>>,
    deadlocks: Vec<Deadlock>,
}

impl Wait {
    /// In words: `waited 6.4 s for ring (priority)`.
    pub fn sentence(&self) -> String {
        let Wait { waited_s, waits_for, reason } = self;
        match waits_for.as_slice() {
            [] => format!("stood {waited_s:.1} s ({reason})"),
            names => format!("waited {waited_s:.1} s for {} ({reason})", names.join(", ")),
        }
    }
}

impl Deadlock {
    /// In words: `ego and ring wait for each other`.
    pub fn sentence(&self) -> String {
        match self.vehicles.as_slice() {
            [only] => format!("{only} stands ({})", self.reason),
            names => format!("{} wait for each other", names.join(" and ")),
        }
    }
}

const IN_A_CIRCLE: &str = "they wait for each other";
const UNEXPLAINED: &str = "no reason found";
const AFTER_COLLISION: &str = "after a collision";

/// Why a vehicle stands that neither rules nor other vehicles stop: it lets a moving vehicle pass, it does not pass a stationary one, or
/// no reason is found.
fn own_reason(standing: &Standing<'_>, frame: &Frame, index: usize) -> String {
    let behind = frame.vehicles[index].plan.homotopy_class.iter().filter(|passing| passing.side == PassingSide::Behind);
    let (stationary, moving): (Vec<&str>, Vec<&str>) =
        behind.map(|passing| passing.of.as_str()).partition(|name| standing.stationary(name).is_some());
    match (moving.as_slice(), stationary.as_slice()) {
        ([], []) => UNEXPLAINED.to_owned(),
        ([], [obstacle, ..]) => {
            let is_walled = standing.stationary(obstacle).is_some_and(|other| standing.is_walled(index, other));
            if is_walled { format!("no room beside {obstacle}") } else { format!("does not pass {obstacle}") }
        }
        (moving, _) => format!("lets {} pass", moving.join(", ")),
    }
}

/// The vehicles for which a vehicle waits, and the reason in words.
fn words(reason: &StandingReason) -> (Vec<String>, String) {
    match reason {
        StandingReason::Sign => (Vec::new(), "sign".to_owned()),
        StandingReason::Light => (Vec::new(), "traffic light".to_owned()),
        StandingReason::GivesWay(names) => (names.clone(), "priority".to_owned()),
        StandingReason::Behind(name) => (vec![name.clone()], "ahead of it".to_owned()),
        StandingReason::Passage(name) => (vec![name.clone()], "to leave the passage".to_owned()),
        StandingReason::InWay(name) => (vec![name.clone()], "in its way".to_owned()),
        StandingReason::Passing { waits_for, obstacle } => {
            (vec![waits_for.clone()], format!("before it passes {obstacle}"))
        }
        StandingReason::NoRoom(name) => (Vec::new(), format!("no room beside {name}")),
    }
}

impl Waits {
    /// Measures before the first stop.
    pub fn new(scenario: &Scenario) -> Self {
        let times: Vec<f64> = scenario.vehicles.iter().map(|vehicle| vehicle.body.real_ratio().sqrt()).collect();
        Waits {
            waited: vec![Vec::new(); times.len()],
            last: vec![None; times.len()],
            circles_s: BTreeMap::new(),
            unexplained_s: vec![0.0; times.len()],
            touched: vec![BTreeSet::new(); times.len()],
            deadlocks: Vec::new(),
            times,
        }
    }

    /// Updates the measures with a tick; returns the events that begin in it.
    pub fn observe(&mut self, standing: &Standing<'_>, frame: &Frame, step_s: f64) -> Vec<Event> {
        let mut circles: BTreeSet<Vec<usize>> = BTreeSet::new();
        let known = self.deadlocks.len();
        self.note_contacts(frame);
        for index in 0..self.times.len() {
            let mut is_unexplained = false;
            let is_slow = frame.vehicles[index].state.speed_mps < SLOW_MPS * self.times[index];
            let shown = if is_slow { standing.plain_reason(index) } else { None };
            let is_excused = standing.told_by(index).is_some() || !self.touched[index].is_empty();
            let shows_none = shown.is_none() && !is_excused;
            self.last[index] = shown.map(|reason| (reason, frame.time_s)).or_else(|| self.last[index].take());
            if standing.stands(index) {
                let circle = standing.reason(index).map_or_else(|| standing.circle(index), |_| Vec::new());
                let is_crash = circle.iter().any(|vehicle| !self.touched[*vehicle].is_empty());
                let circle = if is_crash { Vec::new() } else { circle };
                is_unexplained = shows_none;
                let (waits_for, reason) = self.wait(standing, frame, index, &circle);
                let before_s = self.unexplained_s[index];
                if is_unexplained && passes(before_s, before_s + step_s, STUCK_S * self.times[index]) {
                    self.deadlocks.push(deadlock(frame, step_s, &[index], &reason));
                }
                self.add(index, waits_for, reason, step_s);
                circles.extend(Some(circle).filter(|circle| !circle.is_empty()));
            }
            self.unexplained_s[index] = if is_unexplained { self.unexplained_s[index] + step_s } else { 0.0 };
        }
        self.close(circles, frame, step_s);
        self.deadlocks[known..].iter().map(event).collect()
    }

    /// Updates how long vehicles have waited for one another.
    fn close(&mut self, circles: BTreeSet<Vec<usize>>, frame: &Frame, step_s: f64) {
        self.circles_s.retain(|circle, _| circles.contains(circle));
        for circle in circles {
            let waited_s = self.circles_s.get(&circle).copied().unwrap_or(0.0);
            if passes(waited_s, waited_s + step_s, CIRCLE_S * self.times[circle[0]]) {
                self.deadlocks.push(deadlock(frame, step_s, &circle, IN_A_CIRCLE));
            }
            self.circles_s.insert(circle, waited_s + step_s);
        }
    }

    /// The vehicles for which a vehicle waits, and why. A vehicle that waits for a deadlocked one is not deadlocked itself.
    fn wait(&self, standing: &Standing<'_>, frame: &Frame, index: usize, circle: &[usize]) -> (Vec<String>, String) {
        if let Some(told_by) = standing.told_by(index) {
            return (Vec::new(), told_by.to_owned());
        }
        let setting_off_s = SETTING_OFF_S * self.times[index];
        match &self.last[index] {
            Some((reason, _)) if self.is_of_crash(index, reason) => (Vec::new(), AFTER_COLLISION.to_owned()),
            Some((reason, at_s)) if circle.is_empty() && frame.time_s - at_s <= setting_off_s => words(reason),
            Some(_) if !circle.is_empty() => {
                let others = circle.iter().filter(|other| **other != index);
                (others.map(|other| name(frame, *other)).collect(), IN_A_CIRCLE.to_owned())
            }
            _ if !self.touched[index].is_empty() => (Vec::new(), AFTER_COLLISION.to_owned()),
            _ => (Vec::new(), own_reason(standing, frame, index)),
        }
    }

    /// Records which vehicles touch.
    fn note_contacts(&mut self, frame: &Frame) {
        for [first, second] in frame.collisions.iter().map(|collision| &collision.between) {
            for (own, other) in [(first, second), (second, first)] {
                let index = frame.vehicles.iter().position(|vehicle| vehicle.name == *own);
                if let Some(index) = index {
                    self.touched[index].insert(other.clone());
                }
            }
        }
    }

    /// Whether a reason names only vehicles that this one has touched.
    fn is_of_crash(&self, index: usize, reason: &StandingReason) -> bool {
        let touched = &self.touched[index];
        let names = reason.waits_for();
        !names.is_empty() && names.iter().all(|name| touched.contains(*name))
    }

    fn add(&mut self, index: usize, waits_for: Vec<String>, reason: String, step_s: f64) {
        let waited = &mut self.waited[index];
        match waited.iter_mut().find(|wait| wait.waits_for == waits_for && wait.reason == reason) {
            Some(wait) => wait.waited_s = to_nanosecond(wait.waited_s + step_s),
            None => waited.push(Wait { waited_s: step_s, waits_for, reason }),
        }
    }

    /// The waits of a vehicle, in the order in which they began; short stops are left out.
    pub fn of(&self, vehicle: usize) -> Vec<Wait> {
        let least_s = LEAST_S * self.times[vehicle];
        self.waited[vehicle].iter().filter(|wait| wait.waited_s >= least_s).cloned().collect()
    }

    /// All deadlocks, in order of time.
    pub fn deadlocks(&self) -> &[Deadlock] {
        &self.deadlocks
    }
}

fn passes(before_s: f64, after_s: f64, bound_s: f64) -> bool {
    before_s <= bound_s && after_s > bound_s
}

fn name(frame: &Frame, vehicle: usize) -> String {
    frame.vehicles[vehicle].name.clone()
}

fn deadlock(frame: &Frame, step_s: f64, vehicles: &[usize], reason: &str) -> Deadlock {
    let vehicles = vehicles.iter().map(|vehicle| name(frame, *vehicle)).collect();
    Deadlock { time_s: to_nanosecond(frame.time_s + step_s), vehicles, reason: reason.to_owned() }
}

fn event(deadlock: &Deadlock) -> Event {
    let sentence = deadlock.sentence();
    let vehicle = deadlock.vehicles.first().cloned().unwrap_or_default();
    let text = sentence.strip_prefix(&vehicle).unwrap_or(&sentence).trim_start().to_owned();
    Event { vehicle, level: Level::Warning, text: format!("{text}: a deadlock") }
}

#[cfg(test)]
mod tests {
    use interplay_planners::rules::RoadRules;
    use interplay_scenarios::{Scenario, load};

    use crate::state::frame::{Collision, VehicleFrame};

    use super::*;

    /// Two vehicles that stand at their starts.
    fn two() -> Scenario {
        let mut scenario: Scenario = load("t-junction/bayesian-nice", &[]).expect("authored");
        scenario.vehicles.truncate(2);
        scenario
    }

    /// A tick of 0.1 s in which both stand, each at a line at its front where it gives way to others.
    fn frame(scenario: &Scenario, waits_for: [&[&str]; 2], tick: usize) -> Frame {
        let vehicles = scenario.vehicles.iter().zip(waits_for).map(|(vehicle, names)| {
            let mut state = vehicle.start;
            state.speed_mps = 0.0;
            let line_m = vehicle.route.along(state.position()) + vehicle.body.front_m + 0.5;
            let waits_for = names.iter().map(|name| (*name).to_owned()).collect();
            let holds = !names.is_empty();
            let rules =
                RoadRules { are_kept: true, stop_line_m: holds.then_some(line_m), waits_for, ..RoadRules::default() };
            VehicleFrame { name: vehicle.name.clone(), state, rules, ..VehicleFrame::default() }
        });
        Frame { time_s: 0.1 * tick as f64, vehicles: vehicles.collect(), ..Frame::default() }
    }

    /// The measures and events of some ticks, in the first of which these vehicles begin to touch.
    fn stood_after(between: Option<[&str; 2]>, ticks: usize, waits_for: [&[&str]; 2]) -> (Waits, Vec<Event>) {
        let scenario = two();
        let mut waits = Waits::new(&scenario);
        let mut events = Vec::new();
        for tick in 0..ticks {
            let mut frame = frame(&scenario, waits_for, tick);
            let hit = between.filter(|_| tick == 0).map(|between| between.map(str::to_owned));
            frame.collisions.extend(hit.map(|between| Collision { between, ..Collision::default() }));
            events.extend(waits.observe(&Standing::of(&scenario.vehicles, &frame), &frame, 0.1));
        }
        (waits, events)
    }

    fn stood(ticks: usize, waits_for: [&[&str]; 2]) -> (Waits, Vec<Event>) {
        stood_after(None, ticks, waits_for)
    }

    #[test]
    fn vehicles_that_wait_for_each_other_are_deadlocked() {
        let (waits, events) = stood(20, [&["main"], &["ego"]]);
        assert!(events.is_empty() && waits.deadlocks().is_empty(), "after two seconds they may still be let go");
        let (waits, events) = stood(60, [&["main"], &["ego"]]);
        let [deadlock] = waits.deadlocks() else { panic!("{:?}", waits.deadlocks()) };
        assert!((2.95..3.15).contains(&deadlock.time_s), "{deadlock:?}");
        assert_eq!(deadlock.sentence(), "ego and main wait for each other");
        let [event] = events.as_slice() else { panic!("{events:?}") };
        assert_eq!((event.vehicle.as_str(), event.text.as_str()), ("ego", "and main wait for each other: a deadlock"));
        assert_eq!(waits.of(0)[0].sentence(), "waited 6.0 s for main (they wait for each other)");
    }

    #[test]
    fn a_vehicle_that_stands_without_a_reason_is_stuck_after_ten_seconds() {
        let (waits, events) = stood(101, [&["main"], &[]]);
        let [deadlock] = waits.deadlocks() else { panic!("{:?}", waits.deadlocks()) };
        assert_eq!(deadlock.sentence(), "main stands (no reason found)");
        assert_eq!(events.len(), 1);
        assert!(stood(95, [&["main"], &[]]).1.is_empty(), "not yet");
        assert_eq!(waits.of(1)[0].sentence(), "stood 10.1 s (no reason found)");
    }

    /// Neither a vehicle that stands after a contact nor two that stand against each other are deadlocked.
    #[test]
    fn vehicles_that_have_crashed_are_not_deadlocked() {
        let in_circle: [&[&str]; 2] = [&["main"], &["ego"]];
        let unexplained: [&[&str]; 2] = [&[], &[]];
        for waits_for in [unexplained, in_circle] {
            let (waits, events) = stood_after(Some(["ego", "main"]), 120, waits_for);
            assert!(events.is_empty() && waits.deadlocks().is_empty(), "{:?}", waits.deadlocks());
            assert_eq!(waits.of(0)[0].sentence(), "stood 12.0 s (after a collision)");
        }
    }

    #[test]
    fn oncoming_and_crossing_vehicles_are_not_called_ahead() {
        let sentence = |reason: &StandingReason| {
            let (waits_for, reason) = words(reason);
            Wait { waited_s: 2.0, waits_for, reason }.sentence()
        };
        let name = || "ego".to_owned();
        assert_eq!(sentence(&StandingReason::Behind(name())), "waited 2.0 s for ego (ahead of it)");
        assert_eq!(sentence(&StandingReason::Passage(name())), "waited 2.0 s for ego (to leave the passage)");
        assert_eq!(sentence(&StandingReason::InWay(name())), "waited 2.0 s for ego (in its way)");
    }

    /// A vehicle that waits for a moving one is not deadlocked.
    #[test]
    fn a_wait_names_the_vehicle_with_priority() {
        let reason = StandingReason::GivesWay(vec!["ring".to_owned()]);
        let (waits_for, reason) = words(&reason);
        let wait = Wait { waited_s: 6.41, waits_for, reason };
        assert_eq!(wait.sentence(), "waited 6.4 s for ring (priority)");
        assert!(stood(3, [&["main"], &[]]).0.of(0).is_empty(), "a short stop");
    }
}
