//! Tests whether residuals are white: autocorrelation, Ljung and Box's test, cumulated periodogram.

use std::ops::Range;

use schemars::JsonSchema;
use serde::Serialize;

use super::chi_squared::survival;
use super::periodogram::boundary_excess;
use crate::staged::dense::dot;

/// The most lags that are looked at.
const MOST_LAGS: usize = 48;

/// Tests of whether residuals are white noise.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Whiteness {
    /// Autocorrelation at lags 1, 2, …
    pub autocorrelation: Vec<f64>,
    /// The bound that 95 % of these keep if the residuals are white, 1.96/√n.
    pub bound: f64,
    /// Ljung and Box's test over all these lags.
    pub ljung_box: LjungBox,
    /// Mean excess of the cumulated periodogram over its 95 % band, of the longest segment (nCPBES); 0 for white residuals.
    pub periodogram_excess: Option<f64>,
    /// The result in words.
    pub words: String,
}

/// Ljung and Box's test: Q = n (n+2) Σ_k ρ_k²/(n−k) is chi-squared if the residuals are white.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct LjungBox {
    /// The statistic Q.
    pub statistic: f64,
    /// Degrees of freedom: lags less the coefficients of the residual model.
    pub degrees: usize,
    /// Probability of so large a Q for white residuals.
    pub p_value: f64,
}

/// The diagnostics of residuals over segments; `fitted` is how many coefficients of the residual model were fitted to them.
pub(in crate::identify) fn whiteness(residuals: &[f64], segments: &[Range<usize>], fitted: usize) -> Whiteness {
    let count: usize = segments.iter().map(Range::len).sum();
    let lags = MOST_LAGS.min(count / 4).max(fitted + 1);
    let variance: f64 =
        segments.iter().map(|segment| dot(&residuals[segment.clone()], &residuals[segment.clone()])).sum();
    let correlation = |lag: usize| -> f64 {
        let long = segments.iter().filter(|segment| segment.len() > lag);
        let sum: f64 = long
            .map(|segment| {
                dot(&residuals[segment.start + lag..segment.end], &residuals[segment.start..segment.end - lag])
            })
            .sum();
        if variance > 0.0 { sum / variance } else { 0.0 }
    };
    let autocorrelation: Vec<f64> = (1..=lags).map(correlation).collect();
    let n = count as f64;
    let terms = autocorrelation.iter().zip(1..).map(|(rho, lag)| rho * rho / (n - f64::from(lag)));
    let statistic = n * (n + 2.0) * terms.sum::<f64>();
    let degrees = lags - fitted;
    let ljung_box = LjungBox { statistic, degrees, p_value: survival(statistic, degrees as f64) };
    let longest = segments.iter().max_by_key(|segment| segment.len());
    let periodogram_excess = longest.and_then(|segment| boundary_excess(&residuals[segment.clone()]));
    let bound = 1.96 / n.max(1.0).sqrt();
    let words = in_words(&autocorrelation, &ljung_box);
    Whiteness { autocorrelation, bound, ljung_box, periodogram_excess, words }
}

fn in_words(autocorrelation: &[f64], test: &LjungBox) -> String {
    let by_size = |a: &(usize, &f64), b: &(usize, &f64)| a.1.abs().total_cmp(&b.1.abs());
    let Some((index, largest)) = autocorrelation.iter().enumerate().max_by(by_size) else {
        return "too few residuals to tell".into();
    };
    let lag = index + 1;
    match test.p_value {
        p if p >= 0.05 => format!("white: no structure is left that this test finds (p = {p:.2})"),
        _ if largest.abs() < 0.1 => format!(
            "not white, but nearly: correlations are small (at most {largest:.2}, lag {lag}), and there are enough data to see them"
        ),
        _ => format!(
            "not white (correlation {largest:.2} at lag {lag}): the model misses something, and standard errors are too small"
        ),
    }
}

/// Half the width of the interval of 95 %, in standard errors: the quantile 0.975 of the normal distribution.
pub(in crate::identify) const STANDARD_ERRORS_OF_95_PERCENT: f64 = 1.96;
/// Largest standard error, as a share of the value, of a coefficient that is not called weak. Chosen: the interval of 95 % is
/// then about ±50 % of the value.
const MAX_RELATIVE_STANDARD_ERROR: f64 = 0.25;

