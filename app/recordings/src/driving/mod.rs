//! Statistics of how recorded vehicles drive: gaps, braking, lane changes.

mod distance;
mod lane_changes;

use interplay_planners::motion_prediction::TrafficMoment;
use rayon::prelude::*;
use serde::Serialize;

use crate::measure::nearest_rank;
use crate::start::{PAST_S, known_at};
use crate::traffic::{Recordings, Timeline};
pub use distance::DrivingDistance;
use lane_changes::LaneChange;

/// The quantiles at 5, 50 and 95 % of a sample.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Spread {
    /// Sample size.
    pub count: usize,
    /// 5 % of the sample are below.
    pub low: f64,
    pub median: f64,
    /// 95 % of the sample are below.
    pub high: f64,
}

/// Statistics of the vehicles of a group of recordings, without rows that repeat others. `None` is a statistic without a sample.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DrivingStatistics {
    pub name: String,
    /// Time gaps, bumper to bumper, to vehicles ahead in the lane within 60 m, each second, at speeds above 3 m/s \[s\].
    pub time_gap_s: Option<Spread>,
    /// Share of these gaps below 0.5 s.
    pub time_gap_below_half_share: Option<f64>,
    /// Median time gap beyond 3.5 m of each vehicle that follows steadily \[s\].
    pub steady_time_gap_s: Option<Spread>,
    /// Standard deviation of the logarithm of that time gap, over the same vehicles.
    pub steady_time_gap_deviation: Option<f64>,
    /// The hardest braking of each vehicle, as a slope over 1.2 s \[m/s²\].
    pub peak_braking_mps2: Option<Spread>,
    /// The absolute change of that slope from one second to the next \[m/s³\].
    pub jerk_mps3: Option<Spread>,
    /// Time gaps to the vehicle ahead in the new lane when a lane change crosses the line \[s\].
    pub accepted_lead_gap_s: Option<Spread>,
    /// Time gaps of the vehicle behind in the new lane at that moment \[s\].
    pub accepted_lag_gap_s: Option<Spread>,
    /// The hardest braking of the vehicle behind in the following 3 s \[m/s²\].
    pub lag_braking_mps2: Option<Spread>,
    /// Duration of lane changes \[s\].
    pub lane_change_s: Option<Spread>,
}

/// A vehicle follows another one within this distance \[m\].
const FOLLOWED_M: f64 = 60.0;
/// Time gaps are not measured below this speed \[m/s\].
const MIN_SPEED_MPS: f64 = 3.0;
/// Standstill gap of human drivers \[m\].
const STANDSTILL_M: f64 = 3.5;
/// Steady following: the speeds differ by less than this \[m/s\], for at least [`STEADY_COUNT`] seconds.
const STEADY_MPS: f64 = 1.0;
const STEADY_COUNT: usize = 3;

#[derive(Default)]
struct Counted {
    gaps_s: Vec<f64>,
    steady_s: Vec<f64>,
    braking_mps2: Vec<f64>,
    jerk_mps3: Vec<f64>,
    changes: Vec<LaneChange>,
}

impl Recordings {
    /// Driving statistics of the vehicles of each group.
    pub fn driving(&self) -> Vec<DrivingStatistics> {
        self.counted().into_iter().zip(&self.groups).map(|(counted, name)| counted.statistics(name)).collect()
    }

    /// What is counted of each group.
    fn counted(&self) -> Vec<Counted> {
        let counted: Vec<Counted> = self.timelines.par_iter().map(counted).collect();
        let group = |index: usize| {
            let mut all = Counted::default();
            for (_, counted) in self.timelines.iter().zip(&counted).filter(|(it, _)| it.group == index) {
                all.gaps_s.extend(&counted.gaps_s);
                all.steady_s.extend(&counted.steady_s);
                all.braking_mps2.extend(&counted.braking_mps2);
                all.jerk_mps3.extend(&counted.jerk_mps3);
                all.changes.extend(&counted.changes);
            }
            all
        };
        (0..self.groups.len()).map(group).collect()
    }
}

