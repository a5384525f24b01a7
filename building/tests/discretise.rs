//! Discretisation: heat is conserved, the exact one is exact, and a wrong reading of the units is refused.

mod common;

use common::{distance, isolated_network, network, numbers};
use interplay_building::discretise::{Form, Model, ModelError};
use interplay_building::lifted::Lifted;
use interplay_building::network::{AMBIENT, Network, Wall, Zone};
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

const HALF_HOUR_S: f64 = 1800.0;

/// The exact model in both forms, and Euler's at a step that it can take.
fn models(network: &Network, step_s: f64) -> Vec<Model> {
    let euler = Model::euler(network, step_s).or_else(|error| match error {
        ModelError::Unstable { largest_step_s, .. } => Model::euler(network, 0.9 * largest_step_s),
        other => Err(other),
    });
    vec![
        Model::exact_in(Form::Dense, network, step_s).expect("a valid step"),
        Model::exact_in(Form::Series, network, step_s).expect("a valid step"),
        euler.expect("a stable step"),
    ]
}

fn exact(network: &Network, step_s: f64) -> Model {
    Model::exact(network, step_s).expect("a valid step")
}

proptest! {
    #[test]
    fn an_isolated_building_stores_all_heat_that_enters(network in isolated_network(8), step_s in 30.0..7200.0) {
        let n = network.zone_count();
        for model in models(&network, step_s) {
            let mut temperatures_c: Vec<f64> = numbers(network.node_count(), 10.0).iter().map(|x| 22.0 + x).collect();
            let capacities = network.capacities_kj_per_k();
            let stored_kj =
                |temperatures_c: &[f64]| -> f64 { capacities.iter().zip(temperatures_c).map(|(c, t)| c * t).sum() };
            for step in 0..5 {
                let before_kj = stored_kj(&temperatures_c);
                let heat_kw = &numbers(n * 5, 2.0)[step * n..(step + 1) * n];
                model.step(&mut temperatures_c, heat_kw, 5.0, &vec![0.3; n]);
                let entered_kj = model.step_s() * (heat_kw.iter().sum::<f64>() + 0.3 * n as f64);
                let missing_kj = stored_kj(&temperatures_c) - before_kj - entered_kj;
                prop_assert!(missing_kj.abs() <= 1e-9 * before_kj.abs(), "{missing_kj} kJ of {before_kj} kJ");
            }
        }
    }

    #[test]
    fn dense_matrices_and_chebyshev_series_give_the_same_step(network in network(8), step_s in 1.0..40_000.0) {
        let [dense, series, _] = &models(&network, step_s)[..] else { unreachable!("three models") };
        prop_assert!((dense.state_matrix() - series.state_matrix()).amax() < 1e-13);
        let difference = (dense.gain_matrix() - series.gain_matrix()).amax();
        prop_assert!(difference < 1e-13 * dense.gain_matrix().amax(), "{difference:e}");
    }

    #[test]
    fn the_exact_step_is_the_matrix_exponential(network in network(5), step_s in 60.0..7200.0) {
        // exp [−C⁻¹L C⁻¹; 0 0]h = [A B; 0 I], computed by another method (Padé) in another library.
        let (n, zones) = (network.node_count(), network.zone_count());
        let mut block = DMatrix::zeros(n + zones, n + zones);
        for i in 0..n {
            let rate: f64 = step_s / network.capacities_kj_per_k()[i];
            for j in 0..n {
                block[(i, j)] = -rate * network.laplacian()[(i, j)];
            }
            if i < zones {
                block[(i, n + i)] = rate;
            }
        }
        let exponential = block.exp();
        let model = exact(&network, step_s);
        prop_assert!((exponential.view((0, 0), (n, n)) - model.state_matrix()).amax() < 1e-12);
        let gain = model.gain_matrix();
        prop_assert!((exponential.view((0, n), (n, zones)) - &gain).amax() < 1e-12 * gain.amax());
    }

    #[test]
    fn without_heat_temperatures_stay_between_the_coldest_and_the_warmest(network in network(8), step_s in 1.0..40_000.0) {
        let model = exact(&network, step_s);
        let mut temperatures_c = numbers(network.node_count(), 15.0);
        let (low, high) = temperatures_c.iter().fold((5.0_f64, 5.0_f64), |(l, h), &t| (l.min(t), h.max(t)));
        let none = vec![0.0; network.zone_count()];
        for _ in 0..20 {
            model.step(&mut temperatures_c, &none, 5.0, &none);
            prop_assert!(temperatures_c.iter().all(|&t| low - 1e-9 <= t && t <= high + 1e-9));
        }
    }

    #[test]
    fn the_transpose_product_of_the_model_is_adjoint_to_its_product(network in network(6), step_s in 60.0..7200.0) {
        for model in models(&network, step_s) {
            let n = network.node_count();
            let (x, y) = (numbers(n, 1.0), numbers(2 * n, 1.0)[n..].to_vec());
            let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
            let there = dot(&y, &model.state_product(&x));
            let back = dot(&model.state_transpose_product(&y), &x);
            prop_assert!((there - back).abs() < 1e-12 * n as f64);
        }
    }
}

