//! Verdicts on whether the data determine a coefficient.

use schemars::JsonSchema;
use serde::Serialize;

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
    use super::{Confidence, judge};

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
