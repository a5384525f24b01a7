//! The uncertainty of the disturbance: D ~ N(D̂, Σ) (eq. 3.19).
//!
//! Σ is the sum of a part common to all zones (weather) and a part of each zone (people), both correlated over time:
//!
//! ```text
//! Σ = Σ_w ⊗ 11ᵀ + Σ_o ⊗ I + 10⁻⁸ I,    Σ_w(s,t) = σ_w² ρ_w^|s−t|,    Σ_o(s,t) = σ_o(s) σ_o(t) ρ_o^|s−t|
//! ```
//!
//! σ_o is larger while the zone is occupied. After each day, the σ are estimated again from the errors of the predictions,
//! with the settings as a prior of `prior_days` days. With a constant Σ, the iterations would end with a constant gain.

use interplay_common::setting::{self, SettingError};
use nalgebra::{Cholesky, DMatrix};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::ControlError;
use crate::comfort::Targets;

/// Variance that is added to every entry of the diagonal \[kW²\].
const NUGGET_KW2: f64 = 1e-8;

/// A priori uncertainty of the disturbance.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct UncertaintySettings {
    /// σ_w: standard deviation of the part that all zones have in common \[kW\].
    #[schemars(range(min = 0.0))]
    pub common_kw: f64,
    /// ρ_w: correlation of the common part from one step to the next.
    #[schemars(range(min = -1.0, max = 1.0), extend("x-unit" = "dimensionless"))]
    pub common_correlation: f64,
    /// σ_o: standard deviation of a zone's own part while it is occupied, and a step before and after \[kW\].
    #[schemars(range(min = 0.0))]
    pub zone_kw: f64,
    /// σ_o: standard deviation of a zone's own part at other times \[kW\].
    #[schemars(range(min = 0.0))]
    pub zone_other_kw: f64,
    /// ρ_o: correlation of a zone's own part from one step to the next.
    #[schemars(range(min = -1.0, max = 1.0), extend("x-unit" = "dimensionless"))]
    pub zone_correlation: f64,
    /// Whether the σ are estimated again after each day.
    pub reestimate: bool,
    /// Weight of the settings in these estimates, as a number of days.
    #[schemars(range(min = 0.0))]
    pub prior_days: f64,
}

impl Default for UncertaintySettings {
    fn default() -> Self {
        Self {
            common_kw: 0.026,
            common_correlation: 0.95,
            zone_kw: 0.07,
            zone_other_kw: 0.015,
            zone_correlation: 0.85,
            reestimate: true,
            prior_days: 5.0,
        }
    }
}

/// The current estimate of the uncertainty.
#[derive(Clone, Debug, PartialEq)]
pub struct Uncertainty {
    settings: UncertaintySettings,
    /// Sums of the observed variances of the common part, the occupied and the other zone parts, and of days.
    seen: [(f64, f64); 3],
}

impl Uncertainty {
    /// The uncertainty before the first day.
    ///
    /// # Errors
    /// [`SettingError`] if a deviation is negative, or a correlation not between -1 and 1.
    pub fn new(settings: UncertaintySettings) -> Result<Self, SettingError> {
        setting::check(&settings)?;
        Ok(Self { settings, seen: [(0.0, 0.0); 3] })
    }

    /// The standard deviations σ_w, σ_o while occupied, and σ_o otherwise \[kW\].
    pub fn deviations_kw(&self) -> [f64; 3] {
        let UncertaintySettings { common_kw, zone_kw, zone_other_kw, prior_days, .. } = self.settings;
        let mut deviations_kw = [common_kw, zone_kw, zone_other_kw];
        for (deviation_kw, (sum, days)) in deviations_kw.iter_mut().zip(self.seen) {
            if days > 0.0 {
                *deviation_kw = ((prior_days * *deviation_kw * *deviation_kw + sum) / (prior_days + days)).sqrt();
            }
        }
        deviations_kw
    }

    /// The covariance Σ of a day's disturbance, n·N by n·N \[kW²\].
    pub fn covariance(&self, targets: &Targets) -> DMatrix<f64> {
        let (n, steps) = (targets.zones, targets.steps());
        let [common_kw, zone_kw, other_kw] = self.deviations_kw();
        let deviation_kw: Vec<f64> = busy(targets).iter().map(|&busy| if busy { zone_kw } else { other_kw }).collect();
        let powers = |base: f64| -> Vec<f64> {
            std::iter::successors(Some(1.0), |power| Some(power * base)).take(steps).collect()
        };
        let common = powers(self.settings.common_correlation);
        let own = powers(self.settings.zone_correlation);
        DMatrix::from_fn(n * steps, n * steps, |i, j| {
            let (s, t) = (i / n, j / n);
            let shared = common_kw * common_kw * common[s.abs_diff(t)];
            let zone = if i % n == j % n { deviation_kw[s] * deviation_kw[t] * own[s.abs_diff(t)] } else { 0.0 };
            shared + zone + if i == j { NUGGET_KW2 } else { 0.0 }
        })
    }

