//! Networks as drivers: outputs, files that do not fit, equal runs.

use std::path::PathBuf;

use interplay_scenarios::{Override, Scenario};

use super::tensors::tests::written;
use super::*;
use crate::environment::{Environment, EnvironmentSettings};
use crate::run::run;

const INPUTS: usize = 35;

/// A network with one hidden layer on the five nearest vehicles, with these words about it.
fn network(metadata: &[(&str, &str)]) -> Vec<u8> {
    let number = |index: usize| ((index * 37 % 101) as f32 - 50.0) / 400.0;
    let hidden: Vec<f32> = (0..8 * INPUTS).map(number).collect();
    let last: Vec<f32> = (0..16).map(number).collect();
    let usual = [("observations", r#"[{"kind":"Kinematics"}]"#), ("action", "Continuous")];
    let tensors: [(&str, &[usize], &[f32]); 4] = [
        ("layers.0.weight", &[8, INPUTS], &hidden),
        ("layers.0.bias", &[8], &[0.1; 8]),
        ("layers.1.weight", &[2, 8], &last),
        ("layers.1.bias", &[2], &[0.2, 0.0]),
    ];
    written(&[&usual[..], metadata].concat(), &tensors)
}

fn saved(name: &str, bytes: &[u8]) -> PathBuf {
    let path = std::env::temp_dir().join(format!("interplay-{}-{name}.safetensors", std::process::id()));
    std::fs::write(&path, bytes).expect("written");
    path
}

fn loaded(driver: &str) -> Result<Scenario, String> {
    let registry = Registry::default().with_policies().expect("a new kind");
    let driver = Override::Set(format!("vehicle.ego.driver={driver}"));
    let found = registry.load("lane-change/front-nice", &[driver]);
    found.map_err(|error| error.faults().iter().map(|fault| fault.message().to_owned()).collect())
}

#[test]
fn outputs_are_sums_and_functions_of_inputs() {
    let bytes = written(
        &[("observations", r#"[{"kind":"Kinematics"}]"#), ("action", "Continuous"), ("activation", "relu")],
        &[
            ("layers.0.weight", &[2, 3], &[1.0, 2.0, 3.0, -1.0, -2.0, -3.0]),
            ("layers.0.bias", &[2], &[0.5, 0.5]),
            ("layers.1.weight", &[1, 2], &[2.0, 7.0]),
            ("layers.1.bias", &[1], &[-1.0]),
        ],
    );
    assert_eq!(Network::parse(&bytes).expect("a network").outputs(&[1.0, 0.5, -0.25]), [2.0 * 1.75 - 1.0]);
    let tanh = Network::parse(&network(&[])).expect("a network");
    let seen = [0.3; INPUTS];
    let number = |index: usize| f64::from(((index * 37 % 101) as f32 - 50.0) / 400.0);
    let hidden = |row: usize| {
        let sum: f64 = (0..INPUTS).map(|column| number(row * INPUTS + column) * f64::from(0.3_f32)).sum();
        (sum + f64::from(0.1_f32)).tanh()
    };
    let expected: f64 = (0..8).map(|row| hidden(row) * number(row)).sum::<f64>() + f64::from(0.2_f32);
    assert!((tanh.outputs(&seen)[0] - expected).abs() < 1e-12);
}

/// The network decides the same in an environment, where its action is handed in, and as a driver of a run.
#[test]
fn a_network_drives_a_run_as_it_drives_in_its_environment() {
    let path = saved("run", &network(&[]));
    let scenario = loaded(&format!("{{ kind = 'policy', file = '{}' }}", path.display())).expect("a scenario");
    let first = run("first", &scenario, Vec::new()).expect("a run");
    let text = scenario.to_file().to_toml();
    let digest = Network::parse(&network(&[])).expect("a network").digest;
    assert!(text.contains(&digest), "{text}");
    let registry = Registry::default().with_policies().expect("a new kind");
    // A counterfactual that sets what a network does not have is left out, and so is not written.
    let written = Scenario { left_out: Vec::new(), ..scenario.clone() };
    assert_eq!(registry.from_text("copy.toml", &text, &[]).expect("read"), written);
    let network = Network::parse(&network(&[])).expect("a network");
    let authored = interplay_scenarios::load("lane-change/front-nice", &[]).expect("authored");
    let mut environment = Environment::new(&authored, &EnvironmentSettings::default()).expect("an environment");
    environment.reset_as_written(authored.seed).expect("an episode");
    let mut seen = vec![0.0; INPUTS];
    while environment.is_live() {
        environment.observe(0, &mut seen).expect("an observation");
        environment.step(&network.action_for(&seen)).expect("a step");
    }
    let world = environment.world().expect("a world");
    let steps = (world.time_s() / authored.step_s).round() as usize;
    let mut driven = crate::Simulation::new(&scenario).expect("a world");
    for _ in 0..steps {
        assert!(driven.step().expect("a step").is_some());
    }
    let [in_run, handed_in] = [&driven, world].map(|world| world.states()[0].to_array());
    assert!(in_run.iter().zip(handed_in).all(|(one, other)| (one - other).abs() < 1e-9), "{in_run:?} {handed_in:?}");
    assert_eq!(first.digest, run("second", &scenario, Vec::new()).expect("a run").digest);
    std::fs::remove_file(path).expect("removed");
}

#[test]
fn files_that_do_not_fit_are_refused_with_a_reason() {
    let refused = |name: &str, bytes: &[u8], more: &str| {
        let path = saved(name, bytes);
        let fault = loaded(&format!("{{ kind = 'policy', file = '{}'{more} }}", path.display())).expect_err("refused");
        std::fs::remove_file(path).expect("removed");
        fault
    };
    assert!(refused("text", b"no network", "").contains("is not a `.safetensors` file"));
    assert!(refused("digest", &network(&[]), ", digest = 'ab'").contains("the scenario states ab"));
    assert!(
        refused("meta", &network(&[("action", "DiscreteMeta")]), "").contains("has 2 outputs, and its actions need 5")
    );
    assert!(refused("view", &network(&[("observations", r#"[{"kind":"Lane"}]"#)]), "").contains("has 35 inputs"));
    assert!(refused("word", &network(&[("activation", "gelu")]), "").contains("choose from tanh, relu"));
    assert!(loaded("{ kind = 'policy' }").expect_err("refused").contains("is missing"));
    assert!(loaded("{ kind = 'policy', file = '/nowhere' }").expect_err("refused").contains("cannot be read"));
}
