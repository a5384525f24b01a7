//! The choice of the order: from one state a zone upwards (Bacher and Madsen, *Energy and Buildings* 43, 2011).
//!
//! Each round tries every kind of hidden node that the model does not have yet, and sun on every mass that it has. The best one
//! by Schwarz's criterion (BIC), ln n for each parameter, stays if it is better by it than the model it extends, and if it predicts
//! the last third of the rows better when both are fitted to the first two thirds. A likelihood-ratio test alone has a level that
//! does not fall with the number of rows, and any small error of the data's form, such as interpolation, then buys states.
//!
//! Every model contains the one that it extends and starts next to it, so its likelihood cannot be lower. A lower
//! likelihood means that the search failed, which the row of the table states.
//!
//! Estimated time of the search among models, so that a search of hours is refused before it begins.
//!
//! ```text
//! time ∝ rows · models · (2 · zones)^2.5
//! ```
//!
//! The time of a model is proportional to the rows that are fitted, and grows with the number of states of all zones,
//! which determines the size of the matrices. How many models are tried depends on the results; the estimate assumes
//! three rounds that each try every extension.

use std::ops::Range;

use rayon::prelude::*;

use super::elements::{Extension, HiddenNode};
use super::likelihood::{Observations, log_likelihood, scores};
use super::observations::InputLayout;
use super::scoring::{Ascent, LEAST_GAIN, Maximum};
use super::starts::Guess;
use super::structure::Structure;
use crate::identify::Progress;
use crate::identify::diagnostics::survival;
use crate::identify::report::ModelRow;
use crate::identify::settings::{HiddenTemperature, IdentifySettings};
use crate::identify::telemetry::Telemetry;

/// The share of the rows that a model is fitted to before it predicts the others.
const FITTED_SHARE: (usize, usize) = (2, 3);
/// Steps from the estimate to that of fewer rows.
const STEPS_OF_FEWER_ROWS: usize = 12;
/// A larger model whose log-likelihood is lower by more than this was not searched well.
const WORSE: f64 = 0.05;
/// Limits on steps and rows of the second stage of the search; the best starts then continue on all rows.
const SEARCH_STEPS: usize = 20;
const SEARCHED_ROWS: usize = 3000;
const ENDED_STARTS: usize = 3;
/// Limits on steps and rows of the first stage of the search.
const SCREENING_STEPS: usize = 8;
const SCREENING_ROWS: usize = 1500;
/// Starts are compared when a step promises less than this gain of the log-likelihood.
const SCREENING_GAIN: f64 = 5e-3;
/// How many of the best starts go on to the end, over the number of zones: all of a single zone. With three of them the best
/// optimum of a house with three temperatures was missed in one case of ten.
const FINISHED_STARTS: usize = 7;
const MOST_STEPS: usize = 200;
/// How many smaller models are kept.
const KEPT_SMALLER: usize = 2;

#[derive(Debug, Clone)]
pub(super) struct Fit {
    pub structure: Structure,
    pub bounds: Vec<(f64, f64)>,
    pub maximum: Maximum,
}

/// The chosen model with its alternatives.
pub(super) struct Choice {
    pub chosen: Fit,
    /// The best model with one more hidden node or with more sun, if there is one.
    pub larger: Option<Fit>,
    /// All models with one more hidden node or with more sun: intervals allow for each.
    pub rivals: Vec<Fit>,
    /// The best models by Schwarz's criterion among those with fewer parameters: another world may need no more.
    pub smaller: Vec<Fit>,
    pub table: Vec<ModelRow>,
}

