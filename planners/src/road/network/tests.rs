//! Networks that are known in closed form, and networks that are none.

use std::f64::consts::{FRAC_PI_2, PI};

use super::super::centre_line::{CentreLine, Piece, smooth};
use super::super::profile::Profile;
use super::*;

/// A straight lane from a place in a direction.
fn straight(name: &str, start: [f64; 2], heading_rad: f64, length_m: f64) -> Lane {
    let centre = CentreLine::from_pieces(start, heading_rad, &[Piece::Straight { length_m }]).expect("a sound piece");
    Lane::new(name, centre, 3.5)
}

fn followed_by(mut lane: Lane, successors: &[&str]) -> Lane {
    lane.successors = successors.iter().map(|name| (*name).to_owned()).collect();
    lane
}

fn neighbour(lane: &str, may_change: bool) -> Option<LaneNeighbour> {
    Some(LaneNeighbour { lane: lane.to_owned(), relation: NeighbourRelation::SameDirection, may_change })
}

fn network(lanes: Vec<Lane>) -> RoadNetwork {
    RoadNetwork::new(lanes).expect("a sound network")
}

/// Two lanes along x, 200 m long.
fn two_lanes() -> RoadNetwork {
    let (mut right, mut left) = (straight("right", [0.0, 0.0], 0.0, 200.0), straight("left", [0.0, 3.5], 0.0, 200.0));
    (right.left, left.right) = (neighbour("left", true), neighbour("right", true));
    network(vec![right, left])
}

/// A roundabout of four arms around the origin, counter-clockwise: at arm `i`, `in-i` joins the ring before `ring-i`, and
/// `out-i` leaves it after `ring-(i−1)`.
fn roundabout(radius_m: f64) -> RoadNetwork {
    let mut lanes = Vec::new();
    for arm in 0..4 {
        let angle_rad = FRAC_PI_2 * arm as f64;
        let (sin, cos) = libm::sincos(angle_rad);
        let turned = |[x, y]: [f64; 2]| [cos * x - sin * y, sin * x + cos * y];
        let arc = Piece::Arc { length_m: radius_m * FRAC_PI_2, curvature_1pm: 1.0 / radius_m };
        let ring = CentreLine::from_pieces(turned([radius_m, 0.0]), angle_rad + FRAC_PI_2, &[arc]).expect("an arc");
        let next = (arm + 1) % 4;
        let ring = Lane::new(&format!("ring-{arm}"), ring, 4.0);
        lanes.push(followed_by(ring, &[&format!("ring-{next}"), &format!("out-{next}")]));
        // Towards the middle, and in a right curve of a quarter turn into the ring.
        let turn = [Piece::Straight { length_m: 30.0 }, Piece::Arc { length_m: 10.0 * FRAC_PI_2, curvature_1pm: -0.1 }];
        let turn = smooth(&turn, 6.0).expect("long enough");
        let shape = CentreLine::from_pieces([0.0; 2], PI, &turn).expect("pieces");
        let end = shape.at(shape.length_m()).position;
        let start = turned([radius_m - end[0], -end[1]]);
        let entry = CentreLine::from_pieces(start, angle_rad + PI, &turn).expect("pieces");
        lanes.push(followed_by(Lane::new(&format!("in-{arm}"), entry, 4.0), &[&format!("ring-{arm}")]));
        let exit = CentreLine::from_pieces(
            turned([radius_m, 0.0]),
            angle_rad + FRAC_PI_2,
            &smooth(
                &[Piece::Arc { length_m: 10.0 * FRAC_PI_2, curvature_1pm: -0.1 }, Piece::Straight { length_m: 30.0 }],
                6.0,
            )
            .expect("long enough"),
        );
        lanes.push(Lane::new(&format!("out-{arm}"), exit.expect("pieces"), 4.0));
    }
    network(lanes)
}

