//! A world that is stepped from outside, copied and resumed is bit-identical with one that runs undisturbed.

use interplay_planners::Input;
use interplay_scenarios::{Registry, Scenario, embedded};
use interplay_simulation::report::Report;
use interplay_simulation::run::{RunError, run};
use interplay_simulation::time_points::TimePoints;
use interplay_simulation::{SavedRunError, Simulation, Snapshot};
use rayon::prelude::*;
use serde_json::Value;

use crate::film::{Camera, authored, film};

/// What a report says, wall times apart.
fn outcome(report: &Report) -> Value {
    let mut whole = serde_json::to_value(report).expect("a report is JSON");
    forget_wall_times(&mut whole);
    // A snapshot holds angles in radians, which is remarked upon when it is read.
    whole.as_object_mut().expect("a table").remove("remarks");
    whole
}

fn forget_wall_times(value: &mut Value) {
    match value {
        Value::Object(entries) => {
            entries
                .retain(|key, _| !["wall_s", "median_ms", "p99_ms", "over_budget", "design_s"].contains(&key.as_str()));
            entries.values_mut().for_each(forget_wall_times);
        }
        Value::Array(items) => items.iter_mut().for_each(forget_wall_times),
        _ => {}
    }
}

fn finished(mut simulation: Simulation) -> Report {
    while simulation.step().expect("the run can go on").is_some() {}
    simulation.finish().expect("a run without observers finishes")
}

/// Where a run is copied: pseudo-random steps of the whole run, other ones for other scenarios.
fn moments(name: &str, steps: usize, count: usize) -> Vec<usize> {
    let mut state = name
        .bytes()
        .fold(0x9E37_79B9_7F4A_7C15_u64, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01B3));
    let mut found: Vec<usize> = (0..count)
        .map(|_| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as usize % steps
        })
        .collect();
    found.sort_unstable();
    found
}

/// Runs a scenario with snapshots at some steps, and checks that the run resumed from each has the same outcome.
fn every_fork_ends_alike(name: &str, scenario: &Scenario, count: usize) -> usize {
    let steps = TimePoints::new(scenario).count();
    let moments = moments(name, steps, count);
    let mut simulation =
        Simulation::watched(name, scenario, Vec::new()).unwrap_or_else(|error| panic!("{name}: {error}"));
    let mut forks: Vec<(usize, Snapshot)> = Vec::new();
    for step in 0..steps {
        for _ in moments.iter().filter(|moment| **moment == step) {
            forks.push((step, simulation.snapshot().expect("everything of ours can be copied")));
        }
        assert!(simulation.step().expect("the run can go on").is_some(), "{name}: step {step} of {steps}");
    }
    assert!(simulation.step().expect("the run is over").is_none());
    let wanted = outcome(&simulation.finish().expect("a run without observers finishes"));
    for (step, fork) in &forks {
        let resumed = finished(fork.resume().expect("a copy can be copied"));
        assert_eq!(outcome(&resumed), wanted, "{name}, resumed after {step} steps");
    }
    // The last copy is resumed again, in a world that has gone elsewhere.
    if let Some((step, fork)) = forks.last() {
        let mut other = Simulation::new(scenario).expect("it began before");
        other.step().expect("the run can go on");
        other.restore(fork).expect("a copy can be copied twice");
        assert_eq!(outcome(&finished(other)), wanted, "{name}, restored to step {step}");
    }
    forks.len()
}

/// All authored scenarios: every family, curved roads and networks, buildings in the middle of a day, a building and vehicles.
#[test]
fn authored_scenarios_resume_from_any_time() {
    let count = |name: &str| if name.starts_with("building") { 1 } else { 3 };
    let forks: usize = embedded()
        .par_iter()
        .map(|file| {
            let mut scenario = authored(file.name, &[]);
            scenario.iterations = Some(scenario.days().clamp(1, 2));
            every_fork_ends_alike(file.name, &scenario, count(file.name))
        })
        .sum();
    assert!(forks >= 200, "{forks} moments");
}

