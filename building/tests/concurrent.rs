//! The concurrent design (chapter 4): against independent code, the Youla algebra, its bounds, and its days.

mod common;

use common::reference::*;
use interplay_building::comfort::Setpoints;
use interplay_building::control::concurrent::youla::{StateSpace, YoulaFilter};
use interplay_building::control::concurrent::{Concurrent, ConcurrentSettings, filter};
use interplay_building::control::iterative::guard::worst_radius;
use interplay_building::control::iterative::{IterativeSettings, Stability, feedback};
use interplay_building::control::learning::LearningSettings;
use interplay_building::control::pid::PidSettings;
use interplay_building::control::uncertainty::{Uncertainty, UncertaintySettings};
use interplay_building::control::{BandPenalty, ControlError, Controller, optimum};
use interplay_building::day::{KeyFigures, Surroundings, run_day};
use interplay_building::discretise::Model;
use interplay_building::lifted::Lifted;
use interplay_building::network::{AMBIENT, ModelMismatch, Network, PowerLimits, Wall, Zone};
use interplay_building::occupancy::Occupancy;
use interplay_building::weather::{Climate, Forecast};
use nalgebra::DMatrix;

fn uncertainty() -> Uncertainty {
    Uncertainty::new(UncertaintySettings::default()).expect("valid")
}

fn designed(settings: &ConcurrentSettings) -> Result<filter::FilterDesign, ControlError> {
    filter::design(settings, &lifted(), &chapter_4(), &uncertainty())
}

#[test]
fn taps_and_costs_match_independent_code() {
    let wanted = &optima()["ch4"];
    let found = designed(&ConcurrentSettings::default()).expect("designed");
    assert_close(found.cost, number(&wanted["H2_cost"]), 1e-4);
    assert_close(found.open_cost, number(&wanted["H2_open"]), 1e-6);
    let entries: Vec<f64> =
        found.filter.0.iter().flat_map(|tap| tap.transpose().iter().copied().collect::<Vec<_>>()).collect();
    assert!(common::distance(&entries, &floats(&wanted["Q_taps"])) < 1e-4);
    let penalty = Some(BandPenalty { linear: 50.0, quadratic: 50.0 });
    let nominal = optimum(&lifted(), &[28.5; 4], &chapter_4(), &day(1).0, penalty).expect("solvable");
    assert_close(nominal.objective, number(&wanted["J_nominal_with_slack"]), 1e-4);
}

/// C = (I − QG)⁻¹ Q (eq. 4.29), column by column: the answers to an impulse of one error.
fn feedback_matrix(filter: &YoulaFilter, lifted: &Lifted) -> DMatrix<f64> {
    let (n, size) = (lifted.zones(), lifted.size());
    let mut matrix = DMatrix::zeros(size, size);
    for column in 0..size {
        let mut state = StateSpace::new(filter.clone(), lifted.model());
        for t in 0..lifted.steps() {
            // At time t the error of row t − 1 is known.
            let mut error_k = vec![0.0; n];
            if t > 0 && column / n == t - 1 {
                error_k[column % n] = 1.0;
            }
            let heat_kw = state.answer(&error_k);
            matrix.view_mut((t * n, column), (n, 1)).copy_from_slice(&heat_kw);
            state.advance(&heat_kw);
        }
    }
    matrix
}

#[test]
fn the_identities_of_the_youla_parametrisation_hold() {
    let lifted = lifted();
    let filter = designed(&ConcurrentSettings::default()).expect("designed").filter;
    let size = lifted.size();
    let (g, c) = (lifted.dense(), feedback_matrix(&filter, &lifted));
    let mut q = DMatrix::zeros(size, size);
    let mut unit = vec![0.0; size];
    for column in 0..size {
        unit[column] = 1.0;
        q.column_mut(column).copy_from_slice(&filter.product(&unit));
        unit[column] = 0.0;
    }
    let identity = DMatrix::<f64>::identity(size, size);
    // (4.17), (4.20), (4.21)
    assert!(((&identity - &q * &g) * &c - &q).amax() < 1e-10);
    assert!(((&identity + &g * &c) * (&identity - &g * &q) - &identity).amax() < 1e-9);
    assert!(((&identity + &c * &g) * (&identity - &q * &g) - &identity).amax() < 1e-9);
    for t in 0..48 {
        assert!(c.view((t * 4, t * 4), (4, size - t * 4)).amax() == 0.0, "strictly causal");
    }
    // The responses are those of the closed loop.
    let response = filter.response(&lifted, &identity);
    assert!((&response.temperatures_k - (&g - &g * &q * &g)).amax() < 1e-10);
    assert!((&response.inputs_kw + &q * &g).amax() < 1e-10);
}

