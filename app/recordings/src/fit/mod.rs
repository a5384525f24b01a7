//! Fits a human driver model to a recorded trajectory.
//!
//! From each second of the record with a leader in sight, a candidate driver plans from the state at that second; its
//! plan is compared with the record 1, 2 and 3 s later. The fit determines the time gap, the weight on changes of the
//! acceleration (comfort) and, as a nuisance parameter, the desired speed. The style is the safety weight at which the
//! human driver model keeps that time gap; yielding is not considered.
//!
//! Intervals come from a bootstrap over blocks of consecutive starts, since neighbouring errors are correlated. They are widened by the
//! grid of candidates.

use interplay_common::random::Random;
use interplay_planners::ComfortLimits;
use interplay_planners::drivers::human::{Settings, Style, safety_weight_keeping};
use interplay_planners::motion_prediction::{LateralMotion, MotionModel, PredictedDriver, STEP_S, TrafficMoment};
use rayon::prelude::*;
use serde::Serialize;

use crate::error::RecordingsError;
use crate::measure::{MeasureInterval, nearest_rank};
use crate::start::{Later, PAST_S, known_at};
use crate::traffic::{Recordings, Timeline};

/// The time gap of which the candidates' are multiples \[s\].
fn usual_gap_s() -> f64 {
    ComfortLimits::default().time_gap_s
}

/// A driver that is fitted to a vehicle.
#[derive(Clone, Debug, Serialize)]
pub struct FittedDriver {
    pub vehicle: String,
    /// Number of starts with a vehicle ahead on which it was fitted.
    pub starts: usize,
    /// The time gap that it keeps beyond 3.5 m \[s\].
    pub time_gap_s: MeasureInterval,
    /// The weight of changes of its acceleration \[s⁴/m²\].
    pub acceleration_change: MeasureInterval,
    /// The safety weight at which our human keeps that time gap.
    pub safety_weight: MeasureInterval,
    /// The style whose weight is nearest to it.
    pub style: &'static str,
    /// Its desired speed \[m/s\].
    pub wanted_mps: f64,
    /// Root mean squared error along the road after 3 s \[m\].
    pub along_rmse_m: f64,
    /// The same for a prediction at constant velocity \[m\].
    pub constant_velocity_rmse_m: f64,
}

/// Minimum number of starts with a leader.
const MIN_STARTS: usize = 10;
/// Number of starts in a block: errors within 3 s of one another are correlated.
const BLOCK: usize = 4;
const RESAMPLES: u64 = 400;

impl Recordings {
    pub fn vehicle_ids(&self) -> Vec<&str> {
        self.timelines.iter().flat_map(|timeline| &timeline.tracks).map(|track| track.id.as_str()).collect()
    }
}

/// Fits a driver to a vehicle of recordings.
///
/// # Errors
/// [`RecordingsError::UnknownVehicle`] and [`RecordingsError::TooLittleFollowing`].
pub fn fit_driver(recordings: &Recordings, vehicle: &str) -> Result<FittedDriver, RecordingsError> {
    let places = recordings.timelines.iter().enumerate();
    let mut found = places.flat_map(|(timeline, it)| {
        it.tracks.iter().enumerate().filter(|(_, track)| track.id == vehicle).map(move |(track, _)| (timeline, track))
    });
    let (timeline, track) =
        found.next().ok_or_else(|| RecordingsError::UnknownVehicle { vehicle: vehicle.to_owned() })?;
    let evidence = evidence(&recordings.timelines[timeline], track);
    if evidence.starts.len() < MIN_STARTS {
        let starts = evidence.starts.len();
        return Err(RecordingsError::TooLittleFollowing { vehicle: vehicle.to_owned(), starts, needed: MIN_STARTS });
    }
    Ok(fitted(vehicle, &evidence))
}

