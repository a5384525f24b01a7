//! Measures of all vehicles together, computed again from the frames: gaps and times to collision of any two, the
//! edges of the road, right of way, speed limits. And what a failing expectation says of them.

use std::fs;
use std::sync::Arc;

use interplay_planners::road::centre_line::Piece;
use interplay_planners::road::network::{Lane, RoadNetwork};
use interplay_planners::{Body, CentreLine, State};
use interplay_scenarios::{Branch, Road, Vehicle};
use interplay_simulation::frame::PairGap;
use interplay_simulation::run::run;
use serde_json::{Value, json};

use crate::collisions::{Point, corners, distance};
use crate::command::{interplay, scratch};
use crate::film::{FILMS, Film, authored, film, kinematic};

/// Every two vehicles of a film by index.
fn pairs(film: &Film) -> Vec<[usize; 2]> {
    let count = film.scenario.vehicles.len();
    (0..count).flat_map(|a| (a + 1..count).map(move |b| [a, b])).collect()
}

/// The vehicles with these names, and their indices.
fn indices(film: &Film, names: &[String; 2]) -> [usize; 2] {
    names.each_ref().map(|name| film.scenario.vehicles.iter().position(|one| one.name == *name).expect("a name"))
}

/// The states at every tick and after the last one.
fn moments(film: &Film) -> Vec<Vec<State>> {
    let first = film.frames[0].vehicles.iter().map(|vehicle| vehicle.state).collect();
    std::iter::once(first).chain((0..film.frames.len()).map(|tick| film.states_after(tick))).collect()
}

fn gap_m(film: &Film, states: &[State], [a, b]: [usize; 2]) -> f64 {
    let vehicles = &film.scenario.vehicles;
    distance((&vehicles[a].body, &states[a]), (&vehicles[b].body, &states[b]))
}

/// A metric of two vehicles, its value whatever its unit; none if no two have one.
fn of_pair(film: &Film, name: &str) -> Option<PairGap> {
    let (_, measured) = film.report.metrics.get(name)?;
    let (m, time_s, between) = (measured.value?.as_number(), measured.time_s?, measured.between.clone()?);
    Some(PairGap { m, between, time_s })
}

/// The gap is the smallest of all pairs, and the named pair has it at the named time.
#[test]
fn the_smallest_gap_is_reported_for_the_closest_pair() {
    for film in kinematic() {
        let (pairs, gap) = (pairs(film), of_pair(film, "smallest_gap_m").expect("there are others"));
        let smallest_m =
            |states: &[State]| pairs.iter().map(|pair| gap_m(film, states, *pair)).fold(f64::INFINITY, f64::min);
        let at_ticks = moments(film).iter().map(|states| smallest_m(states)).fold(f64::INFINITY, f64::min);
        let often = film.frames.len() * 50;
        let between = (0..often).map(|part| smallest_m(&film.states_at(part as f64 * film.scenario.step_s / 50.0)));
        let between = between.fold(f64::INFINITY, f64::min);
        assert!((between - 1e-3..=at_ticks + 1e-5).contains(&gap.m), "{}: {gap:?}, {between}", film.name());
        let there_m = gap_m(film, &film.states_at(gap.time_s), indices(film, &gap.between));
        assert!((there_m - gap.m).abs() < 1e-4, "{}: {gap:?}, but {there_m} m", film.name());
        assert!(film.report.min_gap_m().is_none_or(|of_ego_m| gap.m <= of_ego_m), "{}", film.name());
    }
    // Bodies of the dynamic plant may be at distance 0 for a sub-step of a millisecond before they push each other.
    for film in FILMS.iter().filter(|film| !film.report.collisions.is_empty()) {
        let (gap, collision) = (of_pair(film, "smallest_gap_m").expect("two"), &film.report.collisions[0]);
        assert_eq!((gap.m, &gap.between), (0.0, &collision.between), "{}", film.name());
        assert!((gap.time_s - collision.time_s).abs() < 1.5e-3, "{}: {gap:?} {collision:?}", film.name());
    }
}