/// Whether the data determine a coefficient.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Confidence {
    /// Known to better than a quarter of its value.
    Identified,
    /// Different from zero, and known no better than to a quarter of its value.
    Weak,
    /// Cannot be told apart from zero: only an upper bound is known.
    NotDistinguishableFromZero,
    /// Two ways of estimating it, or two halves of the data, contradict each other by more than their errors: the model's form
    /// does not fit the building.
    Disputed,
    /// Negative by more than its error, which physics forbids: the model lacks something.
    WrongSign,
    /// The data say nothing of it: its regressor does not vary, or only together with others.
    NotIdentifiable,
}

/// Whether the data determine a coefficient, and in words.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct ParameterVerdict {
    /// How well the coefficient is determined.
    pub confidence: Confidence,
    /// The verdict in words.
    pub words: String,
}

/// Judges a coefficient, which the words call `name`, by its unconstrained value and standard error.
pub(in crate::identify) fn judge(name: &str, value: f64, standard_error: f64) -> ParameterVerdict {
    let relative = standard_error / value.abs();
    let (confidence, words) = match () {
        () if !standard_error.is_finite() || !value.is_finite() => (
            Confidence::NotIdentifiable,
            format!(
                "{name} cannot be identified: in these data its cause does not vary, or only together with another"
            ),
        ),
        () if value < -STANDARD_ERRORS_OF_95_PERCENT * standard_error => (
            Confidence::WrongSign,
            format!("{name} comes out negative, which cannot be: the model lacks something that moves with it"),
        ),
        () if value < STANDARD_ERRORS_OF_95_PERCENT * standard_error => {
            (Confidence::NotDistinguishableFromZero, format!("{name} cannot be told apart from zero"))
        }
        () if relative > MAX_RELATIVE_STANDARD_ERROR => (
            Confidence::Weak,
            format!("{name} is there, but known only to ±{:.0} %", 100.0 * STANDARD_ERRORS_OF_95_PERCENT * relative),
        ),
        () => (
            Confidence::Identified,
            format!("{name} is known to ±{:.1} %", 100.0 * STANDARD_ERRORS_OF_95_PERCENT * relative),
        ),
    };
    ParameterVerdict { confidence, words }
}

#[cfg(test)]
mod tests {
    use super::{Confidence, judge, whiteness};

    #[test]
    fn correlations_do_not_cross_segments() {
        // Alternating signs within segments that start alike: lag 1 sees −1 within, and nothing between.
        let residuals = [1.0, -1.0, 1.0, -1.0, 1.0, -1.0, 1.0, -1.0];
        let split = whiteness(&residuals, &[0..4, 4..8], 0);
        assert!((split.autocorrelation[0] - -6.0 / 8.0).abs() < 1e-15);
        let whole = whiteness(&residuals, std::slice::from_ref(&(0..8)), 0);
        assert!((whole.autocorrelation[0] - -7.0 / 8.0).abs() < 1e-15);
    }

    #[test]
    fn ljung_box_matches_its_formula_and_rejects_a_wave() {
        let wave: Vec<f64> = (0..400).map(|t| (f64::from(t) * 0.3).sin()).collect();
        let found = whiteness(&wave, std::slice::from_ref(&(0..400)), 3);
        let q: f64 =
            found.autocorrelation.iter().enumerate().map(|(k, rho)| rho * rho / (399.0 - k as f64)).sum::<f64>();
        assert!((found.ljung_box.statistic - q * 400.0 * 402.0).abs() < 1e-9 * found.ljung_box.statistic);
        assert_eq!(found.ljung_box.degrees, 45);
        assert!(found.ljung_box.p_value < 1e-6 && found.words.starts_with("not white"), "{}", found.words);
    }

    #[test]
    fn every_verdict_occurs_for_some_value_and_error() {
        for (value, error, confidence) in [
            (1.0, 0.05, Confidence::Identified),
            (1.0, 0.4, Confidence::Weak),
            (1.0, 0.6, Confidence::NotDistinguishableFromZero),
            (-1.0, 0.6, Confidence::NotDistinguishableFromZero),
            (-1.0, 0.4, Confidence::WrongSign),
            (1.0, f64::INFINITY, Confidence::NotIdentifiable),
            (f64::NAN, 0.1, Confidence::NotIdentifiable),
        ] {
            let verdict = judge("x", value, error);
            assert_eq!(verdict.confidence, confidence, "{value} ± {error}");
            assert!(verdict.words.starts_with("x "));
        }
    }
}
