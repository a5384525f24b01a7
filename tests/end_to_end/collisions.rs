//! A collision is reported with its time, its vehicles and its impact, and only where vehicles touch.

use std::fs;

use interplay_planners::{Body, State};
use interplay_scenarios::{Scenario, from_text};

use crate::command::{interplay, scratch};
use crate::film::{Film, film};

/// A car comes up behind one that stands, in a single lane, and can no longer stop: at 1.5 m/s it needs 1.125 m.
fn unavoidable(free_m: f64) -> String {
    format!(
        r#"
        title = "A car that cannot stop"
        shows = "A collision"
        duration_s = 1.0
        [road]
        kind = "lanes"
        lane_count = 1
        [[vehicle]]
        name = "ego"
        start = {{ x_m = 0.0, y_m = 0.185, speed_mps = 1.5 }}
        [[vehicle]]
        name = "standing"
        start = {{ x_m = {x_m}, y_m = 0.185, speed_mps = 0.0 }}
        [expect]
        no_collision = true
        "#,
        x_m = free_m + 0.4
    )
}

fn scenario(text: &str) -> Scenario {
    from_text("collision.toml", text, &[]).unwrap_or_else(|error| panic!("{:?}", error.faults()))
}

fn gap_m(film: &Film, time_s: f64) -> f64 {
    let (states, vehicles) = (film.states_at(time_s), &film.scenario.vehicles);
    distance((&vehicles[0].body, &states[0]), (&vehicles[1].body, &states[1]))
}

#[test]
fn a_reported_collision_has_a_time_two_vehicles_and_an_impulse() {
    for free_m in [0.1, 0.2, 0.33] {
        let film = film("collision", scenario(&unavoidable(free_m)));
        let [collision] = film.report.collisions.as_slice() else { panic!("{:?}", film.report.collisions) };
        assert_eq!(collision.between, ["ego", "standing"]);
        let touch_s = (0..10_000).map(|i| f64::from(i) * 1e-4).find(|time_s| gap_m(&film, *time_s) == 0.0);
        let touch_s = touch_s.expect("they touch");
        assert!((collision.time_s - touch_s).abs() <= 2e-4, "{} at {touch_s}", collision.time_s);
        // Two equal cars of 0.4 m × 0.19 m and 185 kg/m²: half the mass of one times the closing speed, which counts along
        // the flat rear of the standing one.
        let states = film.states_at(collision.time_s);
        let closing_mps = states[0].speed_mps * states[0].heading_rad.cos() - states[1].speed_mps;
        let expected_ns = 0.5 * 185.0 * 0.4 * 0.19 * closing_mps;
        assert!(collision.impulse_ns > 0.0);
        assert!((collision.impulse_ns / expected_ns - 1.0).abs() < 1e-6, "{} {expected_ns}", collision.impulse_ns);
        assert_eq!(film.report.min_gap_m(), Some(0.0));
        let events: Vec<_> = film.frames.iter().flat_map(|frame| &frame.events).collect();
        let alarms = events.iter().filter(|event| event.text.contains("collides with standing"));
        assert_eq!(alarms.count(), 1, "{events:?}");
        assert!(!film.report.passed);
    }
}

#[test]
fn a_collision_fails_the_run_and_is_reported() {
    let folder = scratch("collision");
    fs::write(folder.join("crash.toml"), unavoidable(0.2)).expect("a scratch file can be written");
    let outcome = interplay(&folder, &["run", "crash.toml", "--no-record"]);
    assert_eq!(outcome.code, Some(1), "{outcome:?}");
    assert!(outcome.stdout.contains("COLLISION of ego and standing at 0."), "{}", outcome.stdout);
    let report = interplay(&folder, &["run", "crash.toml", "--no-record", "--json"]).json();
    assert_eq!(report["collisions"][0]["between"], serde_json::json!(["ego", "standing"]));
}

/// With room to stop outside the safety ellipse (0.35 m from bumper to bumper) a careful driver stops.
#[test]
fn a_car_that_can_stop_does_not_collide() {
    let driver = "driver = { kind = \"conservative\" }";
    let careful = unavoidable(1.6).replace("speed_mps = 1.5 }", &format!("speed_mps = 1.5 }}\n{driver}"));
    let film = film("stops", Scenario { duration_s: 5.0, ..scenario(&careful) });
    assert!(film.report.collisions.is_empty(), "{:?}", film.report.collisions);
    let (gap_m, speed_mps) =
        (film.report.min_gap_m().expect("there is another"), film.report.vehicles[0].last.speed_mps);
    assert!((0.25..0.5).contains(&gap_m) && speed_mps < 1e-3, "{gap_m} {speed_mps}");
}

