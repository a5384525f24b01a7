//! Parked cars, pedestrians, traffic lights, and vehicles that enter and leave a street.

use interplay_planners::State;
use interplay_scenarios::{Override, Scenario, from_text, load};

use crate::film::{Film, film};

/// A street with a lane in each direction, and what else a test needs.
fn two_way(more: &str) -> Scenario {
    let text = format!(
        "title = \"A street\"\nshows = \"What is on it\"\nduration_s = 50.0\ndefaults = {{ class = \"car\" }}\n\
         road = {{ kind = \"two-way\", length_m = 300.0 }}\n{more}"
    );
    from_text("street.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}"))
}

/// The error messages of a scenario.
fn refused(text: &str) -> String {
    let head = "title = \"A street\"\nshows = \"What is wrong\"\ndefaults = { class = \"car\" }\n";
    let error = from_text("wrong.toml", &format!("{head}{text}"), &[]).expect_err("refused");
    let faults: Vec<String> = error.faults().iter().map(ToString::to_string).collect();
    faults.join("\n")
}

fn states(film: &Film, name: &str) -> Vec<(f64, State)> {
    let index = film.scenario.index_of(name).unwrap_or_else(|| panic!("there is no {name}"));
    let there = film.frames.iter().filter(|frame| !frame.vehicles[index].is_absent);
    there.map(|frame| (frame.time_s, frame.vehicles[index].state)).collect()
}

fn high_street(changes: &[&str]) -> Film {
    let changes: Vec<Override> = changes.iter().map(|change| Override::Set((*change).to_owned())).collect();
    let scenario = load("people/high-street", &changes).unwrap_or_else(|error| panic!("{error}"));
    film("high-street", scenario)
}

/// When a vehicle is first beyond a place along x \[s\].
fn passes_s(film: &Film, name: &str, x_m: f64) -> f64 {
    let passed = states(film, name).into_iter().find(|(_, state)| state.x_m > x_m);
    passed.unwrap_or_else(|| panic!("{name} never passes {x_m} m")).0
}

#[test]
fn a_street_with_all_contents_is_driven_lawfully() {
    let film = high_street(&[]);
    assert!(film.report.collisions.is_empty() && film.report.deadlocks.is_empty(), "{:?}", film.report.deadlocks);
    for vehicle in &film.report.vehicles {
        assert_eq!(vehicle.metrics.number("rules_broken").unwrap_or(0.0), 0.0, "{}", vehicle.name);
    }
    // The walker is on the crossing while the ego waits for it, and all vehicles go on afterwards.
    let walker = states(&film, "walker");
    let crosses_s: Vec<f64> =
        walker.iter().filter(|(_, state)| (-3.5..3.5).contains(&state.y_m)).map(|(time_s, _)| *time_s).collect();
    let (begins_s, ends_s) = (crosses_s[0], crosses_s[crosses_s.len() - 1]);
    let ego = states(&film, "ego");
    let nearest_m = ego.iter().filter(|(time_s, _)| (begins_s..=ends_s).contains(time_s)).map(|(_, state)| state.x_m);
    assert!(
        nearest_m.fold(f64::NEG_INFINITY, f64::max) + 2.2 < 0.0,
        "the ego is before the crossing while the walker is on it"
    );
    assert!(ego[ego.len() - 1].1.x_m > 60.0 && walker[walker.len() - 1].1.y_m > 10.0);
}

/// The ego waits for lights that are on, and does not wait for lights that are off.
#[test]
fn the_ego_waits_for_the_traffic_light() {
    let lit = high_street(&[]);
    let off = "phases=[{ colour = \"off\", duration_s = 1 }]";
    let [main, side] = ["main", "side"].map(|name| format!("light.{name}.{off}"));
    let dark = high_street(&[&main, &side]);
    assert!(passes_s(&dark, "ego", 64.0) + 2.0 < passes_s(&lit, "ego", 64.0));
    let reasons = |film: &Film| {
        let ego = film.report.vehicle("ego").expect("an ego");
        ego.standing.iter().any(|wait| wait.reason == "traffic light")
    };
    assert!(reasons(&lit) && !reasons(&dark));
}

