//! Errors of wrong plans of many runs, and their places.

use std::path::Path;

use interplay_scenarios::{LoadError, SweepPlan};
use serde::Deserialize;

/// A plan as it would be read from the file `plan.toml`.
fn read(text: &str) -> Result<SweepPlan, LoadError> {
    SweepPlan::from_text("plan.toml", text, Path::new(""))
}

fn sound(text: &str) -> SweepPlan {
    read(text).unwrap_or_else(|error| panic!("{text}: {:?}", error.faults()))
}

/// The text of each plan, the place of its first fault, and words of what is said of it.
#[derive(Deserialize)]
struct Refusals {
    wrong: Vec<[String; 3]>,
    without_effect: Vec<[String; 3]>,
}

fn all_are_refused(of: impl Fn(Refusals) -> Vec<[String; 3]>) {
    let plans = toml::from_str(include_str!("cases/plans.toml")).expect("a table of plans");
    let mut wrong = Vec::new();
    for [text, place, words] in of(plans) {
        let found = read(&text).err().map(|error| {
            let fault = &error.faults()[0];
            let (line, column) = fault.line_and_column().unwrap_or_default();
            (fault.file().map(str::to_owned), format!("{line}:{column}"), fault.message().to_owned())
        });
        let is_there = found.as_ref().is_some_and(|(file, at, message)| {
            file.as_deref() == Some("plan.toml") && *at == place && message.contains(&words)
        });
        if !is_there {
            wrong.push(format!("{text}{found:?} and not {:?}", (place, words)));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}

#[test]
fn faults_of_plans_are_refused_at_their_place() {
    all_are_refused(|plans| plans.wrong);
}

#[test]
fn changes_and_samples_without_effect_are_refused_at_their_place() {
    all_are_refused(|plans| plans.without_effect);
}

/// Changes with an effect in some run, and samples with a drawn value.
#[test]
fn changes_and_samples_with_an_effect_are_accepted() {
    for text in [
        "scenario = ['lane-change/front-nice']\nset = { vehicle.ego.driver.settled_steps = 20 }\nplanner = ['negotiation', 'idm']\n",
        "scenario = ['lane-change/front-nice']\nset = { 'vehicle.*.goal.speed_mps' = 1.1, 'vehicle.front.goal.speed_mps' = 1.2 }\n",
        "scenario = ['lane-change/front-nice']\nset = { vehicle.front.driver.style = 'tough' }\nstyle = ['as-written', 'nice']\n",
        "scenario = ['lane-change/front-nice']\nsamples = 3\nset = { vehicle.ego.sensing.speed_sd_mps = 0.05 }\n",
        "scenario = ['lane-change/front-nice']\nsamples = 3\nset = { vehicle.ego.sensing.drop_rate = 0.05 }\n",
        "scenario = ['lane-change/front-nice']\nsamples = 3\nset = { start_jitter.speed_mps = 0.05 }\n",
        "scenario = ['lane-change/front-nice']\nsamples = 3\nsampling = 'random'\n[vary]\nhorizon_steps = [20, 25]\n",
        "scenario = ['building/tower']\nsamples = 3\n",
        "scenario = ['lane-change/front-nice']\nset = { horizon_steps = 20 }\n[[style]]\nname = 'a'\n[[style]]\nname = 'b'\n\
         vary = { horizon_steps = [25, 30] }\n",
        "scenario = ['lane-change/front-nice']\nset = { real_time.plan_budget_ms = 10 }\nplanner = ['as-written', { name = 'late', \
         set = { real_time.deadline = 'enforced' } }]\n",
        "scenario = ['lane-change/front-nice']\nset = { vehicle.front.start = { heading_rad = 0.0 } }\n[vary]\n\
         vehicle.front.start.speed_mps = [1.0, 1.1]\n",
        "scenario = ['lane-change/front-nice']\nseed = 4\nsamples = 3\njitter = { position_m = 0.1, speed_mps = 0.1 }\n",
    ] {
        let plan = read(text);
        assert!(plan.is_ok(), "{text}: {:?}", plan.err().map(|error| error.faults().to_vec()));
    }
}

/// The faults of the runs of a valid plan.
fn refusal(plan: &SweepPlan) -> LoadError {
    let points = (0..plan.run_count()).rev().map(|index| plan.point(index));
    let refused = points.filter_map(|point| plan.check(&point).err());
    plan.refusal(&refused.reduce(|all, one| all.and(one)).expect("some are refused"))
}

/// Each fault is reported once, with the first run that has it and their number.
#[test]
fn drawn_values_that_make_a_scenario_invalid_are_reported_once() {
    let plan = sound(
        "scenario = ['lane-change/front-nice']\nplanner = ['idm', 'human']\nsamples = 50\n[vary]\n\
         vehicle.front.start.x_m = { normal = { mean = -0.35, sd = 2.0 } }\n",
    );
    let error = refusal(&plan);
    let overlaps = |error: &LoadError| -> Vec<String> {
        let messages = error.faults().iter().map(|fault| fault.message().to_owned());
        messages.filter(|message| message.contains("`front` and `rear` overlap")).collect()
    };
    let [overlap] = &overlaps(&error)[..] else { panic!("{:?}", error.faults()) };
    let points: Vec<_> = (0..plan.run_count()).map(|index| plan.point(index)).collect();
    let refused: Vec<_> =
        points.iter().filter(|point| plan.scenario(point).is_err_and(|error| !overlaps(&error).is_empty())).collect();
    let value = refused[0].inputs[0].1.as_f64().expect("a number");
    let (_, named) = overlap.split_once("`vehicle.front.start.x_m = ").expect("the value");
    let (named, rest) = named.split_once('`').expect("a number");
    let difference = (named.parse::<f64>().expect("a number") - value).abs();
    assert!(difference <= 5e-6 * value.abs(), "{overlap}");
    assert!(rest.starts_with(&format!(", sample {}: ", refused[0].sample)), "{overlap}");
    assert!(overlap.ends_with(&format!("; {} runs have this error", refused.len())), "{overlap}");
    assert_eq!(error.faults()[0].line_and_column(), Some((5, 21)));
}

/// Faults of the first sample are counted like those of the others.
#[test]
fn faults_of_the_first_sample_state_how_many_runs_have_them() {
    let plan = sound(
        "scenario = ['lane-change/front-nice']\nplanner = ['idm', 'human']\nsamples = 3\n[vary]\nvehicle.front.start.x_m = [-1.65]\n\
         vehicle.front.start.speed_mps = { uniform = [1.0, 1.1] }\n",
    );
    let error = refusal(&plan);
    let fault = &error.faults()[0];
    assert_eq!((fault.file(), fault.line_and_column()), (Some("plan.toml"), Some((5, 21))));
    let said = [", sample 0: ", "overlap at the start", "; 6 runs have this error"];
    assert!(said.iter().all(|words| fault.message().contains(words)), "{}", fault.message());
    // A fault of all runs of a combination is reported when the plan is read.
    let error = read("scenario = ['lane-change/front-nice']\nset = { vehicle.front.start.x_m = -1.65 }\n")
        .err()
        .expect("refused");
    assert!(error.faults()[0].message().contains("overlap at the start"));
}

/// A start that is moved onto another vehicle is blamed on the plan's own change of the starts.
#[test]
fn jitter_that_makes_a_scenario_invalid_is_reported_with_seed_and_sample() {
    let plan = sound(
        "scenario = ['lane-change/front-nice']\nseed = 10\njitter = { position_m = 5.0, speed_mps = 0.1 }\nsamples = 200\n\
         set = { horizon_steps = 20 }\n[vary]\nvehicle.ego.start.speed_mps = { uniform = [1.0, 1.1] }\n",
    );
    for fault in refusal(&plan).faults() {
        assert_eq!((fault.file(), fault.line_and_column()), (Some("plan.toml"), Some((3, 10))), "{}", fault.message());
        let (_, named) = fault.message().split_once("`seed = ").expect("the seed");
        let (seed, rest) = named.split_once("`, sample ").expect("the sample");
        let (sample, _) = rest.split_once(": ").expect("a number");
        let [seed, sample] = [seed, sample].map(|number| number.parse::<u64>().expect("a number"));
        assert_eq!(seed, 10 + sample);
    }
}

/// A counterfactual with a seed of its own would be the same run in every sample.
#[test]
fn a_counterfactual_that_sets_the_seed_is_refused_in_a_plan() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let scenario = "extends = 'intersection/nice'\n[[counterfactual]]\nname = 'seeded'\nset = { seed = 4 }\n\
                    expect = { order = ['ego', 'turning'] }\n";
    std::fs::write(folder.path().join("own.toml"), scenario).expect("a scratch file");
    let read = |more: &str| {
        let jitter = "{ position_m = 0.1, speed_mps = 0.1 }";
        let text = format!("scenario = ['own.toml']\nsamples = 3\njitter = {jitter}\n{more}");
        SweepPlan::from_text("plan.toml", &text, folder.path())
    };
    let sound = read("");
    assert!(sound.is_ok(), "{:?}", sound.err().map(|error| error.faults().to_vec()));
    let error = read("counterfactuals = true\n").err().expect("refused");
    let fault = &error.faults()[0];
    assert!(fault.message().contains("`seeded` that sets the seed"), "{}", fault.message());
    assert_eq!((fault.file(), fault.line_and_column()), (Some("plan.toml"), Some((4, 19))));
}

/// Another number of samples changes no place, and is found however the plan writes its own.
#[test]
fn the_samples_flag_changes_only_the_number_of_samples() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let path = folder.path().join("plan.toml");
    let name = path.to_str().expect("a path");
    let load = |text: &str, samples| {
        std::fs::write(&path, text).expect("a scratch file");
        SweepPlan::load(name, Some(samples))
    };
    for (text, said) in [
        (
            "scenario = ['intersection/nice']\n\"samples\" = 0x3 # ours\njitter = { position_m = 0.1 }\n",
            "scenario = ['intersection/nice']\n\"samples\" = 7 # ours\njitter = { position_m = 0.1 }\n",
        ),
        (
            "title = \"\"\"\nsamples = 2\n\"\"\"\nscenario = ['intersection/nice']\njitter = { position_m = 0.1 }",
            "samples = 7 # --samples\ntitle = \"\"\"\nsamples = 2\n\"\"\"\nscenario = ['intersection/nice']\njitter = { position_m = 0.1 }",
        ),
    ] {
        let plan = load(text, 7).unwrap_or_else(|error| panic!("{text}: {:?}", error.faults()));
        assert_eq!((plan.run_count(), plan.text()), (7, said));
        assert_eq!(read(plan.text()).map(|plan| plan.run_count()).ok(), Some(7));
    }
    let refused = |text: &str, samples| load(text, samples).err().expect("wrong").faults()[0].clone();
    let fault = refused("scenario = ['intersection/nice']\nplanner = ['imd']\n", 7);
    assert_eq!((fault.file(), fault.line_and_column()), (Some(name), Some((2, 12))));
    let fault = refused("scenario = ['intersection/nice']\nsamples = 1\n", 5_000_000);
    assert_eq!((fault.file(), fault.line_and_column()), (Some("--samples"), Some((1, 1))));
}
