//! Intervals by profile likelihood: all values of a quantity f for which the best log-likelihood with f held there is less
//! than 1.92 below the maximum, half of the 95 % point of chi-squared with one degree of freedom.
//!
//! Where the likelihood is nearly quadratic, the interval of the information matrix is the same, and is kept. Both are averaged
//! with each larger model ([`super::model_average`]), and the widest of these intervals counts.

use std::cell::RefCell;

use super::ceilings::{Ceiling, ceiling};
use super::likelihood::Observations;
use super::model_average::Rival;
use super::quantities::{Precision, QuantityKind, logarithm};
use super::scoring::{Ascent, Constraint};
use super::selection::{Fit, Sandwich};
use crate::identify::diagnostics::STANDARD_ERRORS_OF_95_PERCENT;
use crate::identify::telemetry::Telemetry;

/// Standard errors of ln f between which a profile is worth its time.
const WORTH_A_PROFILE: std::ops::Range<f64> = 0.05..2.0;
/// f is held to this share of itself.
const TOLERANCE: f64 = 1e-3;
/// A profile ends where √(2Δℓ) is this near to 1.96.
const NEAR: f64 = 0.05;
/// A trial ends when a step promises less than this gain of the log-likelihood.
const LEAST_GAIN_OF_TRIAL: f64 = 1e-2;
const MOST_TRIALS: usize = 6;
const STEPS_A_TRIAL: usize = 12;
/// Largest standard error of ln f with which a model knows f.
const KNOWN_LOG_ERROR: f64 = 0.25;
/// Beyond this factor of the estimate, an interval is called unbounded.
const MOST_LOG_RATIO: f64 = 4.6;

/// Estimate and interval of a quantity.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Estimated {
    pub value: f64,
    /// Standard error of ln f; infinite where the data do not determine it.
    pub log_error: f64,
    /// Ends of the interval of 95 %; `None` where there is none.
    pub interval: (Option<f64>, Option<f64>),
    /// Why the record does not tell it, or its upper end (of an inverse: the lower end): the value would exceed a ceiling.
    pub beyond: Option<String>,
}

impl Estimated {
    /// Of 1/f.
    fn inverse(self) -> Self {
        let inverse = |end: Option<f64>| end.map(|end| 1.0 / end);
        let interval = (inverse(self.interval.1), inverse(self.interval.0));
        Self { value: 1.0 / self.value, interval, ..self }
    }

    /// Without what exceeds a ceiling: the upper end, or all of it.
    fn below(self, ceiling: Option<Ceiling>) -> Self {
        let Some(Ceiling { most, reason }) = ceiling else { return self };
        if self.value > most {
            return Self { interval: (None, None), beyond: Some(reason), ..self };
        }
        match self.interval {
            (low, Some(high)) if high > most => Self { interval: (low, None), beyond: Some(reason), ..self },
            _ => self,
        }
    }
}