/// Every planner, with all that it remembers; drivers who infer plans behind sensors with errors and delay; tyres; a contact.
#[test]
fn every_planner_sensor_and_plant_resumes_from_any_time() {
    const PLANNERS: [&str; 10] = [
        "human",
        "idm",
        "scripted",
        "conservative",
        "negotiation",
        "bayesian",
        "game",
        "cooperative",
        "nash",
        "contingency",
    ];
    let planner = |kind: &str| format!("vehicle.ego.driver={{ kind = \"{kind}\" }}");
    let late = "vehicle.ego.sensing={ delay_s = 0.3, speed_sd_mps = 0.05, drop_rate = 0.2 }";
    let human = "vehicle.front.driver={ kind = \"human\", reaction_s = 0.3, hesitation_s = 0.4 }";
    let expect = "expect={}";
    let mut runs: Vec<(String, Scenario)> = PLANNERS
        .iter()
        .map(|kind| {
            let changes = [&planner(kind), late, human, expect, "duration_s=6", "counterfactual=[]"];
            (format!("{kind}, late eyes"), authored("lane-change/front-nice", &changes))
        })
        .collect();
    for kind in ["conservative", "negotiation", "bayesian", "game", "nash"] {
        let inferred = format!("vehicle.ego.driver={{ kind = \"{kind}\", prediction = \"inferred\" }}");
        let changes = [inferred.as_str(), late, expect, "duration_s=5", "counterfactual=[]"];
        runs.push((format!("{kind}, inferring"), authored("intersection/nice", &changes)));
    }
    for name in ["crash/side-impact", "lane-change/front-tough"] {
        let tyres = authored(name, &["plant={ kind = \"dynamic\" }", expect, "counterfactual=[]", "duration_s=6"]);
        runs.push((format!("{name} on tyres"), tyres));
    }
    let forks: usize = runs.par_iter().map(|(name, scenario)| every_fork_ends_alike(name, scenario, 4)).sum();
    assert_eq!(forks, 4 * runs.len());
}

/// Bodies that touch do not begin to touch again: the run is copied at every tick around the contact.
#[test]
fn a_contact_in_progress_continues_after_resuming() {
    for plant in ["kinematic", "dynamic"] {
        let plant = format!("plant={{ kind = \"{plant}\" }}");
        let scenario = authored("crash/side-impact", &[&plant, "expect={}", "counterfactual=[]"]);
        let whole = run("crash", &scenario, Vec::new()).expect("a run");
        let first_s = whole.collisions.first().expect("it is a crash").time_s;
        let mut simulation = Simulation::watched("crash", &scenario, Vec::new()).expect("a world");
        let mut compared = 0;
        loop {
            if (simulation.time_s() - first_s).abs() <= 5.0 * scenario.step_s {
                let resumed = simulation.snapshot().expect("a copy").resume().expect("a copy of it");
                assert_eq!(outcome(&finished(resumed)), outcome(&whole), "at {} s", simulation.time_s());
                compared += 1;
            }
            if simulation.step().expect("the run can go on").is_none() {
                break;
            }
        }
        assert!(compared >= 9, "{compared} copies around {first_s} s");
    }
}

/// To look changes nothing, and twice shows the same; with a sensor that draws errors and remembers tracks.
#[test]
fn observing_a_world_has_no_side_effect() {
    let sensing = "vehicle.ego.sensing={ delay_s = 0.2, position_sd_m = 0.02, drop_rate = 0.3 }";
    let changes = [sensing, "vehicle.ego.driver={ kind = \"conservative\", prediction = \"inferred\" }", "expect={}"];
    let scenario = authored("lane-change/front-nice", &[&changes[..], &["counterfactual=[]", "duration_s=5"]].concat());
    let alone = run("observed", &scenario, Vec::new()).expect("a run");
    let mut simulation = Simulation::watched("observed", &scenario, Vec::new()).expect("a world");
    let mut shifted = 0;
    loop {
        let seen = simulation.observe("ego").expect("there is an ego");
        assert_eq!(seen, simulation.observe("ego").expect("there is an ego"));
        let front = simulation.observe("front").expect("there is a front car").scene;
        assert_eq!(front.others.len(), 2);
        shifted += usize::from(front.others[0].prediction.states[0] == front.others[0].state);
        if simulation.step().expect("the run can go on").is_none() {
            break;
        }
    }
    assert_eq!(shifted, scenario.tick_count() + 1, "predictions begin where the others are");
    assert_eq!(outcome(&simulation.finish().expect("a run without observers finishes")), outcome(&alone));
    let simulation = Simulation::new(&scenario).expect("a world");
    assert!(matches!(simulation.observe("stranger"), Err(RunError::NoVehicle { .. })));
}

