//! Pairs of runs under the same conditions.

use serde::{Serialize, Serializer};

use super::building::BuildingDifference;
use super::compared::{ComparedColumns, succeeds};
use super::estimate::Split;
use super::records::RunRecord;
use crate::statistics::{holm, mean_interval, median};

/// Completion times that differ by less count as equal: half a tick of 1/10 scale cars \[s\].
const MIN_DELAY_S: f64 = 0.05;

/// Differences between two planners under the same conditions.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct PairedDifference {
    /// Number of pairs in which both runs finished.
    pub pairs: usize,
    /// Pairs in which one succeeds and the other does not.
    pub success: Split,
    /// Pairs by the better place: without contact where the other has one, or nearer to the front. Going first where that is
    /// possible is not a failure, and neither is going second.
    pub place: Split,
    /// Pairs by the earlier completion; a vehicle that never reaches its goal is later than one that does.
    pub time: Split,
    /// Pairs in which only one reaches the goal: they count for `time`, but have no delay.
    pub censored: usize,
    /// Delay of the first relative to the second \[s\]: mean over the pairs in which both reach the goal; none without any.
    pub delay_s: Option<f64>,
    /// Its bootstrap interval at 95 % \[s\].
    pub delay_interval_s: Option<[f64; 2]>,
    /// The median over these pairs \[s\].
    pub delay_median_s: Option<f64>,
    /// Pairs by the better value of each metric that has one, by key: for `hard_braking`, the one that does not brake
    /// hard where the other does.
    #[serde(flatten)]
    pub metrics: MetricSplits,
    /// Differences for the building; none without one.
    pub building: Option<BuildingDifference>,
}

/// Splits by metrics, in the order in which the metrics are listed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MetricSplits(pub Vec<MetricSplit>);

/// A split by the better value of a metric.
#[derive(Clone, Debug, PartialEq)]
pub struct MetricSplit {
    /// The key of the metric.
    pub key: &'static str,
    /// Its name, in words.
    pub title: String,
    /// The split.
    pub split: Split,
}

impl MetricSplits {
    /// The split with this key; an empty one if it does not exist.
    pub fn get(&self, key: &str) -> Split {
        self.0.iter().find(|one| one.key == key).map(|one| one.split).unwrap_or_default()
    }
}

impl Serialize for MetricSplits {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|one| (one.key, &one.split)))
    }
}

impl PairedDifference {
    /// Compares the first of each pair with the second; `stream` separates the random draws of intervals.
    pub(super) fn of(pairs: &[(&RunRecord, &RunRecord)], compared: &ComparedColumns, stream: u64) -> PairedDifference {
        let pairs: Vec<_> = pairs.iter().filter(|(one, other)| one.is_finished() && other.is_finished()).collect();
        let split = |is_better: &dyn Fn(&RunRecord, &RunRecord) -> bool| {
            Split::between(pairs.iter().map(|(one, other)| (*one, *other)), is_better)
        };
        let is_ahead = |one: &RunRecord, other: &RunRecord| {
            let touches = |record: &RunRecord| record.flag("contacts").unwrap_or(false);
            let place = |record: &RunRecord| record.number("ego_place").unwrap_or(f64::INFINITY);
            touches(one).cmp(&touches(other)).then(place(one).total_cmp(&place(other))).is_lt()
        };
        let succeeded = pairs.iter().filter(|(one, other)| succeeds(one) && succeeds(other));
        let time_s = |record: &RunRecord| record.number("completed_s");
        let delays_s: Vec<f64> = succeeded.filter_map(|(one, other)| Some(time_s(one)? - time_s(other)?)).collect();
        let success = split(&|one, other| succeeds(one) && !succeeds(other));
        let sooner = delays_s.iter().filter(|delay_s| **delay_s < -MIN_DELAY_S).count() + success.wins;
        let later = delays_s.iter().filter(|delay_s| **delay_s > MIN_DELAY_S).count() + success.losses;
        let delay = mean_interval(&delays_s, stream);
        let metrics = compared.splits.iter().map(|metric| MetricSplit {
            key: metric.key,
            title: metric.title.clone(),
            split: split(&|one, other| metric.is_better(one, other)),
        });
        PairedDifference {
            pairs: pairs.len(),
            success,
            place: split(&is_ahead),
            time: Split::of(sooner, later),
            censored: success.wins + success.losses,
            delay_s: delay.map(|(mean, _)| mean),
            delay_interval_s: delay.map(|(_, interval)| interval),
            delay_median_s: median(delays_s),
            metrics: MetricSplits(metrics.collect()),
            building: BuildingDifference::of(&pairs, stream),
        }
    }
}

/// All splits of a difference, kind by kind, in the order common to all differences.
fn splits(difference: &mut PairedDifference) -> Vec<Option<&mut Split>> {
    let PairedDifference { success, place, time, metrics, building, .. } = difference;
    let of_vehicles = [success, place, time].into_iter().chain(metrics.0.iter_mut().map(|metric| &mut metric.split));
    of_vehicles.map(Some).chain([building.as_mut().map(|building| &mut building.cheaper)]).collect()
}

/// Corrects the probabilities of all differences of a comparison together, separately for each kind.
pub(super) fn correct(differences: &mut [&mut PairedDifference]) {
    let mut kinds: Vec<Vec<&mut Split>> = Vec::new();
    for difference in differences {
        for (kind, split) in splits(difference).into_iter().enumerate() {
            if kinds.len() <= kind {
                kinds.push(Vec::new());
            }
            kinds[kind].extend(split);
        }
    }
    for mut splits in kinds {
        let corrected = holm(&splits.iter().map(|split| split.p).collect::<Vec<f64>>());
        for (split, p_holm) in splits.iter_mut().zip(corrected) {
            split.p_holm = p_holm;
        }
    }
}
