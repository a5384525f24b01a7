//! Networks of lanes, written out and as short forms, and vehicles on them.

use std::sync::Arc;
use std::time::Instant;

use interplay_planners::Route;
use interplay_planners::road::network::{NeighbourRelation, RightOfWay, RoadNetwork};
use interplay_scenarios::{Override, Registry, Scenario, from_text, load};

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
fn every_route_through_a_junction_form_is_drivable() {
    assert_drivable("kind = 'roundabout'", "east-in", 16);
    assert_drivable("kind = 'roundabout'\narms = 3", "arm-0-in", 9);
    assert_drivable("kind = 'roundabout'\narms = 5\nradius_m = 18", "arm-0-in", 25);
    assert_drivable("kind = 'roundabout'\narms = 6\nradius_m = 18", "arm-5-in", 36);
    assert_drivable("kind = 'roundabout'\nlane_count = 2\nradius_m = 20", "east-in-1", 64);
    assert_drivable("kind = 't-junction'", "south-in", 6);
    assert_drivable("kind = 't-junction'\nturning_lanes = true", "east-in-1", 8);
    assert_drivable("kind = 'crossing'", "north-in", 12);
    assert_drivable("kind = 'crossing'\nturning_lanes = true", "west-in-1", 18);
    assert_drivable("kind = 'all-way-stop'", "north-in", 12);
    assert_drivable("kind = 'on-ramp'", "ramp", 7);
    assert_drivable("kind = 'narrow-passage'", "east-in", 2);
    assert_drivable("kind = 'two-way'", "east", 2);
}

/// A start names a lane and a goal the lane to reach: the state lies on the lane, and the route leads there.
#[test]
fn a_start_in_a_lane_becomes_a_state_at_the_start_of_the_route() {
    let vehicle = "start = { lane = 'west-in', along_m = 12.0, lateral_offset_m = 0.5, heading_error_deg = 5.0, \
        speed_mps = 7.0 }\ngoal = { lane = 'north-out', speed_mps = 9.0 }";
    let scenario = scenario("kind = 'crossing'", vehicle);
    let car = &scenario.vehicles[0];
    assert!((car.start.x_m + 88.0).abs() < 1e-9 && (car.start.y_m + 1.25).abs() < 1e-9, "{:?}", car.start);
    assert!((car.start.heading_rad - 5_f64.to_radians()).abs() < 1e-12);
    let lanes: Vec<&str> = car.route.legs.iter().map(|leg| leg.lane.as_str()).collect();
    assert_eq!(lanes, ["west-in", "west-to-north", "north-out"]);
    let place = car.route.locate(car.start.position(), None);
    assert!((place.along_m - 12.0).abs() < 1e-9 && (place.across_m - 0.5).abs() < 1e-9, "{place:?}");
    let target = car.target(&scenario.road);
    assert!((target.x_m + 88.0).abs() < 1e-9 && (target.y_m + 1.75).abs() < 1e-9, "the middle of the lane: {target:?}");
    assert_eq!((target.heading_rad, target.speed_mps), (0.0, 9.0));
    assert_eq!(scenario.main_route(), car.route);
}

#[test]
fn the_same_route_can_be_stated_lane_by_lane_and_from_world_coordinates() {
    let on = |vehicle: &str| scenario("kind = 't-junction'", vehicle).vehicles[0].clone();
    let by_goal = on("start = { lane = 'south-in', along_m = 20.0, speed_mps = 5.0 }\ngoal = { lane = 'west-out' }");
    let by_lanes = on("start = { lane = 'south-in', along_m = 20.0, speed_mps = 5.0 }\n\
        route = ['south-in', 'south-to-west', 'west-out']");
    let by_place = on("start = { x_m = 1.75, y_m = -80.0, heading_deg = 95.0, speed_mps = 5.0 }\n\
        goal = { lane = 'west-out' }");
    assert_eq!((&by_goal.route, &by_goal.route), (&by_lanes.route, &by_place.route));
    assert!(by_goal.start.to_array().iter().zip(by_lanes.start.to_array()).all(|(a, b)| (a - b).abs() < 1e-12));
    assert!((by_place.start.heading_rad - 95_f64.to_radians()).abs() < 1e-12);
    // In the junction three lanes overlap: the one that leads to the goal is taken.
    let inside = on("start = { x_m = 1.75, y_m = -11.0, heading_deg = 90.0, speed_mps = 5.0 }\n\
        goal = { lane = 'east-out' }");
    assert_eq!(inside.route.legs[0].lane, "south-to-east");
}