/// The field and the fault of lanes that are no network.
fn fault(lanes: Vec<Lane>) -> (String, &'static str, LaneFault) {
    let error = RoadNetwork::new(lanes).expect_err("no network");
    (error.lane, error.field, error.fault)
}

#[test]
fn a_fault_of_a_network_names_its_lane_and_field() {
    let first = || followed_by(straight("first", [0.0, 0.0], 0.0, 10.0), &["second"]);
    let second = || straight("second", [10.0, 0.0], 0.0, 10.0);
    assert!(RoadNetwork::new(vec![first(), second()]).is_ok());
    assert_eq!(fault(vec![second(), second()]), ("second".into(), "name", LaneFault::SameName));
    assert_eq!(fault(vec![Lane { name: String::new(), ..second() }]).2, LaneFault::NoName);
    assert_eq!(fault(vec![first()]), ("first".into(), "successors", LaneFault::UnknownLane { other: "second".into() }));
    let (lane, field, gap) = fault(vec![first(), straight("second", [10.0, 1.0], 0.0, 10.0)]);
    assert_eq!((lane.as_str(), field), ("first", "successors"));
    assert_eq!(gap, LaneFault::Gap { other: "second".into(), gap_m: 1.0, most_m: 0.1 * 3.5 });
    assert!(matches!(fault(vec![first(), straight("second", [10.0, 0.0], 0.6, 10.0)]).2, LaneFault::Kink { .. }));
    let twice = followed_by(first(), &["second", "second"]);
    assert_eq!(fault(vec![twice, second()]).2, LaneFault::NamedTwice { other: "second".into() });
    assert_eq!(fault(vec![Lane { centre: CentreLine::straight(0.0), ..second() }]).2, LaneFault::NoEnds);
    let limited = Lane { speed_limit_mps: Some(f64::NAN), ..second() };
    assert_eq!(fault(vec![limited]).1, "speed_limit_mps");
    let narrowing = Profile::steps(&[[2.0, 3.0], [4.0, -0.1], [6.0, 3.0]]).expect("sound knots");
    let (_, field, no_width) = fault(vec![Lane { width: narrowing, ..second() }]);
    assert!(field == "width" && matches!(no_width, LaneFault::NotPositive { .. }), "{no_width:?}");
    let arc = [Piece::Arc { length_m: 2.0, curvature_1pm: 0.6 }];
    let tight = Lane { centre: CentreLine::from_pieces([0.0; 2], 0.0, &arc).expect("an arc"), ..second() };
    let (_, field, crossing) = fault(vec![tight]);
    assert!(field == "width" && matches!(crossing, LaneFault::EdgesCross { .. }), "{crossing:?}");
}

/// A lane that turns by some angle on a circle of 20 m.
fn turning(turn_deg: f64) -> Lane {
    let radius_m = 20.0;
    let ahead = Piece::Straight { length_m: 50.0 };
    let turn = Piece::Arc { length_m: turn_deg.to_radians() * radius_m, curvature_1pm: 1.0 / radius_m };
    let pieces = smooth(&[ahead, turn, ahead], 5.0).expect("long enough");
    Lane::new("turning", CentreLine::from_pieces([0.0; 2], 0.0, &pieces).expect("pieces"), 3.5)
}

