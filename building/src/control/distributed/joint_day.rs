//! A day that all zones plan together, and its cost.

use super::zone_models::ZoneModels;
use crate::comfort::Targets;
use crate::control::BandPenalty;
use crate::lifted::Lifted;

/// A day to be planned together.
pub(super) struct JointDay<'a> {
    pub lifted: &'a Lifted,
    pub targets: &'a Targets,
    pub penalty: BandPenalty,
    pub zone_models: &'a ZoneModels,
    /// Nodes' temperatures at midnight.
    pub initial_c: &'a [f64],
    /// All heat but that of the equipment, nodes of a step together \[kW\].
    pub driving_kw: &'a [f64],
    /// Temperatures of the zones without equipment, stacked.
    pub free_c: &'a [f64],
    pub silent: Option<usize>,
}

impl JointDay<'_> {
    /// J of the inputs, with penalties, by simulation.
    pub fn cost(&self, heat_kw: &[f64]) -> f64 {
        let temperatures_c: Vec<f64> =
            self.free_c.iter().zip(self.lifted.product(heat_kw)).map(|(free, risen)| free + risen).collect();
        self.cost_of(&temperatures_c, heat_kw)
    }

    pub(super) fn cost_of(&self, temperatures_c: &[f64], heat_kw: &[f64]) -> f64 {
        self.targets.cost(temperatures_c, heat_kw) + self.penalty.evaluate(self.targets, temperatures_c)
    }

    /// ∂J/∂T and, without the parts of bounds that are kept now, ∂²J/∂T² of an entry.
    pub(super) fn slope(&self, i: usize, temperature_c: f64) -> (f64, f64) {
        let targets = self.targets;
        let error_k = targets.reference_c[i] - temperature_c;
        let weight = targets.error_weight[i];
        let beyond_k = targets.beyond_k(i, temperature_c);
        let c = self.penalty.quadratic;
        let bent = if beyond_k > 0.0 { 2.0 * c } else { 0.0 };
        (-2.0 * weight * error_k - 2.0 * c * beyond_k * error_k.signum(), 2.0 * weight + bent)
    }
}
