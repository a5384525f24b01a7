//! Two runs under the same conditions, many times.

use serde::Serialize;

use super::building::BuildingDifference;
use super::records::RunRecord;
use super::split::Split;
use crate::statistics::{holm, mean_interval, median};

/// Times of completion that differ by less count as equal: half a tick of 1/10 scale cars \[s\].
const MIN_DELAY_S: f64 = 0.05;

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
    /// Who does not brake hard where the other does.
    pub hard_braking: Split,
    /// What is different for the building; none without one.
    pub building: Option<BuildingDifference>,
}

impl PairedDifference {
    /// Compares the first of each pair with the second; `stream` tells the draws of one interval from another's.
    pub(super) fn of(pairs: &[(&RunRecord, &RunRecord)], stream: u64) -> PairedDifference {
        let pairs: Vec<_> = pairs.iter().filter(|(one, other)| one.is_finished() && other.is_finished()).collect();
        let split = |is_better: &dyn Fn(&RunRecord, &RunRecord) -> bool| {
            Split::between(pairs.iter().map(|(one, other)| (*one, *other)), is_better)
        };
        let rank = |record: &RunRecord| (record.has_any_contact, record.place.unwrap_or(u64::MAX));
        let succeeded = pairs.iter().filter(|(one, other)| one.success && other.success);
        let delays_s: Vec<f64> =
            succeeded.filter_map(|(one, other)| Some(one.completed_s? - other.completed_s?)).collect();
        let sooner = delays_s.iter().filter(|delay_s| **delay_s < -MIN_DELAY_S).count();
        let later = delays_s.iter().filter(|delay_s| **delay_s > MIN_DELAY_S).count();
        let delay = mean_interval(&delays_s, stream);
        PairedDifference {
            pairs: pairs.len(),
            success: split(&|one, other| one.success && !other.success),
            place: split(&|one, other| rank(one) < rank(other)),
            time: Split::of(sooner, later),
            delay_s: delay.map(|(mean, _)| mean),
            delay_interval_s: delay.map(|(_, interval)| interval),
            delay_median_s: median(delays_s),
            hard_braking: split(&|one, other| one.brakes_hard == Some(false) && other.brakes_hard == Some(true)),
            building: BuildingDifference::of(&pairs, stream),
        }
    }
}

/// A kind of split of a difference.
type SplitOf = fn(&mut PairedDifference) -> Option<&mut Split>;

/// All kinds of splits.
const KINDS: [SplitOf; 5] = [
    |one| Some(&mut one.success),
    |one| Some(&mut one.place),
    |one| Some(&mut one.time),
    |one| Some(&mut one.hard_braking),
    |one| one.building.as_mut().map(|building| &mut building.cheaper),
];

/// Corrects the probabilities of all differences of a comparison together, those of each kind by themselves.
pub(super) fn correct(differences: &mut [&mut PairedDifference]) {
    for kind in KINDS {
        let mut splits: Vec<&mut Split> = differences.iter_mut().filter_map(|one| kind(one)).collect();
        let corrected = holm(&splits.iter().map(|split| split.p).collect::<Vec<f64>>());
        for (split, p_holm) in splits.iter_mut().zip(corrected) {
            split.p_holm = p_holm;
        }
    }
}
