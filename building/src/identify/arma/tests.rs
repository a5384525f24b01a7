//! The laws of the fit: it is the minimum, by another search too; it recovers truth; its errors are honest.

use std::ops::Range;

use interplay_common::random::Random;

use super::{Arma, fit, is_stable, whitened};

const TRUTH: ([f64; 2], f64, f64) = ([1.55, -0.6], 0.4, 0.02);

/// Two recordings of the process with these coefficients and a mean.
fn process(seed: u64, rows: usize, mean: f64) -> (Vec<f64>, [Range<usize>; 2]) {
    let (alpha, mu, deviation) = TRUTH;
    let mut random = Random::new(seed, 9);
    let (mut v1, mut v2, mut e1) = (0.0, 0.0, 0.0);
    let mut series = Vec::new();
    for t in 0..rows + 200 {
        if t == 200 + rows / 3 {
            // The second recording starts elsewhere.
            (v1, v2, e1) = (-v1, v2 + 0.1, 0.0);
        }
        let e = random.normal(0.0, deviation);
        let v = alpha[0] * v1 + alpha[1] * v2 + e + mu * e1;
        (v2, v1, e1) = (v1, v, e);
        if t >= 200 {
            series.push(mean + v);
        }
    }
    (series, [0..rows / 3, rows / 3..rows])
}

fn sum_of_squares(series: &[f64], segments: &[Range<usize>], (mean, alpha, mu): (f64, &[f64], f64)) -> f64 {
    let errors: Vec<f64> = series.iter().map(|value| value - mean).collect();
    whitened(&errors, alpha, mu, segments).iter().map(|e| e * e).sum()
}

#[test]
fn no_step_away_from_the_fit_lowers_the_sum_of_squares() {
    let (series, segments) = process(3, 600, 0.1);
    let found = fit(&[vec![1.0; 600]], &series, &segments, 2).expect("enough rows");
    let (mean, alpha, mu) = (found.regression[0], found.arma.autoregressive.clone(), found.arma.moving_average);
    let best = sum_of_squares(&series, &segments, (mean, &alpha, mu));
    for direction in 0..4 {
        for step in [-1e-4, 1e-4] {
            let shift = |index: usize| if index == direction { step } else { 0.0 };
            let moved = [alpha[0] + shift(1), alpha[1] + shift(2)];
            let cost = sum_of_squares(&series, &segments, (mean + shift(0), &moved, mu + shift(3)));
            assert!(cost > best, "direction {direction}, step {step}: {cost} against {best}");
        }
    }
}

/// For a given μ the filtered series obeys a linear regression; the best μ on a fine grid must be the fit's.
#[test]
fn a_grid_search_over_the_moving_average_finds_the_same_minimum() {
    let (series, segments) = process(5, 500, 0.0);
    let found = fit(&[], &series, &segments, 2).expect("enough rows");
    let regression = |mu: f64| {
        // w = v/(1 + μB) within a segment, from its third row on; then w_t = α₁ w'_{t−1} + α₂ w'_{t−2} + e_t.
        let filter = |lag: usize| super::moving_average_inverted(|t| series[t - lag], 2, mu, &segments, series.len());
        let (y, x) = (filter(0), [filter(1), filter(2)]);
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let determinant = dot(&x[0], &x[0]) * dot(&x[1], &x[1]) - dot(&x[0], &x[1]).powi(2);
        let alpha = [
            (dot(&x[0], &y) * dot(&x[1], &x[1]) - dot(&x[1], &y) * dot(&x[0], &x[1])) / determinant,
            (dot(&x[1], &y) * dot(&x[0], &x[0]) - dot(&x[0], &y) * dot(&x[0], &x[1])) / determinant,
        ];
        (sum_of_squares(&series, &segments, (0.0, &alpha, mu)), alpha)
    };
    let grid = (-970..=970).map(|step| f64::from(step) / 1000.0);
    let best = grid.min_by(|a, b| regression(*a).0.total_cmp(&regression(*b).0)).expect("a grid");
    assert!((best - found.arma.moving_average).abs() < 1e-3);
    let (_, alpha) = regression(found.arma.moving_average);
    for (grid, fitted) in alpha.iter().zip(&found.arma.autoregressive) {
        assert!((grid - fitted).abs() < 1e-5, "{alpha:?} {:?}", found.arma);
    }
}

/// Bias within two standard errors of the mean, and intervals of 95 % that hold the truth about as often as that.
#[test]
fn true_parameters_lie_within_their_confidence_intervals() {
    const SEEDS: u64 = 40;
    let truth = [0.1, TRUTH.0[0], TRUTH.0[1], TRUTH.1];
    let (mut sums, mut squares, mut covered) = ([0.0; 4], [0.0; 4], 0);
    for seed in 0..SEEDS {
        let (series, segments) = process(seed, 1500, truth[0]);
        let found = fit(&[vec![1.0; 1500]], &series, &segments, 2).expect("enough rows");
        assert!(is_stable(&found.arma.autoregressive));
        assert!((found.arma.innovation_sd / TRUTH.2 - 1.0).abs() < 0.08);
        let alpha = &found.arma.autoregressive;
        let values = [found.regression[0], alpha[0], alpha[1], found.arma.moving_average];
        for index in 0..4 {
            let error = values[index] - truth[index];
            sums[index] += error;
            squares[index] += error * error;
            covered += u32::from(error.abs() <= 1.96 * found.covariance[(index, index)].sqrt());
        }
    }
    let count = SEEDS as f64;
    for index in 0..4 {
        let deviation = (squares[index] / count).sqrt();
        assert!((sums[index] / count).abs() < 2.5 * deviation / count.sqrt(), "{index}: {sums:?}");
    }
    assert!(covered >= 140, "{covered} of 160");
}

/// What the corrected M-step (2.14) converges to: least squares of the autoregression alone. It is biased by the moving average.
#[test]
fn an_autoregression_without_moving_average_is_biased() {
    let mut error = 0.0;
    for seed in 0..10 {
        let (series, segments) = process(seed, 1500, 0.0);
        let lag = |lag: usize| super::moving_average_inverted(|t| series[t - lag], 2, 0.0, &segments, series.len());
        let (y, x1, x2) = (lag(0), lag(1), lag(2));
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let determinant = dot(&x1, &x1) * dot(&x2, &x2) - dot(&x1, &x2).powi(2);
        error += (dot(&x1, &y) * dot(&x2, &x2) - dot(&x2, &y) * dot(&x1, &x2)) / determinant - TRUTH.0[0];
    }
    assert!(error / 10.0 > 0.1, "{error}");
}

#[test]
fn a_forecast_follows_the_process_without_new_noise() {
    let arma = Arma { autoregressive: vec![1.55, -0.6], moving_average: 0.4, innovation_sd: 0.02 };
    let forecast = arma.forecast(&[9.0, 1.0, 2.0], 0.5, 3);
    let first = 1.55 * 2.0 - 0.6 * 1.0 + 0.4 * 0.5;
    let second = 1.55 * first - 0.6 * 2.0;
    assert_eq!(forecast, [first, second, 1.55 * second - 0.6 * first]);
    // Without a past it expects nothing.
    assert_eq!(arma.forecast(&[], 0.0, 2), [0.0, 0.0]);
}
