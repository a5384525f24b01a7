//! Score tests (Lagrange multipliers) for heat that no model contains: they predict the gain in likelihood without a fit. What they
//! call for is fitted.
//!
//! ```text
//! LM = g_βᵀ (I_ββ − I_βθ I_θθ⁻¹ I_θβ)⁻¹ g_β        at β = 0, chi-squared with as many degrees of freedom as β has entries
//! ```

use std::f64::consts::TAU;
use std::ops::Range;

use nalgebra::{DMatrix, DVector};

use super::widened::{HeatColumn, Widened};
use super::{Explanation, World};
use crate::identify::diagnostics::survival;
use crate::identify::report::SuspectedCause;
use crate::identify::state_space::likelihood::Evaluation;
use crate::identify::state_space::scoring::free_parameters;
use crate::identify::telemetry::Neighbour;

const LEVEL: f64 = 0.002;
/// Daily harmonics of the heat of people, and a constant.
const HARMONICS: usize = 3;
/// Ridge of the scaled information, so that undetermined directions count for nothing.
const RIDGE: f64 = 1e-8;
/// Directions of β of which more than this share is explained by θ are not tested.
const LEAST_OWN_SHARE: f64 = 1e-4;
/// Kelvins of outdoor temperature over which the gain of the heat is stated.
const GAIN_PER_K: f64 = 10.0;

/// Heat that a zone's data call for.
pub(super) fn explanations(world: &World<'_>, zone: usize) -> Vec<Explanation> {
    let groups = groups(world, zone);
    let all: Vec<HeatColumn> = groups.iter().flat_map(|group| group.columns.iter().cloned()).collect();
    let Some(evaluation) = Widened::new(world, &all).at_zero() else { return Vec::new() };
    let mut first = 0;
    let mut found = Vec::new();
    for group in &groups {
        let range = first..first + group.columns.len();
        first = range.end;
        let (statistic, degrees) = statistic(world, &evaluation, range);
        if survival(statistic, degrees as f64) < LEVEL {
            found.extend(group.explanation(world, zone));
        }
    }
    found
}

/// Columns that belong to one cause.
struct Group {
    cause: SuspectedCause,
    columns: Vec<HeatColumn>,
}

/// Heats into a zone's air, up to a factor, in multiples of its mean heat.
fn groups(world: &World<'_>, zone: usize) -> Vec<Group> {
    let times = &world.telemetry.time_s;
    let scale = mean_heat_kw(world, zone);
    let wave = |harmonic: usize, phase: f64| -> Vec<f64> {
        times.iter().map(|time| scale * libm::sin(TAU * (harmonic as f64 * time / 86_400.0 + phase))).collect()
    };
    let column = |kw: Vec<f64>| HeatColumn { kw, node: zone };
    let mut daily = vec![column(vec![scale; times.len()])];
    let harmonics = (1..=HARMONICS).flat_map(|harmonic| [wave(harmonic, 0.0), wave(harmonic, 0.25)]);
    daily.extend(harmonics.map(column));
    let mut groups = vec![Group { cause: SuspectedCause::People, columns: daily }];
    if let Some(sun) = &world.telemetry.zones[zone].irradiance_kw_per_m2 {
        let of_phase = |phase| column(wave(1, phase).iter().zip(sun).map(|(wave, sun)| wave * sun).collect());
        groups.push(Group { cause: SuspectedCause::Sun, columns: vec![of_phase(0.0), of_phase(0.25)] });
    }
    groups.extend(varying_gain(world, zone));
    groups
}

/// The recorded heat times the outdoor temperature less its mean; `None` without either.
fn varying_gain(world: &World<'_>, zone: usize) -> Option<Group> {
    let heat = world.fit.structure.layout.heat[zone]?;
    let outdoors = world.telemetry.neighbours(zone).into_iter().find_map(|place| match place {
        Neighbour::Boundary(boundary) => Some(&world.telemetry.boundaries[boundary].temperature_c),
        Neighbour::Zone(_) => None,
    })?;
    let finite = || outdoors.iter().filter(|value| value.is_finite());
    let mean_c = finite().sum::<f64>() / finite().count().max(1) as f64;
    let m = world.observations.widths.1;
    let kw = outdoors
        .iter()
        .enumerate()
        .map(|(row, outdoor_c)| world.observations.inputs[row * m + heat] * (outdoor_c - mean_c) / GAIN_PER_K);
    let node = world.fit.structure.heated_node(zone);
    let columns = vec![HeatColumn { kw: kw.collect(), node }];
    Some(Group { cause: SuspectedCause::VaryingGain, columns })
}

/// Mean size of a zone's heat \[kW\]; 1 without any.
fn mean_heat_kw(world: &World<'_>, zone: usize) -> f64 {
    let Some(column) = world.fit.structure.layout.heat[zone] else { return 1.0 };
    let m = world.observations.widths.1;
    let rows = world.observations.segments.iter().flat_map(Clone::clone);
    let heats = rows.map(|row| world.observations.inputs[row * m + column].abs()).filter(|heat| heat.is_finite());
    let (sum, count) = heats.fold((0.0, 0_usize), |(sum, count), heat| (sum + heat, count + 1));
    if sum > 0.0 { sum / count as f64 } else { 1.0 }
}

impl Group {
    /// The fit with these columns, if it gains likelihood and changes a known number.
    fn explanation(&self, world: &World<'_>, zone: usize) -> Option<Explanation> {
        let maximum = Widened::new(world, &self.columns).fit()?;
        let gain = maximum.evaluation.log_likelihood - world.fit.maximum.evaluation.log_likelihood;
        if !world.is_material(&world.fit.structure, &maximum.theta) {
            return None;
        }
        let strengths = &maximum.theta[world.fit.maximum.theta.len()..];
        let words = match self.cause {
            SuspectedCause::People => {
                let kw = self.root_mean_square_kw(strengths);
                format!(
                    "the data call for heat of about {kw:.2} kW that comes at the same hours each day and is in no column \
                     (log-likelihood higher by {gain:.0}): people or machines?"
                )
            }
            SuspectedCause::Sun => format!(
                "the sun's heat comes at other hours than its irradiance (log-likelihood higher by {gain:.0}): another side \
                 or shade?"
            ),
            _ => {
                let percent = 100.0 * strengths.first().copied().unwrap_or(0.0);
                let (way, cause) = if percent > 0.0 {
                    ("warmer", "is it the electricity of a heat pump?")
                } else {
                    ("colder", "is a part of it lost outdoors?")
                };
                format!(
                    "a recorded kilowatt heats {:.0} % more when it is {GAIN_PER_K:.0} K {way} outdoors (log-likelihood \
                     higher by {gain:.0}): {cause}",
                    percent.abs()
                )
            }
        };
        Some(Explanation { zone: Some(zone), cause: self.cause, words, gain, parameters: self.columns.len() })
    }

    fn root_mean_square_kw(&self, strengths: &[f64]) -> f64 {
        let rows = self.columns.first().map_or(0, |column| column.kw.len());
        let heat = |row: usize| self.columns.iter().zip(strengths).map(|(it, beta)| beta * it.kw[row]).sum::<f64>();
        libm::sqrt((0..rows).map(|row| heat(row) * heat(row)).sum::<f64>() / rows.max(1) as f64)
    }
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
