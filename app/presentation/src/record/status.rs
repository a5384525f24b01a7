//! The goal and the present action of each driver on the road, in a line.

use std::fmt::Write;

use interplay_planners::{PassingSide, PlannedPassing};
use interplay_scenarios::{LaneReference, Scenario, Vehicle};
use interplay_simulation::frame::{Origin, VehicleFrame};

use super::re_sdk_types::archetypes::TextDocument;
use super::re_sdk_types::components::MediaType;
use super::{Logged, RecordedTick};
use crate::passing_words::{has_words, meeting_verb};
use crate::signals::is_braking;

pub const STATUS: &str = "status";
/// A vehicle below this share of its wanted speed counts as standing.
const STANDING_SHARE: f64 = 0.08;
/// A vehicle with less acceleration than this keeps its speed \[m/s²\].
const KEEPS_SPEED_MPS2: f64 = 0.05;

/// Logs the lines of all drivers when they change.
#[derive(Default)]
pub struct StatusLines {
    last: String,
}

impl StatusLines {
    pub fn log_frame(&mut self, tick: &RecordedTick) -> Logged {
        let RecordedTick { stream, scenario, vehicle_colours, frame, requests, described } = *tick;
        if frame.vehicles.is_empty() {
            return Ok(());
        }
        let mut text = String::new();
        let drives = |(index, (vehicle, _)): &(usize, (&Vehicle, _))| {
            vehicle.obstacle.is_none() && !frame.vehicles[*index].is_absent && described[*index]
        };
        for (index, (vehicle, colour)) in scenario.vehicles.iter().zip(vehicle_colours).enumerate().filter(drives) {
            let request = requests.sentence(frame, index);
            let (name, goal) = (&vehicle.name, goal(scenario, vehicle));
            let action = action(scenario, index, &frame.vehicles[index], request);
            let _ = writeln!(text, "**{name}** ({}) wants {goal}: {action}.\n", colour.word);
        }
        if self.last == text {
            return Ok(());
        }
        stream.log(STATUS, &TextDocument::new(text.as_str()).with_media_type(MediaType::MARKDOWN))?;
        self.last = text;
        Ok(())
    }
}

fn goal(scenario: &Scenario, vehicle: &Vehicle) -> String {
    let target = vehicle.target(&scenario.road);
    match &vehicle.goal.lane {
        Some(LaneReference::Number(lane)) if scenario.road.parallel_lanes().is_some_and(|lanes| lanes.count > 1) => {
            format!("lane {lane} at {:.1} m/s", target.speed_mps)
        }
        Some(LaneReference::Name(lane)) => format!("lane `{lane}` at {:.1} m/s", target.speed_mps),
        Some(LaneReference::Number(_)) | None => format!("{:.1} m/s", target.speed_mps),
    }
}

/// The action of a vehicle, with the vehicles that it passes; `request` is its request in words.
fn action(scenario: &Scenario, index: usize, now: &VehicleFrame, request: Option<String>) -> String {
    let vehicle = &scenario.vehicles[index];
    match now.origin {
        Origin::Planned => {}
        Origin::Crashed => return "has collided and brakes to a stop".to_owned(),
        Origin::Continued => return "finds no new plan and continues the last one".to_owned(),
        Origin::Braking => return "finds no plan and brakes fully".to_owned(),
        Origin::Evading => return "finds no plan and evades".to_owned(),
    }
    let wanted_mps = vehicle.target(&scenario.road).speed_mps;
    let stands = now.state.speed_mps.abs() < STANDING_SHARE * wanted_mps;
    let brakes = is_braking(now.input.acceleration_mps2);
    let mut parts: Vec<String> = request.into_iter().collect();
    let passings: Vec<&PlannedPassing> =
        now.plan.homotopy_class.iter().filter(|passing| has_words(scenario, index, passing)).collect();
    parts.extend(grouped(&passings, |passing| {
        meeting_verb(scenario, index, passing).unwrap_or_else(|| verb(passing, stands, brakes))
    }));
    let speed = match now.input.acceleration_mps2 {
        _ if stands => "stands",
        _ if brakes => "brakes",
        acceleration if acceleration > KEEPS_SPEED_MPS2 => "speeds up",
        _ => "keeps its speed",
    };
    let waits = passings.iter().any(|passing| passing.side == PassingSide::Behind);
    if !(stands || brakes) || !waits {
        parts.push(speed.to_owned());
    }
    parts.join("; ")
}

