//! Evidence of a record about a driver: starts with a vehicle ahead, and later positions.

use interplay_common::random::Random;
use interplay_planners::motion_prediction::{MotionModel, PredictedDriver, STEP_S, TrafficMoment};

use crate::start::{Later, PAST_S, known_at};
use crate::traffic::Timeline;

/// A vehicle is not followed from beyond this time gap \[s\].
const FOLLOWED_S: f64 = 6.0;
/// A vehicle is followed within this distance at any speed \[m\].
const FOLLOWED_M: f64 = 20.0;
/// Maximum number of starts; those of a long record are spread evenly.
const MAX_STARTS: usize = 120;
/// The horizons \[s\] with the weight of a squared error at each: errors grow roughly with the square of the horizon.
const HORIZONS: [(f64, f64); 3] = [(1.0, 9.0), (2.0, 1.5), (3.0, 0.5)];
const SEED: u64 = 64;

/// The evidence of a record about a driver.
pub(super) struct Evidence {
    pub starts: Vec<EvidenceStart>,
    /// The highest speed in the record \[m/s\].
    pub fastest_mps: f64,
}

/// A start with a vehicle ahead, and the distance travelled up to each horizon \[m\].
pub(super) struct EvidenceStart {
    known: TrafficMoment,
    along_m: [f64; HORIZONS.len()],
}

pub(super) fn evidence(timeline: &Timeline, track: usize) -> Evidence {
    let car = &timeline.tracks[track];
    let starts = timeline.seconds(track, PAST_S).filter_map(|(at, _)| {
        let (way, along_m, known) = known_at(timeline, track, at.step)?;
        let leader = known.leaders().first().copied()?;
        let gap_m = known.gap_m(&leader);
        if gap_m > FOLLOWED_M.max(FOLLOWED_S * known.speed_mps) {
            return None;
        }
        let truth = Later { timeline, track, step: at.step }.truth(&way, along_m)?;
        Some(EvidenceStart { known, along_m: std::array::from_fn(|index| truth[index].along_m) })
    });
    let mut starts: Vec<EvidenceStart> = starts.collect();
    if starts.len() > MAX_STARTS {
        let count = starts.len();
        let mut index = 0;
        starts.retain(|_| {
            index += 1;
            index * MAX_STARTS / count > (index - 1) * MAX_STARTS / count
        });
    }
    let fastest_mps = car.moments.iter().map(|at| at.speed_mps).fold(1.0, f64::max);
    Evidence { starts, fastest_mps }
}

impl Evidence {
    /// The weighted squared errors of a candidate at each start.
    pub(super) fn squares(&self, driver: &PredictedDriver) -> Vec<f64> {
        let model = MotionModel::Driver(driver.clone());
        let square = |start: &EvidenceStart| -> f64 {
            let motion = model.predict(&start.known);
            let errors = HORIZONS.iter().zip(start.along_m).map(|((horizon_s, weight), along_m)| {
                let error_m = motion.along_m[(horizon_s / STEP_S).round() as usize] - along_m;
                weight * error_m * error_m
            });
            errors.sum()
        };
        self.starts.iter().map(square).collect()
    }

    /// Root mean squared error after 3 s of a driver, or of constant velocity \[m\].
    pub(super) fn rmse_m(&self, driver: Option<&PredictedDriver>) -> f64 {
        let model = driver.map_or(MotionModel::ConstantVelocity, |driver| MotionModel::Driver(driver.clone()));
        let last = HORIZONS.len() - 1;
        let step = (HORIZONS[last].0 / STEP_S).round() as usize;
        let square = |start: &EvidenceStart| (model.predict(&start.known).along_m[step] - start.along_m[last]).powi(2);
        let sum: f64 = self.starts.iter().map(square).sum();
        (sum / self.starts.len().max(1) as f64).sqrt()
    }
}

/// How often each start is drawn when blocks of starts are drawn with replacement.
pub(super) fn resampled(starts: usize, block: usize, resample: u64) -> Vec<u32> {
    let mut random = Random::new(SEED, resample);
    let mut counts = vec![0; starts];
    let mut drawn = 0;
    while drawn < starts {
        let from = (random.uniform(0.0, starts as f64) as usize).min(starts - 1);
        for index in from..from + block.min(starts - drawn) {
            counts[index % starts] += 1;
            drawn += 1;
        }
    }
    counts
}
