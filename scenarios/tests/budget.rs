//! What a run will make is known when its file is loaded, and too much of it is refused at the key that makes it large.

mod common;

use interplay_scenarios::{RunCost, Scenario, SweepPlan, embedded, embedded_plans, from_text, load};

const HEAD: &str = "title = 'a'\nshows = 'b'\n";

fn cost(text: &str) -> RunCost {
    from_text("mine.toml", &format!("{HEAD}{text}"), &[]).unwrap_or_else(|error| panic!("{error:?}")).cost()
}

fn car(name: &str, x_m: usize) -> String {
    format!("[[vehicle]]\nname = '{name}'\nstart = {{ x_m = {x_m}, y_m = 0.2, speed_mps = 1 }}\n")
}

#[test]
fn the_budget_counts_what_the_loop_does() {
    let two_cars = format!("duration_s = 2\nstep_s = 0.1\n{}{}", car("a", 0), car("b", 9));
    let kinematic = cost(&two_cars);
    assert_eq!((kinematic.plans, kinematic.steps, kinematic.records), (40, 60, 20), "two bodies and one pair");
    let dynamic = cost(&format!("plant = {{ kind = 'dynamic' }}\n{two_cars}"));
    assert_eq!((dynamic.plans, dynamic.steps), (40, 6000), "100 sub-steps in each of 20 ticks");
    let building = cost("iterations = 3\n[building]\ngrid = { rows = 2, columns = 3 }\nstep_s = 3600\n");
    assert_eq!((building.plans, building.steps, building.records), (0, 432, 72), "6 zones, 24 steps, 3 days");
    let other = "[[counterfactual]]\nname = 'slow'\nset = { step_s = 0.2 }\nexpect = { no_collision = true }\n";
    let with_another = cost(&format!("{two_cars}{other}"));
    assert_eq!((with_another.plans, with_another.records), (60, 20), "and its 10 ticks are not recorded");
}

#[test]
fn comparing_with_the_central_optimum_costs_more() {
    let building = |compare: bool| {
        cost(&format!("[building]\n[controller]\nkind = 'distributed'\ncompare = {compare}\n")).design_gop
    };
    assert!(building(true) > building(false) && building(false) > 0.0);
}

#[test]
fn the_budget_of_a_plan_at_every_step_grows_with_its_horizon() {
    let building = |horizon_h: u32| {
        cost(&format!("[building]\n[controller]\nkind = 'model-predictive'\nhorizon_h = {horizon_h}\n")).design_gop
    };
    // With the cube of the horizon, and for small plans hardly at all.
    let [ratio, small] = [building(24) / building(12), building(2) / building(1)];
    assert!((1.3..8.0).contains(&ratio) && (1.0..1.1).contains(&small), "{ratio} {small}");
}

#[test]
fn a_run_that_is_too_large_is_refused_with_the_responsible_key() {
    let refused = |text: &str, fragments: &[&str]| {
        common::refused(from_text("bad.toml", &format!("{HEAD}{text}"), &[]), fragments);
    };
    let car = car("ego", 0);
    let text = format!("step_s = 1e6\nduration_s = 1e6\nplant = {{ kind = 'dynamic' }}\n{car}");
    let fragments = ["the run makes 1000000000 steps, more than 20000000", "`budget = { steps = 1000000000 }`"];
    refused(&text, &[&fragments[..], &["lower `step_s`", "bad.toml:3"]].concat());
    let minutes = "[building]\nstep_s = 60\n[controller]\nkind = 'distributed'\ncompare = true\n";
    refused(minutes, &["billion operations", "lengthen `building.step_s`", "bad.toml:4"]);
    let tower = "[building]\ngrid = { rows = 10, columns = 100 }\n[controller]\nkind = 'clairvoyant'\n";
    refused(tower, &["not available for the exact model of 1000 temperatures", "forward Euler", "bad.toml:6"]);
    let euler = tower.replace("[controller]", "method = 'euler'\nstep_s = 60\n[controller]");
    refused(&euler, &["billion operations"]);
    let cars: String = (0..64).map(|i| self::car(&format!("car-{i}"), 2 * i)).collect();
    let cars = cars.replace("speed_mps = 1 }", "speed_mps = 1 }\ndriver = { kind = 'negotiation' }");
    let fragments = ["the run makes 6400000 plans, more than 200000", "lower `duration_s` to 312", "bad.toml:3"];
    refused(&format!("duration_s = 10000\n{cars}"), &fragments);
    let plans = format!("duration_s = 10000\nhorizon_steps = 200\nbudget = {{ plans = 7000000 }}\n{car}");
    refused(&plans, &["a recording of about 601 MB, more than 500 MB", "lower `horizon_steps`"]);
    let other = "[[counterfactual]]\nname = 'long'\nset = { duration_s = 8900 }\nexpect = { no_collision = true }\n";
    let together = format!("duration_s = 9000\nbudget = {{ plans = 100000 }}\n{car}{other}");
    let fragments = ["with its 1 counterfactuals the scenario makes 179000 plans", "state fewer counterfactuals"];
    refused(&together, &fragments);
}

#[test]
fn a_file_may_raise_the_limits_of_its_budget() {
    let long =
        |budget: &str| format!("{HEAD}duration_s = 9000\n{budget}{}{}{}", car("a", 0), car("b", 9), car("c", 18));
    from_text("long.toml", &long(""), &[]).expect_err("270000 plans");
    let scenario: Scenario = from_text("long.toml", &long("budget = { plans = 270000 }\n"), &[]).expect("allowed");
    assert_eq!(scenario.cost().plans, 270_000);
}

#[test]
fn every_authored_scenario_and_plan_stays_far_within_the_limits() {
    for file in embedded() {
        let scenario = load(file.name, &[]).unwrap_or_else(|error| panic!("{}: {error}", file.name));
        let cost = scenario.cost();
        assert_eq!(scenario.budget, Default::default(), "{}", file.name);
        assert!(cost.plans <= 20_000 && cost.steps <= 2_000_000, "{}: {cost}", file.name);
        assert!(cost.design_gop <= 20.0 && cost.recorded_mb <= 50.0, "{}: {cost}", file.name);
    }
    for plan in embedded_plans() {
        SweepPlan::load(plan, None).unwrap_or_else(|error| panic!("{plan}: {error:?}"));
    }
}
