//! Vehicles of any size: classes, `[defaults]`, scaled settings, and remarks on what does not fit together.

use interplay_planners::Driver;
use interplay_scenarios::{Override, Scenario, VehicleClass, from_text};

fn set(assignment: &str) -> Override {
    Override::Set(assignment.to_owned())
}

fn loaded(text: &str, overrides: &[Override]) -> Scenario {
    from_text("size.toml", text, overrides).unwrap_or_else(|error| panic!("{error:?}"))
}

const HEAD: &str = "title = 'a'\nshows = 'b'\n";
const CAR: &str = "[[vehicle]]\nname = 'car'\nstart.lane = 0\nstart.along_m = 0\n";

/// The car, with more said of it; at 3 m/s unless that says otherwise.
fn car(more: &str) -> String {
    let speed = if more.contains("start.speed_mps") { "" } else { "start.speed_mps = 3\n" };
    format!("{CAR}{speed}{more}")
}

/// What a scenario says of everything is written between the head and one car.
fn with_car(between: &str, more: &str) -> Scenario {
    loaded(&format!("{HEAD}{between}\n{}", car(more)), &[])
}

fn remarks(scenario: &Scenario) -> Vec<String> {
    scenario.remarks.iter().map(ToString::to_string).collect()
}

#[test]
fn a_scale_scales_what_is_not_stated() {
    let scenario = with_car("scale = 16", "weights = { y = 0.5 }\nlimits = { speed_max_mps = 7 }");
    assert_eq!((scenario.step_s, scenario.duration_s, scenario.road.lane_width_m()), (0.4, 48.0, 16.0 * 0.37));
    let car = &scenario.vehicles[0];
    assert_eq!((car.body.front_m, car.body.scale, car.safety.along_m), (16.0 * 0.21, 16.0, 12.0));
    assert_eq!((car.limits.speed_max_mps, car.limits.acceleration_min_mps2), (7.0, -1.0));
    assert_eq!((car.weights.y, car.weights.heading, car.weights.speed), (0.5, 0.5, 1.0 / 16.0));
}

#[test]
fn tenth_scale_is_what_is_so_without_a_scale() {
    let (stated, unstated) = (with_car("scale = 'tenth'", "start.speed_mps = 1"), with_car("", "start.speed_mps = 1"));
    assert_eq!(stated.vehicles, unstated.vehicles);
    assert_eq!((stated.step_s, stated.duration_s, stated.road), (unstated.step_s, unstated.duration_s, unstated.road));
}

#[test]
fn a_full_size_scenario_needs_no_numbers_of_its_vehicles() {
    let (by_scale, by_class) = (with_car("scale = 'full'", ""), with_car("[defaults]\nclass = 'car'", ""));
    let (one, other) = (&by_scale.vehicles[0], &by_class.vehicles[0]);
    assert_eq!((one.body, one.limits, one.safety), (other.body, other.limits, other.safety));
    assert_eq!((one.weights, &one.driver), (other.weights, &other.driver));
    assert_eq!((one.body.width_m, one.body.scale, other.class), (1.8, 10.0, Some(VehicleClass::Car)));
    assert_eq!((by_scale.step_s, by_scale.step_s), (by_class.step_s, 0.1 * 10.0_f64.sqrt()));
    assert_eq!(remarks(&by_scale), Vec::<String>::new());
}

#[test]
fn a_vehicle_of_another_class_keeps_its_own() {
    let scenario = with_car("[defaults]\nclass = 'car'\n[defaults.body]\nwidth_m = 1.7", "class = 'truck'");
    let body = scenario.vehicles[0].body;
    assert_eq!((body.front_m, body.width_m), (6.5, 1.7), "what `[defaults]` states holds for every class");
}

#[test]
fn defaults_of_a_driver_are_for_drivers_of_its_kind() {
    let defaults = "[defaults.driver]\nkind = 'human'\nstyle = 'tough'\nreaction_s = 0.3";
    let human = |more: &str| match &with_car(defaults, &format!("start.speed_mps = 1\n{more}")).vehicles[0].driver {
        Driver::Human(settings) => *settings,
        other => panic!("{other:?}"),
    };
    assert_eq!((human("").weight(), human("").reaction_s), (0.0, 0.3));
    let nice = human("driver = { safety_weight = 8 }");
    assert_eq!((nice.style, nice.weight(), nice.reaction_s), (None, 8.0, 0.3), "`safety_weight` replaces `style`");
    let negotiation = with_car(defaults, "start.speed_mps = 1\ndriver = { kind = 'negotiation' }");
    assert_eq!(negotiation.vehicles[0].driver, Driver::Negotiation(Default::default()));
    let other =
        loaded(&format!("{HEAD}{defaults}\n{}", car("start.speed_mps = 1\n")), &[Override::Planner("game".to_owned())]);
    assert_eq!(other.vehicles[0].driver.kind(), "game");
}

