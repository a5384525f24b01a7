//! Events: rows whose innovations are far larger than in general, as after a window was opened.

use super::{Explanation, World};
use crate::identify::report::SuspectedCause;
use crate::identify::state_space::heat_rows;
use crate::identify::telemetry::Neighbour;

/// Rows at the beginning of a segment are left out while the filter comes to know the hidden temperatures \[s\].
const SETTLING_S: f64 = 86_400.0;
/// Standard errors of the kurtosis, or of the skewness, of normal numbers beyond which tails are heavy.
const LIMIT: f64 = 4.5;
const LEAST_ROWS: usize = 100;
/// Shares of events among the rows, and their deviations, that are tried.
const SHARES: [f64; 4] = [0.003, 0.01, 0.03, 0.1];
const DEVIATIONS: [f64; 4] = [2.0, 3.0, 5.0, 10.0];
/// A standardised innovation beyond this is an event.
const EVENT: f64 = 3.5;
const MOST_STEPS: usize = 12;

/// What the innovations of a zone show; `None` if they are like normal numbers, or if no known number depends on the events.
pub(super) fn explanation(world: &World<'_>, zone: usize) -> Option<Explanation> {
    let values = settled(world, zone);
    if values.len() < LEAST_ROWS {
        return None;
    }
    let count = values.len() as f64;
    let mean = values.iter().map(|it| it.value).sum::<f64>() / count;
    let moment = |power: i32| values.iter().map(|it| (it.value - mean).powi(power)).sum::<f64>() / count;
    let variance = moment(2).max(f64::MIN_POSITIVE);
    let kurtosis = (moment(4) / (variance * variance) - 3.0) / libm::sqrt(24.0 / count);
    let skewness = moment(3) / (variance * libm::sqrt(variance)) / libm::sqrt(6.0 / count);
    if kurtosis < LIMIT && skewness.abs() < LIMIT {
        return None;
    }
    let deviation = libm::sqrt(variance);
    let standard: Vec<f64> = values.iter().map(|it| (it.value - mean) / deviation).collect();
    let gain = gain_of_events(&standard);
    let events: Vec<usize> =
        values.iter().zip(&standard).filter(|(_, value)| value.abs() > EVENT).map(|(it, _)| it.row).collect();
    if !is_material(world, &events) {
        return None;
    }
    // Positive if the air follows the outdoor temperature more than the walls explain.
    let outward = values.iter().map(|it| (it.value - mean).powi(3) * it.to_outdoor_k.signum()).sum::<f64>();
    let times = format!(
        "in {} of {} rows the temperature jumps by far more than in general (log-likelihood of such events higher by {gain:.0})",
        events.len(),
        values.len()
    );
    let (cause, words) = if outward > 0.0 {
        (SuspectedCause::Windows, format!("{times}, and towards the temperature outdoors: were windows opened?"))
    } else {
        let words = format!("{times}, and away from it outdoors: did people or machines give off heat at times?");
        (SuspectedCause::People, words)
    };
    Some(Explanation { zone: Some(zone), cause, words, gain, parameters: 2 })
}

/// By how much the log-likelihood of standardised innovations is higher if a share of them has a larger deviation.
fn gain_of_events(standard: &[f64]) -> f64 {
    let density = |value: f64, deviation: f64| libm::exp(-0.5 * value * value / (deviation * deviation)) / deviation;
    let normal: f64 = standard.iter().map(|value| -0.5 * value * value).sum();
    let of = |share: f64, factor: f64| -> f64 {
        // The deviation of all rows is 1.
        let usual = 1.0 / libm::sqrt(1.0 - share + share * factor * factor);
        let mixture = |value: &f64| {
            let sum = (1.0 - share) * density(*value, usual) + share * density(*value, factor * usual);
            libm::log(sum.max(f64::MIN_POSITIVE))
        };
        standard.iter().map(mixture).sum()
    };
    let all = SHARES.iter().flat_map(|&share| DEVIATIONS.iter().map(move |&factor| (share, factor)));
    all.map(|(share, factor)| of(share, factor) - normal).fold(0.0, f64::max)
}

/// Whether a known number changes if the heat before each event counts as unknown.
fn is_material(world: &World<'_>, events: &[usize]) -> bool {
    let mut observations = world.observations.clone();
    for &row in events.iter().filter(|&&row| row > 0) {
        observations.heat.of_row[row - 1] = heat_rows::UNKNOWN;
    }
    world.fit.refit(&observations, MOST_STEPS).is_some_and(|fit| world.is_material(&fit.structure, &fit.maximum.theta))
}

/// A standardised innovation.
struct Innovation {
    row: usize,
    value: f64,
    /// Difference of outdoor and indoor temperature \[K\].
    to_outdoor_k: f64,
}

/// The innovations of a zone once the filter has settled.
fn settled(world: &World<'_>, zone: usize) -> Vec<Innovation> {
    let p = world.observations.widths.0;
    let settling = libm::round(SETTLING_S / world.observations.step_s) as usize;
    let outdoors = world.telemetry.neighbours(zone).into_iter().find(|place| matches!(place, Neighbour::Boundary(_)));
    let difference = |row: usize| {
        let inside = world.telemetry.zones[zone].temperature_c[row];
        outdoors.map_or(-1.0, |place| world.telemetry.temperature_c(place)[row] - inside)
    };
    let rows =
        world.observations.segments.iter().flat_map(|segment| (segment.start + settling).min(segment.end)..segment.end);
    rows.map(|row| Innovation {
        row,
        value: world.filtered.standardised[row * p + zone],
        to_outdoor_k: difference(row),
    })
    .filter(|it| it.value.is_finite() && it.to_outdoor_k.is_finite())
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use interplay_common::random::Random;

    #[test]
    fn events_gain_likelihood_and_normal_numbers_do_not() {
        let mut random = Random::new(3, 3);
        let mut values: Vec<f64> = (0..1000).map(|_| random.normal(0.0, 1.0)).collect();
        let scaled = |values: &[f64]| -> Vec<f64> {
            let deviation = libm::sqrt(values.iter().map(|value| value * value).sum::<f64>() / values.len() as f64);
            values.iter().map(|value| value / deviation).collect()
        };
        assert!(gain_of_events(&scaled(&values)) < 3.0);
        values.iter_mut().step_by(100).for_each(|value| *value += 8.0);
        assert!(gain_of_events(&scaled(&values)) > 100.0);
    }
}
