//! Model predictive control: its plans are those of the day's optimum, it corrects what it is not told, and it says when it has no
//! plan.

mod common;

use common::distance;
use common::ordinary::OrdinaryBuilding;
use interplay_building::comfort::{Setpoints, Targets};
use interplay_building::control::pid::PidSettings;
use interplay_building::control::predictive::PredictiveSettings;
use interplay_building::control::{
    BandPenalty, Control, ControlError, Controller, DayAhead, DayRecord, Disturbance, Observation, optimum,
};
use interplay_building::day::run_day;
use interplay_building::discretise::Model;
use interplay_building::lifted::Lifted;
use interplay_building::network::{AMBIENT, Network, Wall, Zone};

const STEP_S: f64 = 1800.0;
const STEPS: usize = 48;
const ZONES: usize = 2;

/// Two rooms with a heavy outer wall each, which the sun falls on.
fn building() -> Model {
    let zones = ["a", "b"].map(Zone::named);
    let outer =
        |zone: &str| Wall { capacity_kj_per_k: Some(2000.0), solar_aperture_m2: 1.0, ..Wall::new(zone, AMBIENT, 60.0) };
    Model::exact(&Network::new(&zones, &[Wall::new("a", "b", 40.0), outer("a"), outer("b")]).expect("valid"), STEP_S)
        .expect("valid")
}

fn targets() -> Targets {
    Setpoints { occupied_c: vec![22.0], ..Setpoints::default() }.targets(ZONES, STEP_S, STEPS).expect("valid")
}

/// A day whose weather turns; `more_kw` is heat besides people's.
fn day(more_kw: f64) -> Disturbance {
    let hour = |t: usize| t as f64 / STEPS as f64 * std::f64::consts::TAU;
    let gain = |t: usize| if (16..38).contains(&t) { 0.3 } else { 0.0 };
    Disturbance {
        ambient_c: (0..STEPS).map(|t| 27.0 - 5.0 * hour(t).cos()).collect(),
        gains_kw: (0..STEPS)
            .flat_map(|t| [gain(t) + more_kw, 0.5 * gain(t) + more_kw, gain(t), 0.2 * gain(t)])
            .collect(),
    }
}

fn before_first_day(controller: Controller, model: &Model) -> Box<dyn Control> {
    controller.controller(model, STEPS).expect("valid")
}

fn predictive(settings: PredictiveSettings, model: &Model) -> Box<dyn Control> {
    before_first_day(Controller::ModelPredictive(settings), model)
}

/// Runs equal days, of which the controller is told `forecast`.
fn run(days: usize, controller: &mut dyn Control, forecast: &Disturbance, actual: &Disturbance) -> Vec<DayRecord> {
    let model = building();
    let mut temperatures_c = vec![26.0; model.network().node_count()];
    (0..days)
        .map(|_| run_day(&model, &mut temperatures_c, controller, &targets(), forecast, actual).expect("runs"))
        .collect()
}

fn cost(record: &DayRecord) -> f64 {
    targets().cost(&record.temperatures_c, &record.heat_kw)
}

/// The first input of a plan for a whole day is that of the day's optimum, which independent code has checked (`optimum.rs`).
#[test]
fn a_plan_for_a_day_is_the_optimum_of_the_day() {
    let (model, targets, forecast) = (building(), targets(), day(0.0));
    let initial_c = vec![26.0; model.network().node_count()];
    let settings = PredictiveSettings { horizon_h: 24.0, ..PredictiveSettings::default() };
    let penalty = BandPenalty { linear: settings.discomfort_linear, quadratic: settings.discomfort_quadratic };
    let wanted = optimum(&Lifted::new(&model, STEPS), &initial_c, &targets, &forecast, Some(penalty)).expect("solved");
    let mut controller = predictive(settings, &model);
    let ahead = DayAhead { initial_c: &initial_c, targets: &targets, forecast: &forecast, outlook: None, actual: None };
    controller.start_of_day(&ahead).expect("fits");
    let heat_kw = controller.act(&Observation { step: 0, temperatures_c: &initial_c[..ZONES], targets: &targets });
    assert!(distance(&heat_kw, &wanted.heat_kw[..ZONES]) < 1e-6, "{heat_kw:?} {:?}", &wanted.heat_kw[..ZONES]);
    assert!(controller.trouble().is_none());
}