fn verb(passing: &PlannedPassing, stands: bool, brakes: bool) -> &'static str {
    match passing.side {
        PassingSide::Ahead => "goes ahead of",
        PassingSide::Behind if stands => "waits for",
        PassingSide::Behind if brakes => "yields to",
        PassingSide::Behind => "stays behind",
        PassingSide::Left => "passes on the left of",
        PassingSide::Right => "passes on the right of",
    }
}

/// Joins passings with the same verb.
fn grouped(passings: &[&PlannedPassing], verb: impl Fn(&PlannedPassing) -> &'static str) -> Vec<String> {
    let mut groups: Vec<(&str, Vec<&str>)> = Vec::new();
    for passing in passings {
        let verb = verb(passing);
        match groups.iter_mut().find(|(known, _)| *known == verb) {
            Some((_, names)) => names.push(&passing.of),
            None => groups.push((verb, vec![&passing.of])),
        }
    }
    groups.into_iter().map(|(verb, names)| format!("{verb} {}", names.join(" and "))).collect()
}

#[cfg(test)]
mod tests {
    use interplay_planners::{Input, Plan, Proposal, State};
    use interplay_scenarios::load;
    use interplay_simulation::frame::Frame;

    use super::*;
    use crate::requests::Requests;

    fn passing(of: &str, position: PassingSide) -> PlannedPassing {
        PlannedPassing { of: of.to_owned(), side: position }
    }

    fn said(speed_mps: f64, acceleration_mps2: f64, plan: Plan, origin: Origin) -> String {
        let scenario = load("lane-change/front-nice", &[]).expect("embedded");
        let state = State { speed_mps, ..State::default() };
        let input = Input { acceleration_mps2, ..Input::default() };
        let now = VehicleFrame { state, input, plan: plan.into(), origin, ..Default::default() };
        let frame = Frame { vehicles: vec![now.clone()], ..Frame::default() };
        action(&scenario, 0, &now, Requests::default().sentence(&frame, 0))
    }

    #[test]
    fn a_status_line_contains_the_passings_and_the_speed() {
        let behind = || Plan {
            homotopy_class: vec![passing("front", PassingSide::Behind), passing("rear", PassingSide::Behind)],
            ..Plan::default()
        };
        assert_eq!(said(1.0, 0.0, behind(), Origin::Planned), "stays behind front and rear; keeps its speed");
        assert_eq!(said(0.8, -0.5, behind(), Origin::Planned), "yields to front and rear");
        assert_eq!(said(0.0, 0.0, behind(), Origin::Planned), "waits for front and rear");
        assert_eq!(said(1.0, 0.2, Plan::default(), Origin::Planned), "speeds up");
        assert_eq!(said(1.0, 0.0, behind(), Origin::Braking), "finds no plan and brakes fully");
    }

    #[test]
    fn a_status_line_contains_the_request_and_its_answer() {
        let asks = |acceptance| Plan {
            proposals: vec![Proposal { to: "front".to_owned(), trajectory: Default::default(), acceptance }],
            homotopy_class: vec![passing("front", PassingSide::Ahead)],
            ..Plan::default()
        };
        assert_eq!(
            said(1.0, -0.3, asks(Some(0.85)), Origin::Planned),
            "asks front to take the dotted way – front accepts (85 %); goes ahead of front; brakes"
        );
        assert!(said(1.0, 0.0, asks(None), Origin::Planned).starts_with("expects front to take the dotted way; "));
    }

    #[test]
    fn a_goal_names_its_lane_only_on_a_road_with_several_lanes() {
        let said = |name: &str| {
            let scenario = load(name, &[]).expect("embedded");
            goal(&scenario, &scenario.vehicles[0])
        };
        assert_eq!(said("lane-change/front-nice"), "lane 1 at 1.0 m/s");
        assert_eq!(said("intersection/nice"), "1.2 m/s");
    }
}
