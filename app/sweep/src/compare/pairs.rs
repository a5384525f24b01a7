//! Two runs under the same conditions, many times.

use serde::Serialize;

use super::records::RunRecord;
use crate::statistics::{holm, mean_interval, median, sign_test};

/// Times of completion that differ by less count as equal: half a tick of 1/10 scale cars \[s\].
const MIN_DELAY_S: f64 = 0.05;

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

/// What is different with one of two, under the same conditions.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct PairedDifference {
    /// Pairs in which both runs were finished.
    pub pairs: usize,
    /// Who succeeds where the other does not.
    pub success: Split,
    /// Who has the better place: touches nobody where the other does, or is nearer to the front. Going first where that is
    /// possible is no failure, and going second is none either.
    pub place: Split,
    /// Who reaches the goal sooner, of pairs in which both reach it.
    pub time: Split,
    /// How much later the first reaches its goal \[s\]: mean over these pairs; none without any.
    pub delay_s: Option<f64>,
    /// Its bootstrap interval at 95 % \[s\].
    pub delay_interval_s: Option<[f64; 2]>,
    /// The median over these pairs \[s\].
    pub delay_median_s: Option<f64>,
}

impl Split {
    fn of(wins: usize, losses: usize) -> Split {
        let p = sign_test(wins, losses);
        Split { wins, losses, p, p_holm: p }
    }
}

impl PairedDifference {
    /// Compares the first of each pair with the second; `stream` tells the draws of one interval from another's.
    pub(super) fn of(pairs: &[(&RunRecord, &RunRecord)], stream: u64) -> PairedDifference {
        let pairs: Vec<_> = pairs.iter().filter(|(one, other)| one.is_finished() && other.is_finished()).collect();
        let better = |one: &RunRecord, other: &RunRecord| one.success && !other.success;
        let wins = pairs.iter().filter(|(one, other)| better(one, other)).count();
        let losses = pairs.iter().filter(|(one, other)| better(other, one)).count();
        let rank = |record: &RunRecord| (record.has_any_contact, record.place.unwrap_or(u64::MAX));
        let ahead = pairs.iter().filter(|(one, other)| rank(one) < rank(other)).count();
        let behind = pairs.iter().filter(|(one, other)| rank(other) < rank(one)).count();
        let succeeded = pairs.iter().filter(|(one, other)| one.success && other.success);
        let delays_s: Vec<f64> =
            succeeded.filter_map(|(one, other)| Some(one.completed_s? - other.completed_s?)).collect();
        let sooner = delays_s.iter().filter(|delay_s| **delay_s < -MIN_DELAY_S).count();
        let later = delays_s.iter().filter(|delay_s| **delay_s > MIN_DELAY_S).count();
        let delay = mean_interval(&delays_s, stream);
        PairedDifference {
            pairs: pairs.len(),
            success: Split::of(wins, losses),
            place: Split::of(ahead, behind),
            time: Split::of(sooner, later),
            delay_s: delay.map(|(mean, _)| mean),
            delay_interval_s: delay.map(|(_, interval)| interval),
            delay_median_s: median(delays_s),
        }
    }
}

/// Corrects the probabilities of all differences of a comparison together, those of each kind by themselves.
pub(super) fn correct(differences: &mut [&mut PairedDifference]) {
    let corrected = |of: fn(&PairedDifference) -> f64, differences: &[&mut PairedDifference]| {
        holm(&differences.iter().map(|one| of(one)).collect::<Vec<f64>>())
    };
    let success = corrected(|one| one.success.p, differences);
    let place = corrected(|one| one.place.p, differences);
    let time = corrected(|one| one.time.p, differences);
    for (index, one) in differences.iter_mut().enumerate() {
        one.success.p_holm = success[index];
        one.place.p_holm = place[index];
        one.time.p_holm = time[index];
    }
}