/// A run from outside with the inputs that a planner gave is the planner's own run, as far as the plant is concerned.
#[test]
fn a_caller_can_drive_a_vehicle() {
    let own = film("own", authored("lane-change/front-nice", &["counterfactual=[]", "expect={}"]));
    let changes = ["vehicle.ego.driver={ kind = \"external\" }", "counterfactual=[]", "expect={}"];
    let scenario = authored("lane-change/front-nice", &changes);
    let mut simulation = Simulation::new(&scenario).expect("a world");
    assert!(matches!(simulation.step(), Err(RunError::NoInput { .. })), "it waits for its input");
    assert!(simulation.frame().is_none(), "and nothing has moved");
    assert!(matches!(simulation.apply("front", Input::default()), Err(RunError::NotExternal { .. })));
    let broken = Input { acceleration_mps2: f64::NAN, steering_rad: 0.0 };
    assert!(matches!(simulation.apply("ego", broken), Err(RunError::NotFinite { .. })));
    assert!(matches!(simulation.apply_plan("ego", &[]), Err(RunError::WrongPlan { .. })));
    for frame in &own.frames {
        simulation.apply_plan("ego", &frame.vehicles[0].plan.trajectory.inputs).expect("the ego is external");
        let now = simulation.step().expect("it has its input").expect("the scenario goes on");
        for (own, now) in frame.vehicles.iter().zip(&now.vehicles) {
            assert_eq!((own.state, own.input), (now.state, now.input), "{} at {} s", own.name, frame.time_s);
        }
    }
    assert!(simulation.step().expect("the scenario is over").is_none());
    assert_eq!(simulation.finish().expect("a run without observers finishes").order, own.report.order);
}

/// The prediction of a vehicle that hands in an input alone is constant velocity.
#[test]
fn after_a_single_input_others_expect_constant_velocity() {
    let changes = ["vehicle.ego.driver={ kind = \"external\" }", "counterfactual=[]", "expect={}"];
    let mut simulation = Simulation::new(&authored("lane-change/front-nice", &changes)).expect("a world");
    let braking = Input { acceleration_mps2: -0.5, steering_rad: 0.0 };
    for _ in 0..5 {
        simulation.apply("ego", braking).expect("the ego is external");
        simulation.step().expect("it has its input");
    }
    let ego = simulation.observe("rear").expect("a rear car").scene.others[0].clone();
    assert_eq!(ego.name, "ego");
    assert!((ego.state.speed_mps - 0.75).abs() < 1e-12, "{:?}", ego.state);
    assert!(ego.prediction.states.iter().all(|state| state.speed_mps == ego.state.speed_mps));
    let copy = simulation.snapshot().expect("a copy");
    simulation.apply("ego", braking).expect("the ego is external");
    assert!(matches!(copy.resume().expect("a copy").step(), Err(RunError::NoInput { .. })), "it was copied before");
}