/// The time after which two rectangles touch that move without turning: on each normal of an edge, their shadows overlap during
/// an interval of time; they touch while all these intervals overlap.
fn time_to_collision_s(shapes: [[Point; 4]; 2], velocity_mps: Point) -> Option<f64> {
    let axes = shapes.iter().flat_map(|corners| {
        [[0, 1], [1, 2]].map(|[from, to]| [corners[to][1] - corners[from][1], corners[from][0] - corners[to][0]])
    });
    let (mut from_s, mut to_s) = (0.0f64, f64::INFINITY);
    for axis in axes {
        let dot = |point: Point| axis[0] * point[0] + axis[1] * point[1];
        let [[low, high], [other_low, other_high]] = shapes.map(|corners| {
            let shadow = corners.map(dot);
            [shadow.into_iter().fold(f64::INFINITY, f64::min), shadow.into_iter().fold(f64::NEG_INFINITY, f64::max)]
        });
        let rate = dot(velocity_mps);
        if rate == 0.0 {
            if other_low > high || other_high < low {
                return None;
            }
            continue;
        }
        let ends_s = [(low - other_high) / rate, (high - other_low) / rate];
        from_s = from_s.max(ends_s[0].min(ends_s[1]));
        to_s = to_s.min(ends_s[0].max(ends_s[1]));
    }
    (from_s <= to_s).then_some(from_s)
}

#[test]
fn the_time_to_collision_assumes_constant_headings() {
    let mut closed_in = 0;
    for film in FILMS.iter() {
        let (moments, step_s) = (moments(film), film.scenario.step_s);
        let time_s = |tick: usize, [a, b]: [usize; 2]| {
            let shapes = [a, b].map(|index| corners(&film.scenario.vehicles[index].body, &moments[tick][index]));
            let moved = |index: usize| {
                let [before, after] = [tick, tick + 1].map(|tick| moments[tick][index]);
                [(after.x_m - before.x_m) / step_s, (after.y_m - before.y_m) / step_s]
            };
            let (one, other) = (moved(a), moved(b));
            time_to_collision_s(shapes, [other[0] - one[0], other[1] - one[1]])
        };
        let ticks = || (0..film.frames.len()).flat_map(|tick| pairs(film).into_iter().map(move |pair| (tick, pair)));
        let shortest = ticks().filter_map(|(tick, pair)| time_s(tick, pair)).fold(f64::INFINITY, f64::min);
        let is_near = |found_s: f64, wanted_s: f64| (found_s - wanted_s).abs() < 1e-3 * (1.0 + wanted_s);
        match of_pair(film, "time_to_collision_s") {
            Some(found) => {
                assert!(is_near(found.m, shortest), "{}: {found:?}, but {shortest} s", film.name());
                let tick = (found.time_s / step_s).round() as usize;
                let theirs = time_s(tick, indices(film, &found.between)).expect("a collision course");
                assert!(is_near(found.m, theirs), "{}: {found:?}, but {theirs} s", film.name());
                closed_in += 1;
            }
            None => assert!(shortest > 100.0, "{}: {shortest} s", film.name()),
        }
    }
    assert!(closed_in > 20, "only {closed_in} films have a collision course");
}

/// How far a point is beyond the road of a vehicle, from the definition of each road \[m\].
fn beyond_m(road: &Road, vehicle: &Vehicle, [x, y]: Point) -> f64 {
    let width_m = road.width_m();
    match (road, vehicle.road) {
        (Road::Intersection(crossing), Branch::Cross) => {
            let (sin, cos) = crossing.angle_deg.to_radians().sin_cos();
            (-sin * x + cos * (y - 0.5 * width_m)).abs() - 0.5 * width_m
        }
        (Road::RampMerge(ramp), _) => {
            let tanh = ((x - (ramp.ramp_end_m - 2.0 * ramp.taper_m)) / ramp.taper_m).tanh();
            (0.5 * ramp.lane_width_m * (1.0 + tanh) - y).max(y - width_m)
        }
        (Road::Lanes(_) | Road::Intersection(_), _) => (-y).max(y - width_m),
        // On curves and networks the strip is that of the vehicle's route.
        _ => {
            // The nearest of finely spaced places of the centre line, refined by halving the steps.
            let apart_m = |along_m: f64| {
                let [cx, cy] = vehicle.route.position(along_m, 0.0);
                (x - cx).hypot(y - cy)
            };
            let (mut along_m, mut step_m) = (0.0, 0.1);
            let end_m = vehicle.route.end_m();
            let places = (-200..).map(|place| f64::from(place) * step_m).take_while(|along_m| *along_m < end_m + 20.0);
            for place in places {
                along_m = if apart_m(place) < apart_m(along_m) { place } else { along_m };
            }
            while step_m > 1e-9 {
                let nearer =
                    [along_m - step_m, along_m + step_m].into_iter().find(|at| apart_m(*at) < apart_m(along_m));
                (along_m, step_m) = nearer.map_or((along_m, 0.5 * step_m), |nearer| (nearer, step_m));
            }
            let ([ax, ay], [bx, by]) = (vehicle.route.position(along_m, 0.0), vehicle.route.position(along_m, 1.0));
            let across_m = (x - ax) * (bx - ax) + (y - ay) * (by - ay);
            (vehicle.route.right.value(along_m) - across_m).max(across_m - vehicle.route.left.value(along_m))
        }
    }
}

