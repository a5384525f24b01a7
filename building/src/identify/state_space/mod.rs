//! Identification by maximum likelihood in state space.
//!
//! A zone is a network of one measured and up to two hidden temperatures ([`structure`]), driven by the measured boundaries,
//! heat and sun, and by random heat. Zones with walls between them are one model. A Kalman filter turns the model and the
//! measurements into a likelihood ([`likelihood`]), whose maximum is the estimate ([`scoring`]). How many hidden
//! temperatures there are, a likelihood-ratio test decides ([`selection`]). Which numbers can be trusted, [`trust`] says.

#[cfg(test)]
mod armadillo_test;
mod exponential;
mod export;
mod extension;
mod findings;
mod gains;
mod heat_balance;
mod likelihood;
mod linear_model;
mod model_average;
mod network_run;
mod observations;
mod profile;
mod quantities;
mod scoring;
mod selection;
mod starts;
mod structure;
mod tangents;
mod trust;

use std::ops::Range;

use findings::StateSpaceFindings;
use observations::{InputLayout, observations};
use structure::Structure;

use super::report::Identification;
use super::telemetry::Telemetry;
use super::train_test_split::TrainTestSplit;
use super::{IdentifyError, IdentifySettings};

/// At least this many rows are needed for each parameter of the smallest model.
const ROWS_PER_PARAMETER: usize = 10;

/// Identifies all zones of the telemetry together.
///
/// # Errors
/// [`IdentifyError`] for too many zones, too few rows, a zone that nothing acts on, and values that are not finite.
pub(super) fn identify(telemetry: &Telemetry, settings: &IdentifySettings) -> Result<Identification, IdentifyError> {
    let split = TrainTestSplit::new(telemetry, settings);
    let layout = InputLayout::new(telemetry);
    for (zone, measured) in telemetry.zones.iter().enumerate() {
        if telemetry.neighbours(zone).is_empty() && layout.heat[zone].is_none() && layout.sun[zone].is_none() {
            return Err(IdentifyError::NothingToIdentify { zone: measured.name.clone() });
        }
    }
    let train = observations(telemetry, &layout, &split.train)?;
    let all = observations(telemetry, &layout, &telemetry.segments)?;
    let rows: usize = train.segments.iter().map(Range::len).sum();
    let parameters = Structure::new(telemetry, &[]).parameters.len();
    let wanted = ROWS_PER_PARAMETER * parameters;
    if rows < wanted {
        return Err(IdentifyError::TooFewRows { rows, parameters, wanted });
    }
    let choice = selection::choose(telemetry, &train, settings).ok_or(IdentifyError::NotFinite)?;
    StateSpaceFindings { telemetry, settings, split: &split, train: &train, all: &all, choice: &choice }
        .identification()
}
