//! Curved roads, and places in the lanes of every road.

mod common;

use common::{least, set};
use interplay_scenarios::{Branch, Override, Road, Scenario, embedded, from_text, load};

/// Two lanes of 3.5 m that turn by 200° to the left and by 110° to the right, with a start for each test.
fn curved(vehicle: &str, overrides: &[Override]) -> Scenario {
    let text = format!(
        "title = 'a'\nshows = 'b'\n[road]\nkind = 'curve'\nlane_width_m = 3.5\ntransition_m = 8.0\npieces = [\n\
         {{ straight_m = 100.0 }},\n{{ turn_deg = 200.0, radius_m = 25.0 }},\n{{ straight_m = 20.0 }},\n\
         {{ turn_deg = -110.0, radius_m = 15.0 }}]\n\
         [[vehicle]]\nname = 'car'\nbody = {{ front_m = 2.2, rear_m = 2.2, width_m = 1.8 }}\n\
         limits = {{ speed_max_mps = 20.0 }}\n{vehicle}\n"
    );
    from_text("curved.toml", &text, overrides).unwrap_or_else(|error| panic!("{error:?}"))
}

#[test]
fn a_curve_begins_at_the_origin_and_turns_as_its_pieces_say() {
    let scenario = curved("start = { lane = 0, along_m = 4.0, speed_mps = 5.0 }", &[]);
    let (road, route) = (&scenario.road, scenario.main_route());
    assert_eq!(
        (road.parallel_lanes().map(|lanes| lanes.count), road.width_m(), road.heading_rad(Branch::Main)),
        (Some(2), 7.0, 0.0)
    );
    assert_eq!((road.conflict_zone_m(Branch::Main), road.corridor(Branch::Main)), (None, None));
    assert!(route.straight().is_none());
    let begin = route.centre.at(0.0);
    assert_eq!((begin.position, begin.heading_rad), ([0.0, 3.5], 0.0));
    // The last turn has half a transition more, which leads to the straight continuation.
    let length_m = 120.0 + (200.0 * 25.0 + 110.0 * 15.0) * std::f64::consts::PI / 180.0 + 4.0;
    assert!((route.end_m() - length_m).abs() < 1e-9, "{}", route.end_m());
    let ends = route.centre.at(route.end_m());
    assert!(
        (ends.heading_rad - std::f64::consts::FRAC_PI_2).abs() < 1e-9 && ends.curvature_1pm.abs() < 1e-9,
        "{ends:?}"
    );
    let turn = route.tightest_turn().expect("it turns");
    assert!((turn.curvature_1pm + 1.0 / 15.0).abs() < 1e-6, "{turn:?}");
    assert_eq!((route.right.value(0.0), route.left.value(0.0)), (-3.5, 3.5));
    assert_eq!([0, 1].map(|lane| road.lane_centre_m(Branch::Main, lane)), [Some(-1.75), Some(1.75)]);
}

#[test]
fn the_default_transition_fits_the_pieces() {
    let smooth_m = |pieces: &str| {
        let set = [set("road.transition_m=8.0"), set(&format!("road.pieces={pieces}"))];
        let stated = curved("start = { lane = 0, along_m = 4.0, speed_mps = 5.0 }", &set);
        let Road::Curve(mut curve) = stated.road else { panic!("not a curve") };
        curve.transition_m = None;
        let route = Road::Curve(curve).route(Branch::Main).expect("a road without fault");
        let curvature = |index: u32| route.centre.at(f64::from(index) * 0.01).curvature_1pm;
        let changes =
            (0..(100.0 * route.end_m()) as u32).filter(|&index| (curvature(index) - curvature(index + 1)).abs() > 1e-6);
        0.01 * changes.count() as f64 / 2.0
    };
    let wide = smooth_m("[{ straight_m = 100.0 }, { turn_deg = 90.0, radius_m = 25.0 }, { straight_m = 100.0 }]");
    assert!((wide - 12.5).abs() < 0.3, "half of the radius: {wide}");
    let short = smooth_m("[{ straight_m = 100.0 }, { turn_deg = 20.0, radius_m = 25.0 }, { straight_m = 100.0 }]");
    assert!((short - 0.5 * 20_f64.to_radians() * 25.0).abs() < 0.3, "half of the turn: {short}");
}

