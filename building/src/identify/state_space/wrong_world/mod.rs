//! Tests whether the data contradict the assumptions of every model: that the weather's clock is that of the building, that all
//! heat except white or coloured noise is measured, that walls do not change, and that one model is valid for the whole record.
//!
//! The estimate itself does not show this: false assumptions also have best parameters, with short intervals and often
//! with white residuals.

pub(super) mod ceilings;
pub(super) mod halves;
mod score_test;

use std::ops::Range;

use rayon::prelude::*;

use super::likelihood::{Filtered, Observations};
use super::selection::Fit;
use crate::identify::report::{SuspectedCause, Suspicion};
use crate::identify::telemetry::Telemetry;

/// A fit, and what it is judged by.
pub(in crate::identify::state_space) struct World<'a> {
    pub telemetry: &'a Telemetry,
    pub observations: &'a Observations,
    pub fit: &'a Fit,
    pub filtered: &'a Filtered,
}

/// What the data contradict, by tests of which each refuses a right world in less than one of a hundred records.
pub(super) fn suspicions(world: &World<'_>) -> Vec<Suspicion> {
    let mut found: Vec<Suspicion> = better_shift(world).into_iter().map(of_clock).collect();
    for zone in 0..world.telemetry.zones.len() {
        let name = world.telemetry.zones[zone].name.clone();
        let scored = score_test::score_tests(world, zone);
        let tails = score_test::heavy_tail(world, zone);
        let mut add = |cause, words| found.push(Suspicion { zone: Some(name.clone()), cause, words });
        if let Some(tail) = tails {
            add(tail.cause, tail.words);
        }
        for (cause, words) in scored {
            add(cause, words);
        }
    }
    found
}

fn of_clock((hours, gain): (f64, f64)) -> Suspicion {
    let way = if hours > 0.0 { "earlier" } else { "later" };
    let words = format!(
        "the weather fits better when it is taken {:.1} h {way} (log-likelihood higher by {gain:.0}): check the clocks and time zones",
        hours.abs()
    );
    Suspicion { zone: None, cause: SuspectedCause::Clock, words }
}

/// Shifts that are tried \[h\].
const SHIFTS_H: [f64; 6] = [-2.0, -1.0, -0.5, 0.5, 1.0, 2.0];
/// Gain of the log-likelihood from which on a shift wins: the best of six would gain so much by chance in one of a thousand
/// records (χ² with one degree of freedom).
const LEAST_GAIN: f64 = 7.0;
const MOST_STEPS: usize = 12;

/// The shift of the weather \[h\] that fits best and by how much the log-likelihood is higher; `None` if none fits better.
fn better_shift(world: &World<'_>) -> Option<(f64, f64)> {
    let layout = &world.fit.structure.layout;
    let boundaries = world.telemetry.boundaries.len();
    let weather: Vec<usize> = (0..boundaries).chain(layout.sun.iter().flatten().copied()).collect();
    if weather.is_empty() {
        return None;
    }
    let step_s = world.observations.step_s;
    let margin = libm::ceil(SHIFTS_H[SHIFTS_H.len() - 1] * 3600.0 / step_s) as usize;
    let of_shift = |rows: isize| -> Option<f64> {
        let shifted = shifted(world.observations, &weather, rows, margin);
        Some(world.fit.refit(&shifted, MOST_STEPS)?.maximum.evaluation.log_likelihood)
    };
    let as_recorded = of_shift(0)?;
    let shifts: Vec<isize> = SHIFTS_H.iter().map(|hours| libm::round(hours * 3600.0 / step_s) as isize).collect();
    let fits = |rows: isize, hours: f64| rows != 0 && (rows as f64 * step_s / 3600.0 - hours).abs() < 0.1;
    let tried: Vec<Option<(f64, f64)>> = shifts
        .par_iter()
        .zip(&SHIFTS_H)
        .map(|(&rows, &hours)| if fits(rows, hours) { Some((hours, of_shift(rows)? - as_recorded)) } else { None })
        .collect();
    let best = tried.into_iter().flatten().max_by(|a, b| a.1.total_cmp(&b.1))?;
    (best.1 > LEAST_GAIN).then_some(best)
}

/// Observations whose inputs `columns` are those of `rows` rows later, without `margin` rows at both ends of each segment.
fn shifted(observations: &Observations, columns: &[usize], rows: isize, margin: usize) -> Observations {
    let (_, m) = observations.widths;
    let mut shifted = observations.clone();
    for segment in &observations.segments {
        let last = segment.end as isize - 1;
        for row in segment.clone() {
            let from = (row as isize + rows).clamp(segment.start as isize, last) as usize;
            for &column in columns {
                shifted.inputs[row * m + column] = observations.inputs[from * m + column];
                shifted.slopes[row * m + column] = observations.slopes[from * m + column];
            }
        }
    }
    let inner = |segment: &Range<usize>| segment.start + margin..segment.end.saturating_sub(margin);
    let is_complete = |row: &usize| {
        let p = observations.widths.0;
        observations.outputs[row * p..(row + 1) * p].iter().all(|value| value.is_finite())
    };
    let from_first = |segment: Range<usize>| {
        let first = segment.clone().find(is_complete)?;
        (segment.end >= first + 2).then_some(first..segment.end)
    };
    shifted.segments = observations.segments.iter().map(inner).filter_map(from_first).collect();
    shifted.unknown_heat.retain(|row| shifted.segments.iter().any(|segment| segment.contains(row)));
    shifted
}
