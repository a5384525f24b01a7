//! Who did better how often, and whether that is chance.

use serde::Serialize;

use crate::statistics::sign_test;

/// How often each of two did better, and whether that is chance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Split {
    /// Pairs in which the first did better.
    pub wins: usize,
    /// Pairs in which the other did better.
    pub losses: usize,
    /// The probability of a split at least as uneven if both were equally good (McNemar's exact test).
    pub p: f64,
    /// The same after Holm's correction for all splits of this kind in the comparison.
    pub p_holm: f64,
}

impl Split {
    /// A split, not yet corrected.
    pub(super) fn of(wins: usize, losses: usize) -> Split {
        let p = sign_test(wins, losses);
        Split { wins, losses, p, p_holm: p }
    }
}