fn fitted(vehicle: &str, evidence: &Evidence) -> FittedDriver {
    let wanted_mps = wanted_mps(evidence);
    let grid: Vec<[usize; 2]> =
        (0..RATIOS.len()).flat_map(|ratio| (0..COMFORTS.len()).map(move |comfort| [ratio, comfort])).collect();
    let errors: Vec<Vec<f64>> = grid
        .par_iter()
        .map(|[ratio, comfort]| evidence.squares(&driver(RATIOS[*ratio], COMFORTS[*comfort], wanted_mps)))
        .collect();
    let all: Vec<u32> = vec![1; evidence.starts.len()];
    let [ratio, comfort] = least(&grid, &errors, &all);
    let drawn: Vec<[f64; 2]> = (0..RESAMPLES)
        .into_par_iter()
        .map(|resample| least(&grid, &errors, &resampled(evidence.starts.len(), BLOCK, resample)))
        .collect();
    let interval = |value: f64, index: usize, steps: [f64; 2]| {
        let mut values: Vec<f64> = drawn.iter().map(|drawn| drawn[index]).collect();
        values.sort_by(f64::total_cmp);
        let at = |share: f64| nearest_rank(&values, share);
        MeasureInterval { value, low: at(0.025).min(value) / steps[0], high: at(0.975).max(value) * steps[1] }
    };
    let gap = interval(ratio, 0, [RATIO_STEP; 2]);
    let scaled = |by: f64| MeasureInterval { value: by * gap.value, low: by * gap.low, high: by * gap.high };
    let [value, low, high] = [gap.value, gap.low, gap.high].map(safety_weight_keeping);
    let safety = MeasureInterval { value, low, high };
    let best: PredictedDriver = driver(ratio, comfort, wanted_mps);
    FittedDriver {
        vehicle: vehicle.to_owned(),
        starts: evidence.starts.len(),
        time_gap_s: scaled(usual_gap_s()),
        acceleration_change: interval(comfort, 1, [COMFORT_STEP; 2]),
        safety_weight: safety,
        style: style_of(safety.value),
        wanted_mps,
        along_rmse_m: evidence.rmse_m(Some(&best)),
        constant_velocity_rmse_m: evidence.rmse_m(None),
    }
}

/// The desired speed with the least error, for a driver of usual comfort and the best of a few time gaps \[m/s\].
fn wanted_mps(evidence: &Evidence) -> f64 {
    let tried: Vec<(f64, f64)> = WANTED_RATIOS
        .into_par_iter()
        .map(|ratio| {
            let wanted_mps = ratio * evidence.fastest_mps;
            let error =
                |gap: usize| -> f64 { evidence.squares(&driver(RATIOS[gap], COMFORTS[1], wanted_mps)).iter().sum() };
            let least = (0..RATIOS.len()).step_by(3).map(error).fold(f64::INFINITY, f64::min);
            (least, wanted_mps)
        })
        .collect();
    tried.into_iter().min_by(|a, b| a.0.total_cmp(&b.0)).map_or(evidence.fastest_mps, |(_, wanted_mps)| wanted_mps)
}

#[cfg(test)]
mod tests;

/// Intervals of time gaps are widened by this ratio, since candidates are discrete. The ratio was chosen on the simulated
/// drivers of `coverage_of_the_intervals`, so that 95 % of their true values lie within.
const RATIO_STEP: f64 = 1.02;
/// The same ratio for comforts, which is that of two neighbouring candidates.
const COMFORT_STEP: f64 = 1.3;
/// Time gaps, as multiples of the usual one.
const RATIOS: [f64; 13] = [0.4, 0.47, 0.55, 0.64, 0.74, 0.85, 0.97, 1.1, 1.25, 1.42, 1.62, 1.85, 2.1];
/// Weights of changes of the acceleration \[s⁴/m²\].
const COMFORTS: [f64; 7] = [0.03, 0.06, 0.1, 0.17, 0.3, 0.5, 0.9];
/// Desired speeds, as multiples of the highest one in the record.
const WANTED_RATIOS: [f64; 5] = [0.95, 1.0, 1.08, 1.2, 1.4];

fn driver(time_gap_ratio: f64, acceleration_change: f64, wanted_mps: f64) -> PredictedDriver {
    PredictedDriver {
        settings: Settings { style: Some(Style::Normal), time_gap_ratio: Some(time_gap_ratio), ..Settings::default() },
        acceleration_change,
        wanted_mps: Some(wanted_mps),
        looks_beside: false,
        sees_motion: false,
        lateral: Some(LateralMotion::Kept),
        ..PredictedDriver::usual()
    }
}

/// The style with the nearest weight, on the scale on which weights change time gaps.
fn style_of(weight: f64) -> &'static str {
    let away = |style: &Style| (libm::log1p(style.safety_weight()) - libm::log1p(weight)).abs();
    let nearest = Style::ALL.into_iter().min_by(|a, b| away(a).total_cmp(&away(b)));
    nearest.unwrap_or(Style::Normal).name()
}

