//! A single vehicle takes every turn at a speed at which it stays on its road.

use interplay_planners::road::network::RoadNetwork;
use interplay_scenarios::{Scenario, from_text};
use interplay_simulation::report::VehicleReport;
use interplay_simulation::run::run;

/// Tolerance of the distance beyond the edge of the road \[m\].
const MOST_OFF_ROAD_M: f64 = 0.05;
/// Tolerance above the speed limit, unless the vehicle starts faster \[m/s\].
const MOST_SPEEDING_MPS: f64 = 0.1;

/// A single car with IDM.
fn scenario(road: &str, start: &str, goal: &str, speed_mps: f64) -> Scenario {
    let text = format!(
        "title = 'a'\nshows = 'b'\nscale = 'full'\nduration_s = 75.0\n[road]\n{road}\n[[vehicle]]\nname = 'car'\n\
         start = {{ lane = {start}, along_m = 5.0, speed_mps = {speed_mps:?} }}\n\
         goal = {{ lane = {goal}, speed_mps = {speed_mps:?} }}\ndriver = {{ kind = 'idm' }}\n"
    );
    from_text("turn.toml", &text, &[]).unwrap_or_else(|error| panic!("{road}: {error:?}"))
}

/// The report of the car, after a check that it stayed on its road.
fn driven(scenario: &Scenario, of: &str) -> VehicleReport {
    let mut report = run("turn", scenario, Vec::new()).unwrap_or_else(|error| panic!("{of}: {error}"));
    let car = report.vehicles.remove(0);
    let off_road_m = car.metrics.number("off_road_m").expect("measured");
    assert!(off_road_m <= MOST_OFF_ROAD_M, "{of}: {off_road_m} m beside its road");
    car
}

/// The lanes without predecessors, and those without successors.
fn ends(network: &RoadNetwork) -> [Vec<&str>; 2] {
    let lanes = network.lanes();
    let begins = lanes.iter().filter(|lane| !lanes.iter().any(|other| other.successors.contains(&lane.name)));
    let ends = lanes.iter().filter(|lane| lane.successors.is_empty());
    [begins.map(|lane| lane.name.as_str()).collect(), ends.map(|lane| lane.name.as_str()).collect()]
}

/// Drives every route through a network at several speeds. Returns the number of routes.
fn drive_every_way(road: &str, lane: &str, speeds_mps: &[f64]) -> usize {
    let quoted = |lane: &str| format!("'{lane}'");
    let network = scenario(road, &quoted(lane), &quoted(lane), 1.0).network.expect("a network");
    let [begins, ends] = ends(&network);
    let mut ways = 0;
    for (from, to) in begins.iter().flat_map(|from| ends.iter().map(move |to| (from, to))) {
        if network.shortest_route(from, to).is_err() {
            continue;
        }
        let limit_mps = network.lane(from).and_then(|lane| lane.speed_limit_mps).expect("a limit");
        for speed_mps in speeds_mps {
            let of = format!("{road}: {from} to {to} at {speed_mps} m/s");
            let scenario = scenario(road, &quoted(from), &quoted(to), *speed_mps);
            let (car, route) = (driven(&scenario, &of), &scenario.vehicles[0].route);
            let driven_share = route.along(car.last.position()) / route.end_m();
            assert!(driven_share > 0.75, "{of}: it stops after {driven_share} of its way");
            let speeding_mps = car.metrics.number("speeding_mps").expect("there are limits");
            let at_start_mps = (speed_mps - limit_mps).max(0.0);
            assert!(speeding_mps <= at_start_mps + MOST_SPEEDING_MPS, "{of}: {speeding_mps} m/s too fast");
        }
        ways += 1;
    }
    ways
}

/// At speeds below, at and above the limit of the road from which it comes.
#[test]
fn an_idm_driver_stays_on_the_road_in_every_turn_of_every_junction() {
    let speeds_mps = [8.0, 10.0, 12.0, 13.9, 18.0];
    assert_eq!(drive_every_way("kind = 't-junction'", "west-in", &speeds_mps), 6);
    assert_eq!(drive_every_way("kind = 't-junction'\nturning_lanes = true", "west-in", &speeds_mps), 8);
    assert_eq!(drive_every_way("kind = 'roundabout'", "west-in", &speeds_mps), 16);
    assert_eq!(drive_every_way("kind = 'roundabout'\nlane_count = 2\nradius_m = 20", "west-in-1", &[8.0, 18.0]), 64);
    assert_eq!(drive_every_way("kind = 'crossing'", "west-in", &speeds_mps), 12);
    assert_eq!(drive_every_way("kind = 'crossing'\nturning_lanes = true", "west-in-0", &speeds_mps), 18);
    assert_eq!(drive_every_way("kind = 'all-way-stop'", "west-in", &[8.0, 18.0]), 12);
    assert_eq!(drive_every_way("kind = 'on-ramp'", "ramp", &[10.0, 16.7, 25.0]), 7);
}

/// Roads of pieces have no speed limits; the tyres limit the speed.
#[test]
fn an_idm_driver_stays_on_the_road_in_a_curve() {
    let pieces = "pieces = [{ straight_m = 80 }, { turn_deg = 90, radius_m = 20 }, { turn_deg = -90, radius_m = 15 }]";
    for (lane, speed_mps) in [("0", 8.0), ("0", 14.0), ("1", 14.0), ("0", 20.0), ("1", 20.0)] {
        let road = format!("kind = 'curve'\nlane_width_m = 3.5\n{pieces}");
        let car = driven(&scenario(&road, lane, lane, speed_mps), &format!("lane {lane} at {speed_mps} m/s"));
        // The curves end about 115 m ahead of the start and 35 m to its left.
        assert!(car.last.x_m > 110.0 && car.last.y_m > 30.0, "lane {lane} at {speed_mps} m/s: {:?}", car.last);
    }
}