/// An obstacle has the outline that it states: the time of contact is that of its circle, and beside its polygon nothing is touched.
#[test]
fn contacts_with_obstacles_are_those_of_their_outline() {
    let street = |obstacle: &str| {
        two_way(&format!(
            "[[vehicle]]\nname = \"ego\"\nstart = {{ lane = \"east\", along_m = 50.0, speed_mps = 10.0 }}\n\
             driver = {{ kind = \"scripted\" }}\nrules = \"ignored\"\n[[obstacle]]\nname = \"thing\"\nlane = \"east\"\n\
             along_m = 100.0\n{obstacle}"
        ))
    };
    let circle = film("circle", street("radius_m = 1.0"));
    let [contact] = circle.report.collisions.as_slice() else { panic!("one contact: {:?}", circle.report.collisions) };
    // The front is 2.2 m ahead of the middle, the circle begins 1 m before its middle.
    assert!((contact.time_s - (50.0 - 2.2 - 1.0) / 10.0).abs() < 2e-3, "{}", contact.time_s);
    // The box around this triangle is 2 m wide at the height of the ego's side; the triangle is not.
    let triangle = "lateral_offset_m = 1.8\ncorners_m = [[1.0, 1.0], [-1.0, 1.0], [0.0, -0.8]]";
    assert!(film("triangle", street(triangle)).report.collisions.is_empty());
    let wider = film("wider", street(&triangle.replace("-0.8", "-1.0")));
    assert_eq!(wider.report.collisions.len(), 1, "its tip reaches 0.1 m into the way of the ego");
}

/// A driver that keeps the rules passes a parked car; without the car the road is free.
#[test]
fn drivers_pass_a_parked_car() {
    let car = "[[obstacle]]\nname = \"parked\"\nlane = \"east\"\nalong_m = 120.0\nlateral_offset_m = -0.6\n";
    let ego = "[[vehicle]]\nname = \"ego\"\nstart = { lane = \"east\", along_m = 30.0, speed_mps = 10.0 }\n";
    for kind in ["human", "idm", "conservative", "negotiation"] {
        let film = film(kind, two_way(&format!("{ego}driver = {{ kind = \"{kind}\" }}\n{car}")));
        assert!(film.report.collisions.is_empty(), "{kind}");
        let at =
            |x_m: f64| states(&film, "ego").into_iter().find(|(_, state)| state.x_m >= x_m).map(|(_, state)| state);
        let parked = film.scenario.vehicle("parked").expect("an obstacle").start;
        let beside = at(parked.x_m).unwrap_or_else(|| panic!("{kind} never passes"));
        let after = at(parked.x_m + 60.0).unwrap_or_else(|| panic!("{kind} does not go on"));
        assert!(beside.y_m > after.y_m + 0.5, "{kind} moves aside and comes back: {beside:?} {after:?}");
    }
}

/// A vehicle comes once there is room, and leaves where its route ends; outside that interval it is in no scene.
#[test]
fn vehicles_enter_and_leave_at_their_times() {
    let film = film(
        "come",
        two_way(
            "[[vehicle]]\nname = \"ego\"\nstart = { lane = \"west\", along_m = 5.0, speed_mps = 10.0 }\n\
             [[vehicle]]\nname = \"stands\"\nstart = { lane = \"east\", along_m = 40.0, speed_mps = 0.0 }\n\
             driver = { kind = \"scripted\", script = [{ from_s = 9.0, speed_mps = 12.0 }] }\n\
             [[vehicle]]\nname = \"comes\"\nstart = { lane = \"east\", along_m = 30.0, speed_mps = 10.0 }\n\
             enters_s = 4.0\nleaves_at_end = true\n\
             [[vehicle]]\nname = \"goes\"\nstart = { lane = \"east\", along_m = 150.0, speed_mps = 5.0 }\nleaves_s = 6.0\n",
        ),
    );
    let [comes, goes] = ["comes", "goes"].map(|name| states(&film, name));
    let came_s = comes[0].0;
    assert!((9.5..16.0).contains(&came_s), "it enters only after the other one has left: {came_s} s");
    let (_, last) = comes[comes.len() - 1];
    assert!(last.x_m > 140.0 && comes[comes.len() - 1].0 < 49.0, "it leaves where its route ends: {last:?}");
    let (left_s, _) = goes[goes.len() - 1];
    assert!((5.7..6.0).contains(&left_s), "{left_s}");
    assert!(film.report.collisions.is_empty());
    let knows = |frame: &interplay_simulation::frame::Frame| {
        let passings = &frame.vehicles[0].plan.homotopy_class;
        passings.iter().any(|passing| passing.of == "goes" || passing.of == "comes")
    };
    assert!(!film.frames.iter().filter(|frame| (6.5..9.0).contains(&frame.time_s)).any(knows));
}

