//! Compares models on recorded cars: fitted on one half of the cars, evaluated on the other.

use std::collections::BTreeMap;

use interplay_common::random::{SplitMix64, hash_of};
use rayon::prelude::*;
use serde::Serialize;

use crate::driving::DrivingStatistics;
use crate::error::RecordingsError;
use crate::measure::{MeasureInterval, ModelMeasures, Outcome, Resamples, Scales, Sums, measures};
use crate::models::{Fits, NamedModel, every};
use crate::start::{Start, starts};
use crate::traffic::Recordings;

/// Minimum number of starts in each half of the cars.
const MIN_STARTS: usize = 10;
/// Maximum number of starts of each group on which a planning model is fitted; other models are fitted on all starts.
const MAX_PLANNED_STARTS: usize = 350;
/// The same if one of many groups is left out, of all models and of those that plan.
const MAX_STARTS_OF_GROUP: usize = 1000;
const MAX_PLANNED_STARTS_OF_GROUP: usize = 80;
/// Maximum number of starts on which the scales of the likelihoods are estimated.
const MAX_SCALE_STARTS: usize = 300;

/// Comparison of how models predict recorded cars.
#[derive(Clone, Debug, Serialize)]
pub struct PredictionComparison {
    /// Number of starts on which models were fitted.
    pub fitted_on_starts: usize,
    /// Number of cars with these starts.
    pub fitted_on_cars: usize,
    /// Whether each group was judged by models fitted on all others.
    pub leaves_one_out: bool,
    /// All held-out cars together, and those of each group of recordings; all come last where one group was left out at a time.
    pub groups: Vec<GroupComparison>,
    /// How all recorded cars of each group drive; empty where one group was left out at a time.
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
    let (training, held_out): (Vec<&Start>, Vec<&Start>) =
        starts.iter().partition(|start| is_for_fitting(recordings.car(start)));
    if training.len().min(held_out.len()) < MIN_STARTS {
        return Err(RecordingsError::TooFewStarts { starts: starts.len() });
    }
    let held_out = every(&held_out, most_starts);
    let models = Fits::on(&training, [usize::MAX, MAX_PLANNED_STARTS]).models(None);
    let judged = Judged::of(models, &training, held_out, recordings);
    let mut groups = vec![judged.group("all", |_| true)];
    if recordings.groups.len() > 1 {
        let named = recordings.groups.iter().enumerate();
        groups.extend(named.map(|(group, name)| judged.group(name, |start| start.group == group)));
        groups.retain(|group| group.starts > 0);
    }
    Ok(PredictionComparison { driving: recordings.driving(), ..comparison(&training, groups, recordings) })
}

/// Compares all models on each group of recordings, fitted on all others: on at most `most_starts` of each. The last group is the pool of
/// all, the one before it those of its cars that move sideways at the start.
///
/// # Errors
/// [`RecordingsError::TooFewStarts`] with fewer than two groups that have enough starts.
pub fn leave_one_out(recordings: &Recordings, most_starts: usize) -> Result<PredictionComparison, RecordingsError> {
    let starts = starts(recordings);
    let all: Vec<&Start> = starts.iter().collect();
    let of_group = |group: usize| -> Vec<&Start> { all.iter().copied().filter(|it| it.group == group).collect() };
    let sites: Vec<usize> = (0..recordings.groups.len()).filter(|group| of_group(*group).len() >= MIN_STARTS).collect();
    if sites.len() < 2 {
        return Err(RecordingsError::TooFewStarts { starts: starts.len() });
    }
    let fits = Fits::on(&all, [MAX_STARTS_OF_GROUP, MAX_PLANNED_STARTS_OF_GROUP]);
    let mut groups = Vec::new();
    let mut pool: Option<Judged<'_>> = None;
    for site in sites {
        let others: Vec<&Start> = all.iter().copied().filter(|it| it.group != site).collect();
        let judged = Judged::of(fits.models(Some(site)), &others, every(&of_group(site), most_starts), recordings);
        groups.push(judged.group(&recordings.groups[site], |_| true));
        pool = Some(match pool {
            Some(pool) => pool.with(judged),
            None => judged,
        });
    }
    if let Some(mut pool) = pool {
        pool.models.iter_mut().for_each(|model| model.fitted.clear());
        let sideways = pool.group("moving sideways", |start| start.known.moves_sideways());
        groups.extend(Some(sideways).filter(|group| group.starts > 0));
        groups.push(pool.group("all", |_| true));
    }
    Ok(PredictionComparison { leaves_one_out: true, ..comparison(&all, groups, recordings) })
}

fn comparison(training: &[&Start], groups: Vec<GroupComparison>, recordings: &Recordings) -> PredictionComparison {
    let mut cars: Vec<&str> = training.iter().map(|start| recordings.car(start)).collect();
    cars.sort_unstable();
    cars.dedup();
    PredictionComparison {
        fitted_on_starts: training.len(),
        fitted_on_cars: cars.len(),
        leaves_one_out: false,
        groups,
        driving: Vec::new(),
    }
}

impl Recordings {
    /// The name of the car of a start.
    fn car(&self, start: &Start) -> &str {
        &self.timelines[start.timeline].tracks[start.track].car
    }
}

/// Whether a car belongs to the half on which models are fitted; depends on its name alone.
fn is_for_fitting(car: &str) -> bool {
    SplitMix64::new(hash_of(car)).next_u64() & 1 == 0
}

/// The outcomes of all models at the held-out starts.
struct Judged<'a> {
    starts: Vec<&'a Start>,
    cars: Vec<&'a str>,
    models: Vec<NamedModel>,
    outcomes: Vec<Vec<Outcome>>,
    recorded: Vec<Outcome>,
}

impl<'a> Judged<'a> {
    fn of(
        models: Vec<NamedModel>,
        training: &[&Start],
        held_out: Vec<&'a Start>,
        recordings: &'a Recordings,
    ) -> Judged<'a> {
        let for_scales = every(training, MAX_SCALE_STARTS);
        let outcomes = models.iter().map(|it| {
            let scales = Scales::of(&it.model, &for_scales);
            held_out.par_iter().map(|start| Outcome::of(&it.model, &scales, start, recordings)).collect()
        });
        let outcomes = outcomes.collect();
        let recorded = held_out.par_iter().map(|start| Outcome::of_record(start, recordings)).collect();
        let cars = held_out.iter().map(|start| recordings.car(start)).collect();
        Judged { starts: held_out, cars, models, outcomes, recorded }
    }

    /// Both together; the models are those of the first.
    fn with(mut self, other: Judged<'a>) -> Judged<'a> {
        self.starts.extend(other.starts);
        self.cars.extend(other.cars);
        self.outcomes.iter_mut().zip(other.outcomes).for_each(|(own, others)| own.extend(others));
        self.recorded.extend(other.recorded);
        self
    }

    /// The measures on some of the starts.
    fn group(&self, name: &str, belongs: impl Fn(&Start) -> bool) -> GroupComparison {
        let indices: Vec<usize> = (0..self.starts.len()).filter(|index| belongs(self.starts[*index])).collect();
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
