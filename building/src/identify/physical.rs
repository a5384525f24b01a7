//! Physical quantities from the coefficients: capacities, conductances, resistances, with intervals.
//!
//! All are ratios f = n/d of n = n₀ + νᵀθ and d = d₀ + δᵀθ. Standard errors are to first order. Intervals are Fieller's: all f
//! for which n − f d may be zero,
//!
//! ```text
//! (n − f d)² ≤ z² (ν − f δ)ᵀ Σ (ν − f δ)
//! ```
//!
//! which has no upper end when d itself may be zero. Then only a lower bound is known, and no value is given.

use nalgebra::DMatrix;

use super::diagnostics::{Confidence, ParameterVerdict, STANDARD_ERRORS_OF_95_PERCENT, judge};
use super::estimate::Estimate;
use super::regression::Coefficient;
use super::report::Quantity;

/// A zone's coefficients with what turns them into physical quantities.
pub(super) struct Physical<'a> {
    pub coefficients: &'a [Coefficient],
    /// As estimated, or as rates of the continuous network.
    pub estimate: &'a Estimate,
    /// Whether heat is in kW.
    pub heat_has_unit: bool,
}

/// constant + weightsᵀθ.
struct Linear {
    constant: f64,
    weights: Vec<f64>,
}

impl Physical<'_> {
    /// The coefficients of eq. 2.3 themselves.
    pub fn coefficients(&self) -> Vec<Quantity> {
        (0..self.coefficients.len()).map(|index| self.coefficient(index)).collect()
    }

    fn coefficient(&self, index: usize) -> Quantity {
        let (name, symbol, unit) = self.labels(index);
        let unconstrained = self.estimate.unconstrained[index];
        let error = self.error(index);
        let verdict = judge(&name, unconstrained, error);
        let known = verdict.confidence != Confidence::NotIdentifiable;
        let end = |sign: f64| (unconstrained + sign * STANDARD_ERRORS_OF_95_PERCENT * error).max(0.0);
        Quantity {
            symbol: symbol.into(),
            unit: unit.into(),
            value: known.then_some(self.estimate.coefficients[index]),
            standard_error: known.then_some(error),
            interval: if known { (Some(end(-1.0)), Some(end(1.0))) } else { (None, None) },
            name,
            verdict,
            checks: Vec::new(),
        }
    }

    /// Name, symbol and unit of a coefficient.
    fn labels(&self, index: usize) -> (String, &'static str, &'static str) {
        match &self.coefficients[index] {
            Coefficient::Wall { to } => (format!("rate towards {to}"), "b", "1/s"),
            Coefficient::Heat if self.heat_has_unit => ("effect of heat".into(), "a", "K/kJ"),
            Coefficient::Heat => ("effect of the heat signal".into(), "a", "K/(unit·s)"),
            Coefficient::Solar => ("effect of sun".into(), "s", "K·m²/kJ"),
        }
    }

    fn error(&self, index: usize) -> f64 {
        self.estimate.covariance[(index, index)].sqrt()
    }

    /// The physical quantities that follow from the coefficients.
    pub fn quantities(&self) -> Vec<Quantity> {
        let mut quantities = vec![self.capacity()];
        for (index, coefficient) in self.coefficients.iter().enumerate() {
            if let Coefficient::Wall { to } = coefficient {
                quantities.push(self.conductance(index, to));
                quantities.push(self.resistance(index, to));
            }
        }
        if let Some(sun) = self.position(&Coefficient::Solar) {
            quantities.push(self.over_heat("aperture to the sun".into(), "A", "m²", |_| self.only(sun)));
        }
        quantities.extend(self.steady_state());
        quantities
    }

    fn capacity(&self) -> Quantity {
        self.over_heat("heat capacity".into(), "c", "kJ/K", |zeros| Linear { constant: 1.0, weights: zeros })
    }

    fn conductance(&self, index: usize, to: &str) -> Quantity {
        self.over_heat(format!("conductance to {to}"), "1/R", "kW/K", |_| self.only(index))
    }

    fn resistance(&self, index: usize, to: &str) -> Quantity {
        let (name, symbol, unit) = (format!("resistance to {to}"), "R", "K/kW");
        match self.position(&Coefficient::Heat) {
            Some(heat) if self.heat_has_unit => self.ratio((name, symbol, unit), &self.only(heat), &self.only(index)),
            _ => self.without_scale((name, symbol, unit)),
        }
    }

    /// Quantities that need no absolute scale of heat: how fast, and how far in the end.
    fn steady_state(&self) -> Vec<Quantity> {
        let walls = Linear {
            constant: 0.0,
            weights: self
                .coefficients
                .iter()
                .map(|c| f64::from(u8::from(matches!(c, Coefficient::Wall { .. }))))
                .collect(),
        };
        if walls.weights.iter().all(|weight| *weight == 0.0) {
            return Vec::new();
        }
        let hours = Linear { constant: 1.0 / 3600.0, weights: vec![0.0; walls.weights.len()] };
        let mut quantities = vec![self.ratio(("time constant through the walls".into(), "τ", "h"), &hours, &walls)];
        if let Some(heat) = self.position(&Coefficient::Heat) {
            let (name, unit) = match self.heat_has_unit {
                true => ("warming by steady heat", "K/kW"),
                false => ("warming by a steady heat signal", "K/unit"),
            };
            quantities.push(self.ratio((name.into(), "a/Σb", unit), &self.only(heat), &walls));
        }
        if let Some(sun) = self.position(&Coefficient::Solar) {
            let labels = ("warming by steady sun".into(), "s/Σb", "K·m²/kW");
            quantities.push(self.ratio(labels, &self.only(sun), &walls));
        }
        quantities
    }

    fn position(&self, wanted: &Coefficient) -> Option<usize> {
        self.coefficients.iter().position(|coefficient| coefficient == wanted)
    }

    /// The coefficient number `index` alone.
    fn only(&self, index: usize) -> Linear {
        let mut weights = vec![0.0; self.coefficients.len()];
        weights[index] = 1.0;
        Linear { constant: 0.0, weights }
    }

    /// A numerator over the effect of heat, which sets the absolute scale.
    fn over_heat(
        &self,
        name: String,
        symbol: &'static str,
        unit: &'static str,
        numerator: impl Fn(Vec<f64>) -> Linear,
    ) -> Quantity {
        match self.position(&Coefficient::Heat) {
            Some(heat) if self.heat_has_unit => {
                let zeros = vec![0.0; self.coefficients.len()];
                self.ratio((name, symbol, unit), &numerator(zeros), &self.only(heat))
            }
            _ => self.without_scale((name, symbol, unit)),
        }
    }

    fn without_scale(&self, (name, symbol, unit): (String, &str, &str)) -> Quantity {
        let reason = match self.position(&Coefficient::Heat) {
            Some(_) => "the heat signal has no unit, so that only ratios are known",
            None => "no heat is known, so that only rates are",
        };
        let words = format!("{name} cannot be identified: {reason}");
        unknown((name, symbol, unit), (None, None), Confidence::NotIdentifiable, words)
    }

    fn ratio(&self, labels: (String, &str, &str), numerator: &Linear, denominator: &Linear) -> Quantity {
        let theta = &self.estimate.unconstrained;
        let covariance = &self.estimate.covariance;
        let involved = |index: usize| numerator.weights[index] != 0.0 || denominator.weights[index] != 0.0;
        if (0..theta.len()).any(|index| involved(index) && !covariance[(index, index)].is_finite()) {
            let words = format!("{} cannot be identified: the data do not determine what it is made of", labels.0);
            return unknown(labels, (None, None), Confidence::NotIdentifiable, words);
        }
        let (n, d) = (numerator.at(theta), denominator.at(theta));
        let var_n = product(covariance, numerator, numerator);
        let var_d = product(covariance, denominator, denominator);
        let between = product(covariance, numerator, denominator);
        let interval = fieller((n, d), (var_n, var_d, between));
        if d <= STANDARD_ERRORS_OF_95_PERCENT * var_d.sqrt() {
            let bound = interval
                .0
                .map_or("nothing is known of it".into(), |low| format!("it is at least {low:.3} {}", labels.2));
            let words = format!("{} has no upper bound: {bound}", labels.0);
            return unknown(labels, interval, Confidence::NotDistinguishableFromZero, words);
        }
        let f = n / d;
        let error = (var_n - 2.0 * f * between + f * f * var_d).max(0.0).sqrt() / d;
        let value = numerator.at(&self.estimate.coefficients) / denominator.at(&self.estimate.coefficients);
        let verdict = judge(&labels.0, f, error);
        let (name, symbol, unit) = (labels.0, labels.1.into(), labels.2.into());
        let standard_error = Some(error);
        Quantity { name, symbol, unit, value: Some(value), standard_error, interval, verdict, checks: Vec::new() }
    }
}