/// After a full turn the lane is where it was; after three quarters of one it crosses itself, and after half of one lies beside
/// itself.
#[test]
fn a_lane_that_overlaps_itself_is_refused() {
    for turn_deg in [90.0, 180.0, 270.0, 300.0] {
        assert!(RoadNetwork::new(vec![turning(turn_deg)]).is_ok(), "{turn_deg}");
    }
    let (_, field, fault) = fault(vec![turning(360.0)]);
    let LaneFault::MeetsItself { first_m, again_m } = fault else { panic!("{fault:?}") };
    assert_eq!(field, "centre");
    // The straight parts lie on each other: a place before the circle, and the same after it.
    assert!((again_m - first_m - 2.0 * PI * 20.0).abs() < 5.0, "{first_m} {again_m}");
    let ahead = Piece::Straight { length_m: 30.0 };
    let pieces = smooth(&[ahead, Piece::Arc { length_m: 2.2 * PI, curvature_1pm: 1.0 / 2.2 }, ahead], 2.0);
    let hairpin = CentreLine::from_pieces([0.0; 2], 0.0, &pieces.expect("long enough")).expect("pieces");
    assert!(RoadNetwork::new(vec![Lane::new("back", hairpin, 3.5)]).is_ok(), "both directions lie beside each other");
    // A ring of one lane that is its own successor.
    let ring = CentreLine::from_pieces([0.0; 2], 0.0, &[Piece::Arc { length_m: 40.0 * PI, curvature_1pm: 0.05 }]);
    let ring = followed_by(Lane::new("ring", ring.expect("an arc"), 3.5), &["ring"]);
    assert!(RoadNetwork::new(vec![ring]).is_ok());
}

#[test]
fn neighbours_must_lie_on_their_stated_side_and_in_their_direction() {
    let right = |left: &str| Lane { left: neighbour(left, true), ..straight("right", [0.0, 0.0], 0.0, 50.0) };
    let other = |start: [f64; 2], heading_rad: f64| straight("other", start, heading_rad, 50.0);
    assert!(RoadNetwork::new(vec![right("other"), other([0.0, 3.5], 0.0)]).is_ok());
    assert!(RoadNetwork::new(vec![right("other"), other([40.0, 3.5], 0.0)]).is_ok(), "it begins later");
    let refused = |lanes: Vec<Lane>| fault(lanes).2;
    assert_eq!(refused(vec![right("none")]), LaneFault::UnknownLane { other: "none".into() });
    assert_eq!(refused(vec![right("right")]), LaneFault::OwnNeighbour);
    let direction = LaneFault::WrongDirection { other: "other".into() };
    assert_eq!(refused(vec![right("other"), other([50.0, 3.5], PI)]), direction);
    let side = LaneFault::WrongSide { other: "other".into() };
    assert_eq!(refused(vec![right("other"), other([0.0, -3.5], 0.0)]), side);
    // Merging at its end, beside a median and with a little overlap it is a neighbour; across, apart and on the lane it is none.
    let towards = |from_m: f64, to_m: f64| {
        let slope_rad = libm::asin((to_m - from_m) / 50.0);
        vec![right("other"), other([0.0, from_m], slope_rad)]
    };
    for [from_m, to_m] in [[3.5, 0.0], [0.0, 3.5], [3.5, 7.5], [5.0, 5.0], [2.8, 2.8]] {
        assert!(RoadNetwork::new(towards(from_m, to_m)).is_ok(), "{from_m} to {to_m}");
    }
    assert!(matches!(refused(towards(3.5, -3.5)), LaneFault::ChangesSides { along_m, .. } if along_m > 25.0));
    let not_beside = |from_m: f64, to_m: f64| match refused(towards(from_m, to_m)) {
        LaneFault::NotSideBySide { space_m, .. } => space_m,
        fault => panic!("{fault:?}"),
    };
    assert!((not_beside(2.0, 2.0) + 1.5).abs() < 1e-9);
    assert!((not_beside(6.5, 6.5) - 3.0).abs() < 1e-9);
    assert!(not_beside(6.5, 20.0) > 2.9);
    let mut oncoming = right("other");
    oncoming.left.as_mut().expect("a neighbour").relation = NeighbourRelation::Oncoming;
    assert!(RoadNetwork::new(vec![oncoming, other([50.0, 3.5], PI)]).is_ok());
}

