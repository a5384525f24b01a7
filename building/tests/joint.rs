//! Feedback and plan that share the limits: against the cone programme itself, and against the two-stage design.

mod common;

use common::reference::*;
use interplay_building::comfort::{Setpoints, Targets};
use interplay_building::control::iterative::{Coordination, Iterative, IterativeSettings, joint};
use interplay_building::control::uncertainty::{Uncertainty, UncertaintySettings, factor, normal_quantile};
use interplay_building::discretise::Model;
use interplay_building::lifted::Lifted;
use interplay_building::network::Network;
use interplay_convex::{Program, Solver, SolverSettings};
use nalgebra::{DMatrix, DVector};

/// The joint problem as a second-order cone programme in all entries of (Y − I) L, dense; its optimal cost.
fn posed(lifted: &Lifted, targets: &Targets, free_c: &[f64], factor: &DMatrix<f64>, quantile: f64) -> f64 {
    let (n, size) = (lifted.zones(), lifted.size());
    let g = lifted.dense();
    let weights = DMatrix::from_diagonal(&DVector::from_column_slice(&targets.error_weight));
    let curvature =
        g.tr_mul(&(&weights * &g)) + DMatrix::from_diagonal(&DVector::from_column_slice(&targets.input_weight));
    let mut program = Program::new();
    let input = program.variables("plan", size);
    let wanted = DVector::from_fn(size, |i, _| targets.reference_c[i] - free_c[i]);
    let pull = g.tr_mul(&(&weights * &wanted));
    let mut constant = wanted.dot(&(&weights * &wanted));
    let entries = program.variables("entries", size * size);
    let at = |i: usize, j: usize| entries.at(j * size + i);
    let causal = |i: usize, j: usize| i / n > j / n;
    let fixed = program.equal("causal");
    for (i, u) in input.iter().enumerate() {
        program.linear(u, -2.0 * pull[i]);
    }
    for column in 0..size {
        let own = factor.column(column);
        let slope = g.tr_mul(&(&weights * (&g * own)));
        constant += (&g * own).dot(&(&weights * (&g * own)));
        for i in 0..size {
            program.linear(at(i, column), 2.0 * slope[i]);
            if !causal(i, column) {
                program.row(fixed, [(at(i, column), 1.0)], 0.0);
            }
        }
    }
    for j in 0..size {
        for i in 0..=j {
            program.quadratic(input.at(i), input.at(j), 2.0 * curvature[(i, j)]);
            for column in 0..size {
                program.quadratic(at(i, column), at(j, column), 2.0 * curvature[(i, j)]);
            }
        }
    }
    for (i, sign) in (0..size).flat_map(|i| [(i, 1.0), (i, -1.0)]) {
        let cone = program.second_order(format!("limit {i} {sign}"), size + 1);
        program.row(cone, [(input.at(i), sign / quantile)], 2.0 / quantile);
        for column in 0..size {
            program.row(cone, [(at(i, column), -1.0)], 0.0);
        }
    }
    let solution = Solver::new(&program, &SolverSettings::default()).expect("posed").solve().expect("solved");
    solution.objective + constant
}

/// Two rooms in steps of two hours, wanted so cold by day and so warm by night that the limits bind.
fn hard_day() -> (Lifted, Targets, Vec<f64>, DMatrix<f64>) {
    let model = Model::exact(&Network::grid(1, 2), 7200.0).expect("valid");
    let lifted = Lifted::new(&model, 12);
    let setpoints = Setpoints { occupied_c: vec![10.0, 14.0], other_c: Some(30.0), ..Setpoints::default() };
    let targets = setpoints.targets(2, 7200.0, 12).expect("valid");
    let free_c = lifted.free_response(&[28.0; 2], &[30.0; 12], &[0.3; 24]);
    let uncertainty = UncertaintySettings { zone_kw: 0.2, zone_other_kw: 0.2, ..UncertaintySettings::default() };
    let covariance = Uncertainty::new(uncertainty).expect("valid").covariance(&targets);
    (lifted, targets, free_c, factor(covariance).expect("a covariance"))
}

#[test]
fn exchanging_prices_solves_the_cone_programme() {
    let (lifted, targets, free_c, factor) = hard_day();
    let quantile = normal_quantile(0.95);
    let found = joint::design(&lifted, &targets, &free_c, &factor, quantile).expect("designed");
    let wanted = posed(&lifted, &targets, &free_c, &factor, quantile);
    assert_close(found.cost, wanted, 1e-5);
    assert!(found.two_stage_cost > 1.001 * found.cost, "limits bind: {} {}", found.two_stage_cost, found.cost);
    for (u, deviation_kw) in found.plan.heat_kw.iter().zip(found.response.input_deviation_kw()) {
        assert!(u.abs() + quantile * deviation_kw <= 2.0 + 1e-6);
    }
}

#[test]
fn the_two_stage_design_costs_a_few_percent_more_than_the_joint_one() {
    // Rooms wanted so cold by day and warm by night that equipment is at its limits around eight and seven.
    let setpoints = Setpoints { occupied_c: vec![20.0, 21.0, 22.0, 23.0], other_c: Some(30.0), ..Setpoints::default() };
    let (lifted, targets) = (lifted(), setpoints.targets(4, STEP_S, STEPS).expect("valid"));
    let forecast = day(1).0;
    let free_c = lifted.free_response(&[29.0; 4], &forecast.ambient_c, &forecast.gains_kw);
    let covariance = Uncertainty::new(UncertaintySettings::default()).expect("valid").covariance(&targets);
    let factor = factor(covariance).expect("a covariance");
    let found = joint::design(&lifted, &targets, &free_c, &factor, normal_quantile(0.95)).expect("designed");
    let dearer = found.two_stage_cost / found.cost - 1.0;
    assert!((0.02..0.07).contains(&dearer), "{dearer} after {} rounds", found.rounds);
}

#[test]
fn the_joint_design_runs_several_days() {
    let targets = chapter_3(1.0);
    let days: Vec<_> = (0..3).map(day).collect();
    let settings = IterativeSettings { coordination: Coordination::Joint, ..IterativeSettings::default() };
    let mut iterative = Iterative::new(settings, lifted()).expect("valid");
    let records = run(&testbed(), 29.0, &mut iterative, &targets, &days);
    for record in &records[1..] {
        assert_eq!(record.design.fallback, None);
        assert!(targets.cost(&record.temperatures_c, &record.heat_kw) < 80.0);
        assert!(record.design.spectral_radius < Some(0.7));
    }
}
