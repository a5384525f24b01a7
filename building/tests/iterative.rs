//! The iterative design (chapter 3): against independent code, its laws, and what happens when it fails.

mod common;

use common::reference::*;
use interplay_building::comfort::Setpoints;
use interplay_building::control::disturbance_estimate::DisturbancePrediction;
use interplay_building::control::iterative::{
    ErrorGrowth, Iterative, IterativeSettings, Objective, Stability, StaticFeedback, feedback,
};
use interplay_building::control::stability::{closed_loop, positive_decay, spectral_radius};
use interplay_building::control::uncertainty::{Uncertainty, UncertaintySettings, factor, normal_quantile};
use interplay_building::control::{Control, ControlError, Controller, DayAhead, DayRecord, Observation};
use interplay_building::discretise::Model;
use interplay_building::lifted::Lifted;
use interplay_building::network::{AMBIENT, Network, Wall, Zone};
use interplay_convex::{Program, Solver, SolverSettings, triangle};
use nalgebra::DMatrix;

fn covariance(night_weight: f64) -> DMatrix<f64> {
    let uncertainty = Uncertainty::new(UncertaintySettings::default()).expect("valid");
    uncertainty.covariance(&chapter_3(night_weight))
}

const NIGHTS: [(&str, f64); 2] = [("ch3_night1", 1.0), ("ch3_night0", 0.0)];

#[test]
fn expected_costs_are_those_of_independent_code() {
    let (optima, lifted) = (optima(), lifted());
    for (name, weight) in NIGHTS {
        let (targets, wanted) = (chapter_3(weight), &optima[name]);
        let factor = factor(covariance(weight)).expect("a covariance");
        let none = feedback::static_feedback(&lifted, &DMatrix::zeros(4, 4), &factor);
        assert_close(none.cost(&targets), number(&wanted["exp_cost_noFB"]), 1e-6);
        let some = feedback::static_feedback(&lifted, &DMatrix::from_diagonal_element(4, 4, 0.1), &factor);
        assert_close(some.cost(&targets), number(&wanted["exp_cost_K_0p1"]), 1e-6);
        for (stability, key) in [(Stability::LeastSquares, "exp_cost_K_ls"), (Stability::Lmi, "exp_cost_K_lmi_decay07")]
        {
            let settings = IterativeSettings { stability, ..IterativeSettings::default() };
            let found =
                StaticFeedback::design(&settings, &lifted, &targets, covariance(weight), &[]).expect("designed");
            assert_close(found.causal_cost, number(&wanted["exp_cost_optimal_causal_Y"]), 1e-4);
            assert_close(found.cost, number(&wanted[key]), 1e-4);
        }
    }
}

/// The iterative design with the first day of the independent code, whose initial feedback acts at night too, where
/// temperatures are free.
#[derive(Debug)]
struct FeedbackAtNight {
    iterative: Iterative,
    day: usize,
}

impl Control for FeedbackAtNight {
    fn start_of_day(&mut self, day_ahead: &DayAhead<'_>) -> Result<(), ControlError> {
        self.iterative.start_of_day(day_ahead)
    }

    fn act(&mut self, observation: &Observation<'_>) -> Vec<f64> {
        let Observation { step, temperatures_c, targets } = *observation;
        if self.day > 0 || step == 0 {
            return self.iterative.act(observation);
        }
        let wanted_c = targets.reference_at(step).iter().zip(temperatures_c);
        wanted_c.map(|(wanted, actual)| (0.1 * (wanted - actual)).clamp(-2.0, 2.0)).collect()
    }

    fn end_of_day(&mut self, record: &DayRecord) -> Result<(), ControlError> {
        self.day += 1;
        self.iterative.end_of_day(record)
    }
}

