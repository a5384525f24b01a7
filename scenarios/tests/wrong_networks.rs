//! Errors of networks of lanes, and of vehicles on them.

mod common;

use common::Catalogue;
use interplay_scenarios::from_text;

/// Two lanes side by side of which one goes on in a bend, for the cases to spoil.
const GOOD: &str = r#"title = "A car in a bend"
shows = "It drives through the bend"

[road]
kind = "network"

[[road.lane]]
name = "right"
start = { x_m = 0.0, y_m = 0.0, heading_deg = 0.0 }
pieces = [{ straight_m = 60.0 }]
width_m = 3.5
left = "left"
successors = ["bend"]

[[road.lane]]
name = "left"
points = [[0.0, 3.5], [60.0, 3.5]]
width_m = [[0.0, 3.5], [60.0, 3.0]]
right = "right"

[[road.lane]]
name = "bend"
start = { x_m = 60.0, y_m = 0.0, heading_deg = 0.0 }
pieces = [{ straight_m = 5.0 }, { turn_deg = -90.0, radius_m = 8.0 }, { straight_m = 20.0 }]
width_m = 3.5
right_of_way = "yield"

[[vehicle]]
name = "car"
start = { lane = "right", along_m = 10.0, speed_mps = 1.0 }
"#;

/// A crossing with a car from the west to the north, for the cases to spoil.
const CROSSING: &str = r#"title = "A car at a crossing"
shows = "It turns to the left"

[road]
kind = "crossing"
turning_lanes = true

[[vehicle]]
name = "car"
start = { lane = "west-in-0", along_m = 10.0, speed_mps = 1.0 }
goal = { lane = "north-out" }
"#;

/// Cases that each change one text of a good scenario.
fn refuse(errors: &mut Catalogue, good: &str, name: &str, from: &str, to: &str, fragments: &[&str]) {
    assert!(good.contains(from), "{name}: {from} is not in the good scenario");
    errors.error(name, from_text("bad.toml", &good.replacen(from, to, 1), &[]), fragments);
}

#[test]
fn wrong_lanes_are_refused() {
    let mut errors = Catalogue::default();
    from_text("good.toml", GOOD, &[]).expect("nothing is wrong with it");
    let mut case = |name: &str, (from, to): (&str, &str), fragments: &[&str]| {
        refuse(&mut errors, GOOD, name, from, to, fragments);
    };
    case(
        "gap",
        ("x_m = 60.0, y_m = 0.0", "x_m = 62.0, y_m = 0.0"),
        &["bad.toml:13:15", "2 m are between", "x = 60, y = 0"],
    );
    case(
        "kink",
        ("x_m = 60.0, y_m = 0.0, heading_deg = 0.0", "x_m = 60.0, y_m = 0.0, heading_deg = 40.0"),
        &["bad.toml:13:15", "40 degrees", "`heading_deg = 0`"],
    );
    case("unknown_successor", ("[\"bend\"]", "[\"bent\"]"), &["bad.toml:13:15", "names lane `bent`", "`bend`?"]);
    case("successor_twice", ("[\"bend\"]", "[\"bend\", \"bend\"]"), &["bad.toml:13:23", "twice"]);
    case("unknown_neighbour", ("left = \"left\"", "left = \"middle\""), &["bad.toml:12:8", "`middle`"]);
    case("own_neighbour", ("left = \"left\"", "left = \"right\""), &["bad.toml:12:8", "its own neighbour"]);
    case("wrong_side", ("left = \"left\"", "right = \"left\""), &["bad.toml:12:9", "not on this side"]);
    case(
        "wrong_direction",
        ("left = \"left\"", "left = { lane = \"left\", oncoming = true }"),
        &["bad.toml:12:8", "does not run in the direction", "leave `oncoming` out"],
    );
    case("zero_width", ("width_m = 3.5", "width_m = 0.0"), &["bad.toml:11:11", "at least 0.001"]);
    case(
        "width_of_zero_at_the_end",
        ("[60.0, 3.0]]", "[60.0, 0.0]]"),
        &["bad.toml:18:31", "the width 0 m", "at least 0.001 m"],
    );
    case("width_backwards", ("[60.0, 3.0]]", "[0.0, 3.0]]"), &["bad.toml:18:11", "increasing distances"]);
    case("edges_cross", ("radius_m = 8.0", "radius_m = 1.5"), &["bad.toml:24:64", "inner edge", "more than 1.75 m"]);
    let sharp = ("[[0.0, 3.5], [60.0, 3.5]]", "[[0.0, 3.5], [3.0, 3.5], [3.0, 6.5], [0.0, 6.5]]\ntolerance_m = 0.0");
    case("points_too_tight", sharp, &["bad.toml:19:11", "edge crosses itself", "less than"]);
    case("same_name", ("name = \"bend\"", "name = \"left\""), &["two lanes are called `left`", "the first"]);
    case("loop", ("right_of_way", "successors = [\"bend\"]\nright_of_way"), &["bad.toml:26:15", "does not touch"]);
    case("no_line", ("start = { x_m = 0.0, y_m = 0.0, heading_deg = 0.0 }\n", ""), &["has no start", "or `points`"]);
    case("one_point", ("[[0.0, 3.5], [60.0, 3.5]]", "[[0.0, 3.5]]"), &["bad.toml:17:10", "has one point"]);
    case("same_points", ("[60.0, 3.5]]", "[60.0, 3.5], [60.0, 3.5]]"), &["bad.toml:17:36", "points 1 and 2"]);
    case("no_turn", ("turn_deg = -90.0", "turn_deg = 0.0"), &["bad.toml:24:46", "turns by 0"]);
    case("wrong_type", ("width_m = 3.5", "width_m = \"wide\""), &["must be a number or a list, not"]);
    case("unknown_word", ("\"yield\"", "\"give-way\""), &["bad.toml:26:16", "`all-way-stop`"]);
    insta::assert_snapshot!("lanes", errors.0);
}

