//! Vehicles that follow a record, and roads far from the origin of their coordinates.

use interplay_planners::State;
use interplay_scenarios::{Scenario, from_text};

use crate::command::{interplay, scratch};
use crate::film::film;

/// How far a vehicle may be from its record \[m\].
const MAX_MISS_M: f64 = 0.01;

/// A car brakes and turns aside; its record has steps of 0.25 s, and the run others.
fn record() -> Vec<[f64; 5]> {
    let row = |step: u32| {
        let time_s = 0.25 * f64::from(step);
        let speed_mps = (10.0 - 2.0 * time_s).max(0.0);
        let along_m = 30.0 + if time_s < 5.0 { 10.0 * time_s - time_s * time_s } else { 25.0 };
        [time_s, along_m, 1.75 + 0.25 * time_s.min(4.0), 0.03, speed_mps]
    };
    (0..=24).map(row).collect()
}

fn scenario(more: &str) -> Scenario {
    let text = format!(
        "title = \"A record\"\nshows = \"A car follows another one that was recorded\"\nduration_s = 8.0\n{more}\n\
         road = {{ kind = \"lanes\", lane_width_m = 3.5 }}\n[[vehicle]]\nname = \"ego\"\n\
         start = {{ lane = 0, along_m = 0.0, speed_mps = 10.0 }}\n[[vehicle]]\nname = \"front\"\n\
         start = {{ x_m = 30.0, y_m = 1.75, speed_mps = 10.0 }}\ndriver = {{ kind = \"recorded\", points = {:?} }}\n",
        record()
    );
    from_text("record.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}: {:?}", error.faults()))
}

#[test]
fn a_recorded_vehicle_is_where_its_record_says_at_every_tick() {
    for times in
        ["", "step_s = 0.1\nplanning_period_s = 0.3", "step_s = 0.25", "step_s = 0.04\nplanning_period_s = 0.2"]
    {
        let film = film("record", scenario(times));
        let rows = record();
        for frame in film.frames.iter().filter(|frame| frame.time_s <= 6.0) {
            let after = rows.partition_point(|row| row[0] <= frame.time_s).min(rows.len() - 1);
            let [from, to] = [rows[after - 1], rows[after]];
            let share = (frame.time_s - from[0]) / (to[0] - from[0]);
            let [x_m, y_m] = [1, 2].map(|axis| from[axis] + share * (to[axis] - from[axis]));
            let State { x_m: found_x, y_m: found_y, .. } = frame.vehicles[1].state;
            let missed_m = (found_x - x_m).hypot(found_y - y_m);
            assert!(missed_m <= MAX_MISS_M, "{times:?}: {missed_m} m at {} s", frame.time_s);
        }
        // It stands when its record ends, and remains there.
        let last = film.report.vehicles[1].last;
        assert!((last.x_m - 55.0).abs() <= MAX_MISS_M && last.speed_mps == 0.0, "{last:?}");
        assert!(film.report.collisions.is_empty(), "the ego stops behind it: {:?}", film.report.collisions);
    }
}

/// No plan of a recorded vehicle says what comes; `causality.rs` shows that the others cannot know it in any other way.
#[test]
fn other_drivers_do_not_know_the_future_of_a_record() {
    let film = film("record", scenario(""));
    for frame in film.frames.iter().filter(|frame| frame.plans) {
        let front = &frame.vehicles[1];
        assert_eq!(front.prediction.states[0], front.state, "at {} s", frame.time_s);
        let present_mps = front.state.speed_mps;
        assert!(front.plan.trajectory.states.iter().all(|state| (state.speed_mps - present_mps).abs() < 1e-9));
    }
}

/// A network with a bend, a human and a recorded car, whose coordinates are halves and quarters of metres.
fn network(origin: [f64; 2]) -> String {
    let point = |x: f64, y: f64| format!("[{:.3}, {:.3}]", origin[0] + x, origin[1] + y);
    let line: Vec<String> =
        [[0.0, 0.0], [32.0, 0.0], [64.0, 1.5], [96.0, 5.5], [128.0, 12.0]].iter().map(|[x, y]| point(*x, *y)).collect();
    let rows: Vec<String> = (0..=32)
        .map(|step| {
            let time_s = 0.25 * f64::from(step);
            format!("[{time_s}, {:.3}, {:.3}, 0.0, 4.0]", origin[0] + 24.0 + 4.0 * time_s, origin[1] + 0.25)
        })
        .collect();
    format!(
        "title = \"Far away\"\nshows = \"A car follows another one\"\nduration_s = 8.0\n[road]\nkind = \"network\"\n\
         [[road.lane]]\nname = \"a\"\npoints = [{}]\nwidth_m = 3.5\n[[vehicle]]\nname = \"ego\"\n\
         start = {{ x_m = {:.3}, y_m = {:.3}, speed_mps = 8.0 }}\n[[vehicle]]\nname = \"front\"\n\
         start = {{ x_m = {:.3}, y_m = {:.3}, speed_mps = 4.0 }}\ndriver = {{ kind = \"recorded\", points = [{}] }}\n",
        line.join(", "),
        origin[0] + 4.0,
        origin[1] + 0.5,
        origin[0] + 24.0,
        origin[1] + 0.25,
        rows.join(", ")
    )
}

