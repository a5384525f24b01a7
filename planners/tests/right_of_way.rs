//! Who goes first at a crossing with oncoming traffic, in the rules and in the driving of humans and of the intelligent driver
//! model.

mod common;

use common::junction::{crossing, on_route, routes};
use common::world::{Run, human, run};
use interplay_planners::Driver;
use interplay_planners::drivers::human::Style;
use interplay_planners::drivers::idm;
use interplay_planners::road::network::{ConflictKind, Precedence, RightOfWay};

const PRIORITY_ROAD: [RightOfWay; 4] =
    [RightOfWay::Priority, RightOfWay::Yield, RightOfWay::Priority, RightOfWay::Yield];

/// Who goes first of two ways, seen by the first; none where they do not meet.
fn precedence(signs: [RightOfWay; 4], own: [&str; 2], other: [&str; 2]) -> Option<(ConflictKind, Precedence)> {
    let found = routes(&crossing(signs), &[own, other]);
    let conflicts: Vec<_> = found[0].conflicts_with(&found[1]).collect();
    let mirrored: Vec<_> = found[1].conflicts_with(&found[0]).collect();
    assert_eq!(conflicts.len(), mirrored.len());
    for (conflict, mirror) in conflicts.iter().zip(&mirrored) {
        let swapped = match conflict.precedence {
            Precedence::Own => Precedence::Other,
            Precedence::Other => Precedence::Own,
            Precedence::ByArrival => Precedence::ByArrival,
        };
        assert_eq!((mirror.precedence, mirror.kind), (swapped, conflict.kind));
    }
    conflicts.first().map(|conflict| (conflict.kind, conflict.precedence))
}

#[test]
fn signs_and_rules_decide_which_vehicle_goes_first() {
    use ConflictKind::{Crossing, Merging};
    use Precedence::{ByArrival, Other, Own};
    let at = |own, other| precedence(PRIORITY_ROAD, own, other);
    assert_eq!(at(["west", "east"], ["south", "north"]), Some((Crossing, Own)));
    assert_eq!(at(["south", "east"], ["west", "east"]), Some((Merging, Other)));
    assert_eq!(at(["west", "north"], ["east", "west"]), Some((Crossing, Other)), "a left turn across oncoming traffic");
    assert_eq!(at(["west", "north"], ["south", "north"]), Some((Merging, Own)), "from the priority road");
    assert_eq!(at(["west", "east"], ["east", "west"]), None, "lanes side by side");
    let at = |own, other| precedence([RightOfWay::Priority; 4], own, other);
    assert_eq!(at(["west", "east"], ["south", "north"]), Some((Crossing, Other)), "from the right");
    assert_eq!(at(["west", "east"], ["north", "south"]), Some((Crossing, Own)), "from the left");
    let at = |own, other| precedence([RightOfWay::AllWayStop; 4], own, other);
    assert_eq!(at(["west", "east"], ["north", "south"]), Some((Crossing, ByArrival)));
}

/// When each vehicle's rear leaves the middle, in ticks, and whether a vehicle stood on the way.
fn crossing_ticks(run: &Run, count: usize) -> Vec<Option<usize>> {
    let is_out = |state: &interplay_planners::State| libm::hypot(state.x_m, state.y_m) > 1.5;
    (0..count)
        .map(|vehicle| {
            let inside = run.states.iter().position(|states| !is_out(&states[vehicle]))?;
            run.states[inside..].iter().position(|states| is_out(&states[vehicle])).map(|ticks| inside + ticks)
        })
        .collect()
}

fn drivers() -> [Driver; 3] {
    [human(Style::Nice), human(Style::Tough), Driver::Idm(idm::Settings::default())]
}

