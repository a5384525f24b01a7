//! A published fit: the armadillo record of pySIP (github.com/locie/pySIP, `docs/examples/thermal_network/armadillo`), two
//! states by first-order hold. The record is not in this repository: `INTERPLAY_THERMAL_DATA` names a folder with
//! `armadillo/armadillo_data_H2.csv`.

use nalgebra::DMatrix;

use super::exponential::{Number, exponential, real};
use super::heat_rows::HeatRows;
use super::likelihood::{Observations, evaluate, log_likelihood};
use super::linear_model::{ContinuousModel, InitialState};
use super::scoring::{Ascent, LEAST_GAIN};

const DAY_S: f64 = 86_400.0;

/// pySIP's `TwTi_RoRi` with time in days: θ = ln Rₒ, ln Rᵢ, ln C_w, ln Cᵢ, ln σ_w, ln σ_v, and the envelope's first temperature.
fn two_states(theta: &[Number]) -> ContinuousModel {
    let [ro, ri, cw, ci, sigma_w, sigma_v] = [0, 1, 2, 3, 4, 5].map(|index| exponential(theta[index]));
    let one = real(1.0);
    ContinuousModel {
        dynamics: DMatrix::from_row_slice(
            2,
            2,
            &[-(ro + ri) / (cw * ri * ro), one / (cw * ri), one / (ci * ri), -one / (ci * ri)],
        ),
        inputs: DMatrix::from_row_slice(2, 2, &[one / (cw * ro), real(0.0), real(0.0), one / ci]),
        diffusion: vec![sigma_w * sigma_w, real(0.0)],
        outputs: vec![1],
        sensor_variance: vec![sigma_v * sigma_v],
        unknown_heat_variance: vec![0.0; 2],
        heat_swing: Vec::new(),
        initial: InitialState {
            offset: vec![theta[6], real(26.7)],
            from_outputs: DMatrix::zeros(2, 1),
            from_inputs: DMatrix::zeros(2, 2),
            variance: vec![real(0.01), real(0.01)],
            contains_first_outputs: false,
        },
    }
}

fn record() -> Observations {
    let folder = std::env::var_os("INTERPLAY_THERMAL_DATA").expect("INTERPLAY_THERMAL_DATA names a folder");
    let path = std::path::Path::new(&folder).join("armadillo/armadillo_data_H2.csv");
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let number = |field: &str| field.parse::<f64>().expect("a number");
    let mut rows: Vec<Vec<f64>> = text.lines().skip(1).map(|line| line.split(',').map(number).collect()).collect();
    // The published example omits the last row.
    rows.pop();
    let step = (rows[1][0] - rows[0][0]) / DAY_S;
    let inputs: Vec<f64> = rows.iter().flat_map(|row| [row[1], row[2]]).collect();
    let slope = |index: usize| if index + 2 < inputs.len() { (inputs[index + 2] - inputs[index]) / step } else { 0.0 };
    Observations {
        heat: HeatRows::held(rows.len()),
        step_s: step,
        segments: std::iter::once(0..rows.len()).collect(),
        outputs: rows.iter().map(|row| row[4]).collect(),
        slopes: (0..inputs.len()).map(slope).collect(),
        inputs,
        widths: (1, 2),
    }
}

#[test]
#[ignore = "needs the data of measured buildings in INTERPLAY_THERMAL_DATA"]
fn the_armadillo_record_reproduces_its_published_likelihood_and_parameters() {
    let observations = record();
    let capacity = 1e7 / DAY_S;
    let start = [1e-2, 1e-3, capacity, 0.1 * capacity, 1e-3 * DAY_S.sqrt(), 1e-2].map(f64::ln);
    let start: Vec<f64> = start.into_iter().chain([25.0]).collect();
    let mut bounds: Vec<(f64, f64)> = start.iter().map(|value| (value - 12.0, value + 12.0)).collect();
    bounds[6] = (0.0, 50.0);
    let ascent = Ascent {
        model: &two_states,
        observations: &observations,
        bounds: &bounds,
        constraint: None,
        least_gain: LEAST_GAIN,
    };
    let maximum = ascent.run(&start, 100).expect("a likelihood");
    let found = maximum.evaluation.log_likelihood;
    assert!(maximum.converged && (found - 331.057_569).abs() < 1e-3, "{found}");
    // θ as printed by the published example.
    let published = [0.017_593, 0.001_984, 169.597_112, 18.946_350, 0.521_344, 0.034_325];
    for (index, published) in published.into_iter().enumerate() {
        let ours = maximum.theta[index].exp();
        assert!((ours / published - 1.0).abs() < 1e-3, "{index}: {ours} against {published}");
    }
    assert!((maximum.theta[6] - 26.594_539).abs() < 1e-3, "{}", maximum.theta[6]);
    for j in 0..7 {
        let (mut above, mut below) = (start.clone(), start.clone());
        above[j] += 1e-5;
        below[j] -= 1e-5;
        let value = |theta: &[f64]| log_likelihood(&two_states, theta, &observations).expect("near the start");
        let difference = (value(&above) - value(&below)) / 2e-5;
        let gradient = evaluate(&two_states, &start, &observations).expect("at the start").gradient[j];
        assert!((gradient - difference).abs() < 1e-4 * (1.0 + difference.abs()), "{j}: {gradient} {difference}");
    }
}