/// A run may end early, and says so; watchers see what follows a return to an earlier moment, too.
#[test]
fn a_run_ends_early_and_rewinds() {
    let scenario = authored("lane-change/front-nice", &["counterfactual=[]"]);
    let camera = Camera::default();
    let mut simulation = Simulation::watched("early", &scenario, vec![Box::new(camera.clone())]).expect("a world");
    for _ in 0..10 {
        simulation.step().expect("the run can go on");
    }
    let copy = simulation.snapshot().expect("a copy");
    for _ in 0..10 {
        simulation.step().expect("the run can go on");
    }
    simulation.restore(&copy).expect("a copy");
    assert_eq!((simulation.time_s(), copy.time_s()), (1.0, 1.0));
    for _ in 0..5 {
        simulation.step().expect("the run can go on");
    }
    let ticks: Vec<usize> = camera.frames().iter().map(|frame| frame.tick).collect();
    assert_eq!(ticks, (0..20).chain(10..15).collect::<Vec<usize>>());
    let frames = camera.frames();
    assert_eq!(frames[10].vehicles[0].input, frames[20].vehicles[0].input);
    let report = simulation.finish().expect("the camera keeps everything");
    assert_eq!((report.ended_early_s, report.simulated_s), (Some(1.5), 1.5));
    assert!(!report.passed, "the ego has not reached its goal yet");
}

/// A building ends early in the middle of its first day.
#[test]
fn a_run_of_a_building_may_end_early() {
    let mut simulation = Simulation::new(&authored("building/four-room-pid", &[])).expect("a building");
    for _ in 0..30 {
        simulation.step().expect("the run can go on");
    }
    let report = simulation.finish().expect("a run without observers finishes");
    let days = report.building.map(|building| building.iterations.len());
    assert!(report.ended_early_s.is_some_and(|time_s| time_s > 0.0) && days == Some(0), "{days:?}");
}

/// Worlds can be moved to other threads.
#[test]
fn a_simulation_can_move_to_another_thread() {
    fn is_send<T: Send>() {}
    is_send::<Simulation>();
    is_send::<Snapshot>();
}

/// A snapshot as text is read back to the same state, inputs from outside included; a damaged snapshot or one of another version is refused.
#[test]
fn a_snapshot_is_written_as_text_and_read_back() {
    let changes = ["vehicle.ego.driver={ kind = \"external\" }", "counterfactual=[]", "expect={}", "duration_s=4"];
    let mut simulation = Simulation::new(&authored("lane-change/front-nice", &changes)).expect("a world");
    let horizon = simulation.scenario().horizon_steps;
    for tick in 0..25 {
        let input = Input { acceleration_mps2: 0.02 * f64::from(tick - 12), steering_rad: 0.002 * f64::from(tick) };
        if tick % 3 == 0 {
            simulation.apply_plan("ego", &vec![input; horizon]).expect("the ego is external");
        } else {
            simulation.apply("ego", Input::default()).expect("the last call counts");
            simulation.apply("ego", input).expect("the ego is external");
        }
        simulation.step().expect("it has its input");
    }
    let text = simulation.snapshot().expect("a copy").to_json().expect("it is all in the scenario");
    let read = |text: &str| Snapshot::from_json(text, &Registry::default());
    let ends = [simulation, read(&text).expect("the same program").resume().expect("a copy")].map(|mut simulation| {
        while simulation.time_s() < 4.0 {
            simulation.apply("ego", Input::default()).expect("the ego is external");
            simulation.step().expect("it has its input");
        }
        outcome(&simulation.finish().expect("a run without observers finishes"))
    });
    assert_eq!(ends[0], ends[1]);
    let other_run = text.replacen("0.002", "0.003", 1);
    assert!(matches!(read(&other_run), Err(SavedRunError::OtherRun { .. })));
    assert!(matches!(read(&text.replacen("\"format\": 1", "\"format\": 7", 1)), Err(SavedRunError::Format { .. })));
    assert!(matches!(read(&text[..text.len() / 2]), Err(SavedRunError::Text(_))));
    let mut taken = Simulation::new(&authored("lane-change/front-nice", &changes)).expect("a world");
    taken
        .drive_with("ego", interplay_planners::drivers::human::Human::new(Default::default()))
        .expect("there is an ego");
    taken.step().expect("it drives itself");
    let refused = taken.snapshot().expect("ours forks").to_json().expect_err("the scenario does not name it");
    assert!(refused.to_string().starts_with("the driver that has taken over `ego` cannot be copied"), "{refused}");
}
