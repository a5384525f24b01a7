//! A wall between two zones has one resistance, which is estimated from either side: R_ij = a_i/b_ij = a_j/b_ji. Where the two
//! estimates disagree, the network lacks a path of heat, such as air through a door or an unmeasured mass.

use super::diagnostics::STANDARD_ERRORS_OF_95_PERCENT;
use super::report::{Quantity, WallReport};

/// The estimate of a wall's conductance from one side \[kW/K\].
pub(super) struct SideEstimate {
    zone: String,
    /// With standard error, where it is determined.
    estimate: Option<(f64, f64)>,
    /// Interval of 95 %; infinite where there is no bound.
    interval: (f64, f64),
}

impl SideEstimate {
    /// The estimate from a zone's side; `None` without a conductance.
    pub fn new(zone: &str, conductance: Option<&Quantity>) -> Self {
        let (low, high) = conductance.map_or((None, None), |quantity| quantity.interval);
        Self {
            zone: zone.into(),
            estimate: conductance.and_then(|quantity| quantity.value.zip(quantity.standard_error)),
            interval: (low.unwrap_or(0.0), high.unwrap_or(f64::INFINITY)),
        }
    }
}

/// Compares the estimates from both sides.
pub(super) fn compare(first: &SideEstimate, second: &SideEstimate) -> WallReport {
    let (combined, words) = match (first.estimate, second.estimate) {
        (Some(one), Some(other)) => combine(one, other),
        (Some(estimate), None) => alone(first, estimate, second),
        (None, Some(estimate)) => alone(second, estimate, first),
        (None, None) => (None, "neither side determines it".into()),
    };
    WallReport {
        between: (first.zone.clone(), second.zone.clone()),
        from_first: first.estimate,
        from_second: second.estimate,
        combined,
        words,
    }
}

/// The mean of two estimates, weighted by their precision, if they agree.
fn combine(one: (f64, f64), other: (f64, f64)) -> (Option<(f64, f64)>, String) {
    let precision = (1.0 / (one.1 * one.1), 1.0 / (other.1 * other.1));
    let total = precision.0 + precision.1;
    let distance = (one.0 - other.0).abs() / (one.1 * one.1 + other.1 * other.1).sqrt();
    if distance <= STANDARD_ERRORS_OF_95_PERCENT {
        let mean = (one.0 * precision.0 + other.0 * precision.1) / total;
        return (Some((mean, 1.0 / total.sqrt())), format!("both sides agree ({distance:.1} standard errors apart)"));
    }
    (None, format!("the sides disagree by {distance:.0} standard errors: this is not one resistance"))
}

/// The result where one side has an estimate and the other at most a bound.
fn alone(side: &SideEstimate, estimate: (f64, f64), other: &SideEstimate) -> (Option<(f64, f64)>, String) {
    if side.interval.1 < other.interval.0 {
        let words = format!(
            "{} and {} disagree: at most {:.3} kW/K, and at least {:.3}; this is not one resistance",
            side.zone, other.zone, side.interval.1, other.interval.0
        );
        return (None, words);
    }
    (Some(estimate), format!("only {} determines it", side.zone))
}

#[cfg(test)]
mod tests {
    use super::{SideEstimate, compare};

    fn side_estimate(zone: &str, estimate: Option<(f64, f64)>, interval: (f64, f64)) -> SideEstimate {
        SideEstimate { zone: zone.into(), estimate, interval }
    }

    #[test]
    fn agreement_is_the_weighted_mean_and_contradiction_has_none() {
        let a = side_estimate("a", Some((1.0, 0.1)), (0.8, 1.2));
        let b = side_estimate("b", Some((1.2, 0.2)), (0.8, 1.6));
        let (mean, error) = compare(&a, &b).combined.expect("they agree");
        assert!(
            (mean - (1.0 * 100.0 + 1.2 * 25.0) / 125.0).abs() < 1e-12 && (error - 1.0 / 125.0_f64.sqrt()).abs() < 1e-12
        );
        let far = side_estimate("c", Some((3.0, 0.2)), (2.6, 3.4));
        assert_eq!(compare(&a, &far).combined, None);
    }

    #[test]
    fn a_bound_can_contradict_too() {
        let a = side_estimate("a", Some((1.0, 0.1)), (0.8, 1.2));
        let above = side_estimate("b", None, (2.0, f64::INFINITY));
        let report = compare(&above, &a);
        assert_eq!(report.combined, None);
        assert!(
            report.words.starts_with("a and b disagree: at most 1.200 kW/K, and at least 2.000"),
            "{}",
            report.words
        );
        let below = side_estimate("b", None, (0.5, f64::INFINITY));
        assert_eq!(compare(&a, &below).combined, Some((1.0, 0.1)));
        assert_eq!(compare(&below, &below).words, "neither side determines it");
    }
}
