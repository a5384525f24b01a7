//! Which ways of passing make sense in words: left and right are sides of one road only.

use interplay_planners::{PassingSide, PlanEventKind, PlannedPassing, Route};
use interplay_scenarios::Scenario;
use interplay_simulation::frame::{Event, Frame, VehicleFrame};

use crate::body_style::BodyStyle;
use crate::signals::wrapped;

/// A route whose direction changes by more than this leads around a corner \[rad\].
const TURN_RAD: f64 = 0.6;
/// At how many places the direction of a route is looked at.
const PLACES: usize = 64;

/// Vehicles whose directions at the start differ by more than this come toward each other \[rad\].
const ONCOMING_RAD: f64 = 2.5;

/// How a vehicle (its index) passes another one, without the subject; none if it is not put into words ([`is_said`]).
///
/// Somebody who comes toward a vehicle or walks across its way is neither followed nor led: one of them goes before the other.
pub fn passing_sentence(scenario: &Scenario, vehicle: usize, passing: &PlannedPassing) -> Option<String> {
    let sentence = || match meeting_verb(scenario, vehicle, passing) {
        Some(verb) => format!("{verb} {}", passing.of),
        None => passing.sentence(),
    };
    is_said(scenario, vehicle, passing).then(sentence)
}

/// What a vehicle (its index) does to somebody whom it meets; none if it meets nobody, or passes to a side.
pub fn meeting_verb(scenario: &Scenario, vehicle: usize, passing: &PlannedPassing) -> Option<&'static str> {
    let verb = match passing.side {
        PassingSide::Ahead => "goes before",
        PassingSide::Behind => "gives way to",
        PassingSide::Left | PassingSide::Right => return None,
    };
    is_met(scenario, vehicle, passing).then_some(verb)
}

/// Whether the other one comes toward a vehicle (its index), or walks across its way, by their directions at the start.
fn is_met(scenario: &Scenario, vehicle: usize, passing: &PlannedPassing) -> bool {
    let Some(other) = scenario.index_of(&passing.of).map(|index| &scenario.vehicles[index]) else { return false };
    let turned_rad = wrapped(other.start.heading_rad - scenario.vehicles[vehicle].start.heading_rad).abs();
    turned_rad > if BodyStyle::choose(other) == BodyStyle::Walker { TURN_RAD } else { ONCOMING_RAD }
}

/// Whether whoever is met is behind the vehicle (its index) already: then nothing is said of it any more.
pub fn has_met(scenario: &Scenario, frame: &Frame, vehicle: usize, passing: &PlannedPassing) -> bool {
    let other = scenario.index_of(&passing.of).and_then(|index| frame.vehicles.get(index));
    let is_behind = |other: &VehicleFrame| {
        let (own, other) = (&frame.vehicles[vehicle].state, &other.state);
        let (sin, cos) = libm::sincos(own.heading_rad);
        cos * (other.x_m - own.x_m) + sin * (other.y_m - own.y_m) < 0.0
    };
    is_met(scenario, vehicle, passing) && other.is_some_and(is_behind)
}

/// Whether the way in which a vehicle (its index) passes another one is put into words.
///
/// On which side those pass who come toward each other goes without saying. On a network that leads around corners the left and the right of another vehicle are elsewhere a moment later: there
/// only who goes ahead and who stays behind is said.
pub fn is_said(scenario: &Scenario, vehicle: usize, passing: &PlannedPassing) -> bool {
    let is_sideways = matches!(passing.side, PassingSide::Left | PassingSide::Right);
    let turns = |index: usize| leads_around_a_corner(&scenario.vehicles[index].route);
    let turn = || turns(vehicle) || scenario.index_of(&passing.of).is_some_and(turns);
    !is_sideways || !(is_met(scenario, vehicle, passing) || scenario.network.is_some() && turn())
}

/// An event as it is shown, without the subject: all are, but for passings that are not put into words.
pub fn event_text(scenario: &Scenario, frame: &Frame, event: &Event) -> Option<String> {
    let vehicle = scenario.index_of(&event.vehicle).and_then(|index| Some((index, frame.vehicles.get(index)?)));
    let passing = vehicle.and_then(|(index, vehicle)| {
        vehicle.plan.events.iter().find_map(|planned| match &planned.kind {
            PlanEventKind::Passing(passing) if planned.text == event.text => Some((index, passing)),
            _ => None,
        })
    });
    match passing {
        Some((index, passing)) if has_met(scenario, frame, index, passing) => None,
        Some((index, passing)) => passing_sentence(scenario, index, passing),
        None => Some(event.text.clone()),
    }
}

fn leads_around_a_corner(route: &Route) -> bool {
    let length_m = route.centre.length_m();
    let place = |part: usize| route.centre.position(length_m * part as f64 / PLACES as f64, 0.0);
    let direction = |part: usize| {
        let ([x, y], [next_x, next_y]) = (place(part), place(part + 1));
        [next_x - x, next_y - y]
    };
    let first = direction(0);
    let turned = |part: usize| {
        let along = direction(part);
        let (cross, dot) = (first[0] * along[1] - first[1] * along[0], first[0] * along[0] + first[1] * along[1]);
        libm::atan2(cross, dot).abs()
    };
    (1..PLACES).any(|part| turned(part) > TURN_RAD)
}

#[cfg(test)]
mod tests {
    use interplay_scenarios::load;

    use super::*;

    /// Nobody drives behind or ahead of a car that comes toward it.
    #[test]
    fn oncoming_vehicles_are_given_way_to() {
        let scenario = load("overtaking/oncoming", &[]).expect("embedded");
        let said = |of: &str, side| {
            passing_sentence(&scenario, scenario.ego_index(), &PlannedPassing { of: of.to_owned(), side })
        };
        assert_eq!(said("oncoming", PassingSide::Behind).as_deref(), Some("gives way to oncoming"));
        assert_eq!(said("oncoming", PassingSide::Ahead).as_deref(), Some("goes before oncoming"));
        assert_eq!(said("oncoming", PassingSide::Right), None);
        assert_eq!(said("lorry", PassingSide::Behind).as_deref(), Some("stays behind lorry"));
    }

    #[test]
    fn sides_are_said_on_one_road_and_not_on_a_ring() {
        let said = |name: &str, position| {
            let scenario = load(name, &[]).expect("embedded");
            let other = usize::from(scenario.ego_index() == 0);
            let passing = PlannedPassing { of: scenario.vehicles[other].name.clone(), side: position };
            is_said(&scenario, scenario.ego_index(), &passing)
        };
        for name in ["lane-change/front-nice", "on-ramp/five", "overtaking/oncoming", "curve/lane-drop"] {
            assert!(said(name, PassingSide::Left), "{name}");
        }
        for name in ["roundabout/nice", "left-turn/nice", "t-junction/bayesian-nice"] {
            assert!(!said(name, PassingSide::Right), "{name}");
            assert!(said(name, PassingSide::Behind), "{name}");
        }
    }
}
