//! Counts how often each of two planners did better, and tests whether the difference is significant.

use serde::Serialize;

use crate::statistics::sign_test;

/// The number of pairs in which each of two planners did better, with the significance of the difference.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Split {
    /// Pairs in which the first did better.
    pub wins: usize,
    /// Pairs in which the other did better.
    pub losses: usize,
    /// The probability of a split at least as uneven if both were equally good (McNemar's exact test).
    pub p: f64,
    /// The same after Holm's correction over all splits of this kind in the comparison.
    pub p_holm: f64,
}

impl Split {
    /// How often the first of a pair did better, and how often the second.
    pub(super) fn between<'a, T: 'a>(
        pairs: impl Iterator<Item = (&'a T, &'a T)> + Clone,
        is_better: impl Fn(&T, &T) -> bool,
    ) -> Split {
        let wins = pairs.clone().filter(|(one, other)| is_better(one, other)).count();
        Split::of(wins, pairs.filter(|(one, other)| is_better(other, one)).count())
    }

    /// A split, not yet corrected.
    pub(super) fn of(wins: usize, losses: usize) -> Split {
        let p = sign_test(wins, losses);
        Split { wins, losses, p, p_holm: p }
    }
}