    /// First-order noises that make up the disturbance, as their impulse responses over a day \[kW\], n·N by n + 1: one in
    /// each zone with the deviation while occupied, and the common one last.
    pub(crate) fn impulse_responses(&self, zones: usize, steps: usize) -> DMatrix<f64> {
        let [common_kw, zone_kw, _] = self.deviations_kw();
        let UncertaintySettings { common_correlation, zone_correlation, .. } = self.settings;
        let mut responses = DMatrix::zeros(zones * steps, zones + 1);
        let innovation = |deviation_kw: f64, rho: f64| deviation_kw * (1.0 - rho * rho).sqrt();
        let mut own = innovation(zone_kw, zone_correlation);
        let mut common = innovation(common_kw, common_correlation);
        for t in 0..steps {
            for zone in 0..zones {
                responses[(t * zones + zone, zone)] = own;
                responses[(t * zones + zone, zones)] = common;
            }
            own *= zone_correlation;
            common *= common_correlation;
        }
        responses
    }

    /// Learns from the error of a day's prediction \[kW\], stacked. Returns whether anything changed.
    pub fn learn(&mut self, error_kw: &[f64], targets: &Targets) -> bool {
        if !self.settings.reestimate {
            return false;
        }
        let n = targets.zones as f64;
        let mut sums = [(0.0, 0.0_f64); 3];
        for (step_kw, busy) in error_kw.chunks_exact(targets.zones).zip(busy(targets)) {
            let mean = step_kw.iter().sum::<f64>() / n;
            let place = if busy { 1 } else { 2 };
            // With a single zone, the zone's own part cannot be separated from the common one.
            let own = if n > 1.0 {
                step_kw.iter().map(|kw| (kw - mean) * (kw - mean)).sum::<f64>() / (n - 1.0)
            } else {
                mean * mean
            };
            sums[place] = (sums[place].0 + own, sums[place].1 + 1.0);
            if n > 1.0 {
                sums[0] = (sums[0].0 + mean * mean - own / n, sums[0].1 + 1.0);
            }
        }
        for (seen, (sum, count)) in self.seen.iter_mut().zip(sums) {
            if count > 0.0 {
                *seen = (seen.0 + (sum / count).max(0.0), seen.1 + 1.0);
            }
        }
        true
    }
}

/// Whether any zone is occupied in each step, or in the step before or after it.
fn busy(targets: &Targets) -> Vec<bool> {
    let occupied = targets.any_occupied();
    let at = |t: usize| t.checked_sub(1).and_then(|row| occupied.get(row)).copied().unwrap_or(false);
    // Step t runs from T(t) to T(t + 1); rows of targets are T(1) … T(N).
    (0..targets.steps()).map(|t| t.checked_sub(1).is_some_and(at) || at(t) || at(t + 1)).collect()
}

impl Targets {
    /// Whether each step is occupied, or the step before or after it.
    pub(crate) fn busy(&self) -> Vec<bool> {
        busy(self)
    }
}

/// The Cholesky factor L of a covariance: Σ = LLᵀ, lower triangular.
///
/// # Errors
/// [`ControlError::Covariance`] if Σ is not positive definite, or an entry is not finite.
pub fn factor(covariance: DMatrix<f64>) -> Result<DMatrix<f64>, ControlError> {
    let order = covariance.nrows();
    let finite = covariance.iter().all(|value| value.is_finite());
    match Cholesky::new(covariance).filter(|_| finite) {
        Some(factor) => Ok(factor.unpack()),
        None => Err(ControlError::Covariance { order }),
    }
}

/// The quantile Φ⁻¹(p) of the standard normal distribution, for 0 < p < 1.
pub fn normal_quantile(p: f64) -> f64 {
    // Φ(x) = erfc(−x/√2)/2, by bisection to the last digit.
    let (mut low, mut high) = (-40.0, 40.0);
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        if 0.5 * libm::erfc(-middle * std::f64::consts::FRAC_1_SQRT_2) < p {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}
