//! Fits a human driver model to a recorded trajectory.
//!
//! From each second of the record with a leader in sight, a candidate driver plans from the state at that second; its
//! plan is compared with the record 1, 2 and 3 s later. The fit determines the time gap, the weight on changes of the
//! acceleration (comfort) and, as a nuisance parameter, the desired speed. The style is the safety weight at which the
//! human driver model keeps that time gap; yielding is not considered.
//!
//! Intervals come from a bootstrap over blocks of consecutive starts, since neighbouring errors are correlated. They are widened by the
//! grid of candidates.

mod candidates;
mod evidence;

use interplay_planners::ComfortLimits;
use interplay_planners::drivers::human::safety_weight_keeping;
use interplay_planners::motion_prediction::PredictedDriver;
use rayon::prelude::*;
use serde::Serialize;

use crate::error::RecordingsError;
use crate::measure::{MeasureInterval, nearest_rank};
use crate::traffic::Recordings;
use candidates::{COMFORTS, RATIOS, WANTED_RATIOS, driver, style_of};
use evidence::{Evidence, evidence};

/// The time gap of which the candidates' are multiples \[s\].
fn usual_gap_s() -> f64 {
    ComfortLimits::default().time_gap_s
}

/// A driver that is fitted to a vehicle.
#[derive(Clone, Debug, Serialize)]
pub struct FittedDriver {
    /// The vehicle.
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
    /// The names of all vehicles.
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
    let [ratio, comfort] = candidates::least(&grid, &errors, &all);
    let drawn: Vec<[f64; 2]> = (0..RESAMPLES)
        .into_par_iter()
        .map(|resample| candidates::least(&grid, &errors, &evidence::resampled(evidence.starts.len(), BLOCK, resample)))
        .collect();
    let interval = |value: f64, index: usize, steps: [f64; 2]| {
        let mut values: Vec<f64> = drawn.iter().map(|drawn| drawn[index]).collect();
        values.sort_by(f64::total_cmp);
        let at = |share: f64| nearest_rank(&values, share);
        MeasureInterval { value, low: at(0.025).min(value) / steps[0], high: at(0.975).max(value) * steps[1] }
    };
    let gap = interval(ratio, 0, [candidates::RATIO_STEP; 2]);
    let scaled = |by: f64| MeasureInterval { value: by * gap.value, low: by * gap.low, high: by * gap.high };
    let [value, low, high] = [gap.value, gap.low, gap.high].map(safety_weight_keeping);
    let safety = MeasureInterval { value, low, high };
    let best: PredictedDriver = driver(ratio, comfort, wanted_mps);
    FittedDriver {
        vehicle: vehicle.to_owned(),
        starts: evidence.starts.len(),
        time_gap_s: scaled(usual_gap_s()),
        acceleration_change: interval(comfort, 1, [candidates::COMFORT_STEP; 2]),
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
