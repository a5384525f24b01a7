//! Plans of sweeps: samples that would be the same run, counts of faults, and paths of files.

use std::fs;

use crate::command::{interplay, scratch};

/// Samples that differ in the seed only are accepted where the seed changes the run, and refused where it does not.
#[test]
fn samples_are_refused_if_the_seed_has_no_effect() {
    let folder = scratch("sweep-equal-samples");
    let no_deviation = "{ least_bias = 0.0, greatest_bias = 0.0, scatter = 0.0, shift_h = 0.0, meeting_probability = 0.0, noise_kw = 0.0 }";
    let same_people =
        format!("occupancy={{ least_peak_kw = 0.4, greatest_peak_kw = 0.4, deviation = {no_deviation} }}");
    let mut outcomes = Vec::new();
    for (scenario, sets) in [
        ("intersection/nice", &["duration_s=3.0"][..]),
        ("intersection/nice", &["duration_s=3.0", "vehicle.ego.sensing.delay_s=0.2"]),
        ("intersection/nice", &["duration_s=3.0", "vehicle.ego.sensing.speed_sd_mps=0.1"]),
        ("intersection/nice", &["duration_s=3.0", "vehicle.ego.sensing.drop_rate=0.5"]),
        ("intersection/nice", &["duration_s=3.0", "start_jitter.speed_mps=0.1"]),
        ("building/four-room-pid", &["iterations=1"]),
        ("building/epw-weather", &["iterations=1"]),
        ("building/epw-weather", &["iterations=1", "weather.forecast.kind=exact", &same_people]),
    ] {
        let sets: Vec<&str> = sets.iter().flat_map(|set| ["--set", *set]).collect();
        let digest = |seed: &str| {
            let words = ["run", scenario, "--seed", seed, "--no-record", "--json"];
            interplay(&folder, &[&words[..], &sets].concat()).json()["digest"].clone()
        };
        let seed_counts = digest("1") != digest("2");
        let words = ["sweep", "--scenario", scenario, "--samples", "2", "--set", "expect={}", "--dry-run"];
        let checked = interplay(&folder, &[&words[..], &sets].concat());
        assert_eq!(checked.code, Some(if seed_counts { 0 } else { 2 }), "{scenario} {sets:?}: {checked:?}");
        assert!(seed_counts || checked.stderr.contains("samples = 2 # --samples"), "{}", checked.stderr);
        outcomes.push(seed_counts);
    }
    assert!(outcomes.contains(&true) && outcomes.contains(&false), "{outcomes:?}: the test says nothing");
}

/// A path is relative to the folder of the plan that states it, and in a flag to the current folder; the message about
/// a missing file states which.
#[test]
fn paths_of_weather_are_relative_to_the_stating_file() {
    let folder = scratch("sweep-weather");
    let below = folder.join("plans");
    fs::create_dir(&below).expect("a folder");
    let plan =
        "scenario = ['building/epw-weather']\nset = { weather = { kind = 'epw', file = 'own.epw' }, iterations = 1 }\n";
    fs::write(below.join("p.toml"), plan).expect("a scratch file");
    let flags = [
        "sweep",
        "--scenario",
        "building/epw-weather",
        "--set",
        "weather.file='own.epw'",
        "--set",
        "iterations=1",
        "--dry-run",
    ];
    let run =
        ["run", "building/epw-weather", "--set", "weather.file='own.epw'", "--set", "iterations=1", "--no-record"];
    let weather = include_str!("../../scenarios/weather/tropical-july.epw");
    for (arguments, missing, place) in [
        (&["sweep", "plans/p.toml", "--dry-run"][..], "plans/own.epw", "relative to the folder of `plans/p.toml`"),
        (&flags, "own.epw", "relative to the current folder"),
        (&run, "own.epw", "relative to the current folder"),
    ] {
        let refused = interplay(&folder, arguments);
        let said = refused.stderr.split_whitespace().filter(|word| *word != "│").collect::<Vec<_>>().join(" ");
        assert_eq!(refused.code, Some(2), "{refused:?}");
        assert!(said.contains(&format!("cannot read `{missing}`")) && said.contains(place), "{}", refused.stderr);
        fs::write(folder.join(missing), weather).expect("a scratch file");
        let sound = interplay(&folder, arguments);
        assert!(matches!(sound.code, Some(0 | 1)), "{sound:?}");
        fs::remove_file(folder.join(missing)).expect("it was there");
    }
}