/// The fit of which quantities are wanted.
pub(super) struct Profiler<'a> {
    pub telemetry: &'a Telemetry,
    pub observations: &'a Observations,
    pub fit: &'a Fit,
    pub precision: Precision,
    /// The next larger model, if there is one, with its precision.
    pub larger: Option<(&'a Fit, Precision)>,
    /// All models that are one extension larger, with their precisions.
    pub rivals: Vec<(&'a Fit, Precision)>,
    /// Standard errors that hold where innovations are not white, if there are any.
    pub sandwich: Option<Sandwich>,
    /// What was found already.
    pub known: RefCell<Vec<((QuantityKind, usize), Estimated)>>,
}

impl Profiler<'_> {
    /// Estimate and interval of a quantity of a zone.
    pub fn estimated(&self, kind: QuantityKind, zone: usize) -> Option<Estimated> {
        if let QuantityKind::Resistance(neighbour) = kind {
            return self.estimated(QuantityKind::Conductance(neighbour), zone).map(Estimated::inverse);
        }
        let known =
            self.known.borrow().iter().find(|(quantity, _)| *quantity == (kind, zone)).map(|(_, found)| found.clone());
        if known.is_some() {
            return known;
        }
        let ceiling = ceiling(self.telemetry, self.observations, self.fit, (kind, zone));
        let found = self.find(kind, zone)?.below(ceiling);
        self.known.borrow_mut().push(((kind, zone), found.clone()));
        Some(found)
    }

    fn find(&self, kind: QuantityKind, zone: usize) -> Option<Estimated> {
        let (log_value, gradient) =
            logarithm(self.telemetry, &self.fit.structure, (kind, zone), &self.fit.maximum.theta)?;
        let value = libm::exp(log_value);
        let log_error = self.precision.standard_error(&gradient);
        if !log_error.is_finite() {
            return Some(Estimated { value, log_error, interval: (None, None), beyond: None });
        }
        let rivals = self.rivals((kind, zone), log_value);
        let inflation = self.inflation(&gradient, log_error);
        let reach = STANDARD_ERRORS_OF_95_PERCENT * log_error;
        let distance = |sign: f64| -> Option<f64> {
            // A profile that stopped early would be too short, so an end is at least as far away as the standard error says.
            let own = match WORTH_A_PROFILE.contains(&log_error) {
                true => self.profile_end((kind, zone), log_value, &gradient, sign * reach)?.abs().max(reach),
                false => reach,
            };
            let own = inflation * own;
            let ends = rivals.iter().map(|rival| rival.towards(sign).averaged_end(own));
            let averaged = ends.fold(own, f64::max);
            (averaged < MOST_LOG_RATIO).then_some(averaged)
        };
        let (below, above) = (distance(-1.0), distance(1.0));
        let widest = below.unwrap_or(reach).max(above.unwrap_or(reach));
        Some(Estimated {
            value,
            log_error: (inflation * log_error).max(widest / STANDARD_ERRORS_OF_95_PERCENT),
            interval: (below.map(|d| value * libm::exp(-d)), above.map(|d| value * libm::exp(d))),
            beyond: None,
        })
    }

    /// By how much the standard error that allows for correlated innovations is larger than that of the information matrix; at
    /// least 1.
    fn inflation(&self, gradient: &[f64], log_error: f64) -> f64 {
        let Some(sandwich) = &self.sandwich else { return 1.0 };
        let direction = self.precision.direction(gradient, gradient.len());
        (sandwich.standard_error(&direction) / log_error).max(1.0)
    }

    /// The inflation of the standard error of a quantity of a zone.
    pub fn inflation_of(&self, quantity: (QuantityKind, usize)) -> f64 {
        let found = logarithm(self.telemetry, &self.fit.structure, quantity, &self.fit.maximum.theta);
        found.map_or(1.0, |(_, gradient)| self.inflation(&gradient, self.precision.standard_error(&gradient)))
    }

    /// The logarithm of a quantity and its standard error by the next larger model; `None` without such a model, or if
    /// it does not contain the quantity and so cannot contradict it.
    pub fn of_larger(&self, quantity: (QuantityKind, usize)) -> Option<(f64, f64)> {
        self.of_model(self.larger.as_ref()?, quantity)
    }

    fn of_model(&self, (fit, precision): &(&Fit, Precision), quantity: (QuantityKind, usize)) -> Option<(f64, f64)> {
        let (value, gradient) = logarithm(self.telemetry, &fit.structure, quantity, &fit.maximum.theta)?;
        Some((value, precision.standard_error(&gradient))).filter(|(_, error)| *error <= KNOWN_LOG_ERROR)
    }

    /// What the larger models say of a quantity.
    fn rivals(&self, quantity: (QuantityKind, usize), log_value: f64) -> Vec<Rival> {
        let criterion = |fit: &Fit| fit.maximum.evaluation.log_likelihood - fit.structure.parameters.len() as f64;
        let rival = |model: &(&Fit, Precision)| {
            let (other, error) = self.of_model(model, quantity)?;
            Some(Rival::new(criterion(model.0) - criterion(self.fit), other - log_value, error))
        };
        self.rivals.iter().filter_map(rival).collect()
    }

    /// How far ln f may move in the direction of `guess`; `None` without a bound.
    fn profile_end(&self, quantity: (QuantityKind, usize), at: f64, gradient: &[f64], guess: f64) -> Option<f64> {
        let theta = &self.fit.maximum.theta;
        let direction = self.precision.direction(gradient, theta.len());
        let slope: f64 = direction.iter().zip(gradient).map(|(d, g)| d * g).sum();
        let model = |theta: &[super::exponential::Number]| self.fit.structure.model(theta);
        let function = |theta: &[f64]| {
            logarithm(self.telemetry, &self.fit.structure, quantity, theta)
                .unwrap_or_else(|| (at, vec![0.0; theta.len()]))
        };
        let mut distance = guess;
        for _ in 0..MOST_TRIALS {
            let constraint = Constraint { function: &function, target: at + distance, tolerance: TOLERANCE };
            let ascent = Ascent {
                model: &model,
                observations: self.observations,
                bounds: &self.fit.bounds,
                constraint: Some(constraint),
                least_gain: LEAST_GAIN_OF_TRIAL,
            };
            let start: Vec<f64> =
                theta.iter().zip(&direction).map(|(value, direction)| value + direction * distance / slope).collect();
            let held = ascent.run(&start, STEPS_A_TRIAL).or_else(|| ascent.run(theta, STEPS_A_TRIAL))?;
            let reached = function(&held.theta).0 - at;
            let drop = 2.0 * (self.fit.maximum.evaluation.log_likelihood - held.evaluation.log_likelihood);
            let root = libm::sqrt(drop.max(0.0));
            if (root - STANDARD_ERRORS_OF_95_PERCENT).abs() < NEAR {
                return Some(reached);
            }
            // √(2Δℓ) is nearly proportional to the distance.
            let factor = (STANDARD_ERRORS_OF_95_PERCENT / root.max(1e-3)).clamp(0.3, 3.0);
            distance = reached * factor;
            if distance.abs() > MOST_LOG_RATIO {
                return None;
            }
        }
        Some(distance)
    }
}