/// A pedestrian waits at the kerb where cars have priority, and goes first on a zebra crossing.
#[test]
fn pedestrians_wait_at_the_kerb_or_go_first() {
    let street = |crossing: &str| {
        let text = format!(
            "title = \"Kerb\"\nshows = \"A pedestrian crosses\"\nduration_s = 25.0\ndefaults = {{ class = \"car\" }}\n[road]\nkind = \"network\"\n\
             lane = [{{ name = \"street\", points = [[-100, 0], [100, 0]], width_m = 3.5 }},\n\
             {{ name = \"pavement\", points = [[0, -10], [0, -3]], width_m = 2.5, users = [\"pedestrian\"], successors = [\"over\"], right_of_way = \"{}\" }},\n\
             {{ name = \"over\", points = [[0, -3], [0, 9]], width_m = 2.5, users = [\"pedestrian\"]{} }}]\n\
             [[vehicle]]\nname = \"ego\"\nstart = {{ lane = \"street\", along_m = 40.0, speed_mps = 10.0 }}\n\
             [[vehicle]]\nname = \"walker\"\nclass = \"pedestrian\"\nstart = {{ lane = \"pavement\", along_m = 1.0, speed_mps = 1.4 }}\n\
             goal = {{ lane = \"over\", speed_mps = 1.4 }}\ndriver = {{ kind = \"walker\" }}\n",
            if crossing.is_empty() { "yield" } else { "priority" },
            crossing
        );
        from_text("kerb.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}"))
    };
    for (crossing, car_is_first) in [("", true), (", zebra = true", false)] {
        let film = film("kerb", street(crossing));
        let car_s = passes_s(&film, "ego", 2.0);
        let crosses = states(&film, "walker").into_iter().find(|(_, state)| state.y_m > 0.0).expect("it crosses");
        assert_eq!(car_s < crosses.0, car_is_first, "{crossing:?}: car at {car_s} s, walker at {} s", crosses.0);
        assert!(film.report.collisions.is_empty());
        assert_eq!(film.report.vehicle("ego").expect("an ego").metrics.number("rules_broken"), Some(0.0));
    }
}

/// Cars do not use a lane for buses, and a bus does.
#[test]
fn cars_do_not_use_a_bus_lane() {
    let road = "[road]\nkind = \"network\"\nlane = [\n\
         { name = \"main\", points = [[0, 0], [200, 0]], width_m = 3.5, right = \"kept\" },\n\
         { name = \"kept\", points = [[0, -3.5], [200, -3.5]], width_m = 3.5, left = \"main\", users = [\"bus\"] }]\n";
    let text = |class: &str| {
        format!(
            "title = \"Kept\"\nshows = \"A lane for buses\"\n{road}[[vehicle]]\nname = \"ego\"\nclass = \"{class}\"\n\
             start = {{ lane = \"main\", along_m = 10.0, speed_mps = 10.0 }}\n"
        )
    };
    let width_m = |class: &str| {
        let scenario = from_text("kept.toml", &text(class), &[]).unwrap_or_else(|error| panic!("{error}"));
        let route = &scenario.vehicles[0].route;
        route.left.value(100.0) - route.right.value(100.0)
    };
    assert!((width_m("car") - 3.5).abs() < 1e-9 && (width_m("bus") - 7.0).abs() < 1e-9);
    let wrong = refused(&format!(
        "{road}[[vehicle]]\nname = \"ego\"\nstart = {{ lane = \"kept\", along_m = 10.0, speed_mps = 10.0 }}\n"
    ));
    assert!(wrong.contains("not for vehicles of this class"), "{wrong}");
}

