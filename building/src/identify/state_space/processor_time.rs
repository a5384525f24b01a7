//! Estimated time of the search among models, so that a search of hours is refused before it begins.
//!
//! ```text
//! time ∝ rows · models · (2 · zones)^2.5
//! ```
//!
//! The time of a model is proportional to the rows that are fitted, and grows with the number of states of all zones,
//! which determines the size of the matrices. How many models are tried depends on the results; the estimate assumes
//! three rounds that each try every extension.

use super::observations::InputLayout;
use crate::identify::settings::{HiddenTemperature, IdentifySettings};
use crate::identify::telemetry::Telemetry;

/// Time of a row in a model, for one state, on one core of the reference machine, an AMD EPYC at 2.6 GHz: fitted to records that
/// were made at random, with 1 to 3 zones and 300 to 8000 rows \[s\].
const ROW_S: f64 = 4.5e-5;
const GROWTH: f64 = 2.5;

/// Processor time of an identification from `rows` rows \[s\].
pub(super) fn processor_s(telemetry: &Telemetry, settings: &IdentifySettings, rows: usize) -> f64 {
    let layout = InputLayout::new(telemetry);
    let is_tried = |kind| settings.hidden.contains(&kind);
    let walls = if is_tried(HiddenTemperature::Wall) { telemetry.boundaries.len() } else { 0 };
    let heater = is_tried(HiddenTemperature::Heater) && layout.heat.iter().any(Option::is_some);
    let sun = layout.sun.iter().any(Option::is_some);
    let others = [is_tried(HiddenTemperature::Interior), heater, sun].into_iter().filter(|tried| *tried).count();
    // Coloured heat is always tried.
    let extensions = walls + others + 1;
    let models = 1 + settings.most_states * extensions;
    ROW_S * rows as f64 * models as f64 * libm::pow(2.0 * telemetry.zones.len() as f64, GROWTH)
}
