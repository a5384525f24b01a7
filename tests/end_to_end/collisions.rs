//! A collision is reported with its time, its vehicles and its impact, and only where vehicles touch.

use std::fs;

use interplay_scenarios::{Scenario, from_text};

use crate::command::{interplay, scratch};
use crate::film::{Film, film};
use crate::rectangles::distance;

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
