//! What each driver on the road wants and does at the moment, a line for each.

use std::fmt::Write;

use interplay_planners::{PassingSide, PlannedPassing};
use interplay_scenarios::{LaneReference, Scenario, Vehicle};
use interplay_simulation::frame::{Frame, Origin, VehicleFrame};
use rerun::{RecordingStream, RecordingStreamResult};

use super::palette::NamedColour;
use super::re_sdk_types::archetypes::TextDocument;
use super::re_sdk_types::components::MediaType;
use crate::answer::Requests;
use crate::passing_words::{is_said, meeting_verb};
use crate::signals::is_braking;

/// Path of the status lines.
pub const STATUS: &str = "status";
/// Slower than this share of its wanted speed a vehicle stands.
const STANDS_SHARE: f64 = 0.08;
/// A vehicle keeps its speed if its acceleration is below this \[m/s²\].
const KEEPS_MPS2: f64 = 0.05;

/// The lines of all drivers, which are logged when they change.
#[derive(Default)]
pub struct StatusLines {
    last: String,
}

impl StatusLines {
    /// Logs the lines of a tick.
    ///
    /// # Errors
    /// If Rerun refuses the text.
    pub fn tick(
        &mut self,
        stream: &RecordingStream,
        (scenario, vehicle_colours, told): (&Scenario, &[NamedColour], &[bool]),
        frame: &Frame,
        requests: &Requests,
    ) -> RecordingStreamResult<()> {
        if frame.vehicles.is_empty() {
            return Ok(());
        }
        let mut text = String::new();
        let drives = |(index, (vehicle, _)): &(usize, (&Vehicle, _))| {
            vehicle.obstacle.is_none() && !frame.vehicles[*index].is_absent && told[*index]
        };
        for (index, (vehicle, colour)) in scenario.vehicles.iter().zip(vehicle_colours).enumerate().filter(drives) {
            let asks = requests.sentence(frame, index);
            let (name, wants, does) =
                (&vehicle.name, wants(scenario, vehicle), does(scenario, index, &frame.vehicles[index], asks));
            let _ = writeln!(text, "**{name}** ({}) wants {wants}: {does}.\n", colour.word);
        }
        if self.last == text {
            return Ok(());
        }
        stream.log(STATUS, &TextDocument::new(text.as_str()).with_media_type(MediaType::MARKDOWN))?;
        self.last = text;
        Ok(())
    }
}

/// The goal of a vehicle.
fn wants(scenario: &Scenario, vehicle: &Vehicle) -> String {
    let target = vehicle.target(&scenario.road);
    match &vehicle.goal.lane {
        Some(LaneReference::Number(lane)) if scenario.road.parallel_lanes().is_some_and(|lanes| lanes.count > 1) => {
            format!("lane {lane} at {:.1} m/s", target.speed_mps)
        }
        Some(LaneReference::Name(lane)) => format!("lane `{lane}` at {:.1} m/s", target.speed_mps),
        Some(LaneReference::Number(_)) | None => format!("{:.1} m/s", target.speed_mps),
    }
}

/// What a vehicle does, and because of whom; `asks` says for what it asks whom.
fn does(scenario: &Scenario, index: usize, now: &VehicleFrame, asks: Option<String>) -> String {
    let vehicle = &scenario.vehicles[index];
    match now.origin {
        Origin::Planned => {}
        Origin::Crashed => return "has collided and brakes until it stands".to_owned(),
        Origin::Continued => return "finds no new plan and continues the last one".to_owned(),
        Origin::Braking => return "finds no plan and brakes fully".to_owned(),
        Origin::Evading => return "finds no plan and evades".to_owned(),
    }
    let wanted_mps = vehicle.target(&scenario.road).speed_mps;
    let stands = now.state.speed_mps.abs() < STANDS_SHARE * wanted_mps;
    let brakes = is_braking(now.input.acceleration_mps2);
    let mut parts: Vec<String> = asks.into_iter().collect();
    let passings: Vec<&PlannedPassing> =
        now.plan.homotopy_class.iter().filter(|passing| is_said(scenario, index, passing)).collect();
    parts.extend(grouped(&passings, |passing| {
        meeting_verb(scenario, index, passing).unwrap_or_else(|| verb(passing, stands, brakes))
    }));
    let speed = match now.input.acceleration_mps2 {
        _ if stands => "stands",
        _ if brakes => "brakes",
        acceleration if acceleration > KEEPS_MPS2 => "speeds up",
        _ => "keeps its speed",
    };
    let waits = passings.iter().any(|passing| passing.side == PassingSide::Behind);
    if !(stands || brakes) || !waits {
        parts.push(speed.to_owned());
    }
    parts.join("; ")
}

/// What a vehicle does with respect to another one.
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

/// Orders with the same verb as one part of a sentence.
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

    use super::*;

    fn passing(of: &str, position: PassingSide) -> PlannedPassing {
        PlannedPassing { of: of.to_owned(), side: position }
    }

    fn said(speed_mps: f64, acceleration_mps2: f64, plan: Plan, origin: Origin) -> String {
        let scenario = load("lane-change/front-nice", &[]).expect("embedded");
        let state = State { speed_mps, ..State::default() };
        let input = Input { acceleration_mps2, ..Input::default() };
        let now = VehicleFrame { state, input, plan: plan.into(), origin, ..Default::default() };
        let frame = Frame { vehicles: vec![now.clone()], ..Frame::default() };
        does(&scenario, 0, &now, Requests::default().sentence(&frame, 0))
    }

    #[test]
    fn a_line_says_who_waits_for_whom_and_why() {
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
    fn a_line_says_who_is_asked_and_what_it_answers() {
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
    fn a_goal_names_its_lane_only_where_there_are_several() {
        let said = |name: &str| {
            let scenario = load(name, &[]).expect("embedded");
            wants(&scenario, &scenario.vehicles[0])
        };
        assert_eq!(said("lane-change/front-nice"), "lane 1 at 1.0 m/s");
        assert_eq!(said("intersection/nice"), "1.2 m/s");
    }
}