fn off_road_m(film: &Film, index: usize) -> f64 {
    let vehicle = &film.scenario.vehicles[index];
    let seen = moments(film);
    let points = seen.iter().flat_map(|states| corners(&vehicle.body, &states[index]));
    let beyond_m = points.map(|corner| beyond_m(&film.scenario.road, vehicle, corner)).fold(0.0, f64::max);
    // A millimetre is on the road, and an obstacle beside it breaks no rule.
    if beyond_m <= 1e-3 || vehicle.obstacle.is_some() { 0.0 } else { beyond_m }
}

#[test]
fn the_off_road_distance_is_that_of_the_farthest_corner() {
    // A goal right at the edge: half of the vehicle would be beside the road, and what it wants outweighs that. And a bend that
    // is too fast for a slippery road.
    let goal = ["duration_s=4", "vehicle.ego.goal={ y_m = 0.74 }", "vehicle.ego.weights.y=1e5"];
    let ice = ["duration_s=7", "plant={ kind = \"dynamic\", friction = 0.25 }"];
    let strayed = [("lane-change/front-nice", goal.as_slice()), ("full-size/bend", &ice)]
        .map(|(name, changes)| film(name, authored(name, changes)));
    for film in FILMS.iter().chain(&strayed) {
        for (index, vehicle) in film.report.vehicles.iter().enumerate() {
            let expected_m = off_road_m(film, index);
            let at = format!("{}: {}", film.name(), vehicle.name);
            let (_, measured) = vehicle.metrics.get("off_road_m").expect("measured");
            let off_road_m = measured.value.expect("every vehicle has one").as_number();
            assert!((off_road_m - expected_m).abs() < 1e-6, "{at}: {off_road_m} {expected_m}");
            assert_eq!(off_road_m > 0.0, measured.time_s.is_some(), "{at}");
        }
    }
    for film in &strayed {
        let ego = film.report.vehicle("ego").expect("there");
        let off_road_m = ego.metrics.number("off_road_m").expect("measured");
        assert!(off_road_m > 0.01, "{}: {off_road_m} m", film.name());
    }
}

