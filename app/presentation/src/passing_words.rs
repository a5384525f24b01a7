//! Which ways of passing make sense in words: left and right are sides of one road only.

use interplay_planners::{PassingSide, PlanEventKind, PlannedPassing, Route};
use interplay_scenarios::Scenario;
use interplay_simulation::frame::{Event, Frame};

/// A route whose direction changes by more than this leads around a corner \[rad\].
const TURN_RAD: f64 = 0.6;
/// At how many places the direction of a route is looked at.
const PLACES: usize = 64;

/// Whether the way in which a vehicle (its index) passes another one is put into words.
///
/// On a network that leads around corners the left and the right of another vehicle are elsewhere a moment later: there
/// only who goes ahead and who stays behind is said.
pub fn is_said(scenario: &Scenario, vehicle: usize, passing: &PlannedPassing) -> bool {
    let is_sideways = matches!(passing.side, PassingSide::Left | PassingSide::Right);
    let turns = |index: usize| leads_around_a_corner(&scenario.vehicles[index].route);
    let turn = || turns(vehicle) || scenario.index_of(&passing.of).is_some_and(turns);
    !is_sideways || scenario.network.is_none() || !turn()
}

/// Whether an event is shown: all are, but for passings that are not put into words.
pub fn is_event_said(scenario: &Scenario, frame: &Frame, event: &Event) -> bool {
    let Some(index) = scenario.index_of(&event.vehicle) else { return true };
    let Some(vehicle) = frame.vehicles.get(index) else { return true };
    let passings = vehicle.plan.events.iter().filter(|planned| planned.text == event.text);
    passings.into_iter().all(|planned| match &planned.kind {
        PlanEventKind::Passing(passing) => is_said(scenario, index, passing),
        _ => true,
    })
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