#[test]
fn the_strip_of_a_route_contains_lanes_that_it_may_change_into() {
    let network = two_lanes();
    let route = network.route(&["right"]).expect("a lane");
    for along_m in [0.0, 77.7, 200.0] {
        assert!((route.right.value(along_m) + 1.75).abs() < 1e-9 && (route.left.value(along_m) - 5.25).abs() < 1e-9);
    }
    assert_eq!(route.left, Profile::constant(route.left.value(0.0)), "a constant width stays constant");
    let mut lanes = network.lanes().to_vec();
    lanes[0].left = neighbour("left", false);
    let closed = RoadNetwork::new(lanes).expect("a network");
    assert!((closed.route(&["right"]).expect("a lane").left.value(50.0) - 1.75).abs() < 1e-9);
    let not_connected = RouteError::NotConnected { from: "right".into(), to: "left".into() };
    assert_eq!(closed.route(&["right", "left"]), Err(not_connected));
}

#[test]
fn a_lane_change_leads_smoothly_from_one_lane_centre_to_the_other() {
    let route = two_lanes().route(&["right", "left"]).expect("they are neighbours");
    assert_eq!(route.legs.iter().map(|leg| leg.lane.as_str()).collect::<Vec<_>>(), ["right", "left"]);
    let middle_m = route.legs[0].to_m;
    assert!((route.centre.at(middle_m).position[1] - 1.75).abs() < 1e-6);
    assert_eq!(route.centre.at(middle_m - 21.5).position[1], 0.0);
    assert!((route.centre.at(middle_m + 21.5).position[1] - 3.5).abs() < 1e-12);
    let turn = route.tightest_turn().expect("it has legs");
    // The largest second derivative of the quintic smoothstep is 10/√3 (height over length squared).
    let expected = 3.5 * 10.0 / 3.0_f64.sqrt() / (42.0 * 42.0);
    assert!((turn.curvature_1pm.abs() / expected - 1.0).abs() < 0.03, "{turn:?} {expected}");
    assert!(route.check_turns(50.0).is_ok());
    assert!(matches!(route.check_turns(500.0), Err(RouteError::TooTight { .. })));
    for step in 0..=200 {
        let along_m = route.end_m() * f64::from(step) / 200.0;
        let (y, cos) = (route.centre.at(along_m).position[1], libm::cos(route.centre.at(along_m).heading_rad));
        assert!((y + route.right.value(along_m) * cos + 1.75).abs() < 0.02, "the right edge does not move");
        assert!((y + route.left.value(along_m) * cos - 5.25).abs() < 0.02, "nor does the left one");
    }
    assert!((route.along_m("left", 190.0).expect("a leg") - route.end_m() + 10.0).abs() < 1e-9);
}

/// The lane beside is divided one metre later than the lane itself: there is always a lane beside it.
#[test]
fn adjacent_lanes_may_be_divided_at_different_places() {
    let mut lanes = vec![
        followed_by(straight("right-1", [0.0, 0.0], 0.0, 50.0), &["right-2"]),
        straight("right-2", [50.0, 0.0], 0.0, 50.0),
        followed_by(straight("left-1", [0.0, 3.5], 0.0, 51.0), &["left-2"]),
        straight("left-2", [51.0, 3.5], 0.0, 49.0),
    ];
    (lanes[0].left, lanes[1].left) = (neighbour("left-1", true), neighbour("left-2", true));
    let route = network(lanes).route(&["right-1", "right-2"]).expect("it goes on");
    let [least_m, most_m] = route.left.extremes(0.0, 100.0);
    assert!((least_m - 5.25).abs() < 1e-9 && (most_m - 5.25).abs() < 1e-9, "{least_m} {most_m}");
}

