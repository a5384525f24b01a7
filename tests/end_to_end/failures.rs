//! A planner that fails: the previous plan continues, then the vehicle brakes; each failure is reported and counted.
//!
//! No scenario file makes a planner fail on purpose, so a driver takes over that does for a while.

use interplay_planners::drivers::human;
use interplay_planners::prediction::steady;
use interplay_planners::scene::inferred_futures::InferredFutures;
use interplay_planners::{Drive, DriverKind, Limits, Plan, PlanError, Scene};
use interplay_simulation::Simulation;
use interplay_simulation::frame::{Frame, Level, Origin};
use interplay_simulation::run::run;

use crate::film::{Camera, authored, film};

const HORIZON: usize = 5;
/// Ticks at which the front driver does not know what it wants.
const SPOILT: std::ops::Range<usize> = 10..20;

/// A driver whose goal is not a number for a while.
#[derive(Debug)]
struct Undecided(Box<dyn Drive>);

impl Drive for Undecided {
    fn plan(&mut self, scene: &Scene, outlook: &InferredFutures) -> Result<Plan, PlanError> {
        let mut scene = scene.clone();
        if SPOILT.contains(&scene.tick) {
            scene.goal.target.speed_mps = f64::NAN;
        }
        self.0.plan(&scene, outlook)
    }
}

/// A run in which the planner of the front car fails for a while; with the failures that were counted.
fn run_with_failures() -> (Vec<Frame>, usize) {
    let changes = ["horizon_steps=5", "vehicle.ego.driver.settled_steps=2", "vehicle.front.goal.speed_mps=1.4"];
    let scenario = authored("lane-change/front-nice", &changes);
    let camera = Camera::default();
    let mut simulation =
        Simulation::watched("failures", &scenario, vec![Box::new(camera.clone())]).expect("no building");
    simulation.drive_with("front", Undecided(human::Settings::default().driver())).expect("there is a front car");
    for _ in 0..SPOILT.end + 2 {
        simulation.step().expect("the run goes on");
    }
    let copy = simulation.snapshot().map(|_| ()).expect_err("the driver does not fork");
    assert_eq!(copy.to_string(), "the driver of `front` cannot be copied: it does not implement `fork`");
    let report = simulation.finish().expect("the camera keeps everything");
    (camera.frames(), report.vehicle("front").expect("there is a front car").plans.failed)
}

#[test]
fn after_failed_plans_the_vehicle_continues_then_brakes_and_reports_failures() {
    let (frames, failed) = run_with_failures();
    assert_eq!(failed, SPOILT.len());
    assert!(SPOILT.len() > HORIZON, "long enough for both fallbacks");
    let last_plan = &frames[SPOILT.start - 1].vehicles[1].plan.trajectory;
    for (tick, frame) in frames.iter().enumerate() {
        let front = &frame.vehicles[1];
        assert_eq!(front.name, "front");
        let warnings: Vec<_> = frame.events.iter().filter(|event| event.level == Level::Warning).collect();
        let others = [0, 2].map(|index| frame.vehicles[index].origin);
        assert_eq!(others, [Origin::Planned; 2], "one planner's failure leaves the others planned");
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
        assert!(*front.prediction == front.plan.trajectory, "tick {tick}: the others know that it falls back");
    }
}

/// A vehicle that never had a plan brakes at once to a standstill; the report counts every failure.
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
fn with_an_enforced_deadline_a_plan_with_too_much_work_fails() {
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
