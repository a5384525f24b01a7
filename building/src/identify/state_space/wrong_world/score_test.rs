//! Score tests (Lagrange multipliers) for heat that no model contains: they predict the gain in likelihood without a fit.
//!
//! ```text
//! LM = g_βᵀ (I_ββ − I_βθ I_θθ⁻¹ I_θβ)⁻¹ g_β        at β = 0, chi-squared with as many degrees of freedom as β has entries
//! ```

use std::f64::consts::TAU;
use std::ops::Range;

use nalgebra::{DMatrix, DVector};

use super::World;
use crate::identify::diagnostics::survival;
use crate::identify::report::SuspectedCause;
use crate::identify::state_space::exponential::{Number, real};
use crate::identify::state_space::likelihood::{Evaluation, Observations, evaluate};
use crate::identify::state_space::linear_model::ContinuousModel;
use crate::identify::state_space::scoring::free_parameters;
use crate::identify::state_space::structure::{ParameterKind, Place};
use crate::identify::telemetry::Neighbour;

const LEVEL: f64 = 0.002;
/// Daily harmonics of the heat of people, and a constant.
const HARMONICS: usize = 3;
/// Ridge of the scaled information, so that undetermined directions count for nothing.
const RIDGE: f64 = 1e-8;
/// Directions of β of which more than this share is explained by θ are not tested.
const LEAST_OWN_SHARE: f64 = 1e-4;

/// What heat of a zone the data call for, with the words to say so.
pub(super) fn score_tests(world: &World<'_>, zone: usize) -> Vec<(SuspectedCause, String)> {
    let columns = columns(world, zone);
    let Some(evaluation) = evaluated(world, zone, &columns.values) else { return Vec::new() };
    let test = |range: Range<usize>| statistic(world, &evaluation, range);
    let mut found = Vec::new();
    let people = test(columns.daily.clone());
    let p_value = survival(people.0, people.1 as f64);
    if p_value < LEVEL {
        let words = format!(
            "the data call for heat that comes at the same hours each day and is in no column (p = {p_value:.1e}): people or machines?"
        );
        found.push((SuspectedCause::People, words));
    }
    let sun = test(columns.sun.clone());
    let p_value = survival(sun.0, sun.1 as f64);
    if p_value < LEVEL {
        let words = format!(
            "the sun's heat comes at other hours than its irradiance (p = {p_value:.1e}): another side or shade?"
        );
        found.push((SuspectedCause::Sun, words));
    }
    found
}

/// Heats into a zone's air, one after the other \[kW, up to a factor\], and which are what.
struct Columns {
    values: Vec<Vec<f64>>,
    daily: Range<usize>,
    sun: Range<usize>,
}

fn columns(world: &World<'_>, zone: usize) -> Columns {
    let times = &world.telemetry.time_s;
    let wave = |harmonic: usize, phase: f64| -> Vec<f64> {
        times.iter().map(|time| libm::sin(TAU * (harmonic as f64 * time / 86_400.0 + phase))).collect()
    };
    let mut values: Vec<Vec<f64>> = vec![vec![1.0; times.len()]];
    values.extend((1..=HARMONICS).flat_map(|harmonic| [wave(harmonic, 0.0), wave(harmonic, 0.25)]));
    let daily = 0..values.len();
    if let Some(sun) = &world.telemetry.zones[zone].irradiance_kw_per_m2 {
        for phase in [0.0, 0.25] {
            values.push(wave(1, phase).iter().zip(sun).map(|(wave, sun)| wave * sun).collect());
        }
    }
    let sun = daily.end..values.len();
    Columns { values, daily, sun }
}

/// The likelihood with its derivatives by θ and by β, at β = 0.
fn evaluated(world: &World<'_>, zone: usize, columns: &[Vec<f64>]) -> Option<Evaluation> {
    let (p, m) = world.observations.widths;
    let rows = world.observations.outputs.len() / p;
    let wider = |values: &[f64], added: &dyn Fn(usize, usize) -> f64| -> Vec<f64> {
        let row = |row: usize| {
            let known = values[row * m..(row + 1) * m].iter().copied();
            known.chain((0..columns.len()).map(move |column| added(row, column)))
        };
        (0..rows).flat_map(row).collect()
    };
    let observations = Observations {
        inputs: wider(&world.observations.inputs, &|row, column| columns[column][row]),
        slopes: wider(&world.observations.slopes, &|_, _| 0.0),
        widths: (p, m + columns.len()),
        ..world.observations.clone()
    };
    let structure = &world.fit.structure;
    let parameters = world.fit.maximum.theta.len();
    let model = |theta: &[Number]| -> ContinuousModel {
        let mut model = structure.model(&theta[..parameters]);
        let capacity = structure.value(&theta[..parameters], ParameterKind::Capacity(zone, Place::Air));
        let resized = |matrix: &DMatrix<Number>| matrix.clone().resize_horizontally(m + columns.len(), real(0.0));
        model.inputs = resized(&model.inputs);
        model.initial.from_inputs = resized(&model.initial.from_inputs);
        for (column, strength) in theta[parameters..].iter().enumerate() {
            model.inputs[(zone, m + column)] = *strength / capacity;
        }
        model
    };
    let theta: Vec<f64> = world.fit.maximum.theta.iter().copied().chain(columns.iter().map(|_| 0.0)).collect();
    evaluate(&model, &theta, &observations)
}

