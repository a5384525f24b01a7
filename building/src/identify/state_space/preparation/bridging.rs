//! Turns short gaps between segments into rows without measurements.
//!
//! A segment begins with a guess of its hidden temperatures, so a single missing row would lose as much information as
//! days of rows provide. Therefore the filter continues through a short gap: temperatures are missing, and weather is
//! interpolated. Heat is also interpolated if it is the same on both sides of a very short gap. Otherwise the heat of
//! the missing rows is unknown, and so are the temperatures of the nodes that it enters.

use std::ops::Range;

use crate::identify::telemetry::{MeasuredZone, Telemetry};

/// The longest gap that is bridged \[s\]. Chosen: the masses of a house keep most of their heat for this long.
const LONGEST_GAP_S: f64 = 6.0 * 3600.0;
/// In a gap of a single row, or shorter than this \[s\], heat is taken to go on as before …
const LONGEST_HELD_GAP_S: f64 = 3600.0;
/// … if on both sides it differs by no more than this share of its range over the record.
const SAME_HEAT_SHARE: f64 = 0.02;
/// A gap is a multiple of the step to this share of it.
const TOLERANCE: f64 = 1e-3;

/// Where each row of the bridged telemetry comes from.
enum Source {
    Row(usize),
    /// Between two rows, at this share of the way.
    Between(usize, usize, f64),
}

/// The telemetry with short gaps filled, and the rows whose heat is unknown; `None` if it has no short gap.
pub(super) fn bridged(telemetry: &Telemetry) -> Option<(Telemetry, Vec<usize>)> {
    let mut sources: Vec<Source> = Vec::new();
    let mut segments: Vec<Range<usize>> = Vec::new();
    let mut unknown_heat = Vec::new();
    for (index, segment) in telemetry.segments.iter().enumerate() {
        let before = index.checked_sub(1).map(|before| telemetry.segments[before].end - 1);
        let missing = before.map_or(0, |before| missing_rows(telemetry, before, segment.start));
        let start = sources.len();
        let is_held = before.is_some_and(|before| goes_on(telemetry, before, segment.start, missing));
        if let Some(before) = before.filter(|_| missing > 0) {
            for row in 1..=missing {
                if !is_held {
                    unknown_heat.push(sources.len());
                }
                sources.push(Source::Between(before, segment.start, row as f64 / (missing + 1) as f64));
            }
        }
        sources.extend(segment.clone().map(Source::Row));
        match segments.last_mut() {
            Some(last) if missing > 0 => last.end = sources.len(),
            _ => segments.push(start..sources.len()),
        }
    }
    (sources.len() > telemetry.segments.iter().map(Range::len).sum::<usize>())
        .then(|| (filled(telemetry, &sources, segments), unknown_heat))
}

/// Whether the heat of all zones goes on through a gap as before.
fn goes_on(telemetry: &Telemetry, before: usize, after: usize, missing: usize) -> bool {
    let gap_s = (missing + 1) as f64 * telemetry.step_s;
    let is_same = |zone: &MeasuredZone| {
        let finite = zone.power_kw.iter().copied().filter(|power| power.is_finite());
        let (low, high) = finite.fold((f64::MAX, f64::MIN), |(low, high), power| (low.min(power), high.max(power)));
        let change = (zone.power_kw[after] - zone.power_kw[before]).abs();
        zone.supply_air.is_empty() && change <= SAME_HEAT_SHARE * (high - low)
    };
    (missing == 1 || gap_s < LONGEST_HELD_GAP_S) && telemetry.zones.iter().all(is_same)
}

/// How many rows are missing between two rows; 0 where none is, or too many, or they do not fit the step.
fn missing_rows(telemetry: &Telemetry, before: usize, after: usize) -> usize {
    let gap_s = telemetry.time_s[after] - telemetry.time_s[before];
    let steps = libm::round(gap_s / telemetry.step_s);
    let fits = (gap_s - steps * telemetry.step_s).abs() <= TOLERANCE * telemetry.step_s;
    if fits && steps >= 2.0 && gap_s <= LONGEST_GAP_S { steps as usize - 1 } else { 0 }
}

fn filled(telemetry: &Telemetry, sources: &[Source], segments: Vec<Range<usize>>) -> Telemetry {
    let interpolated = |values: &[f64]| -> Vec<f64> {
        let value = |source: &Source| match *source {
            Source::Row(row) => values[row],
            Source::Between(before, after, share) => values[before] + share * (values[after] - values[before]),
        };
        sources.iter().map(value).collect()
    };
    let missing = |values: &[f64]| -> Vec<f64> {
        let value = |source: &Source| if let Source::Row(row) = source { values[*row] } else { f64::NAN };
        sources.iter().map(value).collect()
    };
    let mut filled = Telemetry { time_s: interpolated(&telemetry.time_s), segments, ..telemetry.clone() };
    for zone in &mut filled.zones {
        zone.temperature_c = missing(&zone.temperature_c);
        zone.power_kw = interpolated(&zone.power_kw);
        for air in &mut zone.supply_air {
            air.conductance_kw_per_k = interpolated(&air.conductance_kw_per_k);
            air.temperature_c = interpolated(&air.temperature_c);
        }
        zone.irradiance_kw_per_m2 = zone.irradiance_kw_per_m2.as_deref().map(interpolated);
    }
    for boundary in &mut filled.boundaries {
        boundary.temperature_c = interpolated(&boundary.temperature_c);
    }
    filled
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::identify::synthetic_classroom::Classroom;

    /// The classroom without the rows `gap`, in two segments.
    fn without(gap: Range<usize>) -> Telemetry {
        let whole = Classroom { days: 2, ..Classroom::default() }.simulate();
        let kept: Vec<Source> = (0..whole.rows()).filter(|row| !gap.contains(row)).map(Source::Row).collect();
        let segments = vec![0..gap.start, gap.start..kept.len()];
        filled(&whole, &kept, segments)
    }

    #[test]
    fn short_gaps_join_segments_and_long_gaps_separate_them() {
        let telemetry = without(50..53);
        let (bridged, unknown_heat) = bridged(&telemetry).expect("a short gap");
        assert_eq!((bridged.segments.len(), bridged.rows()), (1, telemetry.rows() + 3));
        assert_eq!(unknown_heat, [50, 51, 52]);
        assert!(bridged.zones[0].temperature_c[50..53].iter().all(|value| value.is_nan()));
        let steps = bridged.time_s.windows(2).map(|pair| pair[1] - pair[0]);
        assert!(steps.into_iter().all(|step| (step - telemetry.step_s).abs() < 1e-6));
        assert!(super::bridged(&without(50..80)).is_none());
    }
}
