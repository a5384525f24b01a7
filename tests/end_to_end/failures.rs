//! A planner that fails: the previous plan goes on, then the brakes are applied; each time it is told and counted.
//!
//! No scenario file makes a planner fail on purpose, so the goal of a vehicle is spoilt in the running world.

use interplay_planners::Limits;
use interplay_planners::predict::steady;
use interplay_simulation::components::{Identity, VehicleGoal};
use interplay_simulation::frame::{Frame, Level, Origin};
use interplay_simulation::measure::Measures;
use interplay_simulation::run::run;
use interplay_simulation::{phases, spawn};

use crate::film::{Camera, authored, film};

const HORIZON: usize = 5;
/// Ticks at which the goal of the front car is not a number.
const SPOILT: std::ops::Range<usize> = 10..20;

/// A run in which the planner of the front car fails for a while; with the failures that were counted.
fn run_with_failures() -> (Vec<Frame>, usize) {
    let scenario = authored("lane-change/front-nice", &["horizon_steps=5", "vehicle.ego.driver.settled_steps=2"]);
    let camera = Camera::default();
    let mut world = spawn::world(&scenario, vec![Box::new(camera.clone())]).expect("no building");
    let mut schedule = phases::schedule();
    for tick in 0..SPOILT.end + 2 {
        let mut objectives = world.query::<(&Identity, &mut VehicleGoal)>();
        for (identity, mut objective) in objectives.iter_mut(&mut world) {
            if identity.name == "front" {
                objective.goal.target.speed_mps = if SPOILT.contains(&tick) { f64::NAN } else { 1.4 };
            }
        }
        schedule.run(&mut world);
    }
    (camera.frames(), world.resource::<Measures>().vehicles[1].planning.failed)
}

#[test]
fn a_failed_plan_is_continued_then_braked_told_and_counted() {
    let (frames, failed) = run_with_failures();
    assert_eq!(failed, SPOILT.len());
    assert!(SPOILT.len() > HORIZON, "long enough for both fallbacks");
    let last_plan = &frames[SPOILT.start - 1].vehicles[1].plan.trajectory;
    for (tick, frame) in frames.iter().enumerate() {
        let front = &frame.vehicles[1];
        assert_eq!(front.name, "front");
        let warnings: Vec<_> = frame.events.iter().filter(|event| event.level == Level::Warning).collect();
        let others = [0, 2].map(|index| frame.vehicles[index].origin);
        assert_eq!(others, [Origin::Planned; 2], "one failure is not everybody's");
        if !SPOILT.contains(&tick) {
            assert_eq!((front.origin, warnings.len()), (Origin::Planned, 0), "tick {tick}");
            continue;
        }
        let [warning] = warnings.as_slice() else { panic!("tick {tick}: {warnings:?}") };
        assert_eq!(warning.vehicle, "front");
        assert!(warning.text.starts_with("no plan (bad input"), "{}", warning.text);
        let since = tick - SPOILT.start + 1;
        if since < HORIZON {
            assert_eq!(front.origin, Origin::Continued, "tick {tick}");
            assert_eq!(front.input, last_plan.inputs[since], "tick {tick}");
            assert!(warning.text.ends_with("continues its previous plan"), "{}", warning.text);
        } else {
            let full = steady(&front.state, -1.0, &Limits::default(), HORIZON, 0.1);
            assert_eq!((front.origin, front.input), (Origin::Braking, full[0]), "tick {tick}");
            assert_eq!(front.plan.trajectory.inputs, full, "tick {tick}");
            assert!(warning.text.ends_with("brakes"), "{}", warning.text);
        }
        assert!(front.prediction == front.plan.trajectory, "tick {tick}: the others know that it falls back");
    }
}

/// Who never had a plan brakes at once, to a standstill and no further; the report counts every failure.
#[test]
fn a_planner_that_never_succeeds_brakes_to_a_standstill() {
    let mut scenario = authored("lane-change/front-nice", &["duration_s=3"]);
    scenario.vehicles[0].goal.speed_mps = Some(f64::NAN);
    let film = film("never", scenario);
    let ego = film.report.vehicle("ego").expect("there is an ego");
    assert_eq!((ego.plans.failed, ego.plans.count), (30, 30));
    assert!(film.frames.iter().all(|frame| frame.vehicles[0].origin == Origin::Braking));
    assert!(ego.last.speed_mps.abs() < 1e-12, "{:?}", ego.last);
    assert!((ego.last.x_m - 0.5 * (1.0 + 0.1)).abs() < 1e-9, "ten steps from 1 m/s at −1 m/s²: {:?}", ego.last);
    let counted = film.report.expectations.iter().find(|one| one.what == "plan_failures_at_most");
    assert!(counted.is_some_and(|one| !one.passed && one.got == 30), "{counted:?}");
}

/// The digest of a run, how many of the ego's plans failed and how many took longer than they may.
fn with_deadline(overrides: &[&str]) -> (String, usize, Option<usize>) {
    let report = run("late", &authored("intersection/tough", overrides), Vec::new()).expect("a run");
    let ego = report.vehicle("ego").expect("an ego").plans;
    assert_eq!(report.vehicle("crossing").expect("a driver").plans.over_budget, None, "people have no deadline");
    (report.digest.clone(), ego.failed, ego.over_budget)
}

#[test]
fn a_late_plan_fails_by_its_work_where_the_deadline_is_enforced() {
    let without = with_deadline(&[]);
    assert_eq!((without.1, without.2), (0, None));
    let reported = with_deadline(&["real_time.plan_budget_ms=0.1"]);
    assert_eq!((&reported.0, reported.1), (&without.0, 0), "what is reported changes nothing");
    assert!(reported.2.is_some_and(|count| count > 0), "no plan is that fast: {reported:?}");
    let enforced =
        |budget| with_deadline(&[&format!("real_time.plan_budget_ms={budget}"), "real_time.deadline=\"enforced\""]);
    assert_eq!(enforced(1e4).0, without.0);
    let late = enforced(1.0);
    assert!(late.1 > 0 && late.0 != without.0, "{late:?}");
    assert_eq!(late.0, enforced(1.0).0);
}
