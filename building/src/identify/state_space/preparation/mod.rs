//! Telemetry made ready for a filter: short gaps become rows without a temperature, and long records have longer steps.

mod bridging;
mod decimation;

use std::borrow::Cow;

use crate::identify::telemetry::Telemetry;

pub(super) struct Prepared<'a> {
    pub telemetry: Cow<'a, Telemetry>,
    /// Rows from which on the heat is not known until the next row, sorted.
    pub unknown_heat: Vec<usize>,
    /// How many rows of the record each step holds; 1 for all but long records.
    pub decimated_by: usize,
}

impl<'a> Prepared<'a> {
    pub fn new(telemetry: &'a Telemetry) -> Self {
        let (bridged, unknown_heat) = match bridging::bridged(telemetry) {
            Some((bridged, unknown_heat)) => (Cow::Owned(bridged), unknown_heat),
            None => (Cow::Borrowed(telemetry), Vec::new()),
        };
        let factor = decimation::factor(&bridged);
        if factor == 1 {
            return Self { telemetry: bridged, unknown_heat, decimated_by: 1 };
        }
        let (decimated, unknown_heat) = decimation::decimated(&bridged, &unknown_heat, factor);
        Self { telemetry: Cow::Owned(decimated), unknown_heat, decimated_by: factor }
    }
}
