//! Bootstrap intervals over cars: predictions of one car are correlated, those of different cars are not.

use interplay_common::random::Random;
use rayon::prelude::*;
use serde::Serialize;

use super::Outcome;

const RESAMPLES: u64 = 1000;
/// Seed of all intervals: the same recordings give the same intervals.
const SEED: u64 = 46;

/// A number with its 95 % interval, by a bootstrap over cars.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct MeasureInterval {
    pub value: f64,
    pub low: f64,
    pub high: f64,
}

/// Resamples of the cars, with the number of times that each car was drawn.
pub(crate) struct Resamples {
    cars: usize,
    car_of_start: Vec<usize>,
    counts: Vec<Vec<u32>>,
}

/// Sums and counts of values for each car.
pub(crate) struct Sums(Vec<[f64; 2]>);

impl Sums {
    /// Sums a value over outcomes, which are in the order of the starts.
    pub(crate) fn of(resamples: &Resamples, outcomes: &[Outcome], value: &dyn Fn(&Outcome) -> f64) -> Sums {
        let mut sums = vec![[0.0; 2]; resamples.cars];
        for (car, outcome) in resamples.car_of_start.iter().zip(outcomes) {
            sums[*car][0] += value(outcome);
            sums[*car][1] += 1.0;
        }
        Sums(sums)
    }

    /// The mean value, each car weighted by its count.
    fn mean(&self, counts: &[u32]) -> f64 {
        let mut total = [0.0; 2];
        for (sums, count) in self.0.iter().zip(counts) {
            total[0] += f64::from(*count) * sums[0];
            total[1] += f64::from(*count) * sums[1];
        }
        total[0] / total[1].max(1.0)
    }
}

impl Resamples {
    /// Resamples the cars to which starts belong; cars are numbered from 0.
    pub(crate) fn of(car_of_start: Vec<usize>) -> Resamples {
        let cars = car_of_start.iter().max().map_or(0, |last| last + 1);
        // Each resample has its own random stream, so the result does not depend on threads.
        let drawn = |resample: u64| {
            let mut random = Random::new(SEED, resample);
            let mut counts = vec![0; cars];
            for _ in 0..cars {
                counts[(random.uniform(0.0, cars as f64) as usize).min(cars - 1)] += 1;
            }
            counts
        };
        Resamples { cars, car_of_start, counts: (0..RESAMPLES).into_par_iter().map(drawn).collect() }
    }

    pub(crate) fn cars(&self) -> usize {
        self.cars
    }

    /// A function of mean values, with its interval.
    pub(crate) fn estimate<const N: usize>(
        &self,
        sums: &[Sums; N],
        value: impl Fn([f64; N]) -> f64,
    ) -> MeasureInterval {
        let of = |counts: &[u32]| value(std::array::from_fn(|index| sums[index].mean(counts)));
        let mut drawn: Vec<f64> = self.counts.iter().map(|counts| of(counts)).collect();
        drawn.sort_by(f64::total_cmp);
        let at = |share: f64| nearest_rank(&drawn, share);
        MeasureInterval { value: of(&vec![1; self.cars]), low: at(0.025), high: at(0.975) }
    }
}

/// The nearest-rank quantile of ascending numbers, which must not be empty.
pub(crate) fn nearest_rank(ascending: &[f64], share: f64) -> f64 {
    ascending[(share * (ascending.len() - 1) as f64).round() as usize]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_reflect_the_number_of_cars_and_not_of_starts() {
        // Two kinds of cars, ten starts each: the mean has the standard error of forty cars, 0.5/√40.
        let car_of_start: Vec<usize> = (0..400).map(|start| start / 10).collect();
        let resamples = Resamples::of(car_of_start);
        let outcomes: Vec<Outcome> = (0..400)
            .map(|start| Outcome { along_m: [f64::from(u8::from((start / 10) % 2 == 0)); 5], ..Outcome::default() })
            .collect();
        let estimate = resamples.estimate(&[Sums::of(&resamples, &outcomes, &|it| it.along_m[0])], |it| it[0]);
        let half_width = 1.96 * 0.5 / 40.0_f64.sqrt();
        assert_eq!(estimate.value, 0.5);
        assert!(
            (estimate.high - 0.5 - half_width).abs() < 0.04 && (0.5 - estimate.low - half_width).abs() < 0.04,
            "{estimate:?}"
        );
        assert_eq!(resamples.cars(), 40);
    }
}