/// Neighbours that are not beside each other, and a lane that is beside itself.
#[test]
fn overlapping_lanes_of_a_network_are_refused() {
    let mut errors = Catalogue::default();
    let mut case = |name: &str, (from, to): (&str, &str), fragments: &[&str]| {
        refuse(&mut errors, GOOD, name, from, to, fragments);
    };
    case(
        "neighbour_across",
        ("[[0.0, 3.5], [60.0, 3.5]]", "[[0.0, 3.5], [60.0, -3.5]]"),
        &["bad.toml:12:8", "lane `left` crosses lane `right`", "merge"],
    );
    case(
        "neighbour_on_the_lane",
        ("[[0.0, 3.5], [60.0, 3.5]]", "[[0.0, 1.5], [60.0, 1.5]]"),
        &["bad.toml:12:8", "lane `left` overlaps lane `right` by 1.75 m"],
    );
    case(
        "neighbour_apart",
        ("[[0.0, 3.5], [60.0, 3.5]]", "[[0.0, 6.5], [60.0, 6.5]]"),
        &["bad.toml:12:8", "3 m away from the edge of lane `right`"],
    );
    case(
        "meets_itself",
        ("{ turn_deg = -90.0, radius_m = 8.0 }", "{ turn_deg = -360.0, radius_m = 20.0 }"),
        &["bad.toml:24:10", "lane `bend` comes back onto itself: after"],
    );
    insta::assert_snapshot!("lanes_in_each_others_way", errors.0);
}

/// A ring without an exit.
#[test]
fn a_ring_without_an_exit_is_refused() {
    let mut errors = Catalogue::default();
    let half = |name: &str, x_m: f64, heading_deg: f64, next: &str| {
        format!(
            "[[road.lane]]\nname = \"{name}\"\nstart = {{ x_m = {x_m:?}, y_m = 0.0, heading_deg = {heading_deg:?} }}\n\
             pieces = [{{ turn_deg = 180.0, radius_m = 10.0 }}]\nwidth_m = 3.5\nsuccessors = [\"{next}\"]\n"
        )
    };
    let text = format!(
        "title = \"a\"\nshows = \"b\"\n[road]\nkind = \"network\"\n{}{}[[vehicle]]\nname = \"car\"\n\
         start = {{ lane = \"north\", along_m = 1.0, speed_mps = 1.0 }}\n",
        half("north", 10.0, 90.0, "south"),
        half("south", -10.0, -90.0, "north")
    );
    errors.error("loop", from_text("bad.toml", &text, &[]), &["bad.toml:10:14", "`north` and 1 more", "a loop"]);
    insta::assert_snapshot!("loops", errors.0);
}

