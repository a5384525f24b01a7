//! View of the beliefs about the nearest drivers, which are inferred from their motion.

use interplay_planners::scene::driver_estimate::DriverModel;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::view::{ObservationSpace, Seen, names, nearest_first};

/// The probabilities of the kinds of driver of each of the nearest vehicles: tough, normal, nice, IDM, none of these. Empty rows
/// are 0.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct BeliefView {
    /// Number of rows.
    pub count: usize,
}

impl Default for BeliefView {
    fn default() -> Self {
        BeliefView { count: 4 }
    }
}

impl BeliefView {
    pub(super) fn space(&self) -> ObservationSpace {
        let names = names(&DriverModel::ALL.map(|model| model.name()));
        let shape = vec![self.count, names.len()];
        ObservationSpace { low: 0.0, ..ObservationSpace::normalised("Belief", shape, names, true) }
    }

    pub(super) fn write(&self, seen: &Seen<'_>, out: &mut [f32]) {
        out.fill(0.0);
        let rows = out.chunks_exact_mut(DriverModel::ALL.len());
        for (other, row) in nearest_first(seen.scene).into_iter().zip(rows) {
            let Some(belief) = seen.beliefs.iter().find(|belief| belief.vehicle == other.name) else { continue };
            for (out, probability) in row.iter_mut().zip(belief.probabilities) {
                *out = probability as f32;
            }
        }
    }
}