impl Counted {
    fn statistics(self, name: &str) -> DrivingStatistics {
        let Counted { gaps_s, steady_s, braking_mps2, jerk_mps3, changes } = self;
        let below = gaps_s.iter().filter(|gap_s| **gap_s < 0.5).count();
        let of_changes =
            |value: &dyn Fn(&LaneChange) -> Option<f64>| quantiles(changes.iter().filter_map(value).collect());
        let logarithms: Vec<f64> =
            steady_s.iter().filter(|gap_s| **gap_s > 0.0).map(|gap_s| libm::log(*gap_s)).collect();
        DrivingStatistics {
            name: name.to_owned(),
            time_gap_below_half_share: (!gaps_s.is_empty()).then(|| below as f64 / gaps_s.len() as f64),
            time_gap_s: quantiles(gaps_s),
            steady_time_gap_s: quantiles(steady_s),
            steady_time_gap_deviation: deviation(&logarithms),
            peak_braking_mps2: quantiles(braking_mps2),
            jerk_mps3: quantiles(jerk_mps3),
            accepted_lead_gap_s: of_changes(&|change| change.lead_gap_s),
            accepted_lag_gap_s: of_changes(&|change| change.lag_gap_s),
            lag_braking_mps2: of_changes(&|change| change.lag_braking_mps2),
            lane_change_s: of_changes(&|change| change.duration_s),
        }
    }
}

fn counted(timeline: &Timeline) -> Counted {
    let mut all = Counted::default();
    for number in timeline.motor_tracks() {
        let (mut steady_s, mut peak_mps2, mut last_mps2) = (Vec::new(), None, None);
        for (at, _) in timeline.seconds(number, PAST_S).filter(|(_, repeats)| !repeats) {
            let Some((_, _, known)) = known_at(timeline, number, at.step) else { continue };
            let braking_mps2 = -known.acceleration_mps2;
            peak_mps2 = Some(peak_mps2.map_or(braking_mps2, |peak: f64| peak.max(braking_mps2)));
            all.jerk_mps3.extend(last_mps2.map(|last: f64| (known.acceleration_mps2 - last).abs()));
            last_mps2 = Some(known.acceleration_mps2);
            let Some((gap_m, closing_mps)) = followed(&known) else { continue };
            all.gaps_s.push(gap_m / known.speed_mps);
            if closing_mps.abs() < STEADY_MPS {
                steady_s.push((gap_m - STANDSTILL_M) / known.speed_mps);
            }
        }
        all.braking_mps2.extend(peak_mps2.map(|peak: f64| peak.max(0.0)));
        if steady_s.len() >= STEADY_COUNT {
            all.steady_s.extend(quantiles(steady_s).map(|it| it.median));
        }
    }
    all.changes = lane_changes::of(timeline);
    all
}

/// The gap to the vehicle ahead that is followed \[m\], and the closing speed \[m/s\].
fn followed(known: &TrafficMoment) -> Option<(f64, f64)> {
    let leader = known.leaders().first().copied()?;
    let gap_m = known.gap_m(&leader);
    let is_followed = known.speed_mps > MIN_SPEED_MPS && (0.0..=FOLLOWED_M).contains(&gap_m);
    is_followed.then_some((gap_m, known.speed_mps - leader.speed_mps))
}

/// The quantiles of a sample; none if it is empty.
fn quantiles(mut numbers: Vec<f64>) -> Option<Spread> {
    numbers.sort_by(f64::total_cmp);
    let at = |share: f64| nearest_rank(&numbers, share);
    (!numbers.is_empty()).then(|| Spread { count: numbers.len(), low: at(0.05), median: at(0.5), high: at(0.95) })
}

/// The standard deviation of a sample; none for fewer than two values.
fn deviation(numbers: &[f64]) -> Option<f64> {
    let count = numbers.len() as f64;
    let mean = numbers.iter().sum::<f64>() / count;
    let squares: f64 = numbers.iter().map(|number| (number - mean) * (number - mean)).sum();
    (numbers.len() > 1).then(|| (squares / (count - 1.0)).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_and_deviations_of_a_sample_are_exact() {
        let found = quantiles((0..=100).map(f64::from).collect()).expect("numbers");
        assert_eq!((found.count, found.low, found.median, found.high), (101, 5.0, 50.0, 95.0));
        assert_eq!((quantiles(Vec::new()), deviation(&[1.0])), (None, None));
        assert!((deviation(&[1.0, 3.0]).expect("two") - std::f64::consts::SQRT_2).abs() < 1e-12);
    }
}
