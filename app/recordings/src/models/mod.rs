//! The models that are compared, and how they are fitted.

mod families;
mod search;

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use interplay_planners::motion_prediction::MotionModel;
use serde::Serialize;

use crate::start::Start;
pub(crate) use families::decay_s;
use families::{FAMILIES, Family};

#[derive(Clone, Debug, Serialize)]
pub struct NamedModel {
    pub name: String,
    /// Its fitted parameters, by name with unit.
    pub fitted: Vec<(String, f64)>,
    /// The model with these parameters.
    #[serde(skip)]
    pub model: MotionModel,
}

/// The starts on which models are fitted, by group, and what is known of their errors already.
pub(crate) struct Fits<'a> {
    /// For models of formulas, and for those that plan.
    starts: [ByGroup<'a>; 2],
    all: Vec<&'a Start>,
    /// The errors in each group of a family, by its number and the bits of its values: fits without one group ask for the same ones.
    known: Mutex<KnownErrors>,
}

/// The errors of models in each group, by the number of their family and the bits of its values.
type KnownErrors = BTreeMap<(usize, Vec<u64>), Vec<f64>>;

/// Starts by group, and the error of constant velocity in each group.
struct ByGroup<'a> {
    groups: Vec<Vec<&'a Start>>,
    usual: Vec<f64>,
}

impl<'a> ByGroup<'a> {
    fn of(starts: &[&'a Start], most: usize) -> ByGroup<'a> {
        let groups = starts.iter().map(|start| start.group + 1).max().unwrap_or(0);
        let of_group = |group: usize| -> Vec<&'a Start> {
            every(&starts.iter().copied().filter(|it| it.group == group).collect::<Vec<_>>(), most)
        };
        let groups: Vec<Vec<&Start>> = (0..groups).map(of_group).collect();
        let usual = groups.iter().map(|starts| along_error(&MotionModel::ConstantVelocity, starts)).collect();
        ByGroup { groups, usual }
    }
}

impl<'a> Fits<'a> {
    /// Fits on starts, at most as many of each group as stated: for formulas, and for plans.
    pub(crate) fn on(starts: &[&'a Start], [formulas, plans]: [usize; 2]) -> Fits<'a> {
        let starts_of = [formulas, plans].map(|most| ByGroup::of(starts, most));
        Fits { starts: starts_of, all: starts.to_vec(), known: Mutex::default() }
    }

    /// All models; those with parameters are fitted on all groups but one.
    pub(crate) fn models(&self, without: Option<usize>) -> Vec<NamedModel> {
        let training: Vec<&Start> = self.all.iter().copied().filter(|it| Some(it.group) != without).collect();
        // The lateral decay is fitted first, since all fitted models use it.
        let decay_s = decay_s(&training);
        (0..FAMILIES.len()).map(|family| self.fitted(family, decay_s, without)).collect()
    }

    fn fitted(&self, number: usize, decay_s: f64, without: Option<usize>) -> NamedModel {
        let family: &Family = &FAMILIES[number];
        // All groups have the same weight, independent of their size, speeds and noise.
        let error = |values: &[f64]| {
            let errors = self.errors(number, values, decay_s);
            errors.iter().enumerate().filter(|(group, _)| Some(*group) != without).map(|(_, error)| error).sum()
        };
        let values = search::least(family.parameters, error);
        let mut fitted: Vec<(String, f64)> =
            family.parameters.iter().map(|it| it.name.to_owned()).zip(values.iter().copied()).collect();
        if family.decays {
            fitted.push(("lateral_decay_s".to_owned(), decay_s));
        }
        NamedModel { name: family.name.to_owned(), fitted, model: (family.model)(&values, decay_s) }
    }

    /// The error of a family with some values in each group, as a share of that at constant velocity. It is one along the road, on which
    /// the decay of lateral speeds has no influence.
    fn errors(&self, number: usize, values: &[f64], decay_s: f64) -> Vec<f64> {
        let family = &FAMILIES[number];
        let key = (number, values.iter().map(|value| value.to_bits()).collect::<Vec<u64>>());
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        let ByGroup { groups, usual } = &self.starts[usize::from(family.plans)];
        let found = known.entry(key).or_insert_with(|| {
            let model = (family.model)(values, decay_s);
            groups.iter().zip(usual).map(|(starts, usual)| along_error(&model, starts) / usual.max(1e-9)).collect()
        });
        found.clone()
    }
}

/// At most `most` of the starts, evenly spread.
pub(crate) fn every<'a>(starts: &[&'a Start], most: usize) -> Vec<&'a Start> {
    let count = starts.len().min(most);
    (0..count).map(|index| starts[index * starts.len() / count]).collect()
}

/// The mean squared error along the road after 3 s \[m²\].
fn along_error(model: &MotionModel, starts: &[&Start]) -> f64 {
    use rayon::prelude::*;
    let squares: Vec<f64> = starts
        .par_iter()
        .map(|start| {
            let predicted = model.predict(&start.known);
            let error_m = predicted.along_m[families::FIT_STEP] - start.truth[families::FIT_HORIZON].along_m;
            error_m * error_m
        })
        .collect();
    squares.iter().sum::<f64>() / squares.len().max(1) as f64
}
