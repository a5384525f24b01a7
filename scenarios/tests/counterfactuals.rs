//! Counterfactuals in a file: what they change, what they inherit, and their errors.

mod common;

use common::Catalogue;
use interplay_planners::Driver;
use interplay_planners::drivers::human::Style;
use interplay_scenarios::{Override, Registry, Scenario, embedded, from_text, load};

/// A variant with one counterfactual, whose table is `stated`.
fn variant(stated: &str) -> String {
    format!(
        "extends = 'intersection/tough'\ntitle = 'Mine'\n\n[[counterfactual]]\nname = 'what if'\n{stated}\n\
         [counterfactual.expect]\norder_differs = true\n"
    )
}

fn loaded(text: &str, overrides: &[Override]) -> Scenario {
    from_text("mine.toml", text, overrides).unwrap_or_else(|error| panic!("{:?}", error.faults()))
}

/// The scenario that the only counterfactual runs.
fn changed(stated: &str, overrides: &[Override]) -> Scenario {
    let scenario = loaded(&variant(stated), overrides);
    let changed = &scenario.counterfactuals.first().expect("one counterfactual").scenario;
    changed.clone()
}

fn set(assignment: &str) -> Override {
    Override::Set(assignment.to_owned())
}

fn style(scenario: &Scenario) -> Option<Style> {
    match &scenario.vehicle("crossing").expect("there").driver {
        Driver::Human(human) => human.style,
        other => panic!("{other:?} is not human"),
    }
}

/// A path in any spelling changes what `--set` would change.
#[test]
fn a_counterfactual_is_the_scenario_that_flags_would_make() {
    let flags = [set("vehicle.crossing.driver.style=\"nice\""), set("vehicle.crossing.goal.speed_mps=0.7")];
    let expected = load("intersection/tough", &flags).expect("authored");
    for spelling in [
        "set = { 'vehicle.crossing.driver.style' = 'nice', 'vehicle.crossing.goal.speed_mps' = 0.7 }",
        "set = { vehicle.crossing.driver.style = 'nice', vehicle.crossing.goal.speed_mps = 0.7 }",
        "set = { vehicle.crossing = { driver.style = 'nice', 'goal.speed_mps' = 0.7 } }",
        "[counterfactual.set]\nvehicle.crossing.driver.style = 'nice'\nvehicle.crossing.goal.speed_mps = 0.7",
        "[counterfactual.set.vehicle.crossing]\ndriver = { style = 'nice' }\ngoal = { speed_mps = 0.7 }",
    ] {
        let found = changed(spelling, &[]);
        assert_eq!(found.vehicles, expected.vehicles, "{spelling}");
        assert_eq!((found.road, found.seed), (expected.road.clone(), expected.seed), "{spelling}");
        assert_eq!(found.expect, Default::default(), "it has none of the scenario's expectations: {spelling}");
    }
}

#[test]
fn a_counterfactual_changes_the_planner_before_its_settings() {
    let found = changed("planner = 'negotiation'\nset = { vehicle.ego.driver.persuasion = false }", &[]);
    let Some(Driver::Negotiation(settings)) = found.ego().map(|ego| &ego.driver) else { panic!("not negotiation") };
    assert!(!settings.persuasion && settings.safety_filter);
    let found = changed("planner = 'idm'", &[]);
    assert!(matches!(found.ego().expect("there").driver, Driver::Idm(_)));
}

/// Changes by flags apply to the counterfactual too, unless it states another value.
#[test]
fn flags_also_change_counterfactuals_whose_own_changes_win() {
    let flags = [Override::Seed(9), set("duration_s=5"), set("vehicle.crossing.driver.style=\"nice\"")];
    let found = changed("set = { duration_s = 2.0 }", &flags);
    assert_eq!((found.seed, found.duration_s, style(&found)), (9, 2.0, Some(Style::Nice)));
    let kept = loaded(&variant("planner = 'idm'"), &[Override::Planner("conservative".to_owned())]);
    let kinds: Vec<&str> =
        [&kept, &kept.counterfactuals[0].scenario].map(|scenario| scenario.vehicles[0].driver.kind()).into();
    assert_eq!(kinds, ["conservative", "idm"]);
    assert!(loaded(&variant("planner = 'idm'"), &[set("counterfactual=[]")]).counterfactuals.is_empty());
}

/// A counterfactual of a mechanism that the planner of a flag does not have is not an error of the file.
#[test]
fn a_counterfactual_that_flags_make_invalid_is_left_out() {
    let text = variant("set = { vehicle.ego.driver.persuasion = false }");
    assert_eq!(loaded(&text, &[]).counterfactuals.len(), 1);
    let scenario = loaded(&text, &[Override::Planner("idm".to_owned())]);
    assert_eq!(scenario.counterfactuals, []);
    let [[name, reason]] = scenario.left_out.as_slice() else { panic!("{:?}", scenario.left_out) };
    assert_eq!((name.as_str(), reason.as_str()), ("what if", "unknown key `persuasion` in `vehicle.ego.driver`"));
    let broken = text.replace("persuasion", "persuation");
    from_text("mine.toml", &broken, &[Override::Planner("idm".to_owned())]).expect_err("wrong with and without flags");
}