/// With the day told exactly it comes near the optimum, and a controller without a forecast does not.
#[test]
fn with_an_exact_forecast_predictive_control_costs_little_more_than_the_optimum() {
    let (model, exact) = (building(), day(0.0));
    let of = |controller: Controller| cost(&run(3, &mut *before_first_day(controller, &model), &exact, &exact)[2]);
    let [predictive, best, pid] = [
        Controller::ModelPredictive(PredictiveSettings::default()),
        Controller::Clairvoyant(Default::default()),
        Controller::Pid(PidSettings::default()),
    ]
    .map(of);
    assert!(predictive < 1.05 * best, "{predictive} and {best}");
    assert!(pid > 2.0 * predictive, "{pid} and {predictive}");
}

/// Heat that was not forecast is estimated and compensated with learning, and is not without.
#[test]
fn unforecast_heat_is_learned_within_a_day() {
    let (told, actual) = (day(0.0), day(0.4));
    let last_cost = |learning_rate: f64| {
        let settings = PredictiveSettings { learning_rate, ..PredictiveSettings::default() };
        cost(&run(2, &mut *predictive(settings, &building()), &told, &actual)[1])
    };
    let knowing = cost(&run(2, &mut *predictive(PredictiveSettings::default(), &building()), &actual, &actual)[1]);
    let (learning, ignorant) = (last_cost(0.3), last_cost(0.0));
    assert!(learning < 1.02 * knowing, "{learning} and {knowing}");
    assert!(ignorant > 1.1 * knowing, "{ignorant} and {knowing}");
}

/// A step without a plan follows the last one, the day says so, and the next day goes on.
#[test]
fn a_step_without_a_plan_follows_the_last_plan_and_gives_the_reason() {
    let actual = day(0.0);
    let mut told = actual.clone();
    told.ambient_c[40] = f64::NAN;
    let mut controller = predictive(PredictiveSettings::default(), &building());
    let model = building();
    let mut temperatures_c = vec![26.0; model.network().node_count()];
    let mut one_day = |forecast: &Disturbance| {
        run_day(&model, &mut temperatures_c, &mut *controller, &targets(), forecast, &actual).expect("runs")
    };
    let (good, bad, after) = (one_day(&actual), one_day(&told), one_day(&actual));
    assert_eq!((good.design.fallbacks, bad.design.fallbacks, after.design.fallbacks), (0, 1, 1));
    // A horizon of 24 steps sees step 40 from step 17 on.
    let fallback = bad.design.fallback.as_ref().expect("told");
    assert!(matches!(fallback, ControlError::StepWithoutPlan { step: 17, .. }), "{fallback}");
    assert!(after.design.fallback.is_none());
    assert!(bad.heat_kw.iter().all(|heat_kw| heat_kw.is_finite()));
    assert!(cost(&after) < 1.05 * cost(&good).max(cost(&after)), "goes on");
}

#[test]
fn buildings_that_are_too_large_and_settings_out_of_range_are_refused() {
    let chain: Vec<Zone> = (0..50).map(|i| Zone::named(format!("z{i}"))).collect();
    let model = Model::exact(&Network::new(&chain, &[]).expect("valid"), STEP_S).expect("valid");
    let refused = |settings: PredictiveSettings| {
        Controller::ModelPredictive(settings).controller(&model, STEPS).map(|_| ()).expect_err("refused")
    };
    let error = refused(PredictiveSettings::default());
    assert_eq!((error.key().as_str(), error.to_string().contains("1200 unknowns")), ("horizon_h", true), "{error}");
    let error = refused(PredictiveSettings { horizon_h: 0.0, ..PredictiveSettings::default() });
    assert_eq!(error.key().as_str(), "horizon_h", "{error}");
}

/// The largest rise of the cost from one day to the next: as the bias settles, costs of later days differ by less than a tenth
/// of a percent.
const SETTLED: f64 = 1.002;

fn check(controller: Controller, seeds: std::ops::Range<u64>) {
    for seed in seeds {
        let building = OrdinaryBuilding::new(seed);
        let (costs, fallbacks) = building.run(controller.clone(), 5).expect("it starts");
        let what = format!("{} {seed} {:?}: {costs:?}", controller.kind(), building.construction);
        assert_eq!(fallbacks, 0, "{what}");
        assert!(costs[1] < 0.2 * costs[0] && costs[4] < costs[1], "{what}");
        assert!(costs.windows(2).all(|pair| pair[1] <= SETTLED * pair[0]), "{what}");
    }
}

#[test]
fn the_iterative_design_works_in_ordinary_buildings() {
    check(Controller::Iterative(Default::default()), 0..9);
}

#[test]
fn the_concurrent_design_works_in_ordinary_buildings() {
    check(Controller::Concurrent(Default::default()), 0..9);
}

#[test]
fn the_distributed_design_works_in_ordinary_buildings() {
    check(Controller::Distributed(Default::default()), 0..9);
}
