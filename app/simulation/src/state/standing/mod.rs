//! Classifies why a vehicle that wants to move is stationary, from positions and traffic rules.

mod conflicts;
mod passing;

use interplay_planners::road::network::LightColour;
use interplay_planners::{Driver, Route, State};
use interplay_scenarios::Vehicle;

use crate::state::frame::Frame;

/// A slower real car is stationary \[m/s\].
pub(crate) const STANDING_MPS: f64 = 0.3;
/// A plan that was made from what the driver saw is followed for at most about this long \[s\].
const PLAN_S: f64 = 0.2;
/// Maximum distance from a traffic light at which a vehicle stops for it, for a real car \[m\].
const LIGHT_M: f64 = 5.0;
/// A vehicle with a desired speed up to this does not want to move, for a real car \[m/s\].
const LEAST_WANTED_MPS: f64 = 0.5;
/// Maximum distance from a vehicle's front to the line or vehicle at which it waits, for a real car \[m\].
const NEAR_M: f64 = 15.0;
/// Maximum distance to a stationary vehicle ahead behind which a real car stands \[m\].
const REST_M: f64 = 30.0;
/// A slower real car may be part of a queue \[m/s\].
const QUEUE_MPS: f64 = 2.0;

/// Why a vehicle is stationary.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum StandingReason {
    /// It stops at a stop sign.
    Sign,
    /// It stops at a traffic light.
    Light,
    /// It gives way to these vehicles.
    GivesWay(Vec<String>),
    /// It waits behind another vehicle.
    Behind(String),
    /// It waits for an oncoming vehicle in a passage too narrow for both.
    Passage(String),
    /// It waits for a vehicle that crosses its way or comes towards it.
    InWay(String),
    /// It waits for another vehicle before it passes an obstacle.
    Passing {
        /// The vehicle for which it waits.
        waits_for: String,
        /// The obstacle.
        obstacle: String,
    },
    /// There is not enough room to pass an obstacle.
    NoRoom(String),
}

impl StandingReason {
    /// The vehicles that the reason names, for which a vehicle waits.
    pub(crate) fn waits_for(&self) -> Vec<&str> {
        match self {
            StandingReason::Sign | StandingReason::Light | StandingReason::NoRoom(_) => Vec::new(),
            StandingReason::GivesWay(names) => names.iter().map(String::as_str).collect(),
            StandingReason::Behind(name)
            | StandingReason::Passage(name)
            | StandingReason::InWay(name)
            | StandingReason::Passing { waits_for: name, .. } => vec![name],
        }
    }
}

impl std::fmt::Display for StandingReason {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            StandingReason::Sign => write!(formatter, "stops at the sign"),
            StandingReason::Light => write!(formatter, "stops at the traffic light"),
            StandingReason::GivesWay(names) => write!(formatter, "gives way to {}", names.join(", ")),
            StandingReason::Behind(name) => write!(formatter, "waits behind {name}"),
            StandingReason::Passage(name) => write!(formatter, "waits for {name} to leave the passage"),
            StandingReason::InWay(name) => write!(formatter, "waits for {name} in its way"),
            StandingReason::Passing { waits_for, obstacle } => {
                write!(formatter, "waits for {waits_for} before it passes {obstacle}")
            }
            StandingReason::NoRoom(name) => write!(formatter, "has no room to pass {name}"),
        }
    }
}

/// All vehicles at one time, some of which may be stationary.
#[derive(Clone, Copy, Debug)]
pub struct Standing<'a> {
    vehicles: &'a [Vehicle],
    frame: &'a Frame,
}

/// Whether a vehicle wants to move: pedestrians may stand, and so may vehicles without a desired speed.
pub(crate) fn wants_to_drive(vehicle: &Vehicle) -> bool {
    let wanted_mps = vehicle.goal.speed_mps.unwrap_or(vehicle.start.speed_mps);
    !matches!(vehicle.driver, Driver::Walker(_)) && wanted_mps > LEAST_WANTED_MPS * vehicle.body.real_ratio().sqrt()
}

impl<'a> Standing<'a> {
    /// The vehicles of a frame.
    pub fn of(vehicles: &'a [Vehicle], frame: &'a Frame) -> Self {
        Standing { vehicles, frame }
    }

    /// Whether a vehicle is stationary although it wants to move.
    pub fn stands(&self, index: usize) -> bool {
        let (vehicle, times) = (&self.vehicles[index], self.scale(index).sqrt());
        self.wants_to_drive(index)
            && !self.is_absent(index)
            && self.state(index).speed_mps < STANDING_MPS * times
            && self.along_m(index) + vehicle.body.front_m + NEAR_M * self.scale(index) < vehicle.route.end_m()
    }