/// The candidate with the least weighted sum of errors, refined between its neighbours by parabolas. `counts` are the weights.
fn least(grid: &[[usize; 2]], errors: &[Vec<f64>], counts: &[u32]) -> [f64; 2] {
    let total =
        |errors: &Vec<f64>| -> f64 { errors.iter().zip(counts).map(|(error, count)| f64::from(*count) * error).sum() };
    let sums: Vec<f64> = errors.iter().map(total).collect();
    let best = (0..sums.len()).min_by(|a, b| sums[*a].total_cmp(&sums[*b])).unwrap_or(0);
    let at = |place: [usize; 2]| sums[place[0] * COMFORTS.len() + place[1]];
    let place = grid[best];
    std::array::from_fn(|axis| {
        let values: &[f64] = if axis == 0 { &RATIOS } else { &COMFORTS };
        let index = place[axis];
        if index == 0 || index + 1 == values.len() {
            return values[index];
        }
        let beside = |index: usize| {
            let mut moved = place;
            moved[axis] = index;
            at(moved)
        };
        let [below, here, above] = [beside(index - 1), beside(index), beside(index + 1)];
        let bend = below - 2.0 * here + above;
        let shift = if bend > 0.0 { (0.5 * (below - above) / bend).clamp(-0.5, 0.5) } else { 0.0 };
        let neighbour = if shift < 0.0 { values[index - 1] } else { values[index + 1] };
        values[index] * libm::pow(neighbour / values[index], shift.abs())
    })
}

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
struct Evidence {
    pub starts: Vec<EvidenceStart>,
    /// The highest speed in the record \[m/s\].
    pub fastest_mps: f64,
}

/// A start with a vehicle ahead, and the distance travelled up to each horizon \[m\].
struct EvidenceStart {
    known: TrafficMoment,
    along_m: [f64; HORIZONS.len()],
}

fn evidence(timeline: &Timeline, track: usize) -> Evidence {
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
    fn squares(&self, driver: &PredictedDriver) -> Vec<f64> {
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
    fn rmse_m(&self, driver: Option<&PredictedDriver>) -> f64 {
        let model = driver.map_or(MotionModel::ConstantVelocity, |driver| MotionModel::Driver(driver.clone()));
        let last = HORIZONS.len() - 1;
        let step = (HORIZONS[last].0 / STEP_S).round() as usize;
        let square = |start: &EvidenceStart| (model.predict(&start.known).along_m[step] - start.along_m[last]).powi(2);
        let sum: f64 = self.starts.iter().map(square).sum();
        (sum / self.starts.len().max(1) as f64).sqrt()
    }
}

/// How often each start is drawn when blocks of starts are drawn with replacement.
fn resampled(starts: usize, block: usize, resample: u64) -> Vec<u32> {
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

#[cfg(test)]
mod candidates_tests {
    use interplay_planners::drivers::human::safety_weight_keeping;

    use super::*;

    #[test]
    fn safety_weights_convert_to_time_gaps_and_back() {
        for (ratio, weight) in [(0.6, 0.0), (1.4, 50.0), (0.3, 0.0), (2.0, 50.0)] {
            assert!((safety_weight_keeping(ratio) - weight).abs() < 1e-9, "{ratio}");
        }
        assert_eq!([0.0, 3.0, 9.0, 45.0].map(style_of), ["tough", "assertive", "normal", "nice"]);
    }

    #[test]
    fn the_fitted_minimum_is_interpolated_between_candidates() {
        let grid: Vec<[usize; 2]> =
            (0..RATIOS.len()).flat_map(|ratio| (0..COMFORTS.len()).map(move |comfort| [ratio, comfort])).collect();
        let bowl = |place: &[usize; 2]| {
            let [ratio, comfort] = [libm::log(RATIOS[place[0]] / 1.0), libm::log(COMFORTS[place[1]] / 0.2)];
            vec![ratio * ratio + 0.1 * comfort * comfort]
        };
        let errors: Vec<Vec<f64>> = grid.iter().map(bowl).collect();
        let [ratio, comfort] = least(&grid, &errors, &[1]);
        assert!((ratio - 1.0).abs() < 0.02 && (comfort - 0.2).abs() < 0.02, "{ratio}, {comfort}");
    }
}
