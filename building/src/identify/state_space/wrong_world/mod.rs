//! Tests whether the data contradict the assumptions of every model: that the weather's clock is that of the building, that all
//! heat except white or coloured noise is measured, when it comes and as heat, that walls do not change, and that one model is valid
//! for the whole record.
//!
//! The estimate itself does not show this: false assumptions also have best parameters, with short intervals and often
//! with white residuals.
//!
//! Every possible cause is fitted together with the model ([`alternatives`]). Causes are ranked by the log-likelihood that each of them
//! explains, less half of Schwarz's penalty for its parameters. A cause that changes no known number by more than
//! [`MATERIAL`] is not worth an alarm.

mod alternatives;
pub(super) mod halves;
mod heavy_tail;
mod score_test;
mod widened;

use std::ops::Range;

use super::likelihood::{Filtered, Observations};
use super::quantities::{Precision, QuantityKind, logarithm};
use super::selection::Fit;
use super::structure::Structure;
use crate::identify::report::{SuspectedCause, Suspicion};
use crate::identify::telemetry::{Neighbour, Telemetry};

/// A cause counts if some known number changes by more than this share of it when the cause is allowed for.
pub(in crate::identify::state_space) const MATERIAL: f64 = 0.02;
/// Largest standard error of the logarithm of a number that counts as known.
const KNOWN_LOG_ERROR: f64 = 0.25;
/// Causes beside the first are named if they explain at least this share of what it explains.
const NAMED_SHARE: f64 = 0.5;

/// A fit, and what it is judged by.
pub(in crate::identify::state_space) struct World<'a> {
    pub telemetry: &'a Telemetry,
    pub observations: &'a Observations,
    pub fit: &'a Fit,
    /// Fits with fewer parameters, which another world may make better.
    pub smaller: &'a [Fit],
    pub precision: &'a Precision,
    pub filtered: &'a Filtered,
}

/// A cause that explains what the model does not.
pub(in crate::identify::state_space) struct Explanation {
    pub zone: Option<usize>,
    pub cause: SuspectedCause,
    pub words: String,
    /// By how much the log-likelihood is higher.
    pub gain: f64,
    /// How many parameters the cause has.
    pub parameters: usize,
}

impl World<'_> {
    /// Number of rows that count.
    fn rows(&self) -> f64 {
        self.observations.segments.iter().map(Range::len).sum::<usize>() as f64
    }

    /// The largest change of the logarithm of a known number from the estimate to `theta` of a structure; infinite if none is known.
    fn change(&self, structure: &Structure, theta: &[f64]) -> f64 {
        let parameters = structure.parameters.len();
        let boundaries = (0..self.telemetry.boundaries.len()).map(Neighbour::Boundary);
        let kinds: Vec<QuantityKind> =
            boundaries.map(QuantityKind::Conductance).chain([QuantityKind::Capacity, QuantityKind::Aperture]).collect();
        let all = (0..self.telemetry.zones.len()).flat_map(|zone| kinds.iter().map(move |&kind| (kind, zone)));
        let change = |quantity| {
            let (before, gradient) = logarithm(self.telemetry, &self.fit.structure, quantity, &self.fit.maximum.theta)?;
            let (after, _) = logarithm(self.telemetry, structure, quantity, &theta[..parameters])?;
            (self.precision.standard_error(&gradient) <= KNOWN_LOG_ERROR).then_some((after - before).abs())
        };
        let changes: Vec<f64> = all.filter_map(change).collect();
        if changes.is_empty() { f64::INFINITY } else { changes.into_iter().fold(0.0, f64::max) }
    }

    /// Whether allowing for a cause, with which the parameters become `theta`, changes a known number.
    fn is_material(&self, structure: &Structure, theta: &[f64]) -> bool {
        self.change(structure, theta) > MATERIAL
    }
}

/// What the data contradict, the cause that explains most first; `more` are explanations that were found elsewhere.
pub(super) fn suspicions(world: &World<'_>, more: Vec<Explanation>) -> Vec<Suspicion> {
    let mut found = alternatives::of_shifts(world);
    for zone in 0..world.telemetry.zones.len() {
        found.extend(score_test::explanations(world, zone));
        found.extend(heavy_tail::explanation(world, zone));
    }
    found.extend(more);
    ranked(found, world.rows())
        .into_iter()
        .map(|it| Suspicion {
            zone: it.zone.map(|zone| world.telemetry.zones[zone].name.clone()),
            cause: it.cause,
            explains: it.gain,
            words: it.words,
        })
        .collect()
}

/// Explanations that are worth their parameters, and at least a share of the best one.
fn ranked(mut found: Vec<Explanation>, rows: f64) -> Vec<Explanation> {
    let worth = |it: &Explanation| it.gain - 0.5 * it.parameters as f64 * libm::log(rows.max(2.0));
    found.retain(|it| worth(it) > 0.0);
    found.sort_by(|a, b| worth(b).total_cmp(&worth(a)));
    let best = found.first().map_or(0.0, worth);
    found.retain(|it| worth(it) >= NAMED_SHARE * best);
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cause_that_explains_most_is_first_and_small_ones_are_not_named() {
        let of = |cause, gain, parameters| Explanation { zone: None, cause, words: String::new(), gain, parameters };
        let all = vec![
            of(SuspectedCause::People, 60.0, 7),
            of(SuspectedCause::Clock, 50.0, 1),
            of(SuspectedCause::Sun, 20.0, 2),
            of(SuspectedCause::Windows, 6.0, 2),
        ];
        let causes: Vec<SuspectedCause> = ranked(all, 1344.0).iter().map(|it| it.cause).collect();
        assert_eq!(causes, [SuspectedCause::Clock, SuspectedCause::People]);
    }
}