#[test]
fn a_position_in_a_lane_becomes_a_state_in_the_world() {
    let start = |vehicle: &str| curved(vehicle, &[]).vehicles[0].start;
    let in_straight = start("start = { lane = 1, along_m = 12.0, speed_mps = 1.3 }");
    assert_eq!(in_straight.to_array(), [12.0, 5.25, 0.0, 1.3]);
    let off = start(
        "start = { lane = 0, along_m = 12.0, lateral_offset_m = 0.5, heading_error_deg = -10.0, speed_mps = 1.3 }",
    );
    assert_eq!(off.position(), [12.0, 2.25]);
    assert!((off.heading_rad + 10_f64.to_radians()).abs() < 1e-12);
    // After the turn of 200° the heading exceeds a half turn, however it is stated.
    let along_m = 100.0 + 200_f64.to_radians() * 25.0 + 10.0;
    let behind = start(&format!("start = {{ lane = 0, along_m = {along_m}, speed_mps = 5.0 }}"));
    assert!((behind.heading_rad - 200_f64.to_radians()).abs() < 1e-9, "{behind:?}");
    let stated = start(&format!(
        "start = {{ x_m = {}, y_m = {}, heading_deg = -160.0, speed_mps = 5.0 }}",
        behind.x_m, behind.y_m
    ));
    assert!(behind.to_array().iter().zip(stated.to_array()).all(|(a, b)| (a - b).abs() < 1e-9), "{stated:?}");
}

#[test]
fn the_target_on_a_curve_is_in_the_goal_lane_beside_the_start() {
    for along_m in [10.0, 110.0, 180.0, 230.0] {
        let vehicle = format!(
            "start = {{ lane = 0, along_m = {along_m}, speed_mps = 5.0 }}\ngoal = {{ lane = 1, speed_mps = 6.0 }}"
        );
        let scenario = curved(&vehicle, &[]);
        let (target, route) = (scenario.vehicles[0].target(&scenario.road), scenario.main_route());
        let place = route.locate(target.position(), None);
        assert!((place.across_m - 1.75).abs() < 1e-9 && (place.along_m - along_m).abs() < 1e-9, "{place:?}");
        assert!((target.heading_rad - route.centre.at(along_m).heading_rad).abs() < 1e-9);
        assert_eq!(target.speed_mps, 6.0);
        let stays = curved(&format!("start = {{ lane = 0, along_m = {along_m}, speed_mps = 5.0 }}"), &[]);
        let (start, target) = (stays.vehicles[0].start, stays.vehicles[0].target(&stays.road));
        assert!(
            start.to_array().iter().zip(target.to_array()).all(|(a, b)| (a - b).abs() < 1e-9),
            "{start:?} {target:?}"
        );
    }
}

#[test]
fn starts_on_straight_roads_may_be_stated_in_lanes() {
    let lane = least("", &[set("vehicle.car.start.lane=1"), set("vehicle.car.start.along_m=2.5")]);
    let start = lane.vehicles[0].start;
    assert!((start.y_m - 0.555).abs() < 1e-12, "`lane` takes the place of `x_m` and `y_m`: {start:?}");
    assert_eq!((start.x_m, start.heading_rad), (2.5, 0.0));
    let back = least(
        "",
        &[set("vehicle.car.start={ lane = 1, along_m = 2.5 }"), set("vehicle.car.start={ x_m = 1, y_m = 0.3 }")],
    );
    assert_eq!(back.vehicles[0].start.to_array(), [1.0, 0.3, 0.0, 1.0], "and the other way round");
    let stated = load("intersection/nice", &[]).expect("authored");
    let crossing = stated.vehicles.iter().find(|vehicle| vehicle.road == Branch::Cross).expect("it crosses");
    let place = crossing.route.locate(crossing.start.position(), None);
    let change = format!("vehicle.{}.start={{ lane = 0, along_m = {:?} }}", crossing.name, place.along_m);
    let by_lane = load("intersection/nice", &[set(&change)]).expect("a start by lane");
    let start = by_lane.vehicle(&crossing.name).expect("there").start;
    let same = crossing.start.to_array().iter().zip(start.to_array()).all(|(a, b)| (a - b).abs() < 1e-12);
    assert!(same, "{start:?} is not {:?}", crossing.start);
    let merge = load(ramp_merge(), &[]).expect("authored");
    assert_eq!(merge.main_route().straight().copied(), merge.road.corridor(Branch::Main));
}

fn ramp_merge() -> &'static str {
    embedded().iter().find(|file| file.name.starts_with("ramp-merge/")).expect("there is one").name
}

#[test]
fn a_lane_of_a_curved_road_may_end() {
    let end = [set("road.lane_end={ end_m = 90.0, taper_m = 4.0 }")];
    let scenario = curved("start = { lane = 0, along_m = 10.0, speed_mps = 5.0 }\ngoal = { lane = 1 }", &end);
    let route = scenario.main_route();
    assert!((route.right.value(10.0) + 3.5).abs() < 1e-9 && route.right.value(90.0).abs() < 0.1);
    assert_eq!(scenario.road.lane_end().map(|end| end.height_m), Some(3.5));
}