#[test]
fn costs_of_days_match_independent_code() {
    let (optima, model) = (optima(), testbed());
    let days: Vec<_> = (0..5).map(day).collect();
    let fixed = IterativeSettings {
        stability: Stability::LeastSquares,
        uncertainty: UncertaintySettings { reestimate: false, ..UncertaintySettings::default() },
        ..IterativeSettings::default()
    };
    let variants = [
        ("iter", fixed),
        ("fixed", IterativeSettings { stability: Stability::Fixed, ..fixed }),
        (
            "fixed_rep",
            IterativeSettings { stability: Stability::Fixed, prediction: DisturbancePrediction::Yesterday, ..fixed },
        ),
        ("printed", IterativeSettings { objective: Objective::Nominal, ..fixed }),
    ];
    for (name, weight) in NIGHTS {
        let targets = chapter_3(weight);
        for (kind, settings) in variants {
            let iterative = Iterative::new(settings, lifted()).expect("valid");
            let mut iterative = FeedbackAtNight { iterative, day: 0 };
            let costs: Vec<f64> = run(&model, 29.0, &mut iterative, &targets, &days)
                .iter()
                .map(|record| targets.cost(&record.temperatures_c, &record.heat_kw))
                .collect();
            let wanted = floats(&optima[name]["J_days"][kind]);
            assert_eq!(costs.len(), wanted.len());
            for (got, want) in costs.iter().zip(wanted) {
                assert_close(*got, want, 1e-6);
            }
        }
    }
}

fn seeds(plant: &Model, settings: IterativeSettings, night_weight: f64) -> Vec<Vec<f64>> {
    let targets = chapter_3(night_weight);
    (1..=8)
        .map(|seed| {
            let mut iterative = Iterative::new(settings, Lifted::new(&testbed(), STEPS)).expect("valid");
            let records = run(plant, 29.0, &mut iterative, &targets, &synthetic(seed, 5, 4));
            assert!(records.iter().all(|record| record.requested_kw.iter().all(|kw| kw.abs() <= 2.0)), "limits hold");
            assert!(records.iter().all(|record| record.design.fallback.is_none()));
            records.iter().map(|record| targets.cost(&record.temperatures_c, &record.heat_kw)).collect()
        })
        .collect()
}

fn later_mean(costs: &[f64]) -> f64 {
    costs[1..].iter().sum::<f64>() / (costs.len() - 1) as f64
}

#[test]
fn iterative_design_is_cheaper_than_a_fixed_feedback_on_every_seed() {
    let plain = IterativeSettings::default();
    let fixed = IterativeSettings { stability: Stability::Fixed, ..plain };
    for weight in [1.0, 0.0] {
        for (designed, fixed) in seeds(&testbed(), plain, weight).iter().zip(&seeds(&testbed(), fixed, weight)) {
            assert!(later_mean(designed) < 0.95 * later_mean(fixed), "{designed:?} {fixed:?}");
            assert!(later_mean(designed) < 0.3 * designed[0], "learned after a day: {designed:?}");
        }
    }
}

#[test]
fn costs_fall_from_day_to_day_when_the_model_is_wrong() {
    // The building has 15 % more capacity, and other walls, than the design believes; every day is the same.
    let plant = testbed_scaled(1.15, 1.0 / 0.85, 1.0 / 1.15);
    let targets = chapter_3(1.0);
    let (_, actual) = day(1);
    let mut iterative = Iterative::new(IterativeSettings::default(), lifted()).expect("valid");
    let records = run(&plant, 29.0, &mut iterative, &targets, &vec![(actual.clone(), actual); 6]);
    let costs: Vec<f64> = records.iter().map(|record| targets.cost(&record.temperatures_c, &record.heat_kw)).collect();
    assert!(costs.is_sorted_by(|before, after| after < before), "{costs:?}");
    assert!(costs[1] > 1.02 * costs[5], "{costs:?}");
}

