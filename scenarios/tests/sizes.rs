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

/// The car with further keys; at 3 m/s unless they state another speed.
fn car(more: &str) -> String {
    let speed = if more.contains("start.speed_mps") { "" } else { "start.speed_mps = 3\n" };
    format!("{CAR}{speed}{more}")
}

/// A scenario of the head, further keys, and one car.
fn with_car(between: &str, more: &str) -> Scenario {
    loaded(&format!("{HEAD}{between}\n{}", car(more)), &[])
}

fn remarks(scenario: &Scenario) -> Vec<String> {
    scenario.remarks.iter().map(ToString::to_string).collect()
}

#[test]
fn a_scale_changes_only_values_that_are_not_stated() {
    let scenario = with_car("scale = 16", "weights = { y = 0.5 }\nlimits = { speed_max_mps = 7 }");
    assert_eq!((scenario.step_s, scenario.duration_s, scenario.road.lane_width_m()), (0.4, 48.0, 16.0 * 0.37));
    let car = &scenario.vehicles[0];
    assert_eq!((car.body.front_m, car.body.scale, car.safety.along_m), (16.0 * 0.21, 16.0, 12.0));
    assert_eq!((car.limits.speed_max_mps, car.limits.acceleration_min_mps2), (7.0, -1.0));
    assert_eq!((car.weights.y, car.weights.heading, car.weights.speed), (0.5, 0.5, 1.0 / 16.0));
}

#[test]
fn the_default_scale_is_one_tenth() {
    let (stated, unstated) = (with_car("scale = 'tenth'", "start.speed_mps = 1"), with_car("", "start.speed_mps = 1"));
    assert_eq!(stated.vehicles, unstated.vehicles);
    assert_eq!((stated.step_s, stated.duration_s, stated.road), (unstated.step_s, unstated.duration_s, unstated.road));
}

#[test]
fn a_full_size_scenario_need_not_state_vehicle_sizes() {
    let (by_scale, by_class) = (with_car("scale = 'full'", ""), with_car("[defaults]\nclass = 'car'", ""));
    let (one, other) = (&by_scale.vehicles[0], &by_class.vehicles[0]);
    assert_eq!((one.body, one.limits, one.safety), (other.body, other.limits, other.safety));
    assert_eq!((one.weights, &one.driver), (other.weights, &other.driver));
    assert_eq!((one.body.width_m, one.body.scale, other.class), (1.8, 10.0, Some(VehicleClass::Car)));
    let times = |scenario: &Scenario| (scenario.step_s, scenario.planning_period_s(), scenario.horizon_steps);
    assert_eq!((times(&by_scale), times(&by_scale)), (times(&by_class), (0.1, 0.2, 40)));
    assert_eq!(remarks(&by_scale), Vec::<String>::new());
}

#[test]
fn a_vehicle_of_another_class_keeps_the_values_of_its_class() {
    let scenario = with_car("[defaults]\nclass = 'car'\n[defaults.body]\nwidth_m = 1.7", "class = 'truck'");
    let body = scenario.vehicles[0].body;
    assert_eq!((body.front_m, body.width_m), (6.5, 1.7), "what `[defaults]` states holds for every class");
}