#[test]
fn a_variant_has_its_own_counterfactuals_only() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let base = folder.path().join("base.toml");
    std::fs::write(&base, variant("planner = 'idm'")).expect("a writable folder");
    assert_eq!(load(&base.to_string_lossy(), &[]).expect("sound").counterfactuals.len(), 1);
    let more = format!("extends = '{}'\ntitle = 'A variant'", base.to_string_lossy());
    let scenario = loaded(&more, &[]);
    assert_eq!(scenario.counterfactuals, []);
}

/// A written counterfactual reads back, and `interplay new` keeps it.
#[test]
fn a_counterfactual_is_written_and_read_back() {
    let scenario = loaded(&variant("set = { 'vehicle.crossing.driver.style' = 'nice', vehicle.ego.limits = {} }"), &[]);
    assert_eq!(loaded(&scenario.to_file().to_toml(), &[]), scenario);
}

#[test]
fn faults_of_a_counterfactual_are_located_before_anything_runs() {
    let mut errors = Catalogue::default();
    let mut case = |name: &str, stated: &str, fragments: &[&str]| {
        errors.error(name, from_text("mine.toml", &variant(stated), &[]), fragments);
    };
    case(
        "unknown_key",
        "set = { 'vehicle.crossing.driver.stile' = 'nice' }",
        &["mine.toml:6:34", "in the counterfactual `what if`", "unknown key `stile`", "did you mean `style`"],
    );
    case("unknown_vehicle", "set = { vehicle.crosing.goal.lane = 0 }", &["mine.toml:6:17", "did you mean `crossing`"]);
    case(
        "bad_value",
        "set = { 'vehicle.crossing.driver.style' = 'nicer' }",
        &["mine.toml:6:43", "did you mean `nice`"],
    );
    case("bad_number", "set = { step_s = -1 }", &["mine.toml:6:18", "at least 0.001"]);
    case("unknown_planner", "planner = 'conservativ'", &["mine.toml:6:11", "did you mean `conservative`"]);
    case(
        "bad_place",
        "set = { vehicle.crossing.start.x_m = 9.0 }",
        &["mine.toml:6:26", "in the counterfactual", "outside"],
    );
    case("no_path", "set = { 'vehicle..goal' = 1 }", &["mine.toml:6:", "not the path of a setting"]);
    case("own_expectations", "set = { 'expect.order' = [] }", &["mine.toml:6:9", "[counterfactual.expect]"]);
    case("no_change", "", &["mine.toml:4:", "changes nothing", "planner ="]);
    case("same_value", "set = { vehicle.crossing.driver.style = 'tough' }", &["changes nothing", "already"]);
    case("unknown_part", "sets = { }", &["unknown key `sets`", "did you mean `set`"]);
    case("wrong_type", "set = 3", &["must be a table"]);
    insta::assert_snapshot!("changes", errors.0);
}

#[test]
fn wrong_expectations_of_a_counterfactual_are_located() {
    let mut errors = Catalogue::default();
    let mut case = |name: &str, expect: &str, fragments: &[&str]| {
        let text = variant("planner = 'idm'").replace("order_differs = true", expect);
        errors.error(name, from_text("mine.toml", &text, &[]), fragments);
    };
    case("nothing", "", &["mine.toml:4:", "expects nothing", "`order_differs`"]);
    case("misspelt", "order_difers = true", &["mine.toml:8:1", "did you mean `order_differs`"]);
    case("unknown_later", "later = [{ vehicle = 'eg', by_s = 0.3 }]", &["mine.toml:8:22", "did you mean `ego`"]);
    case("no_bound", "later = [{ vehicle = 'ego' }]", &["`by_s`", "is missing", "mine.toml:8:"]);
    case("unknown_order", "order = ['ego', 'crosing']", &["mine.toml:8:17", "did you mean `crossing`"]);
    case("nothing_to_break", "breaks = ['ordr']", &["mine.toml:8:11", "has no `ordr`", "did you mean `order`"]);
    let twice =
        variant("planner = 'idm'") + "[[counterfactual]]\nname = 'what if'\nplanner = 'human'\nexpect.breaks = []\n";
    errors.error("twice", from_text("mine.toml", &twice, &[]), &["mine.toml:10:", "two counterfactuals", "of its own"]);
    insta::assert_snapshot!("expectations", errors.0);
}

