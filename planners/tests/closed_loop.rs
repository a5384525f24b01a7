//! Planners and humans together on a road, in the loop that the application runs, with the bicycle as the plant.

mod common;

use common::world::{LANES, Run, Vehicle, human, run, vehicle};
use interplay_planners::Driver;
use interplay_planners::drivers::human::Style;
use interplay_planners::drivers::{conservative, negotiation};
use interplay_planners::road::centre_line::FrenetPoint;

/// The ego changes lanes ahead of, between or behind two faster humans.
fn lane_change(driver: Driver, styles: [Style; 2]) -> Run {
    let (steady, wants) = ([0.0, 4.0, 1.0, 1.0], [LANES[1], 1.4]);
    let vehicles = vec![
        vehicle("ego", [0.0, LANES[0], 1.0], [LANES[1], 1.0], [0.0, 1.0, 0.5, 1.0], driver),
        vehicle("front", [-0.4, LANES[1], 1.4], wants, steady, human(styles[0])),
        vehicle("rear", [-1.7, LANES[1], 1.4], wants, steady, human(styles[1])),
    ];
    let run = run(vehicles, 120);
    assert!(run.failures.is_empty(), "{:?}", run.failures);
    run
}

/// Who is where once the ego has merged: from the front of the road to its rear.
fn merged_order(driver: Driver, styles: [Style; 2]) -> Vec<String> {
    let run = lane_change(driver, styles);
    let merged = run.first(0, |state| state.y_m > 0.5).expect("the ego merges");
    assert!(run.nearest > 0.99, "the ego entered a safety ellipse: {}", run.nearest);
    run.order_at(merged).into_iter().map(str::to_owned).collect()
}

#[test]
fn a_negotiator_goes_ahead_of_nice_drivers_and_a_conservative_one_between_them() {
    let nice = [Style::Nice; 2];
    assert_eq!(merged_order(negotiator(), nice), ["ego", "front", "rear"]);
    let conservative = Driver::Conservative(conservative::Settings::default());
    assert_eq!(merged_order(conservative, nice), ["front", "ego", "rear"]);
}

#[test]
fn a_negotiator_lets_a_tough_driver_pass() {
    use Style::{Nice, Tough};
    assert_eq!(merged_order(negotiator(), [Tough, Nice]), ["front", "ego", "rear"]);
    assert_eq!(merged_order(negotiator(), [Tough, Tough]), ["front", "rear", "ego"]);
}

fn negotiator() -> Driver {
    Driver::Negotiation(negotiation::Settings::default())
}

/// Drives towards a road blocked by standing cars; returns how near the ego comes to the one in its lane, bumper to bumper,
/// and how far a corner of it leaves the road \[m\].
fn towards_a_standing_car(driver: Driver, ahead_m: f64) -> (f64, f64) {
    let ego = vehicle("ego", [0.0, LANES[0], 1.0], [LANES[0], 1.0], [0.0, 1.0, 0.5, 1.0], driver);
    let agent = ego.agent.clone();
    let run = run(vec![ego, standing(ahead_m, LANES[0]), standing(ahead_m, LANES[1])], 80);
    assert!(run.failures.is_empty(), "{:?}", run.failures);
    let (mut gap_m, mut beyond_m) = (f64::INFINITY, 0.0_f64);
    for state in run.states.iter().map(|states| states[0]) {
        gap_m = gap_m.min(ahead_m - state.x_m - agent.body.front_m - agent.body.rear_m);
        let clearances = agent.route.clearances(&agent.body, &state, &FrenetPoint::default());
        beyond_m = clearances.iter().map(|corner| -corner.value).fold(beyond_m, f64::max);
    }
    (gap_m, beyond_m)
}

/// Stands still and wants to.
fn standing(x_m: f64, y_m: f64) -> Vehicle {
    let wants = [y_m, 0.0];
    vehicle(&format!("car at {y_m}"), [x_m, y_m, 0.0], wants, [0.0, 0.0, 1.0, 1.0], human(Style::Tough))
}

#[test]
fn all_vehicles_stop_in_front_of_a_blocked_road() {
    for ahead_m in [1.5, 2.0, 2.5, 3.0, 3.5] {
        for driver in [human(Style::Tough), Driver::Conservative(conservative::Settings::default())] {
            let kind = driver.kind();
            let (gap_m, beyond_m) = towards_a_standing_car(driver, ahead_m);
            assert!(gap_m > 0.02, "{kind}: {gap_m} m before a car {ahead_m} m ahead");
            assert!(beyond_m < 1e-3, "{kind}: {beyond_m} m off the road");
        }
    }
}
