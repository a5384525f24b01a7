//! Checks of an estimate by another estimator and by each half of the data.
//!
//! Standard errors assume that the model's form is right. Where it is not (a hidden mass, doors, a sensor in the wrong
//! place), estimators that weight fast and slow variations differently give different numbers, and so do different weeks.
//! So each zone is also estimated by the other method and on each half of its data. Where two estimates differ by more than
//! three standard errors, the coefficient is disputed, and does not count as identified.

use std::ops::Range;

use super::estimate::{Estimate, estimate};
use super::regression::ZoneModel;
use super::report::CrossCheck;
use super::telemetry::Telemetry;
use super::{Estimator, IdentifyError, IdentifySettings};

/// Estimates that differ by more than this many standard errors of the difference dispute one another. Normal errors alone
/// exceed it in 0.3 % of the cases.
const MAX_UNDISPUTED_STANDARD_ERRORS: f64 = 3.0;

/// An estimate with its cross-checks.
#[derive(Debug, Clone)]
pub(super) struct CheckedEstimate {
    pub estimate: Estimate,
    pub others: Vec<OtherEstimate>,
}

/// An estimate by another method or from other rows.
#[derive(Debug, Clone)]
pub(super) struct OtherEstimate {
    how: String,
    estimate: Estimate,
}

impl CheckedEstimate {
    /// Estimates by the method of the settings, and for cross-checks as far as the data suffice.
    ///
    /// # Errors
    /// [`IdentifyError`] when the data do not suffice for the first.
    pub fn new(
        telemetry: &Telemetry,
        model: &ZoneModel,
        segments: &[Range<usize>],
        settings: &IdentifySettings,
    ) -> Result<Self, IdentifyError> {
        let (other, name) = match settings.method {
            Estimator::Semiparametric => (Estimator::PredictionError, "by prediction-error"),
            Estimator::PredictionError | Estimator::StateSpace => (Estimator::Semiparametric, "by semiparametric"),
        };
        let other = IdentifySettings { method: other, ..settings.clone() };
        let (first, second) = halves(segments);
        let ways: [(&str, &IdentifySettings, &[Range<usize>]); 3] = [
            (name, &other, segments),
            ("in the first half", settings, &first),
            ("in the second half", settings, &second),
        ];
        let main = estimate(telemetry, model, segments, settings)?;
        // With too few rows, a check is left out.
        let check = |(how, settings, segments): (&str, &IdentifySettings, &[Range<usize>])| {
            let estimate = estimate(telemetry, model, segments, settings).ok()?;
            Some(OtherEstimate { how: how.into(), estimate })
        };
        Ok(Self { estimate: main, others: ways.into_iter().filter_map(check).collect() })
    }

    /// Describes the first cross-check that disputes a coefficient, which is called `name`.
    pub fn dispute(&self, index: usize, name: &str) -> Option<String> {
        let (value, error) = of_coefficient(&self.estimate, index);
        self.others.iter().find_map(|other| {
            let (contrary, contrary_error) = of_coefficient(&other.estimate, index);
            let distance = (value - contrary).abs() / (error * error + contrary_error * contrary_error).sqrt();
            let (how, ratio) = (&other.how, contrary / value);
            (distance > MAX_UNDISPUTED_STANDARD_ERRORS)
                .then(|| format!("{how} {name} is {ratio:.2} times as large, {distance:.0} standard errors away"))
        })
    }
}

impl OtherEstimate {
    /// The estimate of a coefficient by this cross-check.
    pub fn check(&self, index: usize) -> CrossCheck {
        let (value, error) = of_coefficient(&self.estimate, index);
        let known = error.is_finite();
        CrossCheck { how: self.how.clone(), value: known.then_some(value), standard_error: known.then_some(error) }
    }
}

/// An unconstrained coefficient and its standard error.
fn of_coefficient(estimate: &Estimate, index: usize) -> (f64, f64) {
    (estimate.unconstrained[index], estimate.covariance[(index, index)].sqrt())
}

/// The first and the second half of the rows.
fn halves(segments: &[Range<usize>]) -> (Vec<Range<usize>>, Vec<Range<usize>>) {
    let half = segments.iter().map(Range::len).sum::<usize>() / 2;
    let (mut first, mut second, mut seen) = (Vec::new(), Vec::new(), 0);
    for segment in segments {
        let middle = (segment.start + half.saturating_sub(seen)).min(segment.end);
        first.push(segment.start..middle);
        second.push(middle..segment.end);
        seen += segment.len();
    }
    let filled = |part: Vec<Range<usize>>| part.into_iter().filter(|rows| !rows.is_empty()).collect();
    (filled(first), filled(second))
}

#[cfg(test)]
mod tests {
    use super::halves;

    #[test]
    fn halves_share_the_rows_in_order() {
        let rows = |pieces: &[(usize, usize)]| pieces.iter().map(|&(start, end)| start..end).collect::<Vec<_>>();
        for (all, first, second) in [
            (rows(&[(0, 10)]), rows(&[(0, 5)]), rows(&[(5, 10)])),
            (rows(&[(0, 4), (10, 16)]), rows(&[(0, 4), (10, 11)]), rows(&[(11, 16)])),
            (rows(&[(0, 8), (10, 12)]), rows(&[(0, 5)]), rows(&[(5, 8), (10, 12)])),
        ] {
            assert_eq!(halves(&all), (first, second));
        }
    }
}
