//! Identification by maximum likelihood with state-space models.
//!
//! A zone is a network of one measured and up to two hidden temperatures ([`structure`]), driven by the measured
//! boundaries, heat and sun, and by random heat. Zones with walls between them form one model. A Kalman filter turns
//! the model and the measurements into a likelihood ([`likelihood`]), whose maximum is the estimate ([`scoring`]).
//! [`selection`] chooses the number of hidden temperatures, [`trust`] decides which numbers are reliable, and
//! [`wrong_world`] tests whether the data contradict the assumptions that all these models share.

#[cfg(test)]
mod armadillo_test;
mod ceilings;
mod elements;
mod exponential;
mod export;
mod findings;
mod gain_tangents;
mod gains;
mod heat_balance;
mod heat_rows;
mod heat_timing;
mod innovations;
mod likelihood;
mod linear_model;
mod model_average;
mod network_run;
mod observations;
mod preparation;
mod profile;
mod quantities;
mod scoring;
mod selection;
mod starts;
mod structure;
mod tangents;
mod trust;
mod wrong_world;

use std::ops::Range;

use findings::StateSpaceFindings;
use observations::{InputLayout, observations};
use preparation::Prepared;
use structure::Structure;

use super::report::Identification;
use super::settings::TrainTestSplit;
use super::telemetry::Telemetry;
use super::{IdentifyError, IdentifySettings, Progress};

/// At least this many rows are needed for each parameter of the smallest model.
const ROWS_PER_PARAMETER: usize = 10;

/// Processor time of [`identify`], roughly \[s\].
pub(super) fn expected_processor_s(record: &Telemetry, settings: &IdentifySettings) -> f64 {
    let prepared = Prepared::new(record);
    let split = TrainTestSplit::new(&prepared.telemetry, settings);
    let rows = split.train.iter().map(Range::len).sum();
    selection::processor_s(&prepared.telemetry, settings, rows)
}

/// Identifies all zones of the telemetry together.
///
/// # Errors
/// [`IdentifyError`] for too many zones, too few rows, too much work, a zone that nothing acts on, and values that are not finite.
pub(super) fn identify(
    record: &Telemetry,
    settings: &IdentifySettings,
    progress: &Progress<'_>,
) -> Result<Identification, IdentifyError> {
    let prepared = Prepared::new(record);
    let telemetry = prepared.telemetry.as_ref();
    let split = TrainTestSplit::new(telemetry, settings);
    let layout = InputLayout::new(telemetry);
    for (zone, measured) in telemetry.zones.iter().enumerate() {
        if telemetry.neighbours(zone).is_empty() && layout.heat[zone].is_none() && layout.sun[zone].is_none() {
            return Err(IdentifyError::NothingToIdentify { zone: measured.name.clone() });
        }
    }
    let train = observations(telemetry, &layout, &split.train, &prepared.unknown_heat)?;
    let all = observations(telemetry, &layout, &telemetry.segments, &prepared.unknown_heat)?;
    let rows: usize = train.segments.iter().map(Range::len).sum();
    let parameters = Structure::new(telemetry, &[]).parameters.len();
    let wanted = ROWS_PER_PARAMETER * parameters;
    if rows < wanted {
        return Err(IdentifyError::TooFewRows { rows, parameters, wanted });
    }
    let expected_s = selection::processor_s(telemetry, settings, rows);
    if expected_s > settings.processor_s {
        return Err(IdentifyError::TooMuchWork { expected_s, limit_s: settings.processor_s });
    }
    let choice = selection::choose(telemetry, &train, settings, progress).ok_or(IdentifyError::NotFinite)?;
    progress("how certain each number is");
    let findings = StateSpaceFindings { telemetry, settings, split: &split, train: &train, all: &all, choice: &choice };
    let mut found = findings.identification()?;
    found.report.rows = record.rows();
    found.report.segments = record.segments.len();
    let trained =
        split.train.iter().flat_map(Clone::clone).filter(|row| prepared.unknown_heat.binary_search(row).is_err());
    found.report.train_rows = trained.count() * prepared.decimated_by;
    if prepared.decimated_by > 1 {
        let minutes = telemetry.step_s / 60.0;
        found.report.warnings.insert(0, format!("the record is long: it was fitted in steps of {minutes} min"));
    }
    Ok(found)
}
