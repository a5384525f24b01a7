//! Plans of many runs: their runs, seeds and drawn values.

use std::path::Path;

use interplay_scenarios::{LoadError, Override, SweepPlan, SweepPoint, embedded_plans};

fn read(text: &str) -> Result<SweepPlan, LoadError> {
    SweepPlan::from_text("plan.toml", text, Path::new(""))
}

fn sound(text: &str) -> SweepPlan {
    read(text).unwrap_or_else(|error| panic!("{text}: {:?}", error.faults()))
}

fn points(plan: &SweepPlan) -> Vec<SweepPoint> {
    (0..plan.run_count()).map(|index| plan.point(index)).collect()
}

fn input(point: &SweepPoint, path: &str) -> f64 {
    let found = point.inputs.iter().find(|(known, _)| known == path);
    found.and_then(|(_, value)| value.as_f64()).unwrap_or_else(|| panic!("{path} in {point:?}"))
}

const SPEED: &str = "vehicle.front.start.speed_mps";

#[test]
fn a_grid_has_every_combination_and_its_samples() {
    let plan = sound(
        "scenario = ['lane-change/front-nice', 'lane-change/both-tough']\nplanner = ['idm', 'conservative']\n\
         style = ['nice', 'tough']\nsamples = 3\nseed = 5\n[vary]\nvehicle.front.start.speed_mps = [1.0, 1.25]\n\
         horizon_steps = { range = [20, 30], step = 5 }\nvehicle.ego.goal.speed_mps = { uniform = [0.9, 1.1] }\n",
    );
    let points = points(&plan);
    assert_eq!(points.len(), 2 * 2 * 2 * 3 * 2 * 3);
    let mut cells: Vec<String> = points
        .iter()
        .map(|point| {
            let [speed, horizon] = [SPEED, "horizon_steps"].map(|path| input(point, path));
            format!("{} {} {} {speed} {horizon} {}", point.scenario, point.style, point.planner, point.seed)
        })
        .collect();
    cells.sort();
    cells.dedup();
    assert_eq!(cells.len(), points.len(), "every combination is there once");
    assert_eq!(points.iter().map(|point| point.seed).min(), Some(5));
    let scenario = plan.scenario(&points[0]).expect("sound");
    assert_eq!(scenario.seed, 5);
    assert!(scenario.counterfactuals.is_empty());
}

#[test]
fn planners_get_the_same_values_and_seeds_in_a_sample() {
    for sampling in ["grid", "random", "latin-hypercube"] {
        let plan = sound(&format!(
            "scenario = ['lane-change/front-nice']\nplanner = ['idm', 'conservative', 'negotiation']\nsamples = 20\n\
             sampling = '{sampling}'\n[vary]\n{SPEED} = {{ normal = {{ mean = 1.2, sd = 0.02 }} }}\n"
        ));
        let points = points(&plan);
        for pair in points.chunks(3) {
            let same = |point: &SweepPoint| (point.inputs.clone(), point.seed, point.sample);
            assert!(pair.iter().all(|point| same(point) == same(&pair[0])), "{sampling}: {pair:?}");
        }
        let mut speeds: Vec<f64> = points.iter().step_by(3).map(|point| input(point, SPEED)).collect();
        speeds.sort_by(f64::total_cmp);
        speeds.dedup();
        assert_eq!(speeds.len(), 20, "{sampling}");
    }
}

#[test]
fn drawn_values_do_not_depend_on_other_parts_of_the_plan() {
    let few = sound(&format!(
        "scenario = ['lane-change/front-nice']\nsamples = 5\n[vary]\n{SPEED} = {{ uniform = [1.0, 1.3] }}\n"
    ));
    let many = sound(&format!(
        "scenario = ['intersection/nice', 'lane-change/front-nice']\nplanner = ['idm', 'game']\nsamples = 9\n[[style]]\nname = 'x'\n\
         vary = {{ 'vehicle.*.goal.speed_mps' = {{ uniform = [1.0, 1.2] }}, '{SPEED}' = {{ uniform = [1.0, 1.3] }} }}\n"
    )
    .replace("'intersection/nice', ", ""));
    let values = |plan: &SweepPlan, planner: &str| -> Vec<f64> {
        let own = points(plan).into_iter().filter(|point| point.planner == planner);
        own.take(5).map(|point| input(&point, SPEED)).collect()
    };
    assert_eq!(values(&few, "as-written"), values(&many, "game"));
}