/// Whatever their styles, a vehicle that yields waits for both vehicles of the priority road and crosses then. With the signs turned round
/// the same vehicle crosses first.
#[test]
fn a_vehicle_that_yields_crosses_after_those_with_priority() {
    let mut turned_round = PRIORITY_ROAD;
    turned_round.rotate_left(1);
    for (signs, waits) in [(PRIORITY_ROAD, true), (turned_round, false)] {
        let network = crossing(signs);
        for driver in drivers() {
            let found = routes(&network, &[["south", "north"], ["west", "east"], ["east", "west"]]);
            let vehicles = vec![
                on_route("minor", &found[0], 1.0, 1.0, driver.clone()),
                on_route("eastbound", &found[1], 1.2, 1.0, driver.clone()),
                on_route("westbound", &found[2], 1.6, 1.0, driver.clone()),
            ];
            let run = run(vehicles, 120);
            let ticks = crossing_ticks(&run, 3);
            assert_eq!(run.collision, None, "{driver:?}");
            assert!(ticks.iter().all(Option::is_some), "{driver:?} {ticks:?}");
            assert_eq!(ticks[0] > ticks[1], waits, "{driver:?} {ticks:?}");
            assert_eq!(ticks[0] > ticks[2], waits, "{driver:?} {ticks:?}");
        }
    }
}

/// At an all-way stop each vehicle stands once, and they go in the order of arrival.
#[test]
fn vehicles_leave_an_all_way_stop_in_the_order_of_arrival() {
    let network = crossing([RightOfWay::AllWayStop; 4]);
    for driver in drivers() {
        let found = routes(&network, &[["south", "north"], ["west", "east"], ["east", "south"], ["north", "east"]]);
        let starts = [("third", 1.8), ("first", 0.8), ("fourth", 2.4), ("second", 1.3)];
        let vehicles = found
            .iter()
            .zip(starts)
            .map(|(route, (name, before_m))| on_route(name, route, before_m, 0.8, driver.clone()));
        let run = run(vehicles.collect(), 300);
        let ticks = crossing_ticks(&run, 4);
        assert_eq!(run.collision, None, "{driver:?}");
        let [third, first, fourth, second] = [ticks[0], ticks[1], ticks[2], ticks[3]];
        assert!(first.is_some() && first < second && second < third && third < fourth, "{driver:?} {ticks:?}");
        for vehicle in 0..4 {
            let slowest = run.states.iter().map(|states| states[vehicle].speed_mps).fold(f64::INFINITY, f64::min);
            assert!(slowest < 0.13, "{driver:?}: vehicle {vehicle} did not stop: {slowest}");
        }
    }
}

/// Without a vehicle to yield to, a yield sign delays none, and a stop sign does.
#[test]
fn a_free_junction_is_crossed_without_waiting_unless_a_sign_requires_it() {
    for (sign, stands) in [(RightOfWay::Yield, false), (RightOfWay::Stop, true)] {
        for driver in drivers() {
            let found = routes(&crossing([sign; 4]), &[["south", "north"]]);
            let run = run(vec![on_route("alone", &found[0], 1.5, 1.0, driver.clone())], 100);
            let slowest = run.states.iter().map(|states| states[0].speed_mps).fold(f64::INFINITY, f64::min);
            assert_eq!(slowest < 0.13, stands, "{driver:?} {sign:?}: {slowest}");
            assert!(crossing_ticks(&run, 1)[0].is_some());
        }
    }
}

/// Where all have to let the one from the right pass and all stand, the first to arrive goes, and no vehicles touch.
#[test]
fn a_circle_of_yielding_drivers_is_broken_by_the_first_to_arrive() {
    for sign in [RightOfWay::Yield, RightOfWay::Stop, RightOfWay::Priority] {
        for driver in drivers() {
            let ways = [["south", "north"], ["west", "east"], ["north", "south"], ["east", "west"]];
            let found = routes(&crossing([sign; 4]), &ways);
            let named = found.iter().zip(["a", "b", "c", "d"]);
            let vehicles = named.map(|(route, name)| on_route(name, route, 1.2, 0.8, driver.clone())).collect();
            let run = run(vehicles, 400);
            assert_eq!(run.collision, None, "{driver:?} {sign:?}");
            let ticks = crossing_ticks(&run, 4);
            let last = run.states.last();
            assert!(ticks.iter().all(Option::is_some), "{driver:?} {sign:?} {ticks:?} {last:?}");
        }
    }
}