#[test]
fn fine_euler_steps_approach_the_exact_step() {
    let network = Network::testbed();
    let heat_kw = [1.0, -2.0, 0.5, 0.0];
    let gains_kw = [0.3, 0.4, 0.3, 0.45];
    let start_c = [24.0, 29.0, 26.0, 27.0];
    let mut exactly_c = start_c;
    exact(&network, HALF_HOUR_S).step(&mut exactly_c, &heat_kw, 31.0, &gains_kw);
    let error_k = |parts: u32| {
        let model = Model::euler(&network, HALF_HOUR_S / f64::from(parts)).expect("stable");
        let mut temperatures_c = start_c;
        for _ in 0..parts {
            model.step(&mut temperatures_c, &heat_kw, 31.0, &gains_kw);
        }
        distance(&temperatures_c, &exactly_c)
    };
    // First order: half the step, half the error, down to where nothing but rounding is left.
    assert!(error_k(1) > 0.01, "Euler is not exact");
    for parts in [64, 1024, 16_384] {
        let ratio = error_k(parts) / error_k(2 * parts);
        assert!((ratio - 2.0).abs() < 0.01, "{ratio} at {parts} parts");
    }
    assert!(error_k(1 << 17) < 5e-6);
}

#[test]
fn two_half_steps_equal_one_step_and_the_steady_state_is_kept() {
    let network = Network::grid(3, 4);
    let n = network.zone_count();
    let heat_kw = numbers(n, 2.0);
    let none = vec![0.0; n];
    let (mut once_c, mut twice_c) = (vec![27.0; n], vec![27.0; n]);
    exact(&network, HALF_HOUR_S).step(&mut once_c, &heat_kw, 30.0, &none);
    let half = exact(&network, 0.5 * HALF_HOUR_S);
    half.step(&mut twice_c, &heat_kw, 30.0, &none);
    half.step(&mut twice_c, &heat_kw, 30.0, &none);
    assert!(distance(&once_c, &twice_c) < 1e-12);

    let driving_kw: Vec<f64> = heat_kw.iter().zip(network.ambient_kw_per_k()).map(|(u, k)| u + 30.0 * k).collect();
    let steady = network.laplacian().lu().solve(&DVector::from_vec(driving_kw)).expect("heat has a way out");
    let mut temperatures_c: Vec<f64> = steady.iter().copied().collect();
    exact(&network, 86_400.0).step(&mut temperatures_c, &heat_kw, 30.0, &none);
    assert!(distance(&temperatures_c, steady.as_slice()) < 1e-11);
}

#[test]
fn the_testbed_has_the_published_eigenvalues() {
    let model = Model::euler(&Network::testbed(), HALF_HOUR_S).expect("stable in the right units");
    for (got, want) in model.eigenvalues().iter().zip([0.8272, 0.8848, 0.8848, 0.9424]) {
        assert!((got - want).abs() < 1e-12, "{got} {want}");
    }
    assert!((model.gain_matrix() - DMatrix::identity(4, 4) * 1.8).amax() < 1e-15);
    let hours: Vec<f64> = Network::testbed().time_constants_s().iter().map(|s| s / 3600.0).collect();
    for (got, want) in hours.iter().zip([8.68, 4.34, 4.34, 2.89]) {
        assert!((got - want).abs() < 0.005, "{got} {want}");
    }
    // The eigenvalues are those of A.
    let of_matrix = model.state_matrix().symmetric_eigenvalues();
    let mut of_matrix: Vec<f64> = of_matrix.iter().copied().collect();
    of_matrix.sort_by(f64::total_cmp);
    assert!(distance(&of_matrix, &model.eigenvalues()) < 1e-12);
}