/// Chooses among models with the kinds of hidden temperatures and the most states a zone of `settings`; `None` where no start has a
/// likelihood.
pub(super) fn choose(
    telemetry: &Telemetry,
    observations: &Observations,
    settings: &IdentifySettings,
    progress: &Progress<'_>,
) -> Option<Choice> {
    let guess = Guess::new(telemetry);
    progress("air alone");
    let smallest = Structure::new(telemetry, &[]);
    let starts = guess.of_smallest(telemetry, &smallest);
    let mut chosen = fit(&guess, smallest, (&starts, &[]), observations)?;
    let count: usize = observations.segments.iter().map(Range::len).sum();
    let penalty = 0.5 * libm::log(count as f64);
    let mut table = vec![row(telemetry, &chosen, None)];
    let mut chosen_row = 0;
    let mut known = vec![chosen.clone()];
    loop {
        let mut left = chosen.structure.candidates(telemetry);
        left.retain(|extension| extension.hidden().kind().is_none_or(|kind| settings.hidden.contains(&kind)));
        let larger: Vec<Option<Fit>> = left
            .par_iter()
            .map(|&added| extended(telemetry, &guess, (&chosen, &known), added, (observations, progress)))
            .collect();
        let mut tried: Vec<(usize, Fit)> = Vec::new();
        for larger in larger.into_iter().flatten() {
            table.push(row(telemetry, &larger, Some(&chosen)));
            tried.push((table.len() - 1, larger));
        }
        known.extend(tried.iter().map(|(_, fit)| fit.clone()));
        let by_criterion =
            |a: &&(usize, Fit), b: &&(usize, Fit)| criterion(&a.1, penalty).total_cmp(&criterion(&b.1, penalty));
        let is_allowed = |fit: &&(usize, Fit)| fit.1.structure.order() <= settings.most_states;
        let best = tried.iter().filter(is_allowed).max_by(by_criterion);
        let is_better = |fit: &Fit| {
            criterion(fit, penalty) > criterion(&chosen, penalty) && predicts_better(fit, &chosen, observations)
        };
        match best.filter(|(_, fit)| is_better(fit)) {
            Some((index, best)) => (chosen, chosen_row) = (best.clone(), *index),
            None => {
                let larger = tried.iter().max_by(by_criterion).map(|(_, fit)| fit.clone());
                table[chosen_row].chosen = true;
                let rivals = tried.into_iter().map(|(_, fit)| fit).collect();
                let smaller = smaller(known, &chosen, penalty);
                return Some(Choice { chosen, larger, rivals, smaller, table });
            }
        }
    }
}

/// The best models with fewer parameters than the chosen one.
fn smaller(mut known: Vec<Fit>, chosen: &Fit, penalty: f64) -> Vec<Fit> {
    known.retain(|fit| fit.structure.parameters.len() < chosen.structure.parameters.len());
    known.sort_by(|a, b| criterion(b, penalty).total_cmp(&criterion(a, penalty)));
    known.truncate(KEPT_SMALLER);
    known
}

fn likelihood(fit: &Fit) -> f64 {
    fit.maximum.evaluation.log_likelihood
}

/// The log-likelihood less a penalty for each parameter: ½ ln n, half of the negative of Schwarz's criterion.
fn criterion(fit: &Fit, penalty: f64) -> f64 {
    likelihood(fit) - penalty * fit.structure.parameters.len() as f64
}

/// Whether a model predicts the last rows better than a smaller one, both fitted to the first ones.
fn predicts_better(larger: &Fit, smaller: &Fit, observations: &Observations) -> bool {
    let count: usize = observations.segments.iter().map(Range::len).sum();
    let beginning = observations.beginning(count * FITTED_SHARE.0 / FITTED_SHARE.1);
    let of_last_rows = |fit: &Fit| -> Option<f64> {
        let theta = fit.refit(&beginning, STEPS_OF_FEWER_ROWS)?.maximum.theta;
        let model = |theta: &[super::exponential::Number]| fit.structure.model(theta);
        Some(log_likelihood(&model, &theta, observations)? - log_likelihood(&model, &theta, &beginning)?)
    };
    match (of_last_rows(larger), of_last_rows(smaller)) {
        (Some(larger), Some(smaller)) => larger > smaller,
        (larger, _) => larger.is_some(),
    }
}

impl Fit {
    /// Fits the same model to other rows, starting from this estimate; `None` if it has no likelihood.
    pub fn refit(&self, observations: &Observations, most_steps: usize) -> Option<Self> {
        let model = |theta: &[super::exponential::Number]| self.structure.model(theta);
        let ascent =
            Ascent { model: &model, observations, bounds: &self.bounds, constraint: None, least_gain: SCREENING_GAIN };
        let maximum = ascent.run(&self.maximum.theta, most_steps)?;
        Some(Self { structure: self.structure.clone(), bounds: self.bounds.clone(), maximum })
    }
}

