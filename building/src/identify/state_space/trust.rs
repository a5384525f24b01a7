//! Decides whether an estimate can be trusted. It is called identified only if
//!
//! 1. its interval is short,
//! 2. the residuals of its zone are white, or so nearly that it makes no difference,
//! 3. the network alone predicts the zone better in free runs than the mean of the data does,
//! 4. the heat balance over the record agrees with it, where it is a conductance,
//! 5. the next larger model does not move it by more than its interval,
//! 6. the two halves of the record agree on it,
//! 7. a building can have it, and the record can show it ([`super::ceilings`]),
//! 8. the data contradict nothing that every model takes for granted ([`super::wrong_world`]).
//!
//! Differences below [`MATERIAL`] of a number contradict nothing.

use super::heat_balance::BalancedConductance;
use super::profile::Estimated;
use super::wrong_world::MATERIAL;
use crate::identify::diagnostics::{Confidence, ParameterVerdict, STANDARD_ERRORS_OF_95_PERCENT, Whiteness};

/// Half of the longest interval that is called short, as a share of the estimate.
pub(super) const SHORT: f64 = 0.25;
/// Residuals pass if the test for whiteness does not refuse them at this level …
const WHITENESS_LEVEL: f64 = 0.01;
/// … or if no autocorrelation is larger than this. Chosen: intervals that take such residuals for white err by a tenth or so.
const NEGLIGIBLE_CORRELATION: f64 = 0.1;

/// What was found of a zone beside its parameters.
pub(super) struct ZoneEvidence<'a> {
    pub whiteness: &'a Whiteness,
    /// Errors of free runs of the network alone and of the mean of the data \[K\]; `None` without a run.
    pub free_run_k: Option<(f64, f64)>,
    /// What the data contradict, in words.
    pub suspicions: Vec<String>,
}

impl ZoneEvidence<'_> {
    /// What speaks against every number of the zone.
    fn doubts(&self) -> Vec<String> {
        let mut doubts = Vec::new();
        let largest = self.whiteness.autocorrelation.iter().fold(0.0_f64, |largest, rho| largest.max(rho.abs()));
        if self.whiteness.ljung_box.p_value < WHITENESS_LEVEL && largest > NEGLIGIBLE_CORRELATION {
            doubts.push(format!("the residuals are not white (correlations up to {largest:.2})"));
        }
        match self.free_run_k {
            None => doubts.push("no stretch is long enough to let the network run freely".into()),
            Some((network, mean)) if network >= mean => doubts.push(format!(
                "in free runs the network alone errs by {network:.2} K, and the mean of the data by {mean:.2} K"
            )),
            Some(_) => {}
        }
        doubts.extend(self.suspicions.iter().cloned());
        doubts
    }
}

/// What was found of a quantity beside its estimate.
#[derive(Default)]
pub(super) struct QuantityEvidence {
    /// The heat balance; of a resistance, its inverse.
    pub balance: Option<BalancedConductance>,
    /// The value by the next larger model.
    pub larger: Option<f64>,
    /// Its values by the halves of the record, if they contradict each other.
    pub halves: Option<[f64; 2]>,
    /// Whether it is proportional to the recorded heat, or inversely so.
    pub scales_with_heat: bool,
}

impl QuantityEvidence {
    fn doubts(&self, estimated: &Estimated) -> Vec<String> {
        let mut doubts = Vec::new();
        let (Some(low), Some(high)) = estimated.interval else { return doubts };
        if let Some(balance) = self.balance {
            let margin = STANDARD_ERRORS_OF_95_PERCENT * balance.standard_error;
            let is_far = libm::log(balance.value / estimated.value).abs() > MATERIAL;
            if (balance.value + margin < low || balance.value - margin > high) && (is_far || balance.value <= 0.0) {
                doubts.push(format!("the heat balance over the record gives {:.3}", balance.value));
            }
        }
        if let Some(larger) = self.larger {
            let half = libm::log(high / estimated.value).max(libm::log(estimated.value / low));
            if libm::log(larger / estimated.value).abs() > half.max(MATERIAL) {
                doubts.push(format!("the next larger model gives {larger:.4}"));
            }
        }
        if let Some([first, second]) = self.halves {
            doubts.push(format!("the first half of the record gives {first:.4}, and the second {second:.4}"));
        }
        doubts
    }
}

/// Judges a quantity, which the words call `name`.
pub(super) fn judge(
    name: &str,
    estimated: &Estimated,
    zone: &ZoneEvidence<'_>,
    evidence: &QuantityEvidence,
) -> ParameterVerdict {
    let verdict = |confidence, words| ParameterVerdict { confidence, words };
    let because = estimated.beyond.as_ref().map_or(String::new(), |reason| format!(": {reason}"));
    let (low, high) = match estimated.interval {
        (Some(low), Some(high)) => (low, high),
        (None, Some(high)) => {
            return verdict(
                Confidence::NotDistinguishableFromZero,
                format!("{name} is at most {high:.3}, and may be zero{because}"),
            );
        }
        (Some(low), None) => {
            return verdict(Confidence::Weak, format!("{name} is at least {low:.3}; no upper limit is known{because}"));
        }
        (None, None) => {
            return verdict(Confidence::NotIdentifiable, format!("the record does not tell the {name}{because}"));
        }
    };
    let half = (high - low) / (2.0 * estimated.value);
    let heat = if evidence.scales_with_heat { " if the recorded heat is right" } else { "" };
    let known = format!("{name} is known to ±{:.1} %", 100.0 * half);
    if half > SHORT {
        return verdict(Confidence::Weak, format!("{name} is known only to ±{:.0} %", 100.0 * half));
    }
    let mut doubts = zone.doubts();
    doubts.extend(evidence.doubts(estimated));
    if doubts.is_empty() {
        return verdict(Confidence::Identified, format!("{known}{heat}"));
    }
    verdict(Confidence::Disputed, format!("{known} if the model is right, but {}", doubts.join(", and ")))
}