/// The testbed with the numbers of Table 2.1 taken for resistances in K/kW.
fn misread(room_to_room: f64, room_to_ambient: f64) -> Network {
    let zones: Vec<Zone> = ["1", "2", "3", "4"].map(Zone::named).to_vec();
    let mut walls: Vec<Wall> =
        [("1", "2"), ("1", "3"), ("2", "4"), ("3", "4")].map(|(a, b)| Wall::new(a, b, room_to_room)).to_vec();
    walls.extend(["1", "2", "3", "4"].map(|zone| Wall::new(zone, AMBIENT, room_to_ambient)));
    Network::new(&zones, &walls).expect("valid numbers")
}

#[test]
fn a_wrong_reading_of_the_units_is_refused_with_the_largest_stable_step() {
    // Printed: kW/K. As resistances in K/kW, and as conductances.
    for (misread, largest_s) in [(misread(1.0417, 0.5208), 346.0), (misread(1.0 / 1.0417, 1.0 / 0.5208), 426.0)] {
        let error = Model::euler(&misread, HALF_HOUR_S).expect_err("unstable");
        let ModelError::Unstable { largest_step_s, .. } = error else { panic!("{error}") };
        assert!((largest_step_s - largest_s).abs() < 2.0, "{largest_step_s}");
        assert!(error.to_string().contains(&format!("largest stable step is {largest_step_s:.1} s")), "{error}");
        // The named step is the boundary, and the exact discretisation needs none.
        assert!(Model::euler(&misread, 0.999 * largest_step_s).is_ok());
        assert!(Model::euler(&misread, 1.001 * largest_step_s).is_err());
        assert!(exact(&misread, HALF_HOUR_S).eigenvalues().iter().all(|e| (0.0..1.0).contains(e)));
    }
}

#[test]
fn a_step_that_is_not_a_positive_duration_is_refused() {
    for step_s in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(Model::exact(&Network::testbed(), step_s), Err(ModelError::BadStep { .. })));
        assert!(matches!(Model::euler(&Network::testbed(), step_s), Err(ModelError::BadStep { .. })));
    }
}

#[test]
fn an_isolated_zone_integrates_its_heat() {
    let network = Network::new(&[Zone::named("a")], &[]).expect("allowed");
    for model in models(&network, HALF_HOUR_S) {
        let mut temperatures_c = [20.0];
        model.step(&mut temperatures_c, &[1.0], -30.0, &[0.5]);
        assert!((temperatures_c[0] - (20.0 + 1.5 * 1.8)).abs() < 1e-12);
    }
}

#[test]
fn a_stiff_network_is_stepped_exactly() {
    // A pane of glass of 0.1 kJ/K: its rate times the step is 3600.
    let walls = [Wall::new("a", AMBIENT, 20.0).with_capacity_kj_per_k(0.1), Wall::new("a", "b", 60.0)];
    let zones = [Zone::named("a"), Zone::named("b")];
    let network = Network::new(&zones, &walls).expect("valid");
    let dense = Model::exact_in(Form::Dense, &network, HALF_HOUR_S).expect("valid");
    let series = Model::exact_in(Form::Series, &network, HALF_HOUR_S).expect("valid");
    assert!((dense.state_matrix() - series.state_matrix()).amax() < 1e-12);
    let massless = Network::new(&zones, &[Wall::new("a", AMBIENT, 20.0), Wall::new("a", "b", 60.0)]).expect("valid");
    let slow = exact(&massless, HALF_HOUR_S).state_matrix();
    assert!((dense.state_matrix().view((0, 0), (2, 2)) - slow).amax() < 1e-3);
}

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