#[test]
fn a_lane_change_needs_room_and_successive_changes_share_it() {
    let lanes = |length_m: f64| {
        let mut lanes: Vec<Lane> =
            (0..3).map(|i| straight(&format!("{i}"), [0.0, 3.5 * f64::from(i)], 0.0, length_m)).collect();
        (lanes[0].left, lanes[1].left) = (neighbour("1", true), neighbour("2", true));
        network(lanes)
    };
    let route = lanes(100.0).shortest_route("0", "2").expect("two changes have room");
    // The first change ends at 45 m; the second one has the rest.
    assert!((route.legs[0].to_m - 25.0).abs() < 0.2 && (route.legs[1].to_m - 72.5).abs() < 0.5, "{:?}", route.legs);
    let short = lanes(30.0);
    assert!(short.route(&["0", "1"]).is_ok(), "one change needs 17.5 m");
    assert!(matches!(short.route(&["0", "1", "2"]), Err(RouteError::NoRoomToChange { .. })));
    let no_way = RouteError::NoWay { from: "0".into(), to: "2".into() };
    assert_eq!(short.shortest_route("0", "2"), Err(no_way));
    let no_way = RouteError::NoWay { from: "0".into(), to: "1".into() };
    assert_eq!(lanes(15.0).shortest_route("0", "1"), Err(no_way));
}

/// An acceleration lane that ends: the strip narrows before its end, and is nowhere wider than the lanes.
#[test]
fn the_strip_narrows_before_a_neighbour_ends() {
    let mut lanes = two_lanes().lanes().to_vec();
    lanes[0] = Lane { left: neighbour("left", true), ..straight("right", [40.0, 0.0], 0.0, 100.0) };
    let route = RoadNetwork::new(lanes).expect("a network").route(&["left"]).expect("a lane");
    for step in 0..=400 {
        let along_m = 0.5 * f64::from(step);
        let right_m = route.right.value(along_m);
        let is_beside = (40.0..=140.0).contains(&along_m);
        assert!(right_m >= if is_beside { -5.25 - 1e-9 } else { -1.75 - 1e-9 }, "{along_m} {right_m}");
        assert!(route.right.slope(along_m).abs() < 0.2 * 1.9);
    }
    assert!((route.right.value(90.0) + 5.25).abs() < 1e-9 && (route.right.value(20.0) + 1.75).abs() < 1e-9);
}

/// Straight lanes at an angle γ overlap over `w (1 + |cos γ|)/sin γ`.
#[test]
fn the_conflict_of_crossing_lanes_matches_their_parallelogram() {
    for angle_deg in [90.0, 60.0, -120.0, 30.0_f64] {
        let (sin, cos) = libm::sincos(angle_deg.to_radians());
        let crossing = straight("crossing", [-50.0 * cos + 3.0, -50.0 * sin], angle_deg.to_radians(), 100.0);
        let network = network(vec![straight("main", [-50.0, 0.0], 0.0, 100.0), crossing]);
        let [a, b] = ["main", "crossing"].map(|lane| network.route(&[lane]).expect("a lane"));
        let found = conflicts(&a, &b);
        assert_eq!((found.len(), found[0].kind), (1, ConflictKind::Crossing));
        let reach_m = 0.5 * 3.5 * (1.0 + cos.abs()) / sin.abs();
        for ([from_m, to_m], middle_m) in [(found[0].on_a, 53.0), (found[0].on_b, 50.0)] {
            let tolerance_m = 0.02 * 3.5 / sin.abs().powi(2);
            assert!((from_m - middle_m + reach_m).abs() < tolerance_m, "{angle_deg}: {from_m}, {reach_m}");
            assert!((to_m - middle_m - reach_m).abs() < tolerance_m, "{angle_deg}: {to_m}, {reach_m}");
        }
        let swapped = conflicts(&b, &a);
        assert_eq!((swapped[0].on_a, swapped[0].on_b), (found[0].on_b, found[0].on_a));
    }
}

#[test]
fn adjacent_lanes_do_not_conflict_but_a_lane_change_merges() {
    let network = two_lanes();
    let [right, left] = ["right", "left"].map(|lane| network.route(&[lane]).expect("a lane"));
    assert_eq!(conflicts(&right, &left), []);
    assert_eq!(conflicts(&right, &right), []);
    let change = network.route(&["right", "left"]).expect("neighbours");
    let found = conflicts(&change, &left);
    assert_eq!((found.len(), found[0].kind), (1, ConflictKind::Merging));
    let [from_m, to_m] = found[0].on_a;
    assert!(from_m > 79.0 && (to_m - change.legs[0].to_m).abs() < 0.1, "{found:?}");
}