/// The mean and the quartiles of many draws, within four standard errors.
#[test]
fn drawn_values_have_their_distributions() {
    let plan = |values: &str| {
        sound(&format!("scenario = ['lane-change/front-nice']\nsamples = 2000\n[vary]\n{SPEED} = {values}\n"))
    };
    let median = |plan: &SweepPlan| {
        let mut all: Vec<f64> = points(plan).iter().map(|point| input(point, SPEED)).collect();
        all.sort_by(f64::total_cmp);
        (all[0], all[1000], all[1999])
    };
    let (least, middle, most) = median(&plan("{ log_uniform = [0.5, 1.5] }"));
    assert!(least >= 0.5 && most <= 1.5 && (middle / (0.75_f64).sqrt() - 1.0).abs() < 0.05, "{least} {middle} {most}");
    let (_, middle, _) = median(&plan("{ normal = { mean = 1.2, sd = 0.01 } }"));
    assert!((middle - 1.2).abs() < 0.002, "{middle}");
}

/// Each scenario has its own counterfactuals as planners after those of the plan, with the same values and seeds.
#[test]
fn counterfactuals_of_a_plan_apply_only_to_their_scenario() {
    let plan = sound(
        "scenario = ['lane-keeping/conservative-nice', 'intersection/nice']\nplanner = ['as-written', 'idm']\nstyle = ['as-written', \
         'tough']\ncounterfactuals = true\nsamples = 3\njitter = { position_m = 0.1, speed_mps = 0.1 }\n",
    );
    let own = |name: &str| interplay_scenarios::load(name, &[]).expect("sound");
    let [one, other] = ["lane-keeping/conservative-nice", "intersection/nice"].map(own);
    let counts = [one.counterfactuals.len(), other.counterfactuals.len()];
    assert!(counts[1] == 3 && counts[0] != 3, "{counts:?}");
    assert_eq!(plan.counterfactual_count(), counts[0] + 3);
    let points = points(&plan);
    assert_eq!(points.len(), 2 * 3 * (2 * 2 + counts[0] + 3));
    for (scenario, of) in [(&one, "lane-keeping/conservative-nice"), (&other, "intersection/nice")] {
        let names: Vec<&str> = scenario.counterfactuals.iter().map(|one| one.stated.name.as_str()).collect();
        let of_scenario: Vec<&SweepPoint> = points.iter().filter(|point| point.scenario == of).collect();
        for pair in of_scenario.chunks(2 + names.len()) {
            let planners: Vec<&str> = pair.iter().map(|point| point.planner.as_str()).collect();
            assert_eq!(planners, [&["as-written", "idm"][..], &names].concat());
            let same = |point: &SweepPoint| (point.seed, point.sample, point.style.clone());
            assert!(pair.iter().all(|point| same(point) == same(pair[0])), "{pair:?}");
        }
        let styles: std::collections::BTreeSet<&str> = of_scenario.iter().map(|one| one.style.as_str()).collect();
        assert_eq!(styles.len(), 2);
    }
    // The change of the counterfactual applies, from the same start.
    let find = |planner: &str| points.iter().find(|point| point.planner == planner && point.style == "as-written");
    let run = |planner: &str| plan.scenario(find(planner).expect("there")).expect("sound");
    let conservative = run("A conservative ego crosses second");
    assert_eq!(conservative.vehicles[0].driver.kind(), "conservative");
    assert_eq!(conservative.vehicles[1], other.vehicles[1]);
    assert_eq!(conservative.start_jitter.position_m, 0.1);
}