/// Largest μ for which [F + Fᵀ − S, (MF)ᵀ; MF, R] ⪰ μ I for some F and S: positive if the inequality accepts the closed loop `closed`.
/// R is r² S for a decay rate r, with tr S = order, and I as printed in (3.23), with S ⪰ 0.
fn lmi_margin(decay: Option<f64>, closed: &DMatrix<f64>) -> f64 {
    let n = closed.nrows();
    let mut program = Program::new();
    let (f, s) = (program.variables("F", n * n), program.variables("S", n * (n + 1) / 2));
    let margin = program.variables("margin", 1).at(0);
    program.linear(margin, -1.0);
    let s = |i: usize, j: usize| s.at(i.max(j) * (i.max(j) + 1) / 2 + i.min(j));
    let block = program.semidefinite("stability", 2 * n);
    for (i, j, weight) in triangle(2 * n) {
        let (mut entry, mut constant) = (Vec::new(), 0.0);
        match (i < n, j < n) {
            (true, true) => entry.extend([(f.at(i * n + j), 1.0), (f.at(j * n + i), 1.0), (s(i, j), -1.0)]),
            (true, false) => entry.extend((0..n).map(|k| (f.at(k * n + i), closed[(j - n, k)]))),
            (false, _) => match decay {
                Some(decay) => entry.push((s(i - n, j - n), decay * decay)),
                None => constant = f64::from(u8::from(i == j)),
            },
        }
        entry.extend((i == j).then_some((margin, -1.0)));
        program.row(block, entry.into_iter().map(|(variable, value)| (variable, -weight * value)), weight * constant);
    }
    if decay.is_some() {
        let size = program.equal("size of S");
        program.row(size, (0..n).map(|i| (s(i, i), 1.0)), n as f64);
    } else {
        let positive = program.semidefinite("S", n);
        triangle(n).for_each(|(i, j, weight)| program.row(positive, [(s(i, j), -weight)], 0.0));
    }
    let solution = Solver::new(&program, &SolverSettings::default()).expect("well posed").solve().expect("solved");
    solution.at(margin)
}

#[test]
fn the_printed_matrix_inequality_accepts_an_unstable_loop_and_the_corrected_one_refuses_it() {
    let model = testbed();
    let gain = DMatrix::from_diagonal_element(4, 4, 100.0);
    let closed = closed_loop(&model.state_matrix(), &model.gain_matrix(), &gain);
    assert!((spectral_radius(&closed) - 179.17).abs() < 0.1, "{}", spectral_radius(&closed));
    let printed = lmi_margin(None, &closed);
    assert!(printed > 1e-6, "accepted: {printed}");
    let corrected = lmi_margin(Some(1.0), &closed);
    assert!(corrected < -1e-3, "refused: {corrected}");
    assert!(positive_decay(&closed) > 100.0);

    // It refuses what is unstable and accepts what is stable, at every decay rate.
    let stable = closed_loop(&model.state_matrix(), &model.gain_matrix(), &DMatrix::from_diagonal_element(4, 4, 0.2));
    let radius = spectral_radius(&stable);
    assert!((positive_decay(&stable) - radius).abs() < 1e-6, "nonnegative: the vector is as good as the eigenvalue");
    assert!(lmi_margin(Some(1.02 * radius), &stable) > 1e-4);
    let refused = lmi_margin(Some(0.9 * radius), &stable);
    assert!(refused < 1e-7, "{refused:e}: S vanishes where the decay is too slow");
}

#[test]
fn both_certificates_give_the_decay_rate_that_was_asked_for() {
    let lifted = lifted();
    let targets = chapter_3(1.0);
    for stability in [Stability::Lmi, Stability::Linear] {
        for decay in [0.5, 0.7, 0.9] {
            let settings = IterativeSettings { stability, decay: Some(decay), ..IterativeSettings::default() };
            let found = StaticFeedback::design(&settings, &lifted, &targets, covariance(1.0), &[]).expect("designed");
            assert!(found.spectral_radius <= decay, "{stability:?} {decay}: {}", found.spectral_radius);
            assert!(found.causal_cost <= found.cost && found.cost < 18.0, "{stability:?} {decay}: {}", found.cost);
        }
    }
}

#[test]
fn walls_that_store_heat_are_states_without_a_sensor() {
    let zones: Vec<Zone> = ["a", "b"].map(Zone::named).to_vec();
    let walls = [
        Wall::new("a", "b", 40.0).with_capacity_kj_per_k(600.0),
        Wall::new("a", AMBIENT, 30.0).with_capacity_kj_per_k(1500.0),
        Wall::new("b", AMBIENT, 35.0),
    ];
    let model = Model::exact(&Network::new(&zones, &walls).expect("valid"), STEP_S).expect("valid");
    let lifted = Lifted::new(&model, STEPS);
    let setpoints = Setpoints { occupied_c: vec![23.0], ..Setpoints::default() };
    let targets = setpoints.targets(2, STEP_S, STEPS).expect("valid");
    let uncertainty = Uncertainty::new(UncertaintySettings::default()).expect("valid");
    for stability in [Stability::Lmi, Stability::Linear] {
        let settings = IterativeSettings { stability, decay: Some(0.99), ..IterativeSettings::default() };
        let found = StaticFeedback::design(&settings, &lifted, &targets, uncertainty.covariance(&targets), &[])
            .expect("designed");
        let closed = closed_loop(&model.state_matrix(), &model.gain_matrix(), &found.gain_kw_per_k);
        assert!((spectral_radius(&closed) - found.spectral_radius).abs() < 1e-12 && found.spectral_radius < 0.99);
        assert!(
            found.cost
                < feedback::static_feedback(
                    &lifted,
                    &DMatrix::zeros(2, 2),
                    &factor(uncertainty.covariance(&targets)).expect("one")
                )
                .cost(&targets)
        );
    }
}

