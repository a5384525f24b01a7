//! Tests whether the data contradict the assumptions of every model: that the weather's clock is that of the building, that all
//! heat except white or coloured noise is measured, that walls do not change, and that one model is valid for the whole record.
//!
//! The estimate itself does not show this: false assumptions also have best parameters, with short intervals and often
//! with white residuals.

pub(super) mod ceilings;
mod clock;
pub(super) mod halves;
mod score_test;
mod tails;

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
    let mut found: Vec<Suspicion> = clock::better_shift(world).into_iter().map(of_clock).collect();
    for zone in 0..world.telemetry.zones.len() {
        let name = world.telemetry.zones[zone].name.clone();
        let scored = score_test::score_tests(world, zone);
        let tails = tails::heavy_tail(world, zone);
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
