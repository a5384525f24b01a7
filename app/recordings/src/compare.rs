//! Compares models on recorded cars: fitted on one half of the cars, evaluated on the other.

use std::collections::BTreeMap;

use interplay_common::random::{SplitMix64, hash_of};
use rayon::prelude::*;
use serde::Serialize;

use crate::driving::DrivingStatistics;
use crate::error::RecordingsError;
use crate::measure::{MeasureInterval, ModelMeasures, Outcome, Resamples, Scales, Sums, measures};
use crate::models::{self, NamedModel, every};
use crate::start::{Start, starts};
use crate::traffic::Recordings;

/// Minimum number of starts in each half of the cars.
const MIN_STARTS: usize = 10;
/// Maximum number of starts on which the scales of the likelihoods are estimated.
const MAX_SCALE_STARTS: usize = 1500;

/// Comparison of how models predict recorded cars.
#[derive(Clone, Debug, Serialize)]
pub struct PredictionComparison {
    /// Number of starts on which models were fitted.
    pub fitted_on_starts: usize,
    /// Number of cars with these starts.
    pub fitted_on_cars: usize,
    /// All held-out cars together, and those of each group of recordings.
    pub groups: Vec<GroupComparison>,
    /// How all recorded cars of each group drive.
    pub driving: Vec<DrivingStatistics>,
}

/// Comparison on the held-out cars of a group of recordings.
#[derive(Clone, Debug, Serialize)]
pub struct GroupComparison {
    /// Its name; `all` for all groups together.
    pub name: String,
    pub starts: usize,
    /// Number of cars with these starts.
    pub cars: usize,
    /// Share of the recorded cars whose recorded body overlaps another one within 3 s, since boxes are not exact.
    pub recorded_contact_share_3s: MeasureInterval,
    /// Share of the recorded cars that are outside all lanes of the map after 3 s; none without a map.
    pub recorded_off_road_share: Option<MeasureInterval>,
    pub models: Vec<ComparedModel>,
}

#[derive(Clone, Debug, Serialize)]
pub struct ComparedModel {
    /// The model.
    #[serde(flatten)]
    pub model: NamedModel,
    /// How well it predicts.
    #[serde(flatten)]
    pub measures: ModelMeasures,
}

/// Compares all models on recordings, on at most `most_starts` held-out starts.
///
/// # Errors
/// [`RecordingsError::TooFewStarts`] if a half of the cars has too few starts.
pub fn compare(recordings: &Recordings, most_starts: usize) -> Result<PredictionComparison, RecordingsError> {
    let starts = starts(recordings);
    let car = |start: &Start| recordings.timelines[start.timeline].tracks[start.track].car.as_str();
    let (training, held_out): (Vec<&Start>, Vec<&Start>) = starts.iter().partition(|start| is_for_fitting(car(start)));
    if training.len().min(held_out.len()) < MIN_STARTS {
        return Err(RecordingsError::TooFewStarts { starts: starts.len() });
    }
    let held_out = every(&held_out, most_starts);
    let models = models::all(&training);
    let for_scales = every(&training, MAX_SCALE_STARTS);
    let outcomes: Vec<Vec<Outcome>> = models
        .iter()
        .map(|it| {
            let scales = Scales::of(&it.model, &for_scales);
            held_out.par_iter().map(|start| Outcome::of(&it.model, &scales, start, recordings)).collect()
        })
        .collect();
    let recorded: Vec<Outcome> = held_out.par_iter().map(|start| Outcome::of_record(start, recordings)).collect();
    let judged = Judged { cars: held_out.iter().map(|start| car(start)).collect(), models, outcomes, recorded };
    let all = (0..held_out.len()).collect();
    let of_group = |group: usize| (0..held_out.len()).filter(|index| held_out[*index].group == group).collect();
    let mut groups = vec![judged.group("all", all)];
    if recordings.groups.len() > 1 {
        let named = recordings.groups.iter().enumerate().filter_map(|(group, name)| {
            let indices: Vec<usize> = of_group(group);
            (!indices.is_empty()).then(|| judged.group(name, indices))
        });
        groups.extend(named);
    }
    let mut cars: Vec<&str> = training.iter().map(|start| car(start)).collect();
    cars.sort_unstable();
    cars.dedup();
    Ok(PredictionComparison {
        fitted_on_starts: training.len(),
        fitted_on_cars: cars.len(),
        groups,
        driving: recordings.driving(),
    })
}

/// Whether a car belongs to the half on which models are fitted; depends on its name alone.
fn is_for_fitting(car: &str) -> bool {
    SplitMix64::new(hash_of(car)).next_u64() & 1 == 0
}

/// The outcomes of all models at the held-out starts.
struct Judged<'a> {
    cars: Vec<&'a str>,
    models: Vec<NamedModel>,
    outcomes: Vec<Vec<Outcome>>,
    recorded: Vec<Outcome>,
}

impl Judged<'_> {
    /// The measures on some of the starts.
    fn group(&self, name: &str, indices: Vec<usize>) -> GroupComparison {
        let mut numbers: BTreeMap<&str, usize> = BTreeMap::new();
        let car_of_start = indices.iter().map(|index| {
            let next = numbers.len();
            *numbers.entry(self.cars[*index]).or_insert(next)
        });
        let resamples = Resamples::of(car_of_start.collect());
        let chosen =
            |outcomes: &[Outcome]| -> Vec<Outcome> { indices.iter().map(|index| outcomes[*index].clone()).collect() };
        let named = |name: &str| self.models.iter().position(|it| it.name == name).unwrap_or(0);
        let [cv, idm] = [named("constant velocity"), named("IDM, fitted")].map(|index| chosen(&self.outcomes[index]));
        let models = self.models.iter().zip(&self.outcomes).map(|(model, outcomes)| ComparedModel {
            model: model.clone(),
            measures: measures(&resamples, &chosen(outcomes), [&cv, &idm]),
        });
        let models = models.collect();
        let recorded = chosen(&self.recorded);
        let share = |is_so: &dyn Fn(&Outcome) -> bool| {
            let sums = Sums::of(&resamples, &recorded, &|outcome| f64::from(u8::from(is_so(outcome))));
            resamples.estimate(&[sums], |it| it[0])
        };
        let has_map = recorded.iter().any(|outcome| outcome.is_off_road.is_some());
        GroupComparison {
            name: name.to_owned(),
            starts: indices.len(),
            cars: resamples.cars(),
            recorded_contact_share_3s: share(&|outcome| outcome.touches_within_3s),
            recorded_off_road_share: has_map.then(|| share(&|outcome| outcome.is_off_road == Some(true))),
            models,
        }
    }
}