#[test]
fn the_causal_feedback_is_optimal() {
    // No causal perturbation of the inputs is cheaper, and its conditions hold: Gᵀ W_e G (L + V) + W_u V vanishes where V
    // is free.
    let (lifted, targets) = (lifted(), chapter_3(1.0));
    let factor = factor(covariance(1.0)).expect("a covariance");
    let causal = feedback::optimal_causal(&lifted, &targets, &factor, &[]).expect("designed");
    for column in [0, 3, 17, 90, 187] {
        let first_free = (column / 4 + 1) * 4;
        let weighted: Vec<f64> = causal.temperatures_k.column(column).iter().copied().collect();
        let pull = lifted.transpose_product(&weighted);
        for i in 0..lifted.size() {
            let v = causal.inputs_kw[(i, column)];
            if i < first_free {
                assert_eq!(v, 0.0, "causal");
            } else {
                assert!((pull[i] + v).abs() < 1e-10, "{}", pull[i] + v);
            }
        }
    }
}

#[test]
fn inputs_stay_within_their_limits_with_the_stated_probability() {
    // A day on which the limits bind; the disturbance is drawn from its covariance.
    let (lifted, targets) = (lifted(), chapter_3(1.0));
    let settings = IterativeSettings::default();
    let found = StaticFeedback::design(&settings, &lifted, &targets, covariance(1.0), &[]).expect("designed");
    let factor = factor(covariance(1.0)).expect("a covariance");
    let response = feedback::static_feedback(&lifted, &found.gain_kw_per_k, &factor);
    let quantile = normal_quantile(0.95);
    assert!((quantile - 1.644_853_626_951_472).abs() < 1e-12);
    let draws = 400;
    let noise = normal_numbers(draws * lifted.size());
    let mut beyond = vec![0; lifted.size()];
    for draw in noise.chunks_exact(lifted.size()) {
        for (i, beyond) in beyond.iter_mut().enumerate() {
            let moved: f64 = response.inputs_kw.row(i).iter().zip(draw).map(|(u, w)| u * w).sum();
            *beyond += usize::from(moved > quantile * found.input_deviation_kw[i] + 1e-12);
        }
    }
    let share = beyond.iter().sum::<usize>() as f64 / (draws * (lifted.size() - 4)) as f64;
    assert!((0.04..0.06).contains(&share), "{share} of the inputs go beyond a margin that 0.05 may");
}