#[test]
fn the_state_space_form_equals_the_feedback_matrix() {
    let lifted = lifted();
    let filter = designed(&ConcurrentSettings::default()).expect("designed").filter;
    let errors = common::numbers(lifted.size(), 1.0);
    let wanted = feedback_matrix(&filter, &lifted) * nalgebra::DVector::from_column_slice(&errors);
    let mut state = StateSpace::new(filter, lifted.model());
    for t in 0..48 {
        let error = if t == 0 { vec![0.0; 4] } else { errors[(t - 1) * 4..t * 4].to_vec() };
        let heat = state.answer(&error);
        assert!(common::distance(&heat, &wanted.as_slice()[t * 4..(t + 1) * 4]) < 1e-10);
        state.advance(&heat);
    }
}

#[test]
fn the_printed_impulse_vector_misses_what_the_impulse_matrix_sees() {
    // Q₀ = 50 (I − 11ᵀ/4).
    let lifted = lifted();
    let blind = YoulaFilter(vec![DMatrix::from_fn(4, 4, |i, j| 50.0 * (if i == j { 1.0 } else { 0.0 } - 0.25))]);
    let printed: Vec<f64> = (0..lifted.size()).map(|i| if i < 4 { 1.0 } else { 0.0 }).collect();
    assert!(blind.product(&printed).iter().all(|v| v.abs() < 1e-12), "‖Qα‖₁ = 0 with the printed α");
    assert!(blind.row_norm() > 70.0 && blind.impulse_norm(&lifted) > 100.0, "{}", blind.impulse_norm(&lifted));
}

#[test]
fn robust_bounds_hold_at_a_higher_cost_and_have_floors() {
    let lifted = lifted();
    let free = designed(&ConcurrentSettings::default()).expect("designed");
    assert!((free.filter.row_norm() - 2.47).abs() < 0.01 && (free.filter.impulse_norm(&lifted) - 4.45).abs() < 0.01);
    for (gamma_q, gamma_2, dearer) in [(1.5, 4.0, 1.08), (1.0, 5.0, 1.46)] {
        let settings =
            ConcurrentSettings { taps: 24, gamma_q, gamma_2: Some(gamma_2), ..ConcurrentSettings::default() };
        let found = designed(&settings).expect("designed");
        assert!(found.filter.row_norm() <= gamma_q + 1e-6 && found.filter.impulse_norm(&lifted) <= gamma_2 + 1e-6);
        assert!((found.cost / free.cost - dearer).abs() < 0.03, "{gamma_q} {gamma_2}: {}", found.cost / free.cost);
    }
    let error = designed(&ConcurrentSettings { gamma_q: 2.0, gamma_2: Some(3.0), ..ConcurrentSettings::default() });
    assert!(matches!(error, Err(ControlError::BelowFloor { floor, .. }) if (floor - 3.6).abs() < 1e-9), "{error:?}");
    // Above one step's effect, but not with so little gain.
    let error = designed(&ConcurrentSettings { gamma_q: 0.1, gamma_2: Some(4.0), ..ConcurrentSettings::default() });
    let Err(ControlError::BelowFloor { floor, .. }) = error else { panic!("{error:?}") };
    assert!(floor > 4.0 && floor < 8.4);
    let within = ConcurrentSettings { gamma_q: 0.1, gamma_2: Some(floor * 1.001), ..ConcurrentSettings::default() };
    designed(&within).expect("the floor is the floor");
}

#[test]
fn four_taps_are_nearly_as_good_as_any_causal_feedback() {
    let (lifted, targets) = (lifted(), chapter_4());
    let factor = interplay_building::control::uncertainty::factor(uncertainty().covariance(&targets)).expect("one");
    let filter = designed(&ConcurrentSettings::default()).expect("designed").filter;
    let best = feedback::optimal_causal(&lifted, &targets, &factor, &[]).expect("designed").cost(&targets);
    let ours = filter.response(&lifted, &factor).cost(&targets);
    let none = feedback::static_feedback(&lifted, &DMatrix::zeros(4, 4), &factor).cost(&targets);
    assert!(best <= ours && ours < best + 0.05 * (none - best), "{best} {ours} {none}");
}

