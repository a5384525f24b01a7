//! Words for how vehicles pass each other. Left and right are only meaningful on one road.

use interplay_planners::{PassingSide, PlanEventKind, PlannedPassing, Route, State};
use interplay_scenarios::Scenario;
use interplay_simulation::frame::{Event, Frame, VehicleFrame};

use crate::body::BodyStyle;
use crate::signals::wrapped;

/// A route that changes its direction by more than this turns a corner \[rad\].
const TURN_RAD: f64 = 0.6;
/// Number of samples of the direction of a route.
const DIRECTION_SAMPLES: usize = 64;

/// Vehicles whose initial directions differ by more than this are oncoming \[rad\].
const ONCOMING_RAD: f64 = 2.5;

/// The sentence, without its subject, for how a vehicle (its index) passes another one; `None` if [`has_words`] is false.
///
// An oncoming vehicle or a crossing pedestrian is not followed or led: one of the two goes first.
pub fn passing_sentence(scenario: &Scenario, vehicle: usize, passing: &PlannedPassing) -> Option<String> {
    let sentence = || match meeting_verb(scenario, vehicle, passing) {
        Some(verb) => format!("{verb} {}", passing.of),
        None => passing.sentence(),
    };
    has_words(scenario, vehicle, passing).then(sentence)
}

/// The verb for passing an oncoming vehicle or a crossing pedestrian; `None` for other vehicles and for passing on a side.
pub fn meeting_verb(scenario: &Scenario, vehicle: usize, passing: &PlannedPassing) -> Option<&'static str> {
    let verb = match passing.side {
        PassingSide::Ahead => "goes before",
        PassingSide::Behind => "gives way to",
        PassingSide::Left | PassingSide::Right => return None,
    };
    is_oncoming_or_crossing(scenario, vehicle, passing).then_some(verb)
}

/// Whether the other vehicle is oncoming, or a pedestrian who crosses, by their initial directions.
fn is_oncoming_or_crossing(scenario: &Scenario, vehicle: usize, passing: &PlannedPassing) -> bool {
    let Some(other) = scenario.index_of(&passing.of).map(|index| &scenario.vehicles[index]) else { return false };
    let turned_rad = wrapped(other.start.heading_rad - scenario.vehicles[vehicle].start.heading_rad).abs();
    turned_rad > if BodyStyle::choose(other) == BodyStyle::Walker { TURN_RAD } else { ONCOMING_RAD }
}

/// Whether the oncoming vehicle or crossing pedestrian is already behind the vehicle (its index) and no longer mentioned.
pub fn has_passed_oncoming(scenario: &Scenario, frame: &Frame, vehicle: usize, passing: &PlannedPassing) -> bool {
    let other = scenario.index_of(&passing.of).and_then(|index| frame.vehicles.get(index));
    let is_behind = |other: &VehicleFrame| {
        let (own, other) = (&frame.vehicles[vehicle].state, &other.state);
        let (sin, cos) = libm::sincos(own.heading_rad);
        cos * (other.x_m - own.x_m) + sin * (other.y_m - own.y_m) < 0.0
    };
    is_oncoming_or_crossing(scenario, vehicle, passing) && other.is_some_and(is_behind)
}

/// Whether a passing of a vehicle (its index) is put into words.
///
/// The side of an oncoming vehicle is self-evident. On a network whose routes turn corners, left and right change along the way,
/// so only passing ahead and behind has words.
pub fn has_words(scenario: &Scenario, vehicle: usize, passing: &PlannedPassing) -> bool {
    let is_sideways = matches!(passing.side, PassingSide::Left | PassingSide::Right);
    let turns = |index: usize| turns_a_corner(&scenario.vehicles[index].route);
    let turn = || turns(vehicle) || scenario.index_of(&passing.of).is_some_and(turns);
    !is_sideways || !(is_oncoming_or_crossing(scenario, vehicle, passing) || scenario.network.is_some() && turn())
}

/// The text of an event, without the subject; `None` for passings without words.
pub fn event_text(scenario: &Scenario, frame: &Frame, event: &Event) -> Option<String> {
    let vehicle = scenario.index_of(&event.vehicle).and_then(|index| Some((index, frame.vehicles.get(index)?)));
    let passing = vehicle.and_then(|(index, vehicle)| {
        vehicle.plan.events.iter().find_map(|planned| match &planned.kind {
            PlanEventKind::Passing(passing) if planned.text == event.text => Some((index, passing)),
            _ => None,
        })
    });
    match passing {
        Some((index, passing)) if has_passed_oncoming(scenario, frame, index, passing) => None,
        Some((index, passing)) => passing_sentence(scenario, index, passing),
        None => Some(event.text.clone()),
    }
}

fn turns_a_corner(route: &Route) -> bool {
    let length_m = route.centre.length_m();
    let place = |part: usize| route.centre.position(length_m * part as f64 / DIRECTION_SAMPLES as f64, 0.0);
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
    (1..DIRECTION_SAMPLES).any(|part| turned(part) > TURN_RAD)
}

/// The point midway between the corner of each vehicle that is nearest to the other vehicle \[m\].
pub fn contact_place(scenario: &Scenario, between: [usize; 2], states: [&State; 2]) -> Option<[f64; 2]> {
    let nearest = |own: usize| {
        let corners = scenario.vehicles[between[own]].body.corners(states[own]);
        let [x, y] = states[1 - own].position();
        let away = |corner: &[f64; 2]| libm::hypot(corner[0] - x, corner[1] - y);
        corners.into_iter().min_by(|a, b| away(a).total_cmp(&away(b)))
    };
    let [one, two] = [nearest(0)?, nearest(1)?];
    Some([0, 1].map(|axis| 0.5 * (one[axis] + two[axis])))
}

/// The corners of a star with eight points around a place.
pub fn star([x, y]: [f64; 2], size: f64) -> Vec<[f64; 2]> {
    let radius = |point: i32| if point % 2 == 0 { size } else { 0.5 * size };
    let at = |point: i32| libm::sincos(std::f64::consts::PI * f64::from(point) / 8.0);
    (0..16).map(|point| (at(point), radius(point))).map(|((sin, cos), r)| [x + r * cos, y + r * sin]).collect()
}

/// The indices of two vehicles with these names.
pub fn vehicle_indices(scenario: &Scenario, between: &[String; 2]) -> Option<[usize; 2]> {
    Some([scenario.index_of(&between[0])?, scenario.index_of(&between[1])?])
}

#[cfg(test)]
mod tests {
    use interplay_scenarios::load;

    use super::*;

    /// Ahead of and behind an oncoming vehicle mean to go before it and to give way to it.
    #[test]
    fn passing_an_oncoming_vehicle_is_described_as_right_of_way() {
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
    fn passing_sides_are_described_unless_routes_turn() {
        let said = |name: &str, position| {
            let scenario = load(name, &[]).expect("embedded");
            let other = usize::from(scenario.ego_index() == 0);
            let passing = PlannedPassing { of: scenario.vehicles[other].name.clone(), side: position };
            has_words(&scenario, scenario.ego_index(), &passing)
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