/// What makes no sense is refused where it is written.
#[test]
fn contradictions_in_a_street_are_refused_at_their_line() {
    let vehicle = "[[vehicle]]\nname = \"ego\"\nstart = { lane = \"east\", along_m = 50.0, speed_mps = 10.0 }\n";
    let road = "road = { kind = \"two-way\" }\n";
    let with = |more: &str| refused(&format!("{road}{vehicle}{more}"));
    let script = |orders: &str| with(&format!("driver = {{ kind = \"scripted\", script = [{orders}] }}\n"));
    for (found, expected) in [
        (script("{ from_s = 1.0, speed_mps = -2.0 }"), "driving backwards"),
        (script("{ from_s = 1.0, speed_mps = 200.0 }"), "outside the vehicle's limits"),
        (script("{ from_s = 1.0, lateral_m = 40.0 }"), "beside the road"),
        (script("{ from_s = 9e3, speed_mps = 1.0 }"), "after the end of the run"),
        (script("{ from_s = 1.0, speed_mps = 1.0 }, { from_s = 1.0, speed_mps = 2.0 }"), "begin at one time"),
        (
            script(
                "{ when = { vehicle = \"stranger\", reaches = { lane = \"east\", along_m = 1.0 } }, speed_mps = 1.0 }",
            ),
            "no vehicle",
        ),
        (
            script("{ when = { vehicle = \"ego\", reaches = { lane = \"west\", along_m = 1.0 } }, speed_mps = 1.0 }"),
            "not on the way",
        ),
        (with("enters_s = 3.0\n"), "not there when the run begins"),
        (
            with(
                "[[vehicle]]\nname = \"other\"\nstart = { lane = \"west\", along_m = 50.0, speed_mps = 5.0 }\nenters_s = 5.0\nleaves_s = 2.0\n",
            ),
            "before it has come",
        ),
        (with("[[obstacle]]\nname = \"ego\"\nlane = \"east\"\nalong_m = 100.0\n"), "are called `ego`"),
        (with("[[obstacle]]\nname = \"wall\"\n"), "does not say where"),
        (with("[[obstacle]]\nname = \"wall\"\nlane = \"est\"\nalong_m = 1.0\n"), "no lane `est`"),
        (with("[[obstacle]]\nname = \"wall\"\nlane = \"east\"\nalong_m = 1e4\n"), "stands 10000 m along"),
        (
            with("[[obstacle]]\nname = \"wall\"\nx_m = 0.0\ny_m = 9.0\ncorners_m = [[1, 0], [-1, 0], [0, 1]]\n"),
            "no convex polygon",
        ),
        (with("[[obstacle]]\nname = \"wall\"\nlane = \"east\"\nalong_m = 50.0\n"), "overlap at the start"),
        (
            with("[[obstacle]]\nname = \"wall\"\ntimetable = [[0.0, 1.0, 9.0, 0.0], [0.0, 2.0, 9.0, 0.0]]\n"),
            "goes back in time",
        ),
        (
            with("[[light]]\nname = \"a\"\nlanes = [\"est\"]\nphases = [{ colour = \"red\", duration_s = 1 }]\n"),
            "does not have",
        ),
    ] {
        assert!(found.contains(expected), "wanted {expected:?}, got {found}");
    }
    let on_lanes = refused(
        "road = { kind = \"lanes\", lane_width_m = 3.5 }\n[[vehicle]]\nname = \"ego\"\nstart = { lane = 0, along_m = 0.0, speed_mps = 1.0 }\n[[light]]\nname = \"a\"\nlanes = [\"b\"]\nphases = [{ colour = \"red\", duration_s = 1 }]\n",
    );
    assert!(on_lanes.contains("lanes with names"), "{on_lanes}");
}