impl Linear {
    fn at(&self, theta: &[f64]) -> f64 {
        self.constant + self.weights.iter().zip(theta).map(|(weight, value)| weight * value).sum::<f64>()
    }
}

/// aᵀΣb over the coefficients that both involve; an undetermined one that is not involved does no harm.
fn product(covariance: &DMatrix<f64>, a: &Linear, b: &Linear) -> f64 {
    let mut sum = 0.0;
    for (i, left) in a.weights.iter().enumerate().filter(|(_, weight)| **weight != 0.0) {
        for (j, right) in b.weights.iter().enumerate().filter(|(_, weight)| **weight != 0.0) {
            sum += left * right * covariance[(i, j)];
        }
    }
    sum
}

/// Fieller's interval of n/d, cut at zero; an unbounded end is `None`.
fn fieller((n, d): (f64, f64), (var_n, var_d, between): (f64, f64, f64)) -> (Option<f64>, Option<f64>) {
    let z2 = STANDARD_ERRORS_OF_95_PERCENT * STANDARD_ERRORS_OF_95_PERCENT;
    let (a, b, c) = (d * d - z2 * var_d, n * d - z2 * between, n * n - z2 * var_n);
    let root = (b * b - a * c).max(0.0).sqrt();
    if d > 0.0 && a > 0.0 {
        (Some(((b - root) / a).max(0.0)), Some(((b + root) / a).max(0.0)))
    } else {
        // d may be zero, so n/d has no upper bound. A lower bound exists only if c and n are positive.
        let low = if c > 0.0 && n > 0.0 { n_over_largest_d(b, root, c) } else { 0.0 };
        (Some(low), None)
    }
}