#[test]
fn driver_defaults_apply_only_to_drivers_of_that_kind() {
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
fn flags_may_change_defaults() {
    let text = format!("{HEAD}[defaults]\nclass = 'car'\n{}", car(""));
    let changed = loaded(&text, &[set("defaults.class=van"), set("defaults.limits.speed_max_mps=20")]);
    assert_eq!((changed.vehicles[0].class, changed.vehicles[0].limits.speed_max_mps), (Some(VehicleClass::Van), 20.0));
}

#[test]
fn a_fault_in_defaults_is_reported_once() {
    let text = format!("{HEAD}[defaults]\nklass = 'car'\n{}{}", car(""), car("").replace("'car'", "'two'"));
    let error = from_text("size.toml", &text, &[]).expect_err("no such key");
    let said: Vec<&str> = error.faults().iter().map(|fault| fault.message()).collect();
    assert_eq!(said, ["unknown key `klass` in `defaults`"]);
}

#[test]
fn idm_drivers_get_the_lanes_of_their_road() {
    let scenario = with_car("scale = 'full'\n[road]\nkind = 'lanes'\nlane_width_m = 3.5", "driver = { kind = 'idm' }");
    let Driver::Idm(settings) = &scenario.vehicles[0].driver else { panic!("another driver") };
    assert_eq!((settings.mobil.lane_width_m, settings.gap_m), (Some(3.5), 2.0));
    assert_eq!((settings.headway_s, settings.acceleration_mps2), (1.5, 1.4), "the values of the literature");
    let source = with_car(
        "scale = 'full'\nconduct = 'source'\n[road]\nkind = 'lanes'\nlane_width_m = 3.5",
        "driver = { kind = 'idm' }",
    );
    let Driver::Idm(settings) = &source.vehicles[0].driver else { panic!("another driver") };
    assert!((settings.headway_s - 0.8 * 10.0_f64.sqrt()).abs() < 1e-12);
}

#[test]
fn each_remark_names_its_place_and_a_remedy() {
    for (between, more, expected) in [
        (
            "[road]\nkind = 'lanes'\nlane_width_m = 3.5",
            "start.speed_mps = 1\nbody.front_m = 0.21",
            "vehicle `car` is 0.19 m wide, on lanes of 3.5 m, 18 times its width (size.toml:11); \
             for real cars state `scale = \"full\"`, or the `class` of the vehicle",
        ),
        (
            "[road]\nkind = 'lanes'\nlane_width_m = 3.5",
            "start.speed_mps = 1\nclass = 'scale-car'",
            "vehicle `car` is 0.19 m wide, on lanes of 3.5 m, 18 times its width (size.toml:6); \
             for a real car state `class = \"car\"`",
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
            "plans reach 2 s ahead, but vehicle `car` needs 5 s to stop from 32 m/s (size.toml:10); \
             `horizon_steps = 25` works, or a `planning_period_s` of 0.5",
        ),
        (
            "scale = 'full'\nhorizon_steps = 10",
            "start.speed_mps = 32\ngoal.speed_mps = 10",
            "plans reach 2 s ahead, but vehicle `car` needs 5 s to stop from 32 m/s (size.toml:10); \
             `horizon_steps = 25` works, or a `planning_period_s` of 0.5",
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

/// A car on a road, in the lane of this name.
fn on_road(road: &str, start: &str, more: &str) -> String {
    format!(
        "{HEAD}[road]\n{road}\n[[vehicle]]\nname = 'car'\nstart = {{ lane = {start}, along_m = 10, speed_mps = 3 }}\n{more}"
    )
}

/// If neither a scale nor a class nor a body is stated, the width of the lanes determines the size.
#[test]
fn the_lane_width_determines_the_default_scale() {
    let size = |road: &str, start: &str, more: &str| {
        let scenario = loaded(&on_road(road, start, more), &[]);
        assert_eq!(remarks(&scenario), Vec::<String>::new(), "{road}");
        (scenario.vehicles[0].body.width_m, scenario.planning_period_s())
    };
    let (full, tenth) = ((1.8, 0.2), (0.19, 0.1));
    assert_eq!(size("kind = 'lanes'\nlane_width_m = 3.5", "0", "goal.speed_mps = 25"), full);
    assert_eq!(size("kind = 'lanes'\nlane_width_m = 2", "0", "class = 'bicycle'").1, full.1);
    let curve = "kind = 'curve'\nlane_width_m = 3.5\npieces = [{ straight_m = 60 }, { turn_deg = 45, radius_m = 60 }]";
    assert_eq!(size(curve, "0", ""), full);
    assert_eq!(size("kind = 't-junction'", "'west-in'", "goal.lane = 'east-out'"), full);
    let network = |width_m: &str| {
        format!("kind = 'network'\n[[road.lane]]\nname = 'a'\npoints = [[0, 0], [90, 0]]\nwidth_m = {width_m}")
    };
    assert_eq!(size(&network("3.5"), "'a'", ""), full);
    let slow = |text: String| text.replace("speed_mps = 3", "speed_mps = 1");
    let scenario = loaded(&slow(on_road(&network("0.37"), "'a'", "")), &[]);
    assert_eq!((scenario.vehicles[0].body.width_m, scenario.planning_period_s()), tenth);
    let small = "kind = 't-junction'\nlane_width_m = 0.37";
    let text = slow(on_road(small, "'west-in'", "goal.lane = 'east-out'")).replace("along_m = 10", "along_m = 1");
    let scenario = loaded(&text, &[]);
    assert_eq!((scenario.vehicles[0].body.width_m, scenario.planning_period_s()), tenth);
}

/// Stated keys go before the width of the lanes.
#[test]
fn a_scale_class_or_body_takes_precedence_over_the_lane_width() {
    let wide = "[road]\nkind = 'lanes'\nlane_width_m = 3.5";
    for (between, more) in [
        (format!("scale = 'tenth'\n{wide}"), ""),
        (wide.to_owned(), "class = 'scale-car'"),
        (wide.to_owned(), "body.front_m = 0.21"),
        (format!("[defaults.body]\nfront_m = 0.21\n{wide}"), ""),
    ] {
        let scenario = with_car(&between, &format!("start.speed_mps = 1\n{more}"));
        assert_eq!((scenario.vehicles[0].body.width_m, scenario.planning_period_s()), (0.19, 0.1), "{between} {more}");
    }
}

#[test]
fn a_speed_out_of_limits_names_scale_and_class() {
    let text = format!("{HEAD}{}", car("goal.speed_mps = 25"));
    let error = from_text("size.toml", &text, &[]).expect_err("too fast");
    let help = error.faults()[0].hint().expect("a remedy");
    assert!(help.contains("from 0 to 1.5") && help.contains("`class`") && help.contains("`scale`"), "{help}");
}

/// Only the narrowest lane of the route counts, from the start on.
#[test]
fn a_lane_narrower_than_the_car_is_found_along_its_route() {
    let first = |text: &str| {
        let error = from_text("size.toml", text, &[]).expect_err(text);
        let fault = &error.faults()[0];
        (fault.message().to_owned(), fault.hint().unwrap_or_default().to_owned())
    };
    let network = |more: &str| {
        let waist = "width_m = [[0, 3.5], [50, 1.5], [100, 3.5]]";
        format!("kind = 'network'\n[[road.lane]]\nname = 'a'\npoints = [[0, 0], [100, 0]]\n{waist}\n{more}")
    };
    let (message, help) = first(&on_road(&network(""), "'a'", ""));
    assert_eq!(message, "vehicle `car` is 1.8 m wide, but lane `a` on its route only 1.5 m, 50 m along it");
    assert!(help.contains("`road.lane.0.width_m`"), "{help}");
    let behind = on_road(&network(""), "'a'", "").replace("along_m = 10", "along_m = 70");
    assert_eq!(remarks(&loaded(&behind, &[])), Vec::<String>::new(), "the narrow place is behind it");
    let (message, help) = first(&on_road("kind = 'narrow-passage'\npassage_width_m = 1.5", "'east-in'", ""));
    assert_eq!(message, "vehicle `car` is 1.8 m wide, but lane `east-in` on its route only 1.5 m, 100 m along it");
    assert!(help.contains("`road.passage_width_m`"), "{help}");
    let beside = "kind = 'network'\n[[road.lane]]\nname = 'cycles'\npoints = [[0, 0], [90, 0]]\nwidth_m = 1.5\n\
        [[road.lane]]\nname = 'a'\npoints = [[0, 9], [90, 9]]\nwidth_m = 3.5";
    assert_eq!(remarks(&loaded(&on_road(beside, "'a'", ""), &[])), Vec::<String>::new());
    let full = "kind = 'network'\n[[road.lane]]\nname = 'a'\npoints = [[0, 0], [90, 0]]\nwidth_m = 1.9";
    let said = remarks(&loaded(&on_road(full, "'a'", ""), &[]));
    assert!(
        said[0].contains("nearly fills its lane of 1.9 m") && said[0].contains("`road.lane.0.width_m`"),
        "{said:?}"
    );
}

/// A lorry swings out at junctions; on the ring of one lane it does not stay on the road. A car stays in its lanes.
#[test]
fn a_turn_too_tight_for_a_body_causes_a_remark() {
    for (road, from, to) in [
        ("t-junction", "west-in", "south-out"),
        ("crossing", "west-in", "south-out"),
        ("roundabout", "west-in", "east-out"),
    ] {
        let said = |class: &str| {
            let more = format!("class = '{class}'\ngoal.lane = '{to}'");
            remarks(&loaded(&on_road(&format!("kind = '{road}'"), &format!("'{from}'"), &more), &[]))
        };
        assert_eq!(said("car"), Vec::<String>::new(), "{road}");
        let lorry = said("truck");
        let is_remarked = lorry
            .iter()
            .any(|said| said.contains("is too tight for the 12 m of vehicle `car`") && said.contains("size.toml:8"));
        assert_eq!(is_remarked, road == "roundabout", "{lorry:?}");
    }
}

#[test]
fn angles_in_files_are_degrees() {
    let scenario = with_car("", "start.speed_mps = 1\nlimits.steering_max_deg = 30");
    assert_eq!(scenario.vehicles[0].limits.steering_max_rad, 30.0_f64.to_radians());
    assert_eq!(remarks(&scenario), Vec::<String>::new());
    let both = format!("{HEAD}{}", car("limits = { steering_max_deg = 30, steering_max_rad = 0.5 }"));
    let error = from_text("size.toml", &both, &[]).expect_err("one or the other");
    assert!(error.faults()[0].message().contains("states both"), "{:?}", error.faults());
}

#[test]
fn drivers_without_lookahead_get_no_remark_on_short_plans() {
    let said = |driver: &str| {
        let scenario = with_car("scale = 'full'\nhorizon_steps = 10", &format!("start.speed_mps = 32\n{driver}"));
        remarks(&scenario).iter().any(|remark| remark.contains("to stop from"))
    };
    assert!(said("") && said("driver = { kind = 'negotiation' }"));
    for kind in ["scripted", "idm"] {
        assert!(!said(&format!("driver = {{ kind = '{kind}' }}")), "{kind}");
    }
}

#[test]
fn numbers_of_remarks_are_rounded() {
    let road = "scale = 'full'\nroad = { kind = 'lanes', lane_width_m = 7.934806511272042 }";
    let said = remarks(&with_car(road, "class = 'scale-car'\nstart.speed_mps = 0.123456789012")).join("\n");
    assert!(said.contains("on lanes of 7.935 m") && !said.contains("934806"), "{said}");
}