#[test]
fn wrong_vehicles_on_lanes_are_refused() {
    let mut errors = Catalogue::default();
    let mut case = |name: &str, (from, to): (&str, &str), fragments: &[&str]| {
        refuse(&mut errors, GOOD, name, from, to, fragments);
    };
    let start = |to: &'static str| ("start = { lane = \"right\", along_m = 10.0, speed_mps = 1.0 }", to);
    case(
        "unknown_lane",
        ("lane = \"right\", along", "lane = \"rigth\", along"),
        &["bad.toml:30:18", "did you mean `right`?"],
    );
    case("number", ("lane = \"right\", along", "lane = 0, along"), &["bad.toml:30:18", "have names", "`bend`"]);
    case("beyond_the_lane", ("along_m = 10.0", "along_m = 70.0"), &["bad.toml:30:37", "the lane is 60 m long"]);
    case("before_the_lane", ("along_m = 10.0", "along_m = -1.0"), &["bad.toml:30:37", "the lane is 60 m long"]);
    case("beside_the_lanes", start("start = { x_m = 10.0, y_m = -9.0, speed_mps = 1.0 }"), &["is on no lane"]);
    case(
        "against_the_lanes",
        start("start = { x_m = 10.0, y_m = 0.0, heading_deg = 180.0, speed_mps = 1.0 }"),
        &["is not along a lane", "lane `right` runs at `heading_deg = 0`"],
    );
    case(
        "no_lateral_position",
        ("speed_mps = 1.0 }", "speed_mps = 1.0 }\ngoal = { y_m = 1.0 }"),
        &["not a lateral position on a network of lanes", "its `lane`"],
    );
    case(
        "cross",
        ("name = \"car\"", "name = \"car\"\nroad = \"cross\""),
        &["bad.toml:30:8", "there is no crossing road"],
    );
    case(
        "off_its_lane",
        ("along_m = 10.0,", "along_m = 10.0, lateral_offset_m = 2.0,"),
        &["out of the lane", "at most 1.75 m"],
    );
    let long = "speed_mps = 1.0 }\nbody = { front_axle_m = 2.0, rear_axle_m = 2.0, front_m = 2.5, rear_m = 2.5 }\n\
        limits = { steering_max_rad = 0.4 }";
    case(
        "turning_circle",
        ("speed_mps = 1.0 }", long),
        &["lane `bend` on the route of vehicle `car`", "turns with a radius of", "this lane"],
    );
    insta::assert_snapshot!("vehicles_on_lanes", errors.0);
}

#[test]
fn wrong_routes_are_refused() {
    let mut errors = Catalogue::default();
    from_text("good.toml", CROSSING, &[]).expect("nothing is wrong with it");
    let mut case = |name: &str, (from, to): (&str, &str), fragments: &[&str]| {
        refuse(&mut errors, CROSSING, name, from, to, fragments);
    };
    let goal = |to: &'static str| ("goal = { lane = \"north-out\" }", to);
    case("fork", goal(""), &["bad.toml:9:8", "lane `west-in-0` forks", "`east-out`"]);
    case("unknown_goal", goal("goal = { lane = \"nort-out\" }"), &["bad.toml:11:17", "did you mean `north-out`?"]);
    case("goal_number", goal("goal = { lane = 1 }"), &["bad.toml:11:17", "have names"]);
    case("no_way", goal("goal = { lane = \"south-in\" }"), &["bad.toml:11:17", "no way leads", "`north-out`"]);
    case(
        "not_connected",
        goal("route = [\"west-in-0\", \"west-to-north\"]"),
        &["bad.toml:11:23", "cannot go from lane `west-in-0` to lane `west-to-north`", "leads to"],
    );
    case("unknown_in_route", goal("route = [\"west-in-0\", \"east-outt\"]"), &["bad.toml:11:23", "`east-out`?"]);
    case("other_begin", goal("route = [\"west-in-1\"]"), &["bad.toml:11:10", "begins with the lane on which"]);
    case(
        "other_end",
        goal("route = [\"west-in-0\"]\ngoal = { lane = \"east-out\" }"),
        &["bad.toml:11:10", "does not end on the lane of its goal"],
    );
    case(
        "no_room",
        ("turning_lanes = true", "turning_lanes = true\narm_length_m = 25.0"),
        &["bad.toml:12:17", "no room to change", "from lane `west-in-0`"],
    );
    let short = CROSSING.replace("turning_lanes = true", "turning_lanes = true\narm_length_m = 25.0");
    let by_name = goal("route = [\"west-in-0\", \"west-in-1\"]");
    refuse(&mut errors, &short, "no_room_on_a_route", by_name.0, by_name.1, &["bad.toml:12:23", "17.5 m are needed"]);
    insta::assert_snapshot!("routes", errors.0);
}

