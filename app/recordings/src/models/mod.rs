//! The models that are compared, and how they are fitted.

mod families;
mod search;

use interplay_planners::motion_prediction::MotionModel;
use serde::Serialize;

use crate::start::Start;
pub(crate) use families::decay_s;
use families::{FAMILIES, Family};

/// Maximum number of starts of each group on which a planning model is fitted; other models are fitted on all starts.
const MAX_PLANNED_STARTS: usize = 350;

#[derive(Clone, Debug, Serialize)]
pub struct NamedModel {
    pub name: String,
    /// Its fitted parameters, by name with unit.
    pub fitted: Vec<(String, f64)>,
    /// The model with these parameters.
    #[serde(skip)]
    pub model: MotionModel,
}

/// All models; those with parameters are fitted on the given starts.
pub(crate) fn all(training: &[&Start]) -> Vec<NamedModel> {
    // The lateral decay is fitted first, since all fitted models use it.
    let decay_s = decay_s(training);
    FAMILIES.iter().map(|family| family.fitted_on(training, decay_s)).collect()
}

impl Family {
    fn fitted_on(&self, training: &[&Start], decay_s: f64) -> NamedModel {
        let most = if self.plans { MAX_PLANNED_STARTS } else { usize::MAX };
        let groups = by_group(training, most);
        let usual: Vec<f64> = groups.iter().map(|starts| along_error(&MotionModel::ConstantVelocity, starts)).collect();
        let model = |values: &[f64]| (self.model)(values, decay_s);
        // All groups have the same weight, independent of their size, speeds and noise.
        let error = |values: &[f64]| {
            let model = model(values);
            groups.iter().zip(&usual).map(|(starts, usual)| along_error(&model, starts) / usual.max(1e-9)).sum()
        };
        let values = search::least(self.parameters, error);
        let mut fitted: Vec<(String, f64)> =
            self.parameters.iter().map(|it| it.name.to_owned()).zip(values.iter().copied()).collect();
        if self.decays {
            fitted.push(("lateral_decay_s".to_owned(), decay_s));
        }
        NamedModel { name: self.name.to_owned(), fitted, model: model(&values) }
    }
}

/// At most `most` of the starts, evenly spread.
pub(crate) fn every<'a>(starts: &[&'a Start], most: usize) -> Vec<&'a Start> {
    let count = starts.len().min(most);
    (0..count).map(|index| starts[index * starts.len() / count]).collect()
}

/// The starts of each group, at most `most` of each.
fn by_group<'a>(starts: &[&'a Start], most: usize) -> Vec<Vec<&'a Start>> {
    let groups = starts.iter().map(|start| start.group + 1).max().unwrap_or(0);
    let of_group = |group: usize| -> Vec<&'a Start> { starts.iter().copied().filter(|it| it.group == group).collect() };
    (0..groups).map(|group| every(&of_group(group), most)).filter(|starts| !starts.is_empty()).collect()
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