/// Of two roads of the width `w` at the angle `γ`, the zone begins `w/2 (1 + |cos γ|)/|sin γ|` before the middle.
#[test]
fn reported_right_of_way_follows_from_the_front_bumpers() {
    let mut judged = 0;
    for film in FILMS.iter() {
        // Routes of networks are tested beside the measure.
        if film.scenario.network.is_some() {
            continue;
        }
        let Road::Intersection(crossing) = &film.scenario.road else {
            assert_eq!(film.report.right_of_way, [], "{}", film.name());
            continue;
        };
        let half_m = 0.5 * crossing.lane_count as f64 * crossing.lane_width_m;
        let (sin, cos) = crossing.angle_deg.to_radians().sin_cos();
        let entered_s = |name: &str| {
            let index = film.scenario.vehicles.iter().position(|one| one.name == name).expect("a name");
            let vehicle = &film.scenario.vehicles[index];
            let [x, y] = if vehicle.road == Branch::Main { [1.0, 0.0] } else { [cos, sin] };
            let front_m = |state: &State| x * state.x_m + y * (state.y_m - half_m) + vehicle.body.front_m;
            let begin_m = -half_m * (1.0 + cos.abs()) / sin.abs();
            let fronts_m: Vec<f64> = moments(film).iter().map(|states| front_m(&states[index])).collect();
            let tick = fronts_m.windows(2).position(|pair| pair[0] < begin_m && pair[1] >= begin_m)?;
            let share = (begin_m - fronts_m[tick]) / (fronts_m[tick + 1] - fronts_m[tick]);
            Some((tick as f64 + share) * film.scenario.step_s)
        };
        for passage in &film.report.right_of_way {
            let (first_s, second_s) = (entered_s(&passage.first).expect("it entered"), entered_s(&passage.second));
            assert!((passage.first_s - first_s).abs() < 1e-6, "{}: {passage:?} {first_s}", film.name());
            assert_eq!(passage.second_s.is_some(), second_s.is_some(), "{}: {passage:?}", film.name());
            let later_s = second_s.unwrap_or(f64::INFINITY);
            assert!((passage.second_s.unwrap_or(later_s) - later_s).abs() < 1e-6 || second_s.is_none());
            assert!(later_s >= first_s, "{}: {passage:?}", film.name());
            judged += 1;
        }
        let roads = film.scenario.vehicles.iter().filter(|vehicle| vehicle.road == Branch::Cross).count();
        assert_eq!(film.report.right_of_way.len(), roads * (film.scenario.vehicles.len() - roads), "{}", film.name());
    }
    assert!(judged > 15, "{judged}");
}

/// All vehicles drive on one lane with a limit of 1.2 m/s, and the two humans want 1.25 m/s.
#[test]
fn vehicles_that_exceed_a_speed_limit_are_named() {
    let line = CentreLine::from_pieces([-10.0, 0.37], 0.0, &[Piece::Straight { length_m: 100.0 }]).expect("a piece");
    let mut lane = Lane::new("main", line, 0.74);
    lane.speed_limit_mps = Some(1.2);
    let route = Arc::new(RoadNetwork::new(vec![lane]).expect("a network").route(&["main"]).expect("a route"));
    let mut scenario = authored("lane-change/front-nice", &["duration_s=0.3", "expect.completes=[]"]);
    scenario.vehicles.iter_mut().for_each(|vehicle| vehicle.route = Arc::clone(&route));
    scenario.expect.speed_limit_exceeded_by_at_most_mps = Some(0.01);
    let report = run("limits", &scenario, Vec::new()).expect("the run can be finished");
    let expectation = report.expectations.iter().find(|one| one.what == "speed_limit_exceeded_by_at_most_mps");
    let expectation = expectation.expect("judged");
    assert!(!expectation.passed, "{expectation}");
    let [mps, vehicle, time_s] = ["mps", "vehicle", "time_s"].map(|key| &expectation.got[key]);
    assert!(mps.as_f64().is_some_and(|mps| (0.049..0.1).contains(&mps)), "{expectation}");
    assert!((vehicle == "front" || vehicle == "rear") && time_s.is_f64(), "{expectation}");
    assert_eq!(report.vehicle("ego").expect("there").metrics.number("speeding_mps"), Some(0.0));
    scenario.expect.speed_limit_exceeded_by_at_most_mps = Some(0.2);
    assert!(report.judged_by(&scenario.expect).iter().all(|one| one.what != expectation.what || one.passed));
}

/// Bounds that hold at an intersection, and the same bounds drawn so tight that they fail.
const BOUNDS: &str = "gap_at_least_m = GAP\ntime_to_collision_at_least_s = TIME\noff_road_at_most_m = 0.0\n\
    comfort = [{ vehicle = 'ego', acceleration_at_most_mps2 = A, jerk_at_most_mps3 = J, lateral_acceleration_at_most_mps2 = L }]\n";

