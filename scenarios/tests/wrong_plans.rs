//! Errors of wrong plans of many runs, and their places.

#[path = "common/plans.rs"]
mod plans;

use interplay_scenarios::{LoadError, SweepPlan};
use plans::read;

fn sound(text: &str) -> SweepPlan {
    read(text).unwrap_or_else(|error| panic!("{text}: {:?}", error.faults()))
}

/// Each wrong plan, with the line, the column and a fragment of its error.
const WRONG: &[plans::WrongPlan] = &[
    ("planner = ['idm']\n", 1, 1, "`scenario` is missing"),
    ("title = 'A'\nshows = 'B'\n[road]\nkind = 'lanes'\n", 3, 2, "is a scenario, not a plan of runs"),
    ("scenario = []\n", 1, 12, "must have at least 1"),
    ("scenario = ['lane-chnge']\n", 1, 13, "no scenario, no family and no file `lane-chnge`"),
    ("scenario = ['lane-change', 'lane-change/front-nice']\n", 1, 28, "in the plan twice"),
    ("scenario = ['lane-change/front-nice']\nsample = 3\n", 2, 1, "unknown key `sample`"),
    ("scenario = ['lane-change/front-nice']\nsamples = 0\n", 2, 11, "must be at least 1"),
    ("scenario = ['lane-change/front-nice']\nplanner = ['imd']\n", 2, 12, "cannot be `imd`"),
    ("scenario = ['lane-change/front-nice']\nplanner = ['idm', 'idm']\n", 2, 19, "two entries `idm`"),
    ("scenario = ['lane-change/front-nice']\nstyle = ['tuff']\n", 2, 10, "neither a style nor a kind of driver"),
    (
        "scenario = ['intersection/nice']\nplanner = [{ name = 'A conservative ego crosses second', kind = 'idm' }]\n\
         counterfactuals = true\n",
        3,
        19,
        "which a planner is called, too",
    ),
    ("scenario = ['building/tower']\nplanner = ['idm']\n", 2, 12, "no vehicles"),
    (
        "scenario = ['lane-change/front-nice']\n[vary]\nvehicle.front.start.sped_mps = [1.0]\n",
        3,
        21,
        "unknown key `sped_mps`",
    ),
    (
        "scenario = ['lane-change/front-nice']\n[vary]\nvehicle.fron.start.speed_mps = [1.0]\n",
        3,
        9,
        "there is no `fron`",
    ),
    // Keys of one table, stated line by line.
    (
        "scenario = ['lane-change/front-nice']\n[set]\nvehicle.ego.driver.kind = 'negotiation'\nvehicle.ego.driver.patience_steps = -1\n",
        4,
        37,
        "must be at least 1",
    ),
    ("scenario = ['lane-change/front-nice']\n[vary]\nvehicle.front.start.speed_mps = []\n", 3, 33, "must not be empty"),
    (
        "scenario = ['lane-change/front-nice']\n[vary]\nvehicle.front.start.speed_mps = 1.0\n",
        3,
        33,
        "neither a list nor a distribution",
    ),
    ("scenario = ['lane-change/front-nice']\n[vary]\nduration_s = { uniform = [2, 1] }\n", 3, 26, "is empty"),
    (
        "scenario = ['lane-change/front-nice']\n[vary]\nduration_s = { range = [2.0, 1.0], count = 3 }\n",
        3,
        24,
        "is empty",
    ),
    ("scenario = ['lane-change/front-nice']\n[vary]\nduration_s = { range = [1.0, 2.0] }\n", 3, 24, "needs a `count`"),
    (
        "scenario = ['lane-change/front-nice']\n[vary]\nduration_s = { range = [1, 2], step = 0 }\n",
        3,
        24,
        "`step` apart",
    ),
    (
        "scenario = ['lane-change/front-nice']\n[vary]\nduration_s = { range = [1.0, 2.0], count = 0 }\n",
        3,
        44,
        "`count` must be",
    ),
    (
        "scenario = ['lane-change/front-nice']\n[vary]\nduration_s = { normal = { mean = 1.0, sd = 0.0 } }\n",
        3,
        25,
        "above 0",
    ),
    (
        "scenario = ['lane-change/front-nice']\n[vary]\nduration_s = { normal = { mean = 1.0 } }\n",
        3,
        25,
        "`mean` and `sd`",
    ),
    ("scenario = ['lane-change/front-nice']\n[vary]\nduration_s = { log_uniform = [0.0, 1.0] }\n", 3, 30, "above 0"),
    (
        "scenario = ['lane-change/front-nice']\n[vary]\nduration_s = { uniform = [1.0, 2.0], sd = 1 }\n",
        3,
        38,
        "does not belong",
    ),
    (
        "scenario = ['lane-change/front-nice']\n[vary]\nduration_s = { uniform = [-1.0, 2.0] }\n",
        3,
        14,
        "must be at least 0.001",
    ),
    ("scenario = ['lane-change/front-nice']\n[vary]\nseed = [1, 2]\n", 3, 1, "follows from its sample"),
    ("scenario = ['lane-change/front-nice']\nsamples = 1000000000000\n", 2, 11, "1000000000000 runs"),
    (
        "scenario = ['lane-change/front-nice']\nsamples = 9223372036854775807\nplanner = ['idm', 'game', 'human']\n",
        2,
        11,
        "more runs than can be counted",
    ),
    ("scenario = ['lane-change/front-nice']\nsamples = 2\nmax_runs = 1\n", 2, 11, "2 runs, and at most 1"),
    // A value that the file accepts and the scenario does not: the vehicles would overlap.
    (
        "scenario = ['lane-change/front-nice']\n[vary]\nvehicle.front.start.x_m = { uniform = [-1.65, -0.3] }\n",
        3,
        21,
        "overlap at the start",
    ),
    // One seed for all runs would make one run of all samples.
    ("scenario = ['lane-change/front-nice']\nset = { seed = 4 }\nsamples = 3\n", 2, 9, "follows from its sample"),
    (
        "scenario = ['lane-change/front-nice']\n[[style]]\nname = 'x'\nset = { seed = 4 }\n",
        4,
        9,
        "follows from its sample",
    ),
    (
        "scenario = ['lane-change/front-nice']\nplanner = [{ name = 'x', set = { 'seed' = 4 } }]\n",
        2,
        35,
        "follows from its sample",
    ),
    ("scenario = ['lane-change/front-nice']\nset = { real_time.plan_budget_ms = 5 }\n", 2, 9, "counted by the clock"),
    (
        "scenario = ['lane-change/front-nice']\n[vary]\nreal_time.plan_budget_ms = [5, 9]\n",
        3,
        11,
        "counted by the clock",
    ),
    // A fault caused by a set value is blamed on it, with and without values that vary.
    (
        "scenario = ['lane-change/front-nice']\nset = { duration_s = 0.5 }\n",
        2,
        22,
        "is not before the end of the run at 0.5 s",
    ),
    (
        "scenario = ['lane-change/front-nice']\nset = { duration_s = 0.5 }\n[vary]\nvehicle.front.start.speed_mps = [1.0, 1.1]\n",
        2,
        22,
        "is not before the end of the run at 0.5 s",
    ),
    (
        "scenario = ['lane-change/front-nice']\nset = { step_s = 0.1 }\n[[style]]\nname = 'short'\nset = { duration_s = 0.5 }\n",
        5,
        22,
        "with the style `short`",
    ),
    (
        "scenario = ['lane-change/front-nice']\nplanner = [{ name = 'short', kind = 'idm', set = { duration_s = 0.5 } }]\n",
        2,
        65,
        "with the style `as-written` and the planner `short`",
    ),
    (
        "scenario = ['lane-change/front-nice']\nset = { vehicle.front.start.y_m = 0.3 }\n[vary]\n\
         vehicle.rear.start.speed_mps = [1.0, 1.1]\nvehicle.front.start.x_m = [-1.65, -0.35]\n",
        5,
        35,
        "with `vehicle.front.start.x_m = -0.35`",
    ),
    // Of two incompatible changes, the one that varies is blamed, or else the one that the fault is about.
    (
        "scenario = ['lane-change/front-nice']\nset = { vehicle.front.start.x_m = 0.1 }\n[vary]\nvehicle.ego.start.y_m = [0.185, 0.5]\n",
        4,
        33,
        "with `vehicle.ego.start.y_m = 0.5`",
    ),
    (
        "scenario = ['lane-change/front-nice']\nplanner = [{ name = 'x', set = { duration_s = 1.5 } }]\n[set]\n\
         'expect.completes.ego.after_s' = 2.0\n",
        4,
        34,
        "is not before the end of the run",
    ),
    // Misspelt distributions.
    (
        "scenario = ['lane-change/front-nice']\n[vary]\nvehicle.front.start.speed_mps = { unifrom = [1.0, 1.2] }\n",
        3,
        35,
        "`unifrom` is not a distribution",
    ),
    (
        "scenario = ['lane-change/front-nice']\n[vary]\nvehicle.front.start.speed_mps = { mean = 1.0, sd = 0.1 }\n",
        3,
        35,
        "`mean` is not a distribution",
    ),
    (
        "scenario = ['intersection/nice']\n[vary]\n'vehicle.*.driver.safety_weight' = { lognormal = [1.0, 1.2] }\n",
        3,
        38,
        "`lognormal` is not a distribution",
    ),
    // Changes of vehicles in a building.
    ("scenario = ['building/tower']\nstyle = ['nice']\n", 2, 10, "no vehicles"),
    ("scenario = ['building/tower']\nset = { 'vehicle.*.driver.kind' = 'idm' }\n", 2, 18, "no vehicles"),
    (
        "scenario = ['building/tower']\njitter = { position_m = 0.1, speed_mps = 0.1 }\n",
        2,
        10,
        "`building/tower` has no vehicles, so `jitter`",
    ),
    // Repeated statements.
    (
        "scenario = ['lane-change/front-nice']\nset = { horizon_steps = 20 }\n[vary]\nhorizon_steps = [20, 25]\n",
        2,
        9,
        "is set here, and varies",
    ),
    (
        "scenario = ['lane-change/front-nice']\nplanner = ['as-written', 'idm']\n[vary]\nvehicle.ego.driver.kind = ['game', 'human']\n",
        2,
        26,
        "is set here, and varies",
    ),
    (
        "scenario = ['lane-change/front-nice']\nstyle = ['nice']\n[vary]\nvehicle.'*'.driver.style = ['nice', 'tough']\n",
        2,
        10,
        "is set here, and varies",
    ),
    (
        "scenario = ['lane-change/front-nice']\n[[style]]\nname = 'x'\nvary = { horizon_steps = [20, 25] }\n[vary]\nhorizon_steps = [20, 25]\n",
        4,
        10,
        "varies in all runs and with this style",
    ),
    (
        "scenario = ['lane-change/front-nice']\njitter = { position_m = 0.1, speed_mps = 0.1 }\nset = { start_jitter = { position_m = 0.2 } }\n",
        3,
        9,
        "`start_jitter` is laid over it",
    ),
];

#[test]
fn faults_of_plans_are_refused_at_their_place() {
    plans::all_are_refused(WRONG);
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
