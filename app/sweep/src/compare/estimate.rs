//! Shares, means and quantiles over runs.

use serde::Serialize;

use crate::statistics::{mean_interval, quantile, sign_test, wilson_interval};

/// A share with its 95 % Wilson interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Share {
    /// The number of runs that count.
    pub count: usize,
    /// The number of all runs.
    pub of: usize,
    /// Lower and upper bound.
    pub interval: [f64; 2],
}

/// A mean with its 95 % bootstrap interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Estimate {
    /// The mean.
    pub mean: f64,
    /// Lower and upper bound.
    pub interval: [f64; 2],
    /// Sample size.
    pub of: usize,
}

/// Quantiles of a measure over runs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Quantiles {
    /// The smallest.
    pub least: f64,
    /// At 5 %.
    pub p05: f64,
    /// The median.
    pub median: f64,
}

impl Share {
    /// The share of the numbers that are not 0.
    pub(super) fn of(numbers: &[f64]) -> Share {
        let (count, of) = (numbers.iter().filter(|number| **number != 0.0).count(), numbers.len());
        Share { count, of, interval: wilson_interval(count, of) }
    }

    /// The share itself; `None` if `of` is zero.
    pub fn share(&self) -> Option<f64> {
        (self.of > 0).then(|| self.count as f64 / self.of as f64)
    }
}

impl Estimate {
    /// The mean of numbers; none if there are none. `stream` separates the random draws of intervals.
    pub(super) fn of(numbers: &[f64], stream: u64) -> Option<Estimate> {
        mean_interval(numbers, stream).map(|(mean, interval)| Estimate { mean, interval, of: numbers.len() })
    }
}

impl Quantiles {
    /// The quantiles of unsorted numbers; none if there are none.
    pub(super) fn of(mut numbers: Vec<f64>) -> Option<Quantiles> {
        numbers.sort_by(f64::total_cmp);
        let at = |share| quantile(&numbers, share);
        Some(Quantiles { least: at(0.0)?, p05: at(0.05)?, median: at(0.5)? })
    }
}

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