#[test]
fn the_concurrent_design_tracks_better_than_pid_on_every_seed() {
    let (model, targets) = (testbed(), chapter_4());
    let pid = LearningSettings { forecast: false, feedback: PidSettings::default(), ..LearningSettings::default() };
    for seed in 1..=8 {
        let days = synthetic(seed, 5, 4);
        let figures = |controller: Controller| -> (f64, f64) {
            let mut controller = controller.controller(&model, STEPS).expect("valid");
            let records = run(&model, 28.5, &mut *controller, &targets, &days);
            assert!(records.iter().all(|record| record.requested_kw.iter().all(|kw| kw.abs() <= 2.0)));
            let later = records[1..]
                .iter()
                .map(|r| KeyFigures::compute(r, &targets, &PowerLimits::symmetric(&[2.0; 4]), STEP_S));
            later.fold((0.0, 0.0), |(rmse, beyond), f| (rmse + f.tracking_rmse_c / 4.0, beyond + f.discomfort_k_h))
        };
        let youla = figures(Controller::Concurrent(ConcurrentSettings::default()));
        let pid = figures(Controller::IterativeLearning(pid));
        assert!(youla.0 < pid.0 && youla.1 < pid.1, "{seed}: {youla:?} {pid:?}");
        assert!(youla.0 < 0.25, "{youla:?}");
    }
}

#[test]
fn a_bound_below_its_floor_is_refused_at_the_start() {
    // Below what one step does, and below what taps within γ_q reach.
    for (gamma_q, gamma_2, floor) in [(2.5, 3.0, "3.6000"), (0.1, 4.0, "")] {
        let settings = ConcurrentSettings { gamma_q, gamma_2: Some(gamma_2), ..ConcurrentSettings::default() };
        let error = Concurrent::new(settings, lifted()).expect_err("no feedback");
        assert!(matches!(error, ControlError::BelowFloor { bound: "gamma_2", .. }), "{error}");
        assert!(error.to_string().contains(floor) && error.key().as_str() == "gamma_2", "{error}");
    }
}

#[test]
fn rooms_with_little_gain_have_a_feasible_default_bound() {
    // The taps that are allowed are too small for rooms of twenty times the capacity.
    let lifted = Lifted::new(&testbed_scaled(20.0, 1.0, 1.0), STEPS);
    let mut concurrent = Concurrent::new(ConcurrentSettings::default(), lifted.clone()).expect("valid");
    let days: Vec<_> = (0..3).map(day).collect();
    let records = run(lifted.model(), 24.0, &mut concurrent, &chapter_4(), &days);
    assert!(records.iter().all(|record| record.design.fallback.is_none()), "{:?}", records[1].design.fallback);
    let taps = &records[2].design.taps_kw_per_k;
    assert!(taps.iter().flatten().flatten().any(|tap| tap.abs() > 0.1), "{taps:?}");
}

#[test]
fn a_day_without_a_forecast_repeats_the_day_before() {
    let mut days: Vec<_> = (0..3).map(day).collect();
    days[1].0.ambient_c[7] = f64::NAN;
    let mut concurrent = Concurrent::new(ConcurrentSettings::default(), lifted()).expect("valid");
    let records = run(&testbed(), 28.5, &mut concurrent, &chapter_4(), &days);
    assert!(records[0].design.fallback.is_none());
    assert!(matches!(records[1].design.fallback, Some(ControlError::NotFinite { index: 7, .. })));
    assert_eq!(records[1].design.planned_kw, records[0].heat_kw);
    assert_eq!(records[2].design.fallbacks, 1);
}

