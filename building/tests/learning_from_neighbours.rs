//! Learning from neighbours (eq. 5.1-5.7): its convergence conditions against dense matrices and closed forms, and days of it.

mod common;

use common::reference::{STEP_S, STEPS};
use interplay_building::control::cooperative::{LearnedErrors, LearningLaw};
use interplay_building::control::learning::LearningSettings;
use interplay_building::discretise::Model;
use interplay_building::lifted::Lifted;
use interplay_building::network::Network;
use nalgebra::DMatrix;

fn grid(rows: usize, columns: usize) -> Lifted {
    Lifted::new(&Model::euler(&Network::grid(rows, columns), STEP_S).expect("stable"), STEPS)
}

/// Spectral radius and largest singular value of a map, from all its entries.
fn dense(size: usize, product: impl Fn(&[f64]) -> Vec<f64>) -> [f64; 2] {
    let mut map = DMatrix::zeros(size, size);
    for column in 0..size {
        let mut unit = vec![0.0; size];
        unit[column] = 1.0;
        map.column_mut(column).copy_from_slice(&product(&unit));
    }
    [map.complex_eigenvalues().iter().map(|value| value.norm()).fold(0.0, f64::max), map.singular_values().max()]
}

#[test]
fn convergence_conditions_match_a_dense_computation() {
    let lifted = Lifted::new(&Model::euler(&Network::grid(2, 2), STEP_S).expect("stable"), 8);
    let (change, errors) = (common::numbers(32, 0.5), common::numbers(64, 1.0)[32..].to_vec());
    for law in [LearningLaw::uniform(4, 8, 0.15, 0.88), LearningLaw::recovered(4, &change, &errors)] {
        for gain in [0.0, 0.2] {
            let [_, singular] = dense(32, |unit| law.next_errors_k(&lifted, gain, unit));
            let conditions = law.conditions(&lifted, gain);
            assert!(
                (conditions.largest_singular_value - singular).abs() < 1e-3 * singular,
                "{conditions:?} {singular}"
            );
            // Of a triangular matrix with defects eigenvalues are found to the root of the machine precision only.
            let blocks = (0..8).map(|t| {
                let [radius, _] = dense(4, |unit| {
                    let mut errors = vec![0.0; 32];
                    errors[t * 4..(t + 1) * 4].copy_from_slice(unit);
                    law.next_errors_k(&lifted, gain, &errors)[t * 4..(t + 1) * 4].to_vec()
                });
                radius
            });
            let radius = blocks.fold(0.0, f64::max);
            assert!((conditions.spectral_radius - radius).abs() < 1e-9, "{conditions:?} {radius}");
        }
    }
}

/// The eigenvalues of Ω are 1 plus those of the grid's Laplacian, 4 − 2 cos(πi/10) − 2 cos(πj/10).
#[test]
fn the_spectral_radius_of_a_hundred_zones_matches_its_closed_form() {
    let lifted = grid(10, 10);
    let rise = STEP_S / lifted.model().network().capacities_kj_per_k()[0];
    let cosine = (std::f64::consts::PI / 10.0).cos();
    for (l, errors, largest) in [
        (0.02, LearnedErrors::Own, 1.0),
        (0.1, LearnedErrors::Neighbours, 5.0 + 4.0 * cosine),
        (0.3, LearnedErrors::Neighbours, 5.0 + 4.0 * cosine),
    ] {
        let settings = LearningSettings {
            proportional_kw_per_k: l,
            derivative_kw_per_k: 0.0,
            errors,
            ..LearningSettings::default()
        };
        let wanted = f64::max((1.0 - l * rise).abs(), (1.0 - l * rise * largest).abs());
        let found = settings.convergence(&lifted).spectral_radius;
        assert!((found - wanted).abs() < 0.01 * wanted, "{l} {errors:?}: {found} instead of {wanted}");
    }
}

/// With ones for neighbours Ω of four zones in a square has a negative eigenvalue: whatever the gain, some pattern of errors grows.
#[test]
fn with_the_printed_adjacency_matrix_every_gain_diverges() {
    let lifted = grid(2, 2);
    for l in [0.001, 0.01, 0.1, 0.3] {
        let radius = |errors| {
            let settings =
                LearningSettings { proportional_kw_per_k: l, derivative_kw_per_k: 0.0, errors, ..Default::default() };
            settings.convergence(&lifted).spectral_radius
        };
        assert!(radius(LearnedErrors::NeighboursAsPrinted) > 1.0, "{l}");
        let is_small = l * STEP_S / lifted.model().network().capacities_kj_per_k()[0] < 0.4;
        assert!(!is_small || radius(LearnedErrors::Neighbours) < 1.0, "{l}");
    }
}

/// A zone without a weight learns nothing, and its neighbours learn nothing from it.
#[test]
fn a_zone_with_a_free_temperature_learns_nothing() {
    let lifted = Lifted::new(&Model::euler(&Network::grid(1, 3), STEP_S).expect("stable"), 1);
    let errors = [Some(1.0), Some(3.0), None];
    assert_eq!(LearnedErrors::Own.combine(&lifted, &errors), [1.0, 3.0, 0.0]);
    assert_eq!(LearnedErrors::Neighbours.combine(&lifted, &errors), [-1.0, 5.0, 0.0]);
    assert_eq!(LearnedErrors::NeighboursAsPrinted.combine(&lifted, &errors), [4.0, 4.0, 0.0]);
}