#[test]
fn flags_reach_defaults() {
    let text = format!("{HEAD}[defaults]\nclass = 'car'\n{}", car(""));
    let changed = loaded(&text, &[set("defaults.class=van"), set("defaults.limits.speed_max_mps=20")]);
    assert_eq!((changed.vehicles[0].class, changed.vehicles[0].limits.speed_max_mps), (Some(VehicleClass::Van), 20.0));
}

#[test]
fn a_fault_in_defaults_is_said_once() {
    let text = format!("{HEAD}[defaults]\nklass = 'car'\n{}{}", car(""), car("").replace("'car'", "'two'"));
    let error = from_text("size.toml", &text, &[]).expect_err("no such key");
    let said: Vec<&str> = error.faults().iter().map(|fault| fault.message()).collect();
    assert_eq!(said, ["unknown key `klass` in `defaults`"]);
}

#[test]
fn idm_drivers_know_the_lanes_of_their_road() {
    let scenario = with_car("scale = 'full'\n[road]\nkind = 'lanes'\nlane_width_m = 3.5", "driver = { kind = 'idm' }");
    let Driver::Idm(settings) = &scenario.vehicles[0].driver else { panic!("another driver") };
    assert_eq!((settings.mobil.lane_width_m, settings.gap_m), (Some(3.5), 2.0));
    assert!((settings.headway_s - 0.8 * 10.0_f64.sqrt()).abs() < 1e-12);
}

#[test]
fn each_remark_names_its_place_and_what_would_work() {
    for (between, more, expected) in [
        (
            "[road]\nkind = 'lanes'\nlane_width_m = 3.5",
            "start.speed_mps = 1",
            "vehicle `car` is 0.19 m wide, on lanes of 3.5 m, 18 times its width (size.toml:6); \
             for real cars state `scale = \"full\"`, or the `class` of the vehicle",
        ),
        (
            "scale = 'full'",
            "safety = { along_m = 4.0 }\n[[vehicle]]\nname = 'two'\nstart = { lane = 1, along_m = 40, speed_mps = 3 }",
            "outside its safety ellipse (`along_m` = 4, `across_m` = 3.3) vehicle `car` may still touch `two` \
             (size.toml:9); with this `across_m`, `along_m` must be at least 5.37",
        ),
        (
            "scale = 'full'\nroad = { kind = 'lanes', lane_width_m = 1.9 }",
            "",
            "vehicle `car` is 1.8 m wide and nearly fills its lane of 1.9 m (size.toml:5); up to 1.71 m leaves it room to \
             steer; `road.lane_width_m` widens the lane",
        ),
        (
            "scale = 'full'",
            "start.lateral_offset_m = 1.2",
            "vehicle `car` starts on the edge of lane 0 (size.toml:6); it is 1.2 m off the lane's centre, and up to 0.95 m \
             keeps its body in the lane; `lane` and `along_m` place it there",
        ),
        (
            "scale = 'full'",
            "start.heading_error_deg = 25",
            "vehicle `car` starts at 25° to its road (size.toml:6); the road runs at `heading_deg = 0` there",
        ),
        (
            "scale = 'full'\nhorizon_steps = 10",
            "goal.speed_mps = 32",
            "plans reach 3.16 s ahead, but vehicle `car` needs 5 s to stop from 32 m/s (size.toml:10); \
             `horizon_steps = 16` works, or a `step_s` of 0.5",
        ),
        (
            "scale = 'full'",
            "limits.steering_max_rad = 0.5",
            "`steering_max_rad` is in radians, which the next version will refuse (size.toml:9); write \
             `steering_max_deg = 28.64789`",
        ),
    ] {
        let said = remarks(&with_car(between, more));
        assert!(said.iter().any(|said| said == expected), "{expected}\nis not among\n{}", said.join("\n"));
    }
}

#[test]
fn a_vehicle_that_is_wider_than_its_lane_is_an_error() {
    let text = format!("{HEAD}road = {{ kind = 'lanes', lane_width_m = 0.5 }}\n[defaults]\nclass = 'car'\n{}", car(""));
    let error = from_text("size.toml", &text, &[]).expect_err("it does not fit");
    let said: Vec<&str> = error.faults().iter().map(|fault| fault.message()).collect();
    assert!(said.contains(&"vehicle `car` is 1.8 m wide, but a lane only 0.5 m"), "{said:?}");
}

#[test]
fn angles_are_degrees() {
    let scenario = with_car("", "start.speed_mps = 1\nlimits.steering_max_deg = 30");
    assert_eq!(scenario.vehicles[0].limits.steering_max_rad, 30.0_f64.to_radians());
    assert_eq!(remarks(&scenario), Vec::<String>::new());
    let both = format!("{HEAD}{}", car("limits = { steering_max_deg = 30, steering_max_rad = 0.5 }"));
    let error = from_text("size.toml", &both, &[]).expect_err("one or the other");
    assert!(error.faults()[0].message().contains("states both"), "{:?}", error.faults());
}
