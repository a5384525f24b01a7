//! A feedback that is certified for a wrong model: its inputs do not alternate for long, and a stated error of the model keeps it calm
//! from the start.

use interplay_building::comfort::Setpoints;
use interplay_building::control::iterative::guard::worst_radius;
use interplay_building::control::iterative::{IterativeSettings, Stability};
use interplay_building::control::{ControlError, Controller};
use interplay_building::day::{Surroundings, run_day};
use interplay_building::discretise::Model;
use interplay_building::network::{AMBIENT, ModelMismatch, Network, Wall, Zone};
use interplay_building::occupancy::Occupancy;
use interplay_building::weather::{Climate, Forecast};

const STEP_S: f64 = 900.0;
const STEPS: usize = 96;
const DAYS: usize = 6;

/// Light air and a heavy wall, whose capacities are believed to be `factor` times what they are.
fn models(factor: f64) -> [Model; 2] {
    let zone = Zone {
        capacity_kj_per_k: 1500.0,
        heating_limit_kw: Some(9.0),
        cooling_limit_kw: Some(0.0),
        ..Zone::named("house")
    };
    let wall = Wall { mass_position: Some(0.1), ..Wall::new("house", AMBIENT, 7.0).with_capacity_kj_per_k(30_000.0) };
    let network = Network::new(&[zone], &[wall]).expect("valid");
    let mismatch = ModelMismatch { capacity_factor: factor, ..ModelMismatch::default() };
    let believed = network.believed(&mismatch).expect("valid");
    [network, believed].map(|network| Model::exact(&network, STEP_S).expect("valid"))
}

/// How many steps after the first day reverse the one before by more than a kilowatt, and remarks on days.
fn reversals(settings: IterativeSettings, factor: f64) -> (usize, Vec<ControlError>) {
    let [model, believed] = models(factor);
    let setpoints =
        Setpoints { occupied_c: vec![21.0], from_h: 0.0, to_h: 24.0, input_weight: 0.05, ..Setpoints::default() };
    let targets = setpoints.targets(1, STEP_S, STEPS).expect("valid");
    let climate = Climate { mean_c: 3.0, storm_probability: 0.0, ..Climate::default() };
    let people = Occupancy::default().people(1, 1);
    let surroundings = Surroundings::new(climate.weather(1, DAYS), (Forecast::Exact, 1), people, model.network());
    let mut controller = Controller::Iterative(settings).controller(&believed, STEPS).expect("valid");
    let mut nodes_c = vec![20.0; 2];
    let (mut heat_kw, mut remarks) = (Vec::new(), Vec::new());
    for day in 0..DAYS {
        let (forecast, actual) = (surroundings.forecast(&model, STEPS, day), surroundings.actual(&model, STEPS, day));
        let record = run_day(&model, &mut nodes_c, &mut *controller, &targets, &forecast, &actual).expect("runs");
        remarks.extend(record.design.fallback.into_iter().chain(record.design.weaker_feedback));
        heat_kw.extend(record.heat_kw);
    }
    let changes: Vec<f64> = heat_kw[STEPS..].windows(2).map(|pair| pair[1] - pair[0]).collect();
    let reverses = |pair: &&[f64]| pair[0] * pair[1] < 0.0 && pair[0].abs().min(pair[1].abs()) > 1.0;
    (changes.windows(2).filter(reverses).count(), remarks)
}

#[test]
fn alternating_inputs_weaken_the_feedback_and_are_reported() {
    for stability in [Stability::Lmi, Stability::Linear] {
        for factor in [1.6, 2.5] {
            let (count, remarks) = reversals(IterativeSettings { stability, ..IterativeSettings::default() }, factor);
            assert!(count < 40, "{stability:?} {factor}: {count} of {} steps reverse", (DAYS - 1) * STEPS);
            let is_remarked = remarks.iter().any(|why| matches!(why, ControlError::AlternatingInputs { .. }));
            assert_eq!(is_remarked, count > 3, "{stability:?} {factor}: {count} {remarks:?}");
        }
    }
}

#[test]
fn a_correct_model_keeps_its_whole_feedback_gain() {
    let (count, remarks) = reversals(IterativeSettings::default(), 1.0);
    assert!(count <= 3 && remarks.is_empty(), "{count} {remarks:?}");
}

/// With a stated error the gain is stable for all models within it, so that nothing alternates at all.
#[test]
fn a_stated_model_error_prevents_alternating_inputs() {
    let settings = IterativeSettings { model_error: 1.0, ..IterativeSettings::default() };
    let (count, remarks) = reversals(settings, 1.6);
    assert!(count <= 3, "{count} {remarks:?}");
    assert!(remarks.iter().any(|why| matches!(why, ControlError::NotRobust { .. })), "{remarks:?}");
}

#[test]
fn a_gain_that_overshoots_is_unstable_for_a_lighter_building() {
    let [model, _] = models(1.0);
    let strong = nalgebra::DMatrix::from_element(1, 1, 2.5);
    let radius = |error| worst_radius(&model, &strong, error).expect("simulated");
    assert!(radius(0.0) < 1.0 && radius(1.0) > 1.0, "{} {}", radius(0.0), radius(1.0));
}