fn bounded(values: [&str; 5], yields: &str, more: &str) -> String {
    let bounds =
        ["GAP", "TIME", "= A", "= J", "= L"].iter().zip(values).fold(BOUNDS.to_owned(), |text, (key, value)| {
            let value = if key.starts_with('=') { format!("= {value}") } else { value.to_owned() };
            text.replacen(key, &value, 1)
        });
    format!("extends = 'intersection/nice'\ntitle = 'Mine'\n[expect]\n{bounds}{yields}\n{more}")
}

#[test]
fn a_failed_expectation_names_the_vehicles_and_the_time() {
    let folder = scratch("traffic");
    let held = "yields = [{ vehicle = 'crossing', to = 'ego' }]";
    let claim = "[[counterfactual]]\nname = 'without asking the ego waits'\nplanner = 'conservative'\n\
                 [counterfactual.expect]\nbreaks = ['order', 'completes.ego', 'yields.crossing.to.ego']\n\
                 yields = [{ vehicle = 'ego', to = 'crossing' }]\n";
    let sound = bounded(["0.01", "0.05", "5", "60", "5"], held, claim);
    fs::write(folder.join("sound.toml"), sound).expect("a scratch file can be written");
    let outcome = interplay(&folder, &["run", "sound.toml", "--no-record", "--json"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stdout);
    let report = outcome.json();
    let tight = bounded(["9", "99", "1e-9", "1e-9", "0.0"], "yields = [{ vehicle = 'ego', to = 'crossing' }]", "");
    fs::write(folder.join("tight.toml"), tight).expect("a scratch file can be written");
    let outcome = interplay(&folder, &["run", "tight.toml", "--no-record", "--json"]);
    let failed: Vec<Value> = outcome.json()["expectations"].as_array().expect("a list").clone();
    let got = |what: &str| {
        let one = failed.iter().find(|one| one["what"] == what).unwrap_or_else(|| panic!("no {what}: {failed:#?}"));
        assert_eq!(one["passed"], false, "{one}");
        one["got"].clone()
    };
    assert_eq!(got("gap_at_least_m"), report["smallest_gap"]);
    assert_eq!(got("time_to_collision_at_least_s"), report["shortest_time_to_collision"]);
    assert_eq!(got("yields.ego.to.crossing"), report["right_of_way"][0]);
    let ego = &report["vehicles"][0];
    for (key, peak, time) in [
        ("acceleration_at_most_mps2", "peak_acceleration_mps2", "acceleration"),
        ("jerk_at_most_mps3", "peak_jerk_mps3", "jerk"),
    ] {
        let wanted = json!({ "peak": ego[peak], "time_s": ego["peak_times_s"][time] });
        assert_eq!(got(&format!("comfort.ego.{key}")), wanted);
    }
    let text = interplay(&folder, &["run", "tight.toml", "--no-record"]).stdout;
    assert!(text.contains("FAIL gap_at_least_m: wanted: at least 9.0 m; got: "), "{text}");
    assert!(text.contains(" between ego and crossing at "), "{text}");
    // No vehicle gets there in half a second.
    let short = ["run", "sound.toml", "--no-record", "--set", "duration_s=0.5"];
    let text = interplay(&folder, &[&short[..], &["--set", "counterfactual=[]"]].concat()).stdout;
    assert!(text.contains("got: neither entered the conflict zone"), "{text}");
}

/// The rectangle of 0.4 m × 0.19 m behind another one, and beside it.
#[test]
fn times_to_collision_of_rectangles_match_closed_forms() {
    let body = Body::default();
    let at = |x_m: f64, y_m: f64| corners(&body, &State { x_m, y_m, heading_rad: 0.0, speed_mps: 0.0 });
    let is = |found: Option<f64>, wanted: f64| found.is_some_and(|found| (found - wanted).abs() < 1e-12);
    assert!(is(time_to_collision_s([at(0.0, 0.0), at(2.0, 0.1)], [-0.5, 0.0]), 3.2));
    assert!(is(time_to_collision_s([at(0.0, 0.0), at(0.1, 0.0)], [1.0, 0.0]), 0.0));
    assert_eq!(time_to_collision_s([at(0.0, 0.0), at(2.0, 0.1)], [0.5, 0.0]), None);
    assert_eq!(time_to_collision_s([at(0.0, 0.0), at(2.0, 0.2)], [-0.5, 0.0]), None);
}