/// A late change is comfortable at 25 m/s, and uses the lane up to its last metres.
#[test]
fn routes_may_leave_lanes_that_end_near_their_end() {
    let network = two_lanes();
    let lanes = ["right", "left"];
    let [middle, late] = [EndingLane::Middle, EndingLane::End].map(|place| network.route_leaving(&lanes, place));
    let (middle, late) = (middle.expect("neighbours"), late.expect("neighbours"));
    assert!((middle.legs[0].to_m - 100.0).abs() < 1.0 && !middle.legs[0].is_left_late, "{:?}", middle.legs);
    assert!((140.0..160.0).contains(&late.legs[0].to_m) && late.legs[0].is_left_late, "{:?}", late.legs);
    assert!(!late.legs[1].is_left_late);
    let sharpest_1pm = |route: &Route| route.tightest_turn().map_or(0.0, |turn| turn.curvature_1pm.abs());
    let mps = [&middle, &late].map(|route| (2.25 / sharpest_1pm(route)).sqrt());
    assert!(mps[0] < 16.0 && mps[1] > 25.0, "{mps:?}");
}

#[test]
fn a_roundabout_has_routes_around_it_and_conflicts_where_they_join() {
    let network = roundabout(15.0);
    let route = network.shortest_route("in-0", "out-3").expect("the ring leads there");
    let lanes: Vec<&str> = route.legs.iter().map(|leg| leg.lane.as_str()).collect();
    assert_eq!(lanes, ["in-0", "ring-0", "ring-1", "ring-2", "out-3"]);
    let (begin, end) = (route.centre.at(0.0).heading_rad, route.centre.at(route.end_m()).heading_rad);
    assert!((end - begin - (-FRAC_PI_2 + 1.5 * PI - FRAC_PI_2)).abs() < 0.01, "headings go on: {begin} {end}");
    let step_m = 0.05;
    for step in 0..(route.end_m() / step_m) as usize - 1 {
        let [here, ahead] = [0, 1].map(|by| route.centre.at(step_m * (step + by) as f64).curvature_1pm);
        assert!((here - ahead).abs() < 0.01, "the curvature does not jump at {}", step_m * step as f64);
    }
    for along_m in [10.0, 60.0, route.end_m() - 5.0] {
        assert!((route.left.value(along_m) - 2.0).abs() < 0.02 && (route.right.value(along_m) + 2.0).abs() < 0.02);
    }
    // A vehicle that enters at arm 1 joins the ring in front of those that circulate.
    let entering = network.shortest_route("in-1", "out-3").expect("the ring leads there");
    let found = conflicts(&route, &entering);
    assert_eq!(found.iter().map(|conflict| conflict.kind).collect::<Vec<_>>(), [ConflictKind::Merging], "{found:?}");
    let joins_m = entering.legs[0].to_m;
    assert!((found[0].on_b[1] - joins_m).abs() < 2.0 && found[0].on_b[0] > joins_m - 20.0, "{found:?}");
    // A vehicle that leaves before diverges from those that go on.
    let leaving = network.shortest_route("in-0", "out-1").expect("the ring leads there");
    let found = conflicts(&route, &leaving);
    assert_eq!(found.iter().map(|conflict| conflict.kind).collect::<Vec<_>>(), [ConflictKind::Diverging], "{found:?}");
}

