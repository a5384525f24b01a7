//! Converts telemetry to rows of outputs and inputs.

use super::gains::MOST_OUTPUTS;
use super::heat_rows::{HeatRows, Levels};
use super::likelihood::Observations;
use crate::identify::error::IdentifyError;
use crate::identify::telemetry::{Hold, MeasuredZone, Telemetry};

/// Which column of the inputs is what. Temperatures of boundaries come first.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct InputLayout {
    /// The heat of each zone, if it has any.
    pub heat: Vec<Option<usize>>,
    /// The irradiance of each zone, if it is measured.
    pub sun: Vec<Option<usize>>,
    /// Whether the heat of each zone switches inside of rows, or may.
    pub switches: Vec<bool>,
    pub count: usize,
}

impl InputLayout {
    pub fn new(telemetry: &Telemetry) -> Self {
        let mut count = telemetry.boundaries.len();
        let mut columns = |is_there: &dyn Fn(&MeasuredZone) -> bool| -> Vec<Option<usize>> {
            let column = |zone| {
                is_there(zone).then(|| {
                    count += 1;
                    count - 1
                })
            };
            telemetry.zones.iter().map(column).collect()
        };
        let heat = columns(&MeasuredZone::has_heat);
        let sun = columns(&|zone| zone.irradiance_kw_per_m2.as_ref().is_some_and(|sun| sun.iter().any(|&s| s != 0.0)));
        let switches = telemetry.zones.iter().map(|zone| Levels::new(zone).is_some()).collect();
        Self { heat, sun, switches, count }
    }
}

/// The rows of `segments`: zone temperatures as outputs; boundary temperatures, heat \[kW\] and irradiance \[kW/m²\] as inputs.
///
/// Heat of supply air is that at the measured temperature of the zone. A segment begins at its first row in which all zones
/// are measured. `unknown_heat` are the rows from which on the heat is unknown until the next.
///
/// # Errors
/// [`IdentifyError::TooManyZones`].
pub(super) fn observations(
    telemetry: &Telemetry,
    layout: &InputLayout,
    segments: &[std::ops::Range<usize>],
    unknown_heat: &[usize],
) -> Result<Observations, IdentifyError> {
    let zones = &telemetry.zones;
    if zones.len() > MOST_OUTPUTS {
        return Err(IdentifyError::TooManyZones { zones: zones.len(), most: MOST_OUTPUTS });
    }
    let rows = telemetry.rows();
    let outputs = (0..rows).flat_map(|row| zones.iter().map(move |zone| zone.temperature_c[row])).collect();
    let mut columns: Vec<(Vec<f64>, Hold)> =
        telemetry.boundaries.iter().map(|boundary| (boundary.temperature_c.clone(), boundary.hold)).collect();
    for (zone, _) in zones.iter().zip(&layout.heat).filter(|(_, column)| column.is_some()) {
        columns.push((heat(zone), zone.power_hold));
    }
    for (zone, _) in zones.iter().zip(&layout.sun).filter(|(_, column)| column.is_some()) {
        columns.push((zone.irradiance_kw_per_m2.clone().unwrap_or_default(), zone.irradiance_hold));
    }
    let mut slopes = vec![0.0; rows * layout.count];
    for segment in segments {
        for row in segment.start..segment.end.saturating_sub(1) {
            for (column, (values, hold)) in columns.iter().enumerate() {
                if *hold == Hold::FirstOrder {
                    slopes[row * layout.count + column] = (values[row + 1] - values[row]) / telemetry.step_s;
                }
            }
        }
    }
    let inputs = (0..rows).flat_map(|row| columns.iter().map(move |(values, _)| values[row])).collect();
    let is_complete = |row: &usize| zones.iter().all(|zone| zone.temperature_c[*row].is_finite());
    let from_first = |segment: &std::ops::Range<usize>| {
        let first = segment.clone().find(is_complete)?;
        (segment.end - first >= 2).then_some(first..segment.end)
    };
    let segments = segments.iter().filter_map(from_first).collect();
    Ok(Observations {
        step_s: telemetry.step_s,
        segments,
        outputs,
        inputs,
        slopes,
        heat: HeatRows::new(telemetry, &layout.heat, &telemetry.segments, unknown_heat),
        widths: (zones.len(), layout.count),
    })
}

/// Known heat of a zone in each row \[kW\]. Where its temperature is missing, the last one takes its place.
fn heat(zone: &MeasuredZone) -> Vec<f64> {
    let mut last_c = zone.temperature_c.iter().copied().find(|value| value.is_finite()).unwrap_or(20.0);
    let mut at = |row: usize| {
        if zone.temperature_c[row].is_finite() {
            last_c = zone.temperature_c[row];
        }
        zone.heat_kw(row, last_c)
    };
    (0..zone.power_kw.len()).map(&mut at).collect()
}
