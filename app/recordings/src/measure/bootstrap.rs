//! Bootstrap intervals over cars: predictions of one car are correlated, those of different cars are not.

use interplay_common::random::Random;
use interplay_planners::motion_prediction::{MotionModel, PredictedMotion, STEP_S, STEPS};
use rayon::prelude::*;
use serde::Serialize;

use crate::geometry::Box2;
use crate::start::{HORIZONS_S, Later, Start};
use crate::traffic::Recordings;

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

const COUNT: usize = HORIZONS_S.len();

#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Outcome {
    /// Predicted minus recorded position along the road at each horizon \[m\].
    pub along_m: [f64; COUNT],
    /// The same across the road \[m\].
    pub across_m: [f64; COUNT],
    /// Negative log-likelihood of the recorded position at each horizon.
    pub negative_log_likelihood: [f64; COUNT],
    pub touches_within_3s: bool,
    pub touches_within_5s: bool,
    /// Whether the centre is outside all lanes after 3 s; none without a map.
    pub is_off_road: Option<bool>,
}

/// The mean absolute errors along and across the road at each horizon, on the starts on which models are fitted \[m\].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Scales {
    along_m: [f64; COUNT],
    across_m: [f64; COUNT],
}

/// Minimum scale: records are not more exact than this \[m\].
const LEAST_SCALE_M: f64 = 0.01;

/// Contacts of a predicted body are checked at every this many steps.
const STEPS_BETWEEN: usize = 2;

/// Contact shares are counted up to this time and up to the last horizon \[s\].
const FIRST_S: f64 = 3.0;

impl Scales {
    /// The scales of a model on some starts.
    pub(crate) fn of(model: &MotionModel, starts: &[&Start]) -> Scales {
        use rayon::prelude::*;
        let errors: Vec<_> = starts.par_iter().map(|start| errors_m(&model.predict(&start.known), start)).collect();
        let mean = |index: usize, part: usize| {
            let sum: f64 = errors.iter().map(|errors| errors[part][index].abs()).sum();
            (sum / errors.len().max(1) as f64).max(LEAST_SCALE_M)
        };
        Scales {
            along_m: std::array::from_fn(|index| mean(index, 0)),
            across_m: std::array::from_fn(|index| mean(index, 1)),
        }
    }
}

/// The errors along and across the road at each horizon \[m\].
fn errors_m(motion: &PredictedMotion, start: &Start) -> [[f64; COUNT]; 2] {
    let at = |horizon_s: f64| (horizon_s / STEP_S).round() as usize;
    let along = |index: usize| motion.along_m[at(HORIZONS_S[index])] - start.truth[index].along_m;
    let across = |index: usize| motion.across_m[at(HORIZONS_S[index])] - start.truth[index].across_m;
    [std::array::from_fn(along), std::array::from_fn(across)]
}

impl Outcome {
    /// The outcome of a model's prediction at a start.
    pub(crate) fn of(model: &MotionModel, scales: &Scales, start: &Start, recordings: &Recordings) -> Outcome {
        let motion = model.predict(&start.known);
        let [along_m, across_m] = errors_m(&motion, start);
        let negative_log_likelihood = std::array::from_fn(|index| {
            let term = |error_m: f64, scale_m: f64| libm::log(2.0 * scale_m) + error_m.abs() / scale_m;
            term(along_m[index], scales.along_m[index]) + term(across_m[index], scales.across_m[index])
        });
        let timeline = &recordings.timelines[start.timeline];
        let car = &timeline.tracks[start.track];
        let place = |step: usize| start.way.position(start.along_m + motion.along_m[step], motion.across_m[step]);
        let body = |step: usize| {
            let (middle, heading_rad) = place(step);
            Box2 { middle, heading_rad, half_m: [0.5 * car.length_m, 0.5 * car.width_m] }
        };
        let contact_s = first_contact_s(start, recordings, |step| Some(body(step)));
        let first = (FIRST_S / STEP_S).round() as usize;
        Outcome {
            along_m,
            across_m,
            negative_log_likelihood,
            touches_within_3s: contact_s.is_some_and(|contact_s| contact_s <= FIRST_S + 1e-9),
            touches_within_5s: contact_s.is_some(),
            is_off_road: (!timeline.map.is_empty()).then(|| !timeline.map.covers(place(first).0)),
        }
    }

    /// The outcome of the record itself: contacts of its boxes, and positions outside the lanes of its map.
    pub(crate) fn of_record(start: &Start, recordings: &Recordings) -> Outcome {
        let timeline = &recordings.timelines[start.timeline];
        let later = Later { timeline, track: start.track, step: start.step };
        let contact_s = first_contact_s(start, recordings, |step| later.own_box(STEP_S * step as f64));
        let at_first = later.own_box(FIRST_S).map(|own| own.middle);
        Outcome {
            touches_within_3s: contact_s.is_some_and(|contact_s| contact_s <= FIRST_S + 1e-9),
            touches_within_5s: contact_s.is_some(),
            is_off_road: at_first.filter(|_| !timeline.map.is_empty()).map(|at| !timeline.map.covers(at)),
            ..Outcome::default()
        }
    }
}

/// Time at which a body first overlaps another recorded one \[s\].
fn first_contact_s(start: &Start, recordings: &Recordings, body: impl Fn(usize) -> Option<Box2>) -> Option<f64> {
    let later = Later { timeline: &recordings.timelines[start.timeline], track: start.track, step: start.step };
    let others = later.others();
    let times = (STEPS_BETWEEN..=STEPS).step_by(STEPS_BETWEEN);
    let touches = |step: &usize| body(*step).is_some_and(|own| later.touches(&own, &others, STEP_S * *step as f64));
    times.into_iter().find(touches).map(|step| STEP_S * step as f64)
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