/// LM of the columns `range`, and how many directions of them θ leaves free.
fn statistic(world: &World<'_>, evaluation: &Evaluation, range: Range<usize>) -> (f64, usize) {
    if range.is_empty() {
        return (0.0, 1);
    }
    let parameters = world.fit.maximum.theta.len();
    let information = &evaluation.information;
    let known = free_parameters(&world.fit.maximum.theta, &world.fit.bounds, &evaluation.gradient[..parameters]);
    let added: Vec<usize> = range.map(|column| parameters + column).collect();
    let scale = |j: usize| libm::sqrt(information[(j, j)]).max(f64::MIN_POSITIVE);
    let block = |rows: &[usize], columns: &[usize]| {
        DMatrix::from_fn(rows.len(), columns.len(), |a, b| {
            information[(rows[a], columns[b])] / scale(rows[a]) / scale(columns[b])
        })
    };
    let mut of_known = block(&known, &known);
    (0..known.len()).for_each(|j| of_known[(j, j)] += RIDGE);
    let (Some(factor), cross) = (of_known.cholesky(), block(&known, &added)) else { return (0.0, 1) };
    let own = block(&added, &added) - cross.transpose() * factor.solve(&cross);
    let gradient = |indices: &[usize]| {
        DVector::from_iterator(indices.len(), indices.iter().map(|&j| evaluation.gradient[j] / scale(j)))
    };
    // The remaining gradient with respect to θ, which is nearly zero at the maximum.
    let left = gradient(&added) - cross.transpose() * factor.solve(&gradient(&known));
    let eigen = own.symmetric_eigen();
    let mut sum = (0.0, 0);
    for (k, &eigenvalue) in eigen.eigenvalues.iter().enumerate() {
        if eigenvalue > LEAST_OWN_SHARE {
            let along = eigen.eigenvectors.column(k).dot(&left);
            sum = (sum.0 + along * along / eigenvalue, sum.1 + 1);
        }
    }
    (sum.0, sum.1.max(1))
}

/// Rows at the beginning of a segment are left out while the filter comes to know the hidden temperatures \[s\].
const SETTLING_S: f64 = 86_400.0;
/// Standard errors of the kurtosis, or of the skewness, of normal numbers beyond which tails are heavy.
const LIMIT: f64 = 4.5;
const LEAST_ROWS: usize = 100;

/// A finding, with the words to say so.
pub(super) struct HeavyTail {
    pub cause: SuspectedCause,
    pub words: String,
}

/// What the innovations of a zone show; `None` if they are like normal numbers.
pub(super) fn heavy_tail(world: &World<'_>, zone: usize) -> Option<HeavyTail> {
    let values = settled(world, zone);
    if values.len() < LEAST_ROWS {
        return None;
    }
    let count = values.len() as f64;
    let mean = values.iter().map(|(value, _)| value).sum::<f64>() / count;
    let moment = |power: i32| values.iter().map(|(value, _)| (value - mean).powi(power)).sum::<f64>() / count;
    let variance = moment(2).max(f64::MIN_POSITIVE);
    let kurtosis = (moment(4) / (variance * variance) - 3.0) / libm::sqrt(24.0 / count);
    let skewness = moment(3) / (variance * libm::sqrt(variance)) / libm::sqrt(6.0 / count);
    if kurtosis < LIMIT && skewness.abs() < LIMIT {
        return None;
    }
    // Positive if the air follows the outdoor temperature more than the walls explain.
    let outward = values.iter().map(|(value, to_outdoor)| (value - mean).powi(3) * to_outdoor.signum()).sum::<f64>();
    let times = format!(
        "innovations are at times far larger than in general (kurtosis {kurtosis:.0} standard errors too large)"
    );
    Some(if outward > 0.0 {
        let words = format!("{times}, and towards the temperature outdoors: were windows opened?");
        HeavyTail { cause: SuspectedCause::Windows, words }
    } else {
        let words =
            format!("{times}, and away from the temperature outdoors: did people or machines give off heat at times?");
        HeavyTail { cause: SuspectedCause::People, words }
    })
}

/// Standardised innovations of a zone, each with the difference of outdoor and indoor temperature \[K\].
fn settled(world: &World<'_>, zone: usize) -> Vec<(f64, f64)> {
    let p = world.observations.widths.0;
    let settling = libm::round(SETTLING_S / world.observations.step_s) as usize;
    let outdoors = world.telemetry.neighbours(zone).into_iter().find(|place| matches!(place, Neighbour::Boundary(_)));
    let difference = |row: usize| {
        let inside = world.telemetry.zones[zone].temperature_c[row];
        outdoors.map_or(-1.0, |place| world.telemetry.temperature_c(place)[row] - inside)
    };
    let rows =
        world.observations.segments.iter().flat_map(|segment| (segment.start + settling).min(segment.end)..segment.end);
    rows.map(|row| (world.filtered.standardised[row * p + zone], difference(row)))
        .filter(|(value, difference)| value.is_finite() && difference.is_finite())
        .collect()
}