#[test]
fn a_day_without_forecast_error_follows_its_plan() {
    let days: Vec<_> = (0..3).map(|k| (day(k).1, day(k).1)).collect();
    let mut concurrent = Concurrent::new(ConcurrentSettings::default(), lifted()).expect("valid");
    let records = run(&testbed(), 28.5, &mut concurrent, &chapter_4(), &days);
    for record in &records[1..] {
        assert!(common::distance(&record.temperatures_c, &record.design.planned_c) < 1e-8);
        assert!(common::distance(&record.heat_kw, &record.design.planned_kw) < 1e-8);
        // Precooling: something is done before the references start at 7:30.
        assert!(record.heat_kw[..14 * 4].iter().any(|kw| *kw < -0.05));
    }
}

#[test]
fn the_default_bound_grows_with_the_building() {
    for side in [1, 3] {
        let model = Model::euler(&Network::grid(side, side), STEP_S).expect("stable");
        let zones = side * side;
        let setpoints = Setpoints { occupied_c: vec![23.0], ..Setpoints::default() };
        let targets = setpoints.targets(zones, STEP_S, STEPS).expect("valid");
        let lifted = Lifted::new(&model, STEPS);
        let found =
            filter::design(&ConcurrentSettings::default(), &lifted, &targets, &uncertainty()).expect("designed");
        let floor = 1.8 * (zones as f64).sqrt();
        let norm = found.filter.impulse_norm(&lifted);
        assert!((floor..=4.6 / 3.6 * floor + 1e-6).contains(&norm), "{zones}: {norm}");
        assert!(found.cost < 0.2 * found.open_cost);
    }
}

const QUARTER_HOUR_S: f64 = 900.0;
const QUARTER_HOURS_A_DAY: usize = 96;
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
    [network, believed].map(|network| Model::exact(&network, QUARTER_HOUR_S).expect("valid"))
}

/// How many steps after the first day reverse the one before by more than a kilowatt, and remarks on days.
fn reversals(settings: IterativeSettings, factor: f64) -> (usize, Vec<ControlError>) {
    let [model, believed] = models(factor);
    let setpoints =
        Setpoints { occupied_c: vec![21.0], from_h: 0.0, to_h: 24.0, input_weight: 0.05, ..Setpoints::default() };
    let targets = setpoints.targets(1, QUARTER_HOUR_S, QUARTER_HOURS_A_DAY).expect("valid");
    let climate = Climate { mean_c: 3.0, storm_probability: 0.0, ..Climate::default() };
    let people = Occupancy::default().people(1, 1);
    let surroundings = Surroundings::new(climate.weather(1, DAYS), (Forecast::Exact, 1), people, model.network());
    let mut controller = Controller::Iterative(settings).controller(&believed, QUARTER_HOURS_A_DAY).expect("valid");
    let mut nodes_c = vec![20.0; 2];
    let (mut heat_kw, mut remarks) = (Vec::new(), Vec::new());
    for day in 0..DAYS {
        let (forecast, actual) = (
            surroundings.forecast(&model, QUARTER_HOURS_A_DAY, day),
            surroundings.actual(&model, QUARTER_HOURS_A_DAY, day),
        );
        let record = run_day(&model, &mut nodes_c, &mut *controller, &targets, &forecast, &actual).expect("runs");
        remarks.extend(record.design.fallback.into_iter().chain(record.design.weaker_feedback));
        heat_kw.extend(record.heat_kw);
    }
    let changes: Vec<f64> = heat_kw[QUARTER_HOURS_A_DAY..].windows(2).map(|pair| pair[1] - pair[0]).collect();
    let reverses = |pair: &&[f64]| pair[0] * pair[1] < 0.0 && pair[0].abs().min(pair[1].abs()) > 1.0;
    (changes.windows(2).filter(reverses).count(), remarks)
}

#[test]
fn alternating_inputs_weaken_the_feedback_and_are_reported() {
    for stability in [Stability::Lmi, Stability::Linear] {
        for factor in [1.6, 2.5] {
            let (count, remarks) = reversals(IterativeSettings { stability, ..IterativeSettings::default() }, factor);
            assert!(
                count < 40,
                "{stability:?} {factor}: {count} of {} steps reverse",
                (DAYS - 1) * QUARTER_HOURS_A_DAY
            );
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
    let strong = DMatrix::from_element(1, 1, 2.5);
    let radius = |error| worst_radius(&model, &strong, error).expect("simulated");
    assert!(radius(0.0) < 1.0 && radius(1.0) > 1.0, "{} {}", radius(0.0), radius(1.0));
}