/// Headings are those of the route, which may turn by more than half a circle.
#[test]
fn headings_along_a_ring_continue_beyond_a_full_turn() {
    let car = |along_m: f64| {
        let start = format!(
            "start = {{ lane = 'ring-north', along_m = {along_m:?}, speed_mps = 5.0 }}\ngoal = {{ lane = 'north-out' }}"
        );
        scenario("kind = 'roundabout'", &start).vehicles[0].clone()
    };
    let (early, late) = (car(1.0), car(5.0));
    assert!(early.start.heading_rad < late.start.heading_rad);
    assert!((late.start.heading_rad - early.start.heading_rad - 4.0 / 15.0).abs() < 1e-6);
    let route = &late.route;
    let turned = route.centre.at(route.end_m()).heading_rad - route.centre.at(0.0).heading_rad;
    assert!(turned > std::f64::consts::PI, "it goes on around the ring: {turned}");
}

#[test]
fn a_vehicle_without_a_goal_takes_the_only_route() {
    let lanes = |road: &str, lane: &str| {
        let vehicle = format!("start = {{ lane = '{lane}', along_m = 20.0, speed_mps = 5.0 }}");
        let car = scenario(road, &vehicle).vehicles[0].clone();
        car.route.legs.iter().map(|leg| leg.lane.clone()).collect::<Vec<_>>()
    };
    assert_eq!(lanes("kind = 'narrow-passage'", "west-in"), ["west-in", "west-passage", "west-out"]);
    assert_eq!(lanes("kind = 'on-ramp'", "ramp"), ["ramp", "acceleration"]);
    assert_eq!(lanes("kind = 'two-way'", "east"), ["east"]);
}

/// The right of way and the neighbouring lanes of the short forms.
#[test]
fn junction_forms_define_right_of_way_and_lane_changes() {
    let right_of_way = |road: &str, lane: &str| network(road, lane).lane(lane).expect("it is there").right_of_way;
    assert_eq!(right_of_way("kind = 'roundabout'", "north-in"), RightOfWay::Yield);
    assert_eq!(right_of_way("kind = 't-junction'", "south-in"), RightOfWay::Yield);
    assert_eq!(right_of_way("kind = 't-junction'\nright_of_way = 'stop'", "south-in"), RightOfWay::Stop);
    assert_eq!(right_of_way("kind = 't-junction'", "west-in"), RightOfWay::Priority);
    assert_eq!(right_of_way("kind = 'crossing'\nminor = 'stop'", "north-in"), RightOfWay::Stop);
    assert_eq!(right_of_way("kind = 'all-way-stop'", "east-in"), RightOfWay::AllWayStop);
    assert_eq!(right_of_way("kind = 'on-ramp'", "acceleration"), RightOfWay::Yield);
    assert_eq!(right_of_way("kind = 'narrow-passage'\npriority_to = 'east'", "west-in"), RightOfWay::Yield);
    assert_eq!(right_of_way("kind = 'narrow-passage'", "west-in"), RightOfWay::Priority);
    let left = |road: &str, lane: &str| {
        let network = network(road, lane);
        let left = network.lane(lane).and_then(|lane| lane.left.clone()).expect("a neighbour");
        (left.lane.clone(), left.relation, left.may_change)
    };
    let oncoming = NeighbourRelation::Oncoming;
    assert_eq!(left("kind = 'two-way'", "east"), ("west".to_owned(), oncoming, true));
    assert_eq!(left("kind = 'two-way'\novertaking = false", "east"), ("west".to_owned(), oncoming, false));
    assert_eq!(left("kind = 'on-ramp'", "acceleration"), ("main-0".to_owned(), NeighbourRelation::SameDirection, true));
    assert!(
        network("kind = 'on-ramp'", "main-0").lane("main-0").is_some_and(|lane| !lane.may_change_to("acceleration"))
    );
}

/// A T-junction has one turning lane: from the east, where the minor road is to the left.
#[test]
fn the_turning_lane_of_a_t_junction_leads_into_the_minor_road() {
    let network = network("kind = 't-junction'\nturning_lanes = true", "east-in-1");
    let leads_to = |lane: &str| network.lane(lane).expect("it is there").successors.clone();
    assert_eq!(leads_to("east-in-1"), ["east-to-south"]);
    assert_eq!(leads_to("east-in-0"), ["east-to-west"]);
    assert_eq!(leads_to("west-in"), ["west-to-east", "west-to-south"]);
    assert!(network.lane("west-in-1").is_none());
    // Its lanes lie opposite each other, with an island as wide as the turning lane.
    let at = |lane: &str| network.lane(lane).expect("it is there").centre.at(0.0).position[1];
    assert_eq!(["east-in-0", "east-in-1", "east-out", "west-in", "west-out"].map(at), [3.5, 0.0, -3.5, -3.5, 3.5]);
    assert_eq!(network.lane("west-in").and_then(|lane| lane.left.clone()), None);
}