/// In coordinates of UTM a scenario has the same report as at the origin, bit for bit, as far as its numbers can be written exactly.
#[test]
fn a_scenario_far_from_the_origin_has_the_same_report() {
    let load = |origin| {
        from_text("far.toml", &network(origin), &[]).unwrap_or_else(|error| panic!("{error}: {:?}", error.faults()))
    };
    let near = film("far", load([0.0, 0.0]));
    let far = film("far", load([4e5, 5e6]));
    assert_eq!(near.report.digest, far.report.digest);
    for (one, other) in near.frames.iter().zip(&far.frames) {
        assert!(
            one.vehicles.iter().zip(&other.vehicles).all(|(one, other)| one.state == other.state),
            "{} s",
            one.time_s
        );
    }
    let remark = far.scenario.remarks.iter().map(ToString::to_string).find(|remark| remark.contains("moved"));
    assert!(remark.is_some_and(|remark| remark.contains("(400000, 5000000)")));
}

/// The steps of a user: import, check, run; and a run of the XML file itself.
#[test]
fn scenarios_of_commonroad_are_imported_and_run() {
    let folder = scratch("commonroad");
    for name in ["motorway", "tee-in-utm"] {
        let xml = format!("{}/cases/commonroad/{name}.xml", env!("CARGO_MANIFEST_DIR"));
        let imported = interplay(&folder, &["import", &xml, "--ego", "idm"]);
        assert_eq!(imported.code, Some(0), "{imported:?}");
        assert!(imported.stdout.contains("not carried over yet"), "{imported:?}");
        assert!(imported.stdout.contains(&format!("interplay run {name}.toml")), "{imported:?}");
        let again = interplay(&folder, &["import", &xml]);
        assert!(again.code == Some(2) && again.stderr.contains("exists already"), "{again:?}");
        for file in [format!("{name}.toml"), xml] {
            let run = interplay(&folder, &["run", &file, "--no-record"]);
            assert_eq!(run.code, Some(0), "{run:?}");
        }
    }
    let wrong = interplay(&folder, &["import", "motorway.csv"]);
    assert!(wrong.code == Some(2) && wrong.stderr.contains("not valid XML"), "{wrong:?}");
}

/// A recorded car would drive into one that stands where it was free when it was recorded. With `hands_over` it does not, and says why.
#[test]
fn a_driver_takes_over_before_a_record_leads_into_another_vehicle() {
    let run = |more: &str| {
        let text = format!(
            "title = \"In its way\"\nshows = \"A vehicle stands in the way of a recorded car\"\nduration_s = 12.0\n\
             road = {{ kind = \"lanes\", lane_width_m = 3.5 }}\n[[vehicle]]\nname = \"ego\"\n\
             start = {{ lane = 0, along_m = 80.0, speed_mps = 0.0 }}\ndriver = {{ kind = \"scripted\" }}\n[[vehicle]]\n\
             name = \"rear\"\nstart = {{ x_m = 0.0, y_m = 1.75, speed_mps = 10.0 }}\ndriver = {{ kind = \"recorded\"{more}, \
             points = [[0.0, 0.0, 1.75, 0.0, 10.0], [12.0, 120.0, 1.75, 0.0, 10.0]] }}\n"
        );
        film("in-its-way", from_text("way.toml", &text, &[]).unwrap_or_else(|error| panic!("{error:?}")))
    };
    assert_eq!(run("").report.collisions.len(), 1, "a recorded vehicle does not react");
    let handed = run(", hands_over = { to = \"human\", when = \"disturbed\" }");
    assert!(handed.report.collisions.is_empty(), "{:?}", handed.report.collisions);
    let told = handed.frames.iter().flat_map(|frame| &frame.events).find(|event| event.text.contains("drives itself"));
    assert!(told.is_some_and(|event| event.vehicle == "rear" && event.text.contains("ego is in its way")));
    // With a time for `when` it does so then, whatever the traffic.
    let at = run(", hands_over = { to = \"idm\", when = 3.0 }");
    let left = at.frames.iter().find(|frame| frame.events.iter().any(|event| event.text.contains("drives itself")));
    assert!(left.is_some_and(|frame| (2.99..3.5).contains(&frame.time_s)) && at.report.collisions.is_empty());
}