    /// What makes a vehicle stand whatever happens around it, in words: its script, its record, or inputs from outside.
    pub(crate) fn told_by(&self, index: usize) -> Option<&'static str> {
        match &self.vehicles[index].driver {
            Driver::Scripted(_) => Some("as its script says"),
            Driver::Recorded(_) => Some("as its record says"),
            driver => driver.is_driven_from_outside().then_some("as its inputs say"),
        }
    }

    /// Why a vehicle is stationary; `None` if no reason is visible, or if vehicles wait for one another in a cycle.
    pub fn reason(&self, index: usize) -> Option<StandingReason> {
        self.plain_reason(index).filter(|reason| self.ends(reason, &mut vec![index]))
    }

    /// The cycle of vehicles that wait for one another and to which a vehicle belongs, itself included, in ascending
    /// order; empty without a cycle.
    pub fn circle(&self, index: usize) -> Vec<usize> {
        let together = |other: &usize| self.reaches(*other).contains(&index);
        let mut circle: Vec<usize> = self.reaches(index).into_iter().filter(together).collect();
        circle.sort_unstable();
        circle
    }

    /// The stationary vehicles for which a vehicle waits, directly or through other vehicles.
    fn reaches(&self, index: usize) -> Vec<usize> {
        let mut found: Vec<usize> = Vec::new();
        let mut next = vec![index];
        while let Some(vehicle) = next.pop() {
            let waits = self.stands(vehicle) && self.told_by(vehicle).is_none();
            let reason = self.plain_reason(vehicle).filter(|_| waits);
            let names = reason.iter().flat_map(StandingReason::waits_for);
            let waited_for = names.filter_map(|name| self.vehicles.iter().position(|other| other.name == name));
            let new: Vec<usize> = waited_for.filter(|other| self.stands(*other) && !found.contains(other)).collect();
            found.extend(&new);
            next.extend(new);
        }
        found
    }

    /// Whether the vehicle that is waited for moves, or waits for one that does.
    fn ends(&self, reason: &StandingReason, passed: &mut Vec<usize>) -> bool {
        let names = reason.waits_for();
        let indices = names.iter().filter_map(|name| self.vehicles.iter().position(|vehicle| vehicle.name == *name));
        names.is_empty()
            || indices.into_iter().any(|index| {
                if passed.contains(&index) {
                    return false;
                }
                passed.push(index);
                !self.stands(index)
                    || self.told_by(index).is_some()
                    || self.plain_reason(index).is_some_and(|reason| self.ends(&reason, passed))
            })
    }

    /// Why a vehicle is stationary, independently of the vehicles for which it waits.
    pub fn plain_reason(&self, index: usize) -> Option<StandingReason> {
        let conflict = || self.others(index).find_map(|other| self.before_conflict(index, other));
        self.visible_reason(index).or_else(conflict)
    }

    /// Why a vehicle is stationary, by what is before it and by the rules.
    fn visible_reason(&self, index: usize) -> Option<StandingReason> {
        let (vehicle, scale) = (&self.vehicles[index], self.scale(index));
        let front_m = self.along_m(index) + vehicle.body.front_m;
        let rules = &self.frame.vehicles[index].rules;
        let line_m = rules.stop_line_m.filter(|line_m| line_m - front_m < NEAR_M * scale);
        let stands_at_light = || rules.waits_for.is_empty() && line_m.is_some_and(|line_m| self.is_lit(index, line_m));
        if let Some(obstacle) = self.ahead(index, NEAR_M * scale) {
            if self.wants_to_drive(obstacle) {
                return Some(self.because_of(index, obstacle));
            }
            let reason = match self.walks_across(index, obstacle) {
                true if stands_at_light() => None,
                true => Some(self.before_walker(index, obstacle)),
                false => self.before_passing(index, obstacle),
            };
            if reason.is_some() {
                return reason;
            }
        }
        if let Some(name) = rules.evades.as_ref().filter(|_| line_m.is_some()) {
            return Some(StandingReason::InWay(name.clone()));
        }
        if let Some(name) = rules.keeps_clear_behind.as_ref().filter(|_| line_m.is_some()) {
            return Some(StandingReason::Behind(name.clone()));
        }
        line_m.map(|line_m| match rules.waits_for.as_slice() {
            [] if self.is_lit(index, line_m) => StandingReason::Light,
            [] => StandingReason::Sign,
            names => StandingReason::GivesWay(names.to_vec()),
        })
    }

    /// The index of the vehicle of this name, if it is stationary.
    pub(crate) fn stationary(&self, name: &str) -> Option<usize> {
        let index = self.vehicles.iter().position(|vehicle| vehicle.name == name)?;
        (self.state(index).speed_mps < STANDING_MPS * self.scale(index).sqrt()).then_some(index)
    }

    /// Whether a traffic light that is not green, or was not when the driver saw it, is just beyond a line \[m\].
    fn is_lit(&self, index: usize, line_m: f64) -> bool {
        let (vehicle, near_m) = (&self.vehicles[index], LIGHT_M * self.scale(index));
        let late_s = if vehicle.knows_plans() { 0.0 } else { vehicle.driver.reaction_s() + PLAN_S };
        let is_closed = |colour: LightColour| !matches!(colour, LightColour::Green | LightColour::Off);
        vehicle.route.legs.iter().filter(|leg| (0.0..near_m).contains(&(leg.to_m - line_m))).any(|leg| {
            let times_s = [self.frame.time_s, self.frame.time_s - late_s];
            leg.light.as_ref().is_some_and(|light| times_s.iter().any(|time_s| is_closed(light.colour_at(*time_s))))
        })
    }

    /// The nearest vehicle ahead in the same lane that is stationary, less than 30 m of a real car ahead, and its distance between
    /// bumpers \[m\].
    pub(crate) fn stationary_ahead(&self, index: usize) -> Option<(usize, f64)> {
        let found = self.nearest_ahead(index, REST_M * self.scale(index));
        found.filter(|(other, _)| self.state(*other).speed_mps < STANDING_MPS * self.scale(*other).sqrt())
    }

    /// A vehicle that waits for a visible reason in the lane of a vehicle's route, beside that vehicle or close ahead of it.
    pub(crate) fn queue_beside(&self, index: usize) -> Option<usize> {
        let (own, own_m, scale) = (&self.vehicles[index], self.along_m(index), self.scale(index));
        self.others(index).find(|other| {
            let (theirs, state) = (&self.vehicles[*other], self.state(*other));
            let at = own.route.locate(state.position(), None);
            let (ahead_m, half_m) = (at.along_m - own_m, own.route.half_width.value(at.along_m));
            let is_along = libm::cos(state.heading_rad - at.heading_rad) > std::f64::consts::FRAC_1_SQRT_2;
            let reach_m = own.body.front_m + theirs.body.rear_m + NEAR_M * scale;
            let is_near = (-own.body.rear_m - theirs.body.front_m..reach_m).contains(&ahead_m);
            is_along && is_near && at.across_m.abs() < half_m && self.queues(*other)
        })
    }

    /// Whether a vehicle that wants to move stands, or moves slowly, for a visible reason that will end.
    pub(crate) fn queues(&self, index: usize) -> bool {
        let is_slow = self.state(index).speed_mps <= QUEUE_MPS * self.scale(index).sqrt();
        let ends = |reason: &StandingReason| !matches!(reason, StandingReason::NoRoom(_));
        self.wants_to_drive(index) && is_slow && self.visible_reason(index).as_ref().is_some_and(ends)
    }

    /// The nearest vehicle ahead in the same lane, within a distance between bumpers.
    fn ahead(&self, index: usize, within_m: f64) -> Option<usize> {
        self.nearest_ahead(index, within_m).map(|(other, _)| other)
    }

    /// The nearest vehicle ahead in the same lane, within a distance between bumpers, and that distance \[m\].
    fn nearest_ahead(&self, index: usize, within_m: f64) -> Option<(usize, f64)> {
        let (own, own_m) = (&self.vehicles[index], self.along_m(index));
        let across_m = own.route.across(self.state(index).position());
        let others = self.others(index).filter_map(|other| {
            let body = &self.vehicles[other].body;
            let at = own.route.locate(self.state(other).position(), None);
            let gap_m = at.along_m - own_m - own.body.front_m - body.rear_m.max(body.front_m);
            let reach_m = 0.5 * (own.body.width_m + body.width_m);
            let is_ahead = at.along_m > own_m && gap_m < within_m && (at.across_m - across_m).abs() < reach_m;
            is_ahead.then_some((other, gap_m))
        });
        others.min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// The other vehicles on the road.
    fn others(&self, index: usize) -> impl Iterator<Item = usize> {
        (0..self.vehicles.len()).filter(move |other| *other != index && !self.is_absent(*other))
    }

    fn is_absent(&self, index: usize) -> bool {
        self.frame.vehicles[index].is_absent
    }

    fn wants_to_drive(&self, index: usize) -> bool {
        wants_to_drive(&self.vehicles[index])
    }

    fn state(&self, index: usize) -> &State {
        &self.frame.vehicles[index].state
    }

    fn along_m(&self, index: usize) -> f64 {
        let route: &Route = &self.vehicles[index].route;
        route.along(self.state(index).position())
    }

    fn scale(&self, index: usize) -> f64 {
        self.vehicles[index].body.real_ratio()
    }
}
