//! Thermal parameters from telemetry.

use interplay_building::identify::{Mapping, Telemetry};
use interplay_presentation::report::{Believed, identified_scenario};
use pyo3::prelude::*;

use crate::errors::refused_text;

/// Identifies thermal parameters from a table. Returns the document of `interplay identify --json`, the summary, and a
/// scenario with the identified network, if one can be made. `names` are those of table and mapping in errors.
#[pyfunction]
pub fn identify(
    py: Python<'_>,
    table: &str,
    mapping: &str,
    names: (String, String),
) -> PyResult<(String, String, Option<String>)> {
    py.detach(|| {
        let refused = |error: &dyn std::fmt::Display| refused_text(&error.to_string());
        let mapping = Mapping::parse(&names.1, mapping).map_err(|error| refused(&error))?;
        let telemetry = Telemetry::read(&names.0, table, &mapping).map_err(|error| refused(&error))?;
        let found = interplay_building::identify::identify(&telemetry, &mapping.identify);
        let found = found.map_err(|error| refused(&format!("{}: {error}", names.0)))?;
        let report = serde_json::to_string(&found.report).map_err(|error| refused(&error))?;
        let summary = interplay_presentation::report::identified_summary(&names.0, &found);
        let network = found.network.as_ref().ok();
        let scenario =
            network.map(|network| identified_scenario(&names.0, &found.report, network, None, Believed::Estimate));
        Ok((report, summary, scenario))
    })
}