#[test]
fn wrong_junction_forms_are_refused() {
    let mut errors = Catalogue::default();
    let mut case = |name: &str, road: &str, fragments: &[&str]| {
        let text = CROSSING.replace("kind = \"crossing\"\nturning_lanes = true", road);
        errors.error(name, from_text("bad.toml", &text, &[]), fragments);
    };
    case("tight_turn", "kind = \"crossing\"\nturn_radius_m = 1.5", &["bad.toml:6:17", "a car needs about 5.5 m"]);
    case("short_arm", "kind = \"t-junction\"\narm_length_m = 10.0", &["bad.toml:6:16", "more than", "`turn_radius_m`"]);
    case("small_ring", "kind = \"roundabout\"\nradius_m = 6.0", &["bad.toml:6:12", "too small for 4 arms"]);
    case("short_ring_arm", "kind = \"roundabout\"\narm_length_m = 20.0", &["bad.toml:6:16", "too short", "works"]);
    case("many_arms", "kind = \"roundabout\"\narms = 9", &["bad.toml:6:8", "at most 6"]);
    case("tight_ramp", "kind = \"on-ramp\"\nramp_radius_m = 1.0", &["bad.toml:6:17", "more than 1.75 m"]);
    case("long_taper", "kind = \"narrow-passage\"\ntaper_m = 200.0", &["bad.toml:6:11", "not within the approach"]);
    case("tight_taper", "kind = \"narrow-passage\"\ntaper_m = 0.5", &["bad.toml:4:1", "edge crosses itself"]);
    case("lanes_without_names", "kind = \"lanes\"", &["have no names", "0 to 1"]);
    insta::assert_snapshot!("short_forms", errors.0);
}

/// The lanes of a road that has only numbers.
#[test]
fn lane_names_on_parallel_lanes_are_refused() {
    let mut errors = Catalogue::default();
    let good = "title = \"a\"\nshows = \"b\"\n[[vehicle]]\nname = \"car\"\n\
        start = { lane = 0, along_m = 1.0, speed_mps = 1.0 }\n";
    let mut case = |name: &str, (from, to): (&str, &str), fragments: &[&str]| {
        refuse(&mut errors, good, name, from, to, fragments);
    };
    case("start", ("lane = 0", "lane = \"right\""), &["bad.toml:5:18", "counted from the right: 0 to 1"]);
    case("goal", ("1.0 }\n", "1.0 }\ngoal = { lane = \"right\" }\n"), &["bad.toml:6:17", "counted from the right"]);
    case("route", ("1.0 }\n", "1.0 }\nroute = [\"right\"]\n"), &["bad.toml:6:", "leave it out"]);
    insta::assert_snapshot!("names_on_parallel_lanes", errors.0);
}

fn refused(from: &str, to: &str, words: &[&str]) {
    let error = from_text("bad.toml", &GOOD.replace(from, to), &[]).expect_err("no road");
    let shown = common::rendered(&error, 2000);
    assert!(words.iter().all(|word| shown.contains(word)), "{words:?} in\n{shown}");
}

#[test]
fn a_lane_width_of_zero_is_reported_before_the_length() {
    let (widths, zeros) = ("[[0.0, 3.5], [60.0, 3.0]]", "[[0.0, 0.0], [60.0, 0.0]]");
    refused(widths, zeros, &["bad.toml:18:18", "a lane has the width 0 m", "widths are at least 0.001 m"]);
}

#[test]
fn the_error_of_points_that_double_back_names_the_point() {
    let (last, back) = ("[60.0, 3.5]]", "[60.0, 3.5], [10.0, 3.5], [-5.0, 3.5]]");
    refused(last, back, &["bad.toml:17:23", "the line turns back at point 1"]);
}

/// Lanes of a millimetre would be compared at millions of places before the cars turn out not to fit.
#[test]
fn cars_on_lanes_of_a_millimetre_are_refused_quickly() {
    let car = |name: &str, lane: &str| {
        format!("[[vehicle]]\nname = \"{name}\"\nstart = {{ lane = \"{lane}\", along_m = 5.0, speed_mps = 9.0 }}\n")
    };
    let road = "kind = \"narrow-passage\"\npassage_width_m = 3.2\npassage_m = 5000.0\nlane_width_m = 0.001";
    let cars = [car("one", "west-in"), car("other", "east-in")].concat();
    let begun = std::time::Instant::now();
    let error = from_text("bad.toml", &format!("title = \"a\"\nshows = \"b\"\n[road]\n{road}\n{cars}"), &[]);
    let error = error.expect_err("the cars do not fit");
    let too_wide = error.faults().iter().filter(|fault| fault.message().contains("wide, but lane")).count();
    assert_eq!(too_wide, 2, "{error:?}");
    assert!(begun.elapsed().as_secs() < 10, "{:?}", begun.elapsed());
}