/// Pieces end where they would end without the smooth curves between them, so that lanes can be laid out by hand.
#[test]
fn a_lane_ends_where_its_pieces_end() {
    let road = "kind = 'network'\nlane = [{ name = 'bend', start = { x_m = 5.0, y_m = 3.0, heading_deg = 90.0 }, \
        width_m = [[0.0, 3.5], [20.0, 3.0]], speed_limit_mps = 8.0, right_of_way = 'stop', \
        pieces = [{ straight_m = 20.0 }, { turn_deg = -90.0, radius_m = 10.0 }, { straight_m = 15.0 }] }]";
    let network = network(road, "bend");
    let bend = network.lane("bend").expect("it is there");
    let end = bend.centre.at(bend.centre.length_m());
    assert!((end.position[0] - 30.0).abs() < 1e-9 && (end.position[1] - 33.0).abs() < 1e-9, "{end:?}");
    assert!(libm::sin(end.heading_rad).abs() < 1e-9, "{end:?}");
    assert_smooth(&network.route(&["bend"]).expect("a lane"), "the bend");
    let widths_m = [0.0, 20.0, 40.0].map(|along_m| bend.width.value(along_m));
    assert!(widths_m.iter().zip([3.5, 3.0, 3.0]).all(|(a, b)| (a - b).abs() < 1e-12), "{widths_m:?}");
    assert_eq!((bend.speed_limit_mps, bend.right_of_way), (Some(8.0), RightOfWay::Stop));
}

/// `interplay new` writes a file that means the same.
#[test]
fn networks_are_written_and_read_back() {
    let folder = tempfile::tempdir().expect("a folder");
    let lanes = "kind = 'network'\n[[road.lane]]\nname = 'a'\npoints = [[0.0, 0.0], [50.0, 1.0]]\nwidth_m = 3.5\n\
        left = 'b'\nsuccessors = ['c']\n[[road.lane]]\nname = 'b'\npoints = [[0.0, 3.5], [50.0, 4.5]]\n\
        width_m = [[0.0, 3.5], [50.0, 3.0]]\nright = { lane = 'a', may_change = false }\n[[road.lane]]\nname = 'c'\n\
        points = [[50.0, 1.0], [90.0, 2.0]]\nwidth_m = 3.0\nright_of_way = 'yield'";
    let cases = [
        (lanes, "start = { lane = 'a', along_m = 9.0, speed_mps = 1.0 }\nroute = ['a', 'c']"),
        (
            "kind = 'roundabout'",
            "start = { lane = 'west-in', along_m = 9.0, speed_mps = 1.0 }\ngoal = { lane = 'east-out' }",
        ),
        (
            "kind = 'narrow-passage'\npriority_to = 'east'",
            "start = { lane = 'east-in', along_m = 9.0, speed_mps = 1.0 }",
        ),
    ];
    for (road, vehicle) in cases {
        let text = format!("title = 'a'\nshows = 'b'\n[[vehicle]]\nname = 'car'\n{vehicle}\n[road]\n{road}\n");
        let path = folder.path().join("first.toml");
        std::fs::write(&path, &text).expect("the folder can be written");
        let first = load(&path.to_string_lossy(), &[]).unwrap_or_else(|error| panic!("{road}: {error:?}"));
        let written = Registry::standard().commented(&path.to_string_lossy(), folder.path(), false).expect("it loads");
        let second = from_text("second.toml", &written, &[]).unwrap_or_else(|error| panic!("{written}\n{error:?}"));
        assert_eq!(first, second, "{written}");
        assert!(second.network.is_some());
    }
}

/// A variant changes one lane of its parent's network by name.
#[test]
fn flags_change_the_lane_with_a_given_name() {
    let text = "title = 'a'\nshows = 'b'\n[[vehicle]]\nname = 'car'\nstart = { lane = 'a', along_m = 9.0, speed_mps = 1.0 }\n\
        [road]\nkind = 'network'\n[[road.lane]]\nname = 'a'\npoints = [[0.0, 0.0], [50.0, 1.0]]\nwidth_m = 3.5\n";
    let set = Override::Set("road.lane.a.speed_limit_mps=9.5".to_owned());
    let scenario = from_text("a.toml", text, &[set]).expect("a sound change");
    let network = scenario.network.expect("a network");
    assert_eq!(network.lane("a").and_then(|lane| lane.speed_limit_mps), Some(9.5));
}

/// Lanes of a millimetre would be compared at millions of places before the cars turn out not to fit.
#[test]
fn cars_on_lanes_of_a_millimetre_are_refused_quickly() {
    let car = |name: &str, lane: &str| {
        format!("[[vehicle]]\nname = \"{name}\"\nstart = {{ lane = \"{lane}\", along_m = 5.0, speed_mps = 9.0 }}\n")
    };
    let road = "kind = \"narrow-passage\"\npassage_width_m = 3.2\npassage_m = 5000.0\nlane_width_m = 0.001";
    let cars = [car("one", "west-in"), car("other", "east-in")].concat();
    let begun = Instant::now();
    let error = from_text("bad.toml", &format!("title = \"a\"\nshows = \"b\"\n[road]\n{road}\n{cars}"), &[]);
    let error = error.expect_err("the cars do not fit");
    let too_wide = error.faults().iter().filter(|fault| fault.message().contains("wide, but lane")).count();
    assert_eq!(too_wide, 2, "{error:?}");
    assert!(begun.elapsed().as_secs() < 10, "{:?}", begun.elapsed());
}
