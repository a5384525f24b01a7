//! How far the driving of one group of recordings is from that of another: simulated traffic from people.

use serde::Serialize;

use super::{Counted, nearest_rank};
use crate::traffic::Recordings;

/// Distance of a distribution from that of the first group.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DrivingDistance {
    /// The group.
    pub name: String,
    /// What is distributed, with its unit.
    pub quantity: &'static str,
    /// Sizes of the samples: of the first group, and of this one.
    pub counts: [usize; 2],
    /// The Wasserstein distance, in the unit of the quantity: by how much values have to change on average.
    pub wasserstein: f64,
    /// The largest difference of the distribution functions (Kolmogorov and Smirnov).
    pub largest_difference: f64,
    /// Share of the sample within 5 to 95 % of the first group's; 0.9 of that itself.
    pub inside_share: f64,
}

impl Recordings {
    /// The distances of all groups from the first, where both have samples.
    pub fn driving_distances(&self) -> Vec<DrivingDistance> {
        let mut samples = self.counted().into_iter().map(Counted::samples);
        let Some(first) = samples.next() else { return Vec::new() };
        let others = samples.zip(&self.groups[1..]);
        others
            .flat_map(|(samples, name)| {
                let pairs = first.iter().zip(samples);
                pairs.filter_map(|((quantity, first), (_, other))| distance(name, quantity, first, &other))
            })
            .collect()
    }
}

impl Counted {
    /// The sorted samples, by quantity.
    fn samples(self) -> [(&'static str, Vec<f64>); 6] {
        let of_changes = |value: fn(&super::LaneChange) -> Option<f64>| self.changes.iter().filter_map(value).collect();
        let mut samples = [
            ("time gap [s]", self.gaps_s.clone()),
            ("peak braking [m/s²]", self.braking_mps2.clone()),
            ("lane changes: gap ahead [s]", of_changes(|it| it.lead_gap_s)),
            ("lane changes: gap behind [s]", of_changes(|it| it.lag_gap_s)),
            ("lane changes: the one behind brakes [m/s²]", of_changes(|it| it.lag_braking_mps2)),
            ("lane changes: duration [s]", of_changes(|it| it.duration_s)),
        ];
        samples.iter_mut().for_each(|(_, sample)| sample.sort_by(f64::total_cmp));
        samples
    }
}

fn distance(name: &str, quantity: &'static str, first: &[f64], other: &[f64]) -> Option<DrivingDistance> {
    if first.is_empty() || other.is_empty() {
        return None;
    }
    let mut values: Vec<f64> = first.iter().chain(other).copied().collect();
    values.sort_by(f64::total_cmp);
    let up_to = |sample: &[f64], value: f64| sample.partition_point(|it| *it <= value) as f64 / sample.len() as f64;
    let differences: Vec<f64> =
        values.iter().map(|value| (up_to(first, *value) - up_to(other, *value)).abs()).collect();
    let areas = values.windows(2).zip(&differences).map(|(pair, difference)| difference * (pair[1] - pair[0]));
    let bounds = [0.05, 0.95].map(|share| nearest_rank(first, share));
    let inside = other.iter().filter(|value| (bounds[0]..=bounds[1]).contains(*value)).count();
    Some(DrivingDistance {
        name: name.to_owned(),
        quantity,
        counts: [first.len(), other.len()],
        wasserstein: areas.sum(),
        largest_difference: differences.iter().copied().fold(0.0, f64::max),
        inside_share: inside as f64 / other.len() as f64,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shifted_distribution_is_as_far_as_the_shift() {
        let people: Vec<f64> = (0..=100).map(f64::from).collect();
        let shifted: Vec<f64> = people.iter().map(|value| value + 10.0).collect();
        let found = distance("b", "x", &people, &shifted).expect("samples");
        assert!((found.wasserstein - 10.0).abs() < 1e-9 && (found.largest_difference - 10.0 / 101.0).abs() < 1e-9);
        assert!((found.inside_share - 86.0 / 101.0).abs() < 1e-9, "{found:?}");
        let same = distance("a", "x", &people, &people).expect("samples");
        assert_eq!((same.wasserstein, same.largest_difference), (0.0, 0.0));
        assert!(distance("a", "x", &people, &[]).is_none());
    }
}