#[test]
fn a_failed_design_repeats_the_previous_day_and_gives_the_reason() {
    let targets = chapter_3(1.0);
    let mut days: Vec<_> = (0..5).map(day).collect();
    days[2].0.ambient_c[7] = f64::NAN;
    let mut iterative = Iterative::new(IterativeSettings::default(), lifted()).expect("valid");
    let records = run(&testbed(), 29.0, &mut iterative, &targets, &days);
    let design = &records[2].design;
    assert!(matches!(design.fallback, Some(ControlError::NotFinite { index: 7, .. })), "{:?}", design.fallback);
    assert_eq!(design.planned_kw, records[1].heat_kw, "yesterday's inputs");
    assert_eq!(records.iter().map(|record| record.design.fallbacks).collect::<Vec<_>>(), [0, 0, 1, 1, 1]);
    assert!(records[3].design.fallback.is_none(), "and goes on");
    assert!(targets.cost(&records[2].temperatures_c, &records[2].heat_kw) < 300.0, "yesterday's plan still helps");

    // Growth of the error forbidden: a day that starts hot cannot be as good as a mild one.
    let hard = IterativeSettings { convergence: ErrorGrowth::Hard, ..IterativeSettings::default() };
    let mut iterative = Iterative::new(hard, lifted()).expect("valid");
    let mut hot = day(2);
    hot.0.ambient_c.iter_mut().for_each(|t| *t += 25.0);
    let records = run(&testbed(), 29.0, &mut iterative, &targets, &[day(0), day(1), hot, day(3)]);
    let fallback = &records[2].design.fallback;
    assert!(matches!(fallback, Some(ControlError::Solve(_))), "{fallback:?}");

    // No gain decays that fast.
    let fast = IterativeSettings { stability: Stability::Linear, decay: Some(1e-3), ..IterativeSettings::default() };
    let mut iterative = Iterative::new(fast, lifted()).expect("valid");
    let records = run(&testbed(), 29.0, &mut iterative, &targets, &[day(0), day(1)]);
    assert!(records[1].design.fallbacks <= 1);
}

#[test]
fn a_matrix_that_is_not_a_covariance_is_refused() {
    let contradicting = DMatrix::from_row_slice(3, 3, &[1.0, 0.9, -0.9, 0.9, 1.0, 0.9, -0.9, 0.9, 1.0]);
    assert!(matches!(factor(contradicting), Err(ControlError::Covariance { order: 3 })));
    let mut missing = covariance(1.0);
    missing[(5, 5)] = f64::NAN;
    let error = StaticFeedback::design(&IterativeSettings::default(), &lifted(), &chapter_3(1.0), missing, &[]);
    assert!(matches!(error, Err(ControlError::Covariance { order: 192 })), "{error:?}");
}

#[test]
fn the_uncertainty_is_reestimated_from_prediction_errors() {
    let targets = chapter_3(1.0);
    let settings = UncertaintySettings { prior_days: 2.0, ..UncertaintySettings::default() };
    let truth = UncertaintySettings { common_kw: 0.05, zone_kw: 0.2, zone_other_kw: 0.03, ..settings };
    let factor = factor(Uncertainty::new(truth).expect("valid").covariance(&targets)).expect("a covariance");
    let mut learned = Uncertainty::new(settings).expect("valid");
    for draw in normal_numbers(200 * 192).chunks_exact(192) {
        let surprise: Vec<f64> = factor.row_iter().map(|row| row.iter().zip(draw).map(|(l, w)| l * w).sum()).collect();
        assert!(learned.learn(&surprise, &targets));
    }
    for (got, want) in learned.deviations_kw().iter().zip([0.05, 0.2, 0.03]) {
        assert!((got / want - 1.0).abs() < 0.12, "{:?}", learned.deviations_kw());
    }
}

/// The first day has no plan yet: designs only feed back, and only where temperatures have a weight.
#[test]
fn no_heat_is_used_on_the_first_day_while_temperatures_are_free() {
    let (model, days) = (testbed(), [day(0)]);
    for controller in [
        Controller::Iterative(Default::default()),
        Controller::Concurrent(Default::default()),
        Controller::Distributed(Default::default()),
        Controller::Centralised(Default::default()),
    ] {
        let mut at_work = controller.controller(&model, STEPS).expect("valid");
        let targets = chapter_5(vec![22.5, 22.0, 23.0, 23.5], 4);
        let heat_kw = &run(&model, 28.5, &mut *at_work, &targets, &days)[0].heat_kw;
        for (step, heat_kw) in heat_kw.chunks_exact(4).enumerate() {
            // Occupied from 8:00 to 19:00, both ends included.
            let free = !(16..=38).contains(&step);
            assert!(heat_kw.iter().all(|kw| (*kw == 0.0) == free), "{} step {step}: {heat_kw:?}", controller.kind());
        }
        // With a weight at night there is heat at night.
        let mut at_work = controller.controller(&model, STEPS).expect("valid");
        let heat_kw = &run(&model, 28.5, &mut *at_work, &chapter_3(1.0), &days)[0].heat_kw;
        assert!(heat_kw[4..16 * 4].iter().all(|kw| *kw != 0.0), "{}", controller.kind());
    }
}