/// The positive root of a f² − 2 b f + c with c > 0 and a ≤ 0, without cancellation.
fn n_over_largest_d(b: f64, root: f64, c: f64) -> f64 {
    c / (b + root)
}

fn unknown(
    (name, symbol, unit): (String, &str, &str),
    interval: (Option<f64>, Option<f64>),
    confidence: Confidence,
    words: String,
) -> Quantity {
    Quantity {
        name,
        symbol: symbol.into(),
        unit: unit.into(),
        value: None,
        standard_error: None,
        interval,
        verdict: ParameterVerdict { confidence, words },
        checks: Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::fieller;

    /// With a certain denominator it is the usual interval, with a certain numerator the inverse of the usual one.
    #[test]
    fn fiellers_interval_reduces_to_the_normal_one_if_one_term_is_certain() {
        let (low, high) = fieller((6.0, 2.0), (0.25, 0.0, 0.0));
        assert!((low.expect("bounded") - (6.0 - 0.98) / 2.0).abs() < 1e-12);
        assert!((high.expect("bounded") - (6.0 + 0.98) / 2.0).abs() < 1e-12);
        let (low, high) = fieller((1.0, 2.0), (0.0, 0.25, 0.0));
        assert!((low.expect("bounded") - 1.0 / 2.98).abs() < 1e-12);
        assert!((high.expect("bounded") - 1.0 / 1.02).abs() < 1e-12);
    }

    #[test]
    fn a_denominator_that_may_be_zero_leaves_only_a_lower_bound() {
        let (low, high) = fieller((1.0, 0.5), (0.0, 0.25, 0.0));
        assert!((low.expect("bounded below") - 1.0 / 1.48).abs() < 1e-12);
        assert_eq!(high, None);
        assert_eq!(fieller((0.1, 0.5), (1.0, 0.25, 0.0)), (Some(0.0), None));
    }
}
