//! Log events that no planner reports: braking, acceptance of proposals, arrivals, heat at its limit,
//! and missed comfort.
//!
//! Each event is logged when it begins, and again only after it has ended.

use std::collections::BTreeMap;

use interplay_planners::{Limits, Proposal};
use interplay_scenarios::Scenario;

use crate::climate::Building;
use crate::state::frame::{BuildingFrame, Event, Frame, Level, VehicleFrame};

/// A vehicle begins to brake above this share of its strongest deceleration.
const BRAKING_BEGINS_SHARE: f64 = 0.4;
/// A vehicle has stopped braking at or below this share of its strongest deceleration.
const BRAKING_ENDS_SHARE: f64 = 0.1;
/// A proposal counts as accepted from the first acceptance probability on, and as refused up to the second.
const MIN_ACCEPTED_PROBABILITY: f64 = 0.8;
const MAX_REFUSED_PROBABILITY: f64 = 0.2;
/// At most this many zones are named; the others are counted.
const MAX_NAMED_ZONES: usize = 3;
const BUILDING_SOURCE: &str = "building";

/// The present milestones of all vehicles.
#[derive(Clone, Debug)]
pub struct Milestones {
    limits: Vec<Limits>,
    brakes: Vec<bool>,
    /// For each vehicle, whether its last proposal to each other vehicle was accepted, by name, once that is clear.
    accepted: Vec<BTreeMap<String, bool>>,
}

impl Milestones {
    /// Begins with nothing logged.
    pub fn new(scenario: &Scenario) -> Milestones {
        let limits: Vec<Limits> = scenario.vehicles.iter().map(|vehicle| vehicle.limits).collect();
        Milestones { brakes: vec![false; limits.len()], accepted: vec![BTreeMap::new(); limits.len()], limits }
    }

    /// The events that begin in this tick.
    pub fn observe(&mut self, frame: &Frame) -> Vec<Event> {
        let vehicles = frame.vehicles.iter().enumerate();
        vehicles
            .flat_map(|(index, vehicle)| self.braking(index, vehicle).into_iter().chain(self.answers(index, vehicle)))
            .collect()
    }

    fn braking(&mut self, index: usize, vehicle: &VehicleFrame) -> Option<Event> {
        let share = vehicle.input.acceleration_mps2 / self.limits[index].acceleration_min_mps2;
        let braked = self.brakes[index];
        self.brakes[index] = share > if braked { BRAKING_ENDS_SHARE } else { BRAKING_BEGINS_SHARE };
        (self.brakes[index] && !braked).then(|| note(&vehicle.name, "brakes"))
    }

    /// Events of the answers to proposals.
    fn answers(&mut self, index: usize, vehicle: &VehicleFrame) -> Vec<Event> {
        let proposals = &vehicle.plan.proposals;
        let known = &mut self.accepted[index];
        known.retain(|name, _| proposals.iter().any(|proposal| proposal.to == *name));
        proposals.iter().filter_map(|proposal| answer(known, vehicle, proposal)).collect()
    }
}

/// The event of an answer to a proposal. A proposal that requests nothing new counts as accepted and is not logged.
fn answer(known: &mut BTreeMap<String, bool>, vehicle: &VehicleFrame, proposal: &Proposal) -> Option<Event> {
    let acceptance = proposal.acceptance?;
    let now = if acceptance >= MIN_ACCEPTED_PROBABILITY {
        true
    } else if acceptance <= MAX_REFUSED_PROBABILITY {
        false
    } else {
        return None;
    };
    let before = known.insert(proposal.to.clone(), now);
    match (before, now) {
        (None | Some(true), false) => Some(note(&proposal.to, &format!("does not do what {} proposes", vehicle.name))),
        (Some(false), true) => Some(note(&proposal.to, &format!("does what {} proposes", vehicle.name))),
        _ => None,
    }
}

const HAS_CROSSED: &str = "has crossed";
const IN_ITS_LANE: &str = "is in its lane";

/// A vehicle has reached its goal.
pub fn arrival(vehicle: &str, crosses: bool) -> Event {
    note(vehicle, if crosses { HAS_CROSSED } else { IN_ITS_LANE })
}

/// Whether an event says that a vehicle has reached its goal.
pub fn is_arrival(event: &Event) -> bool {
    [HAS_CROSSED, IN_ITS_LANE].contains(&event.text.as_str())
}

fn note(vehicle: &str, text: &str) -> Event {
    Event { vehicle: vehicle.to_owned(), level: Level::Note, text: text.to_owned() }
}

/// The building's events that were logged today.
#[derive(Clone, Copy, Debug, Default)]
pub struct Today {
    limited: bool,
    uncomfortable: bool,
}

