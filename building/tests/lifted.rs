//! The lifted form is the simulation, its transpose and its inverse.

mod common;

use common::{distance, network, numbers};
use interplay_building::discretise::{Form, Model};
use interplay_building::lifted::Lifted;
use interplay_building::network::Network;
use nalgebra::DVector;
use proptest::prelude::*;

const STEP_S: f64 = 1800.0;
const STEPS: usize = 6;

fn forms(network: &Network) -> [Lifted; 2] {
    [Form::Dense, Form::Series].map(|form| {
        let model = Model::exact_in(form, network, STEP_S).expect("a valid step");
        Lifted::new(&model, STEPS)
    })
}

proptest! {
    #[test]
    fn products_with_the_lifted_map_match_its_dense_matrix(network in network(5)) {
        for lifted in forms(&network) {
            let g = lifted.dense();
            let u = DVector::from_vec(numbers(lifted.size(), 2.0));
            prop_assert!(distance(&lifted.product(u.as_slice()), (&g * &u).as_slice()) < 1e-11 * g.amax());
            let back = g.tr_mul(&u);
            prop_assert!(distance(&lifted.transpose_product(u.as_slice()), back.as_slice()) < 1e-11 * g.amax());
        }
    }

    #[test]
    fn solving_the_lifted_map_recovers_the_inputs(network in network(5)) {
        for lifted in forms(&network) {
            let u = numbers(lifted.size(), 2.0);
            let found = lifted.solve(&lifted.product(&u));
            prop_assert!(distance(&found, &u) < 1e-8, "{}", distance(&found, &u));
        }
    }

    #[test]
    fn a_response_is_the_free_response_plus_the_effect_of_inputs(network in network(5), ambient_c in -10.0..35.0) {
        for lifted in forms(&network) {
            let initial_c: Vec<f64> = numbers(network.node_count(), 5.0).iter().map(|x| 25.0 + x).collect();
            let ambient_c = vec![ambient_c; STEPS];
            let (u, w) = (numbers(lifted.size(), 2.0), numbers(lifted.size(), 0.4));
            let day = lifted.response(&initial_c, &u, &ambient_c, &w);
            let free = lifted.free_response(&initial_c, &ambient_c, &w);
            let sum: Vec<f64> = free.iter().zip(lifted.product(&u)).map(|(free, gu)| free + gu).collect();
            prop_assert!(distance(&day, &sum) < 1e-10);
        }
    }
}

#[test]
fn the_matrix_is_lower_triangular_toeplitz_in_the_impulse_response() {
    let model = Model::euler(&Network::testbed(), STEP_S).expect("stable");
    let lifted = Lifted::new(&model, STEPS);
    let (g, markov) = (lifted.dense(), lifted.markov());
    let (a, b) = (model.state_matrix(), model.gain_matrix());
    for row in 0..STEPS {
        for column in 0..STEPS {
            let block = g.view((4 * row, 4 * column), (4, 4));
            if row < column {
                assert_eq!(block.amax(), 0.0, "the future does not act on the past");
            } else {
                assert_eq!(block, markov[row - column]);
                let printed = a.pow((row - column) as u32) * &b;
                assert!((block - printed).amax() < 1e-14);
            }
        }
    }
    assert!((&markov[0] - &b).amax() < 1e-15, "h₁ = B (eq. 2.18)");
}

#[test]
fn disturbances_are_found_from_measured_temperatures() {
    // With massless walls the disturbance is D = w + k T₀, whatever was simulated (after eq. 2.20).
    let network = Network::testbed();
    let lifted = Lifted::new(&Model::exact(&network, STEP_S).expect("valid"), STEPS);
    let initial_c = [26.0, 27.0, 28.0, 29.0];
    let (u, w) = (numbers(lifted.size(), 2.0), numbers(lifted.size(), 0.4));
    let ambient_c: Vec<f64> = (0..STEPS).map(|t| 26.0 + t as f64).collect();
    let measured_c = lifted.response(&initial_c, &u, &ambient_c, &w);
    let none = vec![0.0; lifted.size()];
    let at_rest_c = lifted.free_response(&initial_c, &[0.0; STEPS], &none);
    let risen_k: Vec<f64> = measured_c.iter().zip(&at_rest_c).map(|(t, t_in)| t - t_in).collect();
    for (i, (explained, u)) in lifted.solve(&risen_k).iter().zip(&u).enumerate() {
        let disturbance_kw = w[i] + ambient_c[i / 4] / 31.25;
        assert!((explained - u - disturbance_kw).abs() < 1e-10);
    }
}

#[test]
fn a_horizon_of_zero_steps_has_empty_signals() {
    let lifted = Lifted::new(&Model::exact(&Network::testbed(), STEP_S).expect("valid"), 0);
    assert!(lifted.product(&[]).is_empty() && lifted.markov().is_empty());
}
