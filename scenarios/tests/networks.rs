//! Networks of lanes, written out and as short forms, and vehicles on them.

use std::sync::Arc;

use interplay_planners::Route;
use interplay_planners::road::network::RoadNetwork;
use interplay_scenarios::{Scenario, from_text};

/// A scenario with a car on a road.
fn scenario(road: &str, vehicle: &str) -> Scenario {
    let text = format!(
        "title = 'a'\nshows = 'b'\n[road]\n{road}\n[[vehicle]]\nname = 'car'\n\
         body = {{ front_m = 2.2, rear_m = 2.2, width_m = 1.8, front_axle_m = 1.4, rear_axle_m = 1.4 }}\n\
         limits = {{ speed_max_mps = 40.0, steering_max_rad = 0.5 }}\n{vehicle}\n"
    );
    from_text("network.toml", &text, &[]).unwrap_or_else(|error| panic!("{road}: {error:?}"))
}

/// The network of a road with a lane of this name.
fn network(road: &str, lane: &str) -> Arc<RoadNetwork> {
    let vehicle = format!("start = {{ lane = '{lane}', along_m = 5.0, speed_mps = 1.0 }}\nroute = ['{lane}']");
    scenario(road, &vehicle).network.expect("it is a network")
}

/// The lanes into and out of a network: those without predecessors and those without successors.
fn ends(network: &RoadNetwork) -> [Vec<&str>; 2] {
    let lanes = network.lanes();
    let begins = lanes.iter().filter(|lane| !lanes.iter().any(|other| other.successors.contains(&lane.name)));
    let ends = lanes.iter().filter(|lane| lane.successors.is_empty());
    [begins.map(|lane| lane.name.as_str()).collect(), ends.map(|lane| lane.name.as_str()).collect()]
}

/// A route is smooth: neither heading nor curvature jumps.
fn assert_smooth(route: &Route, of: &str) {
    let (count, step_m) = ((route.end_m() / 0.1) as usize, 0.1);
    let mut before = route.centre.at(0.0);
    for index in 1..=count {
        let at = route.centre.at(step_m * index as f64);
        let apart_m = libm::hypot(at.position[0] - before.position[0], at.position[1] - before.position[1]);
        assert!((apart_m - step_m).abs() < 1e-3, "{of}: a gap at {} m", step_m * index as f64);
        let bend = (at.curvature_1pm - before.curvature_1pm).abs();
        assert!(bend < 0.03, "{of}: the curvature jumps by {bend} at {} m", step_m * index as f64);
        before = at;
    }
}

/// Every way through a junction can be driven with a turning radius of 5.5 m.
fn assert_drivable(road: &str, lane: &str, pairs: usize) {
    let network = network(road, lane);
    let [begins, ends] = ends(&network);
    let mut found = 0;
    for from in &begins {
        for to in &ends {
            let Ok(route) = network.shortest_route(from, to) else { continue };
            let of = format!("{road}: {from} to {to}");
            assert!(route.check_turns(5.5).is_ok(), "{of}: {:?}", route.tightest_turn());
            assert_smooth(&route, &of);
            for lane in route.legs.iter().filter_map(|leg| network.lane(&leg.lane)) {
                assert!(lane.speed_limit_mps.is_some_and(|limit_mps| limit_mps > 2.0), "{of}: {}", lane.name);
            }
            found += 1;
        }
    }
    assert_eq!(found, pairs, "{road}: {begins:?} to {ends:?}");
}

#[test]
fn every_way_through_a_short_form_can_be_driven() {
    assert_drivable("kind = 'roundabout'", "east-in", 16);
    assert_drivable("kind = 'roundabout'\narms = 3", "arm-0-in", 9);
    assert_drivable("kind = 'roundabout'\narms = 5\nradius_m = 18", "arm-0-in", 25);
    assert_drivable("kind = 'roundabout'\narms = 6\nradius_m = 18", "arm-5-in", 36);
    assert_drivable("kind = 'roundabout'\nlane_count = 2\nradius_m = 20", "east-in-1", 64);
    assert_drivable("kind = 't-junction'", "south-in", 6);
    assert_drivable("kind = 'crossing'", "north-in", 12);
    assert_drivable("kind = 'crossing'\nturning_lanes = true", "west-in-1", 18);
    assert_drivable("kind = 'all-way-stop'", "north-in", 12);
    assert_drivable("kind = 'on-ramp'", "ramp", 7);
    assert_drivable("kind = 'narrow-passage'", "east-in", 2);
    assert_drivable("kind = 'two-way'", "east", 2);
}