/// Side by side with 5 mm between them, at the same speed: near, but without contact.
#[test]
fn vehicles_five_millimetres_apart_do_not_collide() {
    let text = r#"
        title = "Side by side"
        shows = "No collision"
        duration_s = 1.0
        road = { kind = "lanes", lane_count = 2, lane_width_m = 0.195 }
        [[vehicle]]
        name = "ego"
        start = { x_m = 0.0, y_m = 0.0975, speed_mps = 1.0 }
        driver = { kind = "human", style = "tough" }
        [[vehicle]]
        name = "other"
        start = { x_m = 0.1, y_m = 0.2925, speed_mps = 1.0 }
        driver = { kind = "human", style = "tough" }
    "#;
    let film = film("near", scenario(text));
    assert!(film.report.collisions.is_empty(), "{:?}", film.report.collisions);
    let smallest = film.report.min_gap_m().expect("there is another");
    assert!((smallest - 0.005).abs() < 1e-4, "{smallest}");
}

pub type Point = [f64; 2];

/// The corners of a footprint, counter-clockwise.
pub fn corners(body: &Body, state: &State) -> [Point; 4] {
    let (sin, cos) = state.heading_rad.sin_cos();
    let half = body.width_m / 2.0;
    let local = [[body.front_m, -half], [body.front_m, half], [-body.rear_m, half], [-body.rear_m, -half]];
    local.map(|[ahead, left]| [state.x_m + cos * ahead - sin * left, state.y_m + sin * ahead + cos * left])
}

fn edges(corners: &[Point; 4]) -> [[Point; 2]; 4] {
    std::array::from_fn(|i| [corners[i], corners[(i + 1) % 4]])
}

/// Twice the signed area of a triangle: positive if `c` is to the left of the line from `a` to `b`.
fn turn([ax, ay]: Point, [bx, by]: Point, [cx, cy]: Point) -> f64 {
    (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
}

fn to_segment(point: Point, [a, b]: [Point; 2]) -> f64 {
    let (along, away) = ([b[0] - a[0], b[1] - a[1]], [point[0] - a[0], point[1] - a[1]]);
    let length_squared = along[0] * along[0] + along[1] * along[1];
    let share = ((away[0] * along[0] + away[1] * along[1]) / length_squared).clamp(0.0, 1.0);
    (away[0] - share * along[0]).hypot(away[1] - share * along[1])
}

/// Distance between two footprints; 0 where they overlap \[m\].
pub fn distance(first: (&Body, &State), second: (&Body, &State)) -> f64 {
    let (a, b) = (corners(first.0, first.1), corners(second.0, second.1));
    let inside = |point: Point, of: &[Point; 4]| edges(of).iter().all(|[from, to]| turn(*from, *to, point) >= 0.0);
    let cross = |[a, b]: [Point; 2], [c, d]: [Point; 2]| {
        turn(a, b, c) * turn(a, b, d) < 0.0 && turn(c, d, a) * turn(c, d, b) < 0.0
    };
    let overlap = a.iter().any(|point| inside(*point, &b))
        || b.iter().any(|point| inside(*point, &a))
        || edges(&a).iter().any(|one| edges(&b).iter().any(|other| cross(*one, *other)));
    if overlap {
        return 0.0;
    }
    let from_a = a.iter().flat_map(|point| edges(&b).map(|edge| to_segment(*point, edge)));
    let from_b = b.iter().flat_map(|point| edges(&a).map(|edge| to_segment(*point, edge)));
    from_a.chain(from_b).fold(f64::INFINITY, f64::min)
}

#[test]
fn distances_of_rectangles_match_closed_forms() {
    let body = Body::default();
    let at = |x_m: f64, y_m: f64, heading_rad: f64| State { x_m, y_m, heading_rad, speed_mps: 0.0 };
    let far = |a: State, b: State| distance((&body, &a), (&body, &b));
    assert!((far(at(0.0, 0.0, 0.0), at(1.0, 0.0, 0.0)) - 0.6).abs() < 1e-12);
    assert!((far(at(0.0, 0.0, 0.0), at(0.0, 1.0, 0.0)) - 0.81).abs() < 1e-12);
    assert!((far(at(0.0, 0.0, 0.0), at(0.7, 0.59, 0.0)) - 0.3f64.hypot(0.4)).abs() < 1e-12);
    assert_eq!(far(at(0.0, 0.0, 0.0), at(0.0, 0.0, 1.0)), 0.0, "crossed without a corner inside");
}
