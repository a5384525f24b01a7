//! Tests for heavy tails: innovations that are occasionally far larger than usual. Random heat and sensor noise have no
//! heavy tails, but opened windows and people who come and go do.

use super::World;
use crate::identify::report::SuspectedCause;
use crate::identify::telemetry::Neighbour;

/// Rows at the beginning of a segment are left out while the filter comes to know the hidden temperatures \[s\].
const SETTLING_S: f64 = 86_400.0;
/// Standard errors of the kurtosis, or of the skewness, of normal numbers beyond which tails are heavy.
const LIMIT: f64 = 4.5;
const LEAST_ROWS: usize = 100;

/// A finding, with the words to say so.
pub(super) struct HeavyTail {
    pub cause: SuspectedCause,
    pub words: String,
}

/// What the innovations of a zone show; `None` if they are like normal numbers.
pub(super) fn heavy_tail(world: &World<'_>, zone: usize) -> Option<HeavyTail> {
    let values = settled(world, zone);
    if values.len() < LEAST_ROWS {
        return None;
    }
    let count = values.len() as f64;
    let mean = values.iter().map(|(value, _)| value).sum::<f64>() / count;
    let moment = |power: i32| values.iter().map(|(value, _)| (value - mean).powi(power)).sum::<f64>() / count;
    let variance = moment(2).max(f64::MIN_POSITIVE);
    let kurtosis = (moment(4) / (variance * variance) - 3.0) / libm::sqrt(24.0 / count);
    let skewness = moment(3) / (variance * libm::sqrt(variance)) / libm::sqrt(6.0 / count);
    if kurtosis < LIMIT && skewness.abs() < LIMIT {
        return None;
    }
    // Positive if the air follows the outdoor temperature more than the walls explain.
    let outward = values.iter().map(|(value, to_outdoor)| (value - mean).powi(3) * to_outdoor.signum()).sum::<f64>();
    let times = format!(
        "innovations are at times far larger than in general (kurtosis {kurtosis:.0} standard errors too large)"
    );
    Some(if outward > 0.0 {
        let words = format!("{times}, and towards the temperature outdoors: were windows opened?");
        HeavyTail { cause: SuspectedCause::Windows, words }
    } else {
        let words =
            format!("{times}, and away from the temperature outdoors: did people or machines give off heat at times?");
        HeavyTail { cause: SuspectedCause::People, words }
    })
}

/// Standardised innovations of a zone, each with the difference of outdoor and indoor temperature \[K\].
fn settled(world: &World<'_>, zone: usize) -> Vec<(f64, f64)> {
    let p = world.observations.widths.0;
    let settling = libm::round(SETTLING_S / world.observations.step_s) as usize;
    let outdoors = world.telemetry.neighbours(zone).into_iter().find(|place| matches!(place, Neighbour::Boundary(_)));
    let difference = |row: usize| {
        let inside = world.telemetry.zones[zone].temperature_c[row];
        outdoors.map_or(-1.0, |place| world.telemetry.temperature_c(place)[row] - inside)
    };
    let rows =
        world.observations.segments.iter().flat_map(|segment| (segment.start + settling).min(segment.end)..segment.end);
    rows.map(|row| (world.filtered.standardised[row * p + zone], difference(row)))
        .filter(|(value, difference)| value.is_finite() && difference.is_finite())
        .collect()
}