#[test]
fn a_star_in_a_plan_stands_for_all_vehicles_except_the_ego() {
    let plan = sound("scenario = ['lane-change/front-nice']\nstyle = ['tough']\nplanner = ['conservative']\n");
    let scenario = plan.scenario(&plan.point(0)).expect("sound");
    let drivers: Vec<String> = scenario.vehicles.iter().map(|vehicle| format!("{:?}", vehicle.driver)).collect();
    assert!(
        drivers[0].starts_with("Conservative") && drivers[1] == drivers[2] && drivers[1].contains("Tough"),
        "{drivers:?}"
    );
}

/// Metres are metres at every scale; with `scaled`, the change of starts of real cars is that of 1/10 scale cars by Froude's law.
#[test]
fn jitter_of_a_plan_is_scaled_to_the_vehicles_on_request_only() {
    for (more, is_scaled) in [("", false), (", scaled = true", true)] {
        let plan = sound(&format!(
            "scenario = ['lane-change/front-nice', 'roundabout/nice']\njitter = {{ position_m = 0.1, speed_mps = 0.1{more} }}\n",
        ));
        for (point, scale) in points(&plan).iter().zip([1.0_f64, 10.0]) {
            let scenario = plan.scenario(point).expect("sound");
            assert_eq!(scenario.vehicles[0].body.scale, scale);
            let (jitter, scale) = (scenario.start_jitter, if is_scaled { scale } else { 1.0 });
            assert_eq!((jitter.position_m, jitter.speed_mps), (0.1 * scale, 0.1 * scale.sqrt()));
        }
    }
}

/// The results that a plan keeps about a road equal those that a single scenario computes.
#[test]
fn plan_runs_with_a_cached_road_equal_single_runs() {
    let plan = sound(
        "scenario = ['roundabout', 't-junction', 'narrow-passage', 'left-turn', 'on-ramp', 'all-way-stop', 'overtaking']\nsamples = 2\n\
         jitter = { position_m = 0.1, speed_mps = 0.1 }\n",
    );
    let points = points(&plan);
    for point in points.iter().chain(&points) {
        let changes = [Override::Set("counterfactual=[]".to_owned()), Override::Seed(point.seed)];
        let alone = interplay_scenarios::load(&point.scenario, &changes).expect("sound");
        let in_plan = plan.scenario(point).expect("sound");
        assert!(alone.network.is_some() && alone.vehicles.iter().all(|vehicle| vehicle.route.is_in_network()));
        assert_eq!((&in_plan.network, &in_plan.vehicles), (&alone.network, &alone.vehicles), "{}", point.scenario);
    }
}

#[test]
fn families_and_patterns_in_a_plan_select_scenarios() {
    let names = |entry: &str| -> Vec<String> {
        let plan = sound(&format!("scenario = ['{entry}']\n"));
        plan.names()[0].iter().map(|name| (*name).to_owned()).collect()
    };
    assert_eq!(names("narrow-passage").len(), 5);
    assert_eq!(names("*/nice"), names("*/nice"));
    assert!(names("*/nice").contains(&"roundabout/nice".to_owned()));
}

#[test]
fn the_embedded_plans_are_valid() {
    for name in embedded_plans() {
        let plan = SweepPlan::load(name, Some(1)).unwrap_or_else(|error| panic!("{name}: {:?}", error.faults()));
        let last = plan.point(plan.run_count() - 1);
        plan.scenario(&last).expect("sound");
    }
    assert!(embedded_plans().contains(&"quick"));
}

/// An entry of a list below a table is named as on the command line, whether the path is quoted or not.
#[test]
fn paths_in_a_plan_may_name_entries_of_nested_lists() {
    for path in ["building.zone.office.heating_limit_kw", "'building.zone.office.heating_limit_kw'"] {
        let text = format!("scenario = ['building/office-and-flat']\n[set]\n{path} = 5.5\nbuilding.step_s = 900.0\n");
        let plan = SweepPlan::from_text("plan.toml", &text, Path::new("")).expect("sound");
        let scenario = plan.scenario(&plan.point(0)).expect("sound");
        let text = scenario.to_file().to_toml();
        assert!(text.contains("heating_limit_kw = 5.5"), "{path}: {}", &text[..200]);
    }
}