/// A building has no order and no planner.
#[test]
fn a_building_may_have_counterfactuals() {
    let stated = |more: &str| {
        let text = "extends = 'building/four-room-pid'\ntitle = 'Mine'\niterations = 2\n[[counterfactual]]\nname = 'what if'\n";
        from_text("mine.toml", &format!("{text}{more}"), &[])
    };
    let sound = stated("set = { 'controller.kind' = 'thermostat' }\nexpect = { building.cost_never_rises = true }");
    let sound = sound.unwrap_or_else(|error| panic!("{:?}", error.faults()));
    let changed = &sound.counterfactuals[0].scenario;
    assert_eq!((changed.controller().kind(), changed.days()), ("thermostat", 2));
    let mut errors = Catalogue::default();
    let order = "set = { 'controller.kind' = 'thermostat' }\nexpect.order_differs = true";
    errors.error("order", stated(order), &["mine.toml:7:", "there are no vehicles"]);
    errors.error("planner", stated("planner = 'idm'\nexpect.order_differs = true"), &["there are no vehicles"]);
}

/// Settings that a file states for its planner are varied, and no others.
#[test]
fn why_varies_the_planner_settings_that_a_file_states() {
    let factors = |sets: &[&str]| -> Vec<(String, String)> {
        let sets: Vec<Override> = sets.iter().map(|set| Override::Set((*set).to_owned())).collect();
        let scenario = load("intersection/nice", &sets).expect("sound");
        let changes = Registry::standard().standard_changes("intersection/nice", &scenario, &sets).expect("they fit");
        changes.into_iter().map(|one| (one.factor, one.change)).collect()
    };
    let plain = factors(&[]);
    let is_of = |key: &'static str| move |(factor, _): &&(String, String)| *factor == format!("ego's {key}");
    for key in ["settled_steps", "patience_steps"] {
        assert!(plain.iter().find(is_of(key)).is_none(), "{key} is not named: {plain:?}");
    }
    let named = factors(&["vehicle.ego.driver.settled_steps=29", "vehicle.ego.driver.patience_steps=40"]);
    let what = |key| named.iter().find(is_of(key)).map(|(_, change)| change.as_str());
    assert_eq!(what("settled_steps"), Some("ego: settled_steps = 6"));
    assert_eq!(what("patience_steps"), Some("ego: patience_steps = 5"));
    // A mechanism is switched off where it is on, and on where the file switches it off.
    let persuasion = |all: &[(String, String)]| all.iter().find(is_of("persuasion")).map(|(_, change)| change.clone());
    assert_eq!(persuasion(&plain).as_deref(), Some("ego: without persuasion (persuasion = false)"));
    let off = factors(&["vehicle.ego.driver.persuasion=false"]);
    assert_eq!(persuasion(&off).as_deref(), Some("ego: with persuasion (persuasion = true)"));
    let planners: Vec<_> = plain.iter().filter(is_of("planner")).collect();
    assert!(planners.iter().all(|(_, change)| !change.ends_with("idm")), "{planners:?}");
    assert!(plain.iter().any(|(factor, _)| factor == "ego's replacement by IDM"));
}

/// Each change of the standard list is a scenario that differs from its origin in this one thing.
#[test]
fn the_standard_changes_of_why_fit_every_authored_scenario() {
    for file in embedded() {
        let scenario = load(file.name, &[]).expect("authored");
        let changes = Registry::standard().standard_changes(file.name, &scenario, &[]);
        let changes = changes.unwrap_or_else(|error| panic!("{}: {:?}", file.name, error.faults()));
        assert_eq!(changes.is_empty(), scenario.vehicles.is_empty(), "{}", file.name);
        for one in changes {
            let pairs = one.scenario.vehicles.iter().zip(&scenario.vehicles);
            assert_eq!(pairs.filter(|(a, b)| a != b).count(), 1, "{}: {}", file.name, one.change);
            assert_eq!(one.scenario.expect, scenario.expect, "{}: {}", file.name, one.change);
            assert!(one.scenario.counterfactuals.is_empty() && !one.factor.is_empty(), "{}: {}", file.name, one.change);
        }
    }
}

#[test]
fn why_varies_a_driver_that_the_file_does_not_state() {
    let text = "title = 'a'\nshows = 'b'\nscale = 'full'\n[[vehicle]]\nname = 'car'\nstart = { lane = 0, along_m = 1.0, speed_mps = 3.0 }\n";
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("mine.toml").to_string_lossy().into_owned();
    std::fs::write(&path, text).expect("a writable folder");
    let scenario = load(&path, &[]).expect("a human by default");
    let changes = Registry::standard().standard_changes(&path, &scenario, &[]).expect("they fit");
    let style = changes.iter().find(|one| one.factor == "car's style").expect("a style");
    assert_eq!(style.sets, ["vehicle.car.driver.kind=\"human\"", "vehicle.car.driver.style=\"tough\""]);
    assert!(changes.iter().any(|one| one.factor == "car's late reaction"));
    assert!(changes.iter().all(|one| one.scenario.vehicles[0] != scenario.vehicles[0]));
}