/// The best fit of the model with one more hidden node than the chosen one, or with more sun. It begins near all known models
/// that lack one thing that it has: the best optimum may be next to one that was not chosen.
fn extended(
    telemetry: &Telemetry,
    guess: &Guess,
    (chosen, known): (&Fit, &[Fit]),
    added: Extension,
    (observations, progress): (&Observations, &Progress<'_>),
) -> Option<Fit> {
    let mut extensions = chosen.structure.extensions();
    extensions.push(added);
    let structure = Structure::new(telemetry, &extensions);
    progress(&in_words(telemetry, &structure));
    let (mut starts, mut near) = (Vec::new(), Vec::new());
    for smaller in known {
        let has = smaller.structure.extensions();
        let lacking: Vec<Extension> = extensions.iter().copied().filter(|it| !has.contains(it)).collect();
        if let &[added] = lacking.as_slice() {
            starts.extend(guess.of_larger(&smaller.structure, &smaller.maximum.theta, &structure, added));
            near.extend(starts.pop());
        }
    }
    fit(guess, structure, (&starts, &near), observations)
}

/// Ascends from every start for a few steps on the first rows, from the better ones for more steps on more rows, and from the
/// best of those to the end on all rows. Those near a smaller model always go to the end.
fn fit(
    guess: &Guess,
    structure: Structure,
    (starts, near): (&[Vec<f64>], &[Vec<f64>]),
    observations: &Observations,
) -> Option<Fit> {
    let bounds = guess.bounds(&structure);
    let model = |theta: &[super::exponential::Number]| structure.model(theta);
    let beginning = observations.beginning(SCREENING_ROWS);
    let search = observations.beginning(SEARCHED_ROWS);
    let ascent = |observations, least_gain| Ascent {
        model: &model,
        observations,
        bounds: &bounds,
        constraint: None,
        least_gain,
    };
    let screened = |start: &Vec<f64>| ascent(&beginning, SCREENING_GAIN).run(start, SCREENING_STEPS);
    let mut first: Vec<Maximum> = starts.par_iter().filter_map(screened).collect();
    first.sort_by(|a, b| by_likelihood(b, a));
    let (zones, _) = observations.widths;
    let finished = first.into_iter().take((FINISHED_STARTS / zones).max(1)).map(|maximum| maximum.theta);
    let finished: Vec<Vec<f64>> = finished.collect();
    let finish = |start: &Vec<f64>| ascent(observations, SCREENING_GAIN).run(start, MOST_STEPS);
    let searched = |start: &Vec<f64>| ascent(&search, SCREENING_GAIN).run(start, SEARCH_STEPS);
    let mut found: Vec<Maximum> = finished.par_iter().filter_map(searched).collect();
    found.sort_by(|a, b| by_likelihood(b, a));
    let best = found.into_iter().take(ENDED_STARTS).map(|maximum| maximum.theta);
    // The starts next to smaller models always continue, so that no model is worse than the models that it contains.
    let finished: Vec<Vec<f64>> = best.chain(near.iter().cloned()).collect();
    let all: Vec<Maximum> = finished.par_iter().filter_map(finish).collect();
    let best = all.into_iter().max_by(by_likelihood)?;
    let maximum = ascent(observations, LEAST_GAIN).run(&best.theta, MOST_STEPS)?;
    Some(Fit { structure, bounds, maximum })
}

fn by_likelihood(a: &Maximum, b: &Maximum) -> std::cmp::Ordering {
    a.evaluation.log_likelihood.total_cmp(&b.evaluation.log_likelihood)
}

fn row(telemetry: &Telemetry, fit: &Fit, smaller: Option<&Fit>) -> ModelRow {
    let gain = smaller.map(|smaller| {
        let twice = 2.0 * (likelihood(fit) - likelihood(smaller));
        let added = fit.structure.parameters.len() - smaller.structure.parameters.len();
        (twice, if twice > 0.0 { survival(twice, added as f64) } else { 1.0 })
    });
    ModelRow {
        model: in_words(telemetry, &fit.structure),
        states: fit.structure.order(),
        parameters: fit.bounds.iter().filter(|(low, high)| low < high).count(),
        log_likelihood: likelihood(fit),
        search_failed: smaller.is_some_and(|smaller| likelihood(fit) < likelihood(smaller) - WORSE),
        gain,
        chosen: false,
    }
}

fn in_words(telemetry: &Telemetry, structure: &Structure) -> String {
    let word = |hidden: &HiddenNode| match hidden {
        HiddenNode::Wall(boundary) => format!("wall to {}", telemetry.boundaries[*boundary].name),
        HiddenNode::Interior => "interior mass".to_owned(),
        HiddenNode::Heater => "heater".to_owned(),
        HiddenNode::ColouredHeat => "coloured heat".to_owned(),
    };
    if structure.hidden.is_empty() {
        return "air alone".to_owned();
    }
    let sun = structure.sunlit.iter().map(|hidden| format!("sun on the {}", word(hidden)));
    format!("air, {}", structure.hidden.iter().map(word).chain(sun).collect::<Vec<_>>().join(", "))
}

/// Time of a row in a model, for one state, on one core of the reference machine, an AMD EPYC at 2.6 GHz: fitted to records that
/// were made at random, with 1 to 3 zones and 300 to 8000 rows \[s\].
const ROW_S: f64 = 4.5e-5;
const GROWTH: f64 = 2.5;

/// Processor time of an identification from `rows` rows \[s\].
pub(super) fn processor_s(telemetry: &Telemetry, settings: &IdentifySettings, rows: usize) -> f64 {
    let layout = InputLayout::new(telemetry);
    let is_tried = |kind| settings.hidden.contains(&kind);
    let walls = if is_tried(HiddenTemperature::Wall) { telemetry.boundaries.len() } else { 0 };
    let heater = is_tried(HiddenTemperature::Heater) && layout.heat.iter().any(Option::is_some);
    let sun = layout.sun.iter().any(Option::is_some);
    let others = [is_tried(HiddenTemperature::Interior), heater, sun].into_iter().filter(|tried| *tried).count();
    // Coloured heat is always tried.
    let extensions = walls + others + 1;
    let models = 1 + settings.most_states * extensions;
    ROW_S * rows as f64 * models as f64 * libm::pow(2.0 * telemetry.zones.len() as f64, GROWTH)
}

/// Correlations of scores count up to this lag \[s\] …
const LONGEST_LAG_S: f64 = 12.0 * 3600.0;

/// … and up to this share of the rows.
const LONGEST_LAG_SHARE: usize = 20;

pub(super) struct Sandwich {
    scores: Vec<f64>,
    parameters: usize,
    segments: Vec<Range<usize>>,
    lags: usize,
}

impl Sandwich {
    /// Computes the matrices of the sandwich; `None` if the model has no likelihood.
    pub fn new(fit: &Fit, observations: &Observations) -> Option<Self> {
        let model = |theta: &[super::exponential::Number]| fit.structure.model(theta);
        let rows: usize = observations.segments.iter().map(Range::len).sum();
        let lags = (LONGEST_LAG_S / observations.step_s) as usize;
        Some(Self {
            scores: scores(&model, &fit.maximum.theta, observations)?,
            parameters: fit.maximum.theta.len(),
            segments: observations.segments.clone(),
            lags: lags.min(rows / LONGEST_LAG_SHARE),
        })
    }

    /// Standard error of a function of the parameters, from its `direction` I⁻¹ ∇f.
    pub fn standard_error(&self, direction: &[f64]) -> f64 {
        let along: Vec<f64> = self
            .scores
            .chunks_exact(self.parameters)
            .map(|scores| scores.iter().zip(direction).map(|(score, weight)| score * weight).sum())
            .collect();
        let product = |lag: usize| -> f64 {
            let of_segment = |segment: &Range<usize>| -> f64 {
                (segment.start + lag..segment.end).map(|row| along[row] * along[row - lag]).sum()
            };
            self.segments.iter().map(of_segment).sum()
        };
        let weight = |lag: usize| 2.0 * (1.0 - lag as f64 / (self.lags + 1) as f64);
        let correlated: f64 = (1..=self.lags).map(|lag| weight(lag) * product(lag)).sum();
        libm::sqrt((product(0) + correlated).max(0.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Scores that come in equal pairs have twice the long-run variance of white ones; Bartlett's weights see half of that at L = 1.
    #[test]
    fn correlated_scores_have_larger_standard_errors() {
        let sign = |row: usize| if (row / 2 * 7919) % 13 < 6 { 1.0 } else { -1.0 };
        let scores: Vec<f64> = (0..400).map(sign).collect();
        let of = |lags| Sandwich {
            scores: scores.clone(),
            parameters: 1,
            segments: std::iter::once(0..400).collect(),
            lags,
        };
        let white = of(0).standard_error(&[1.0]);
        assert!((white - 20.0).abs() < 1e-12);
        assert!(of(1).standard_error(&[1.0]) > 1.15 * white);
    }
}