impl Today {
    /// The events that begin in this step: the first time each day that heat is at its limit, and that comfort is missed while people
    /// are present.
    pub fn observe(&mut self, frame: &BuildingFrame, building: &Building) -> Vec<Event> {
        if frame.step == 0 {
            *self = Today::default();
        }
        let network = building.model.network();
        let (names, limits, targets) = (network.names(), network.limits(), &building.targets);
        let zones = || frame.zones.iter().enumerate();
        let mut events = Vec::new();
        let limited =
            zones().filter(|(index, zone)| limits.excess_kw(*index, zone.requested_kw) >= 0.0 && zone.heat_kw != 0.0);
        let limited: Vec<&str> = limited.map(|(index, _)| names[index].as_str()).collect();
        if !limited.is_empty() && !self.limited {
            self.limited = true;
            events.push(note(
                BUILDING_SOURCE,
                &format!("{}: heat at its limit in {}", day_and_time(frame, building), listed(&limited)),
            ));
        }
        let missed =
            zones().filter(|(index, zone)| targets.beyond_k(frame.step * targets.zones + index, zone.next_c) > 0.0);
        let missed: Vec<&str> = missed.map(|(index, _)| names[index].as_str()).collect();
        if !missed.is_empty() && !self.uncomfortable {
            self.uncomfortable = true;
            events.push(note(
                BUILDING_SOURCE,
                &format!(
                    "{}: people there, and outside the comfort band {}",
                    day_and_time(frame, building),
                    listed(&missed)
                ),
            ));
        }
        events
    }
}

/// The day, from 1, and the time of day at the end of a step.
fn day_and_time(frame: &BuildingFrame, building: &Building) -> String {
    let minutes = ((frame.step + 1) as f64 * building.model.step_s() / 60.0).round() as usize;
    format!("day {}, {}:{:02}", frame.day + 1, minutes / 60, minutes % 60)
}

/// Up to [`MAX_NAMED_ZONES`] names, and the number of the others.
fn listed(names: &[&str]) -> String {
    let shown = names[..names.len().min(MAX_NAMED_ZONES)].join(", ");
    let more = names.len().saturating_sub(MAX_NAMED_ZONES);
    if more == 0 { shown } else { format!("{shown} and {more} more") }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use interplay_planners::{Input, Plan, Trajectory};
    use interplay_scenarios::load;

    use super::*;

    fn tick(acceleration_mps2: f64, acceptance: Option<f64>) -> Frame {
        let proposal = |_| Proposal { to: "front".to_owned(), trajectory: Trajectory::default(), acceptance };
        let proposals = acceptance.map(proposal).into_iter().collect();
        let vehicle = VehicleFrame {
            name: "ego".to_owned(),
            input: Input { acceleration_mps2, steering_rad: 0.0 },
            plan: Plan { proposals, ..Plan::default() }.into(),
            ..VehicleFrame::default()
        };
        Frame { vehicles: vec![vehicle], ..Frame::default() }
    }

    fn logged(frames: &[Frame]) -> Vec<(usize, String)> {
        logged_of(Milestones::new(&load("lane-change/front-nice", &[]).expect("authored")), frames)
    }

    fn logged_of(mut milestones: Milestones, frames: &[Frame]) -> Vec<(usize, String)> {
        let frames = frames.iter().enumerate();
        let events = frames.flat_map(|(at, frame)| milestones.observe(frame).into_iter().map(move |event| (at, event)));
        events.map(|(at, event)| (at, format!("{} {}", event.vehicle, event.text))).collect()
    }

    #[test]
    fn braking_is_logged_once_until_it_ends() {
        let said = logged(&[0.0, -0.5, -0.3, -0.6, 0.0, -0.3, -0.41].map(|a| tick(a, None)));
        assert_eq!(said, [(1, "ego brakes".to_owned()), (6, "ego brakes".to_owned())]);
        // The threshold is a share of the vehicle's strongest braking.
        let mut milestones = Milestones::new(&load("lane-change/front-nice", &[]).expect("authored"));
        milestones.limits[0].acceleration_min_mps2 = -4.0;
        let said = logged_of(milestones, &[-1.2, -2.4].map(|a| tick(a, None)));
        assert_eq!(said, [(1, "ego brakes".to_owned())]);
    }

    #[test]
    fn answers_to_proposals_are_logged_when_they_change() {
        let said = logged(&[1.0, 0.5, 0.1, 0.15, 0.5, 0.9, 1.0].map(|p| tick(0.0, Some(p))));
        let (refused, accepted) = ("front does not do what ego proposes", "front does what ego proposes");
        assert_eq!(said, [(2, refused.to_owned()), (5, accepted.to_owned())]);
        let again = logged(&[tick(0.0, Some(0.1)), tick(0.0, None), tick(0.0, Some(0.9)), tick(0.0, Some(0.1))]);
        assert_eq!(again.len(), 2, "{again:?}");
    }

    /// Each vehicle that receives a proposal answers for itself.
    #[test]
    fn answers_of_several_vehicles_are_logged_separately() {
        let asked = |of: [(&str, f64); 2]| {
            let mut frame = tick(0.0, None);
            let proposal = |(to, acceptance): (&str, f64)| Proposal {
                to: to.to_owned(),
                trajectory: Trajectory::default(),
                acceptance: Some(acceptance),
            };
            Arc::make_mut(&mut frame.vehicles[0].plan).proposals = of.map(proposal).to_vec();
            frame
        };
        let said = logged(&[asked([("front", 1.0), ("rear", 0.0)]), asked([("front", 0.1), ("rear", 0.9)])]);
        let does_not = "does not do what ego proposes";
        let expected = [
            (0, format!("rear {does_not}")),
            (1, format!("front {does_not}")),
            (1, "rear does what ego proposes".to_owned()),
        ];
        assert_eq!(said, expected);
    }

    #[test]
    fn an_event_names_three_zones_and_counts_the_others() {
        assert_eq!(listed(&["a"]), "a");
        assert_eq!(listed(&["a", "b", "c", "d", "e"]), "a, b, c and 2 more");
    }
}