/// A run is made anew when what it reads of a file is another than before, be the file stated by a scenario or by a plan.
#[test]
fn different_files_with_the_same_name_are_different_runs() {
    let folder = scratch("sweep-named-files");
    let weather = include_str!("../../scenarios/weather/tropical-july.epw");
    let prices = |price: f64| {
        let rows: String = (0..24).map(|hour| format!("{hour},{price}\n")).collect();
        format!("hour,price_per_kwh\n{rows}")
    };
    let plan = "scenario = ['building/epw-weather']\nset = { iterations = 1, weather = { kind = 'epw', file = 'w.epw' }, tariff = { file = 'p.csv' } }\n";
    fs::write(folder.join("plan.toml"), plan).expect("a scratch file");
    fs::write(folder.join("w.epw"), weather).expect("a scratch file");
    fs::write(folder.join("p.csv"), prices(0.2)).expect("a scratch file");
    let sweep = || {
        let swept = interplay(&folder, &["sweep", "plan.toml", "--out", "rows"]);
        assert_eq!(swept.code, Some(0), "{swept:?}");
        swept.stderr
    };
    assert!(sweep().contains("1 run to make, 0 made before"), "the first time");
    assert!(sweep().contains("0 runs to make, 1 made before"), "nothing has changed");
    fs::write(folder.join("p.csv"), prices(0.3)).expect("a scratch file");
    assert!(sweep().contains("1 run to make"), "other prices");
    let warmer = weather.replacen(",27.0,", ",29.0,", 1);
    fs::write(folder.join("w.epw"), warmer).expect("a scratch file");
    assert!(sweep().contains("1 run to make"), "other weather");
}

#[test]
fn faults_of_samples_are_counted_and_attributed_to_their_flags() {
    let folder = scratch("sweep-first-sample");
    let of_all = "samples = 3\n[vary]\nvehicle.front.start.x_m = [-1.65]\nvehicle.ego.start.speed_mps = { uniform = [1.0, 1.1] }\n";
    for (more, arguments, words) in
        [(of_all, &[][..], "3 runs have this"), ("samples = 1\n", &["--samples", "40"], "[--samples:1:1]")]
    {
        fs::write(folder.join("plan.toml"), format!("scenario = ['lane-change/front-nice']\n{more}"))
            .expect("a scratch file");
        for dry in [&["--dry-run"][..], &[]] {
            let refused = interplay(&folder, &[&["sweep", "plan.toml", "--out", "out"], arguments, dry].concat());
            assert_eq!(refused.code, Some(2), "{more}: {refused:?}");
            assert!(refused.stderr.contains(words), "{more}: {}", refused.stderr);
            assert!(!folder.join("out").exists(), "{more}");
        }
    }
}

/// A pattern in a plan selects files as it selects scenarios of the binary, and none of other folders.
#[test]
fn a_pattern_of_a_plan_selects_files() {
    let folder = scratch("sweep-pattern");
    fs::create_dir_all(folder.join("streets/deeper")).expect("a folder");
    let street = "extends = 'lane-keeping/nice'\nduration_s = 0.4\nexpect = {}\n";
    for name in ["streets/a-1.toml", "streets/a-2.toml", "streets/b-1.toml", "streets/deeper/a-3.toml", "a-4.toml"] {
        fs::write(folder.join(name), street).expect("a scratch file");
    }
    let swept = |pattern: &str| {
        let plan = format!("scenario = ['{pattern}']\nplanner = ['idm']\n");
        fs::write(folder.join("plan.toml"), plan).expect("a scratch file");
        interplay(&folder, &["sweep", "plan.toml", "--dry-run"])
    };
    for (pattern, runs) in [("streets/a-*.toml", "2 runs"), ("*.toml", "1 run"), ("streets/*.toml", "3 runs")] {
        let planned = swept(pattern);
        assert!(planned.code == Some(0) && planned.stdout.contains(runs), "{pattern}: {planned:?}");
    }
    let refused = swept("streets/c-*.toml");
    assert!(refused.code == Some(2) && refused.stderr.contains("streets/c-*.toml"), "{refused:?}");
}