#[test]
fn a_route_search_ends_without_a_route_and_with_loops() {
    let network = roundabout(12.0);
    let no_way = RouteError::NoWay { from: "out-1".into(), to: "in-2".into() };
    assert_eq!(network.shortest_route("out-1", "in-2"), Err(no_way));
    assert_eq!(
        network.shortest_route("ring-0", "in-1").map(|_| ()).expect_err("no way").to_string(),
        "no route leads from lane `ring-0` to lane `in-1`"
    );
    assert_eq!(network.shortest_route("nowhere", "in-1"), Err(RouteError::UnknownLane { lane: "nowhere".into() }));
    let none: [&str; 0] = [];
    assert_eq!(network.route(&none), Err(RouteError::NoLanes));
    let around = ["ring-0", "ring-1", "ring-2", "ring-3", "ring-0"];
    let twice = network.route(&around).expect("more than once around");
    assert!((twice.end_m() - 12.0 * 2.5 * PI).abs() < 1e-9);
    assert!((twice.centre.at(twice.end_m()).curvature_1pm - 1.0 / 12.0).abs() < 1e-9);
    let alone = network.shortest_route("ring-2", "ring-2").expect("one lane");
    assert_eq!(alone.legs.len(), 1);
}

#[test]
fn lanes_of_a_loop_without_an_exit_are_found() {
    let around = roundabout(12.0);
    assert!(around.lanes_without_end().is_empty());
    let closed = around.lanes().iter().filter(|lane| !lane.name.starts_with("out")).cloned().map(|mut lane| {
        lane.successors.retain(|name| !name.starts_with("out"));
        lane
    });
    let mut closed: Vec<Lane> = closed.collect();
    closed.push(straight("elsewhere", [90.0, 90.0], 0.0, 10.0));
    let closed = network(closed);
    let names: Vec<&str> = closed.lanes_without_end().iter().map(|lane| lane.name.as_str()).collect();
    assert_eq!(names, ["ring-0", "in-0", "ring-1", "in-1", "ring-2", "in-2", "ring-3", "in-3"]);
}

#[test]
fn a_position_is_located_on_the_lanes_that_contain_it() {
    let network = roundabout(15.0);
    let found = network.locate([0.0, 15.5], PI);
    assert!(found.iter().any(|place| place.lane == "ring-0") && found.iter().any(|place| place.lane == "ring-1"));
    let found = network.locate([15.0 / 2.0_f64.sqrt(), 15.0 / 2.0_f64.sqrt()], 2.4);
    assert_eq!(found[0].lane, "ring-0");
    assert!((found[0].point.along_m - 7.5 * FRAC_PI_2).abs() < 1e-6 && found[0].point.across_m.abs() < 1e-6);
    assert!((found[0].heading_error_rad - (2.4 - 0.75 * PI)).abs() < 1e-6);
    assert!(network.locate([0.0, 0.0], 0.0).is_empty());
    let crossing = two_lanes().locate([10.0, 1.75], 0.0);
    assert_eq!(crossing.len(), 2, "the edge between two lanes belongs to both");
}

/// Where overtaking is permitted, the strip holds the oncoming lane, and the edges of the own direction do not.
#[test]
fn the_strip_contains_an_oncoming_lane_where_it_may_be_used() {
    let oncoming = |lane: &str, may_change: bool| {
        Some(LaneNeighbour { lane: lane.to_owned(), relation: NeighbourRelation::Oncoming, may_change })
    };
    for (may_change, left_m) in [(true, 5.25), (false, 1.75)] {
        let mut east = straight("east", [0.0, 0.0], 0.0, 100.0);
        let mut west = straight("west", [100.0, 3.5], PI, 100.0);
        (east.left, west.left) = (oncoming("west", may_change), oncoming("east", may_change));
        let route = network(vec![east, west]).route(&["east"]).expect("a route");
        let [right, left] = route.edges_before_end_m(40.0);
        assert!((right + 1.75).abs() < 1e-6 && (left - left_m).abs() < 1e-6, "{right} {left}");
        let [own_right, own_left] = route.same_direction_edges_m(40.0);
        assert!((own_right + 1.75).abs() < 1e-6 && (own_left - 1.75).abs() < 1e-6);
    }
}
