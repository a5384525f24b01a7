//! Other worlds, fitted from the estimate: inputs that are recorded at another time.

use std::ops::Range;

use rayon::prelude::*;

use super::{Explanation, World};
use crate::identify::report::SuspectedCause;
use crate::identify::state_space::likelihood::{Observations, numbers};
use crate::identify::state_space::selection::Fit;
use crate::identify::state_space::structure::ParameterKind;

/// Shifts of the weather that are tried \[h\].
const WEATHER_SHIFTS_H: [f64; 6] = [-2.0, -1.0, -0.5, 0.5, 1.0, 2.0];
/// Shifts of the heat that are tried beside those of a row \[h\].
const HEAT_SHIFTS_H: [f64; 4] = [-1.0, -0.5, 0.5, 1.0];
/// A shift by whole rows may differ from a shift in hours by this much \[h\].
const SHIFT_TOLERANCE_H: f64 = 0.1;
/// Gain of the log-likelihood from which on a shift wins: the best of six would gain so much by chance in one of a thousand
/// records (χ² with one degree of freedom).
const LEAST_GAIN: f64 = 7.0;
const MOST_STEPS: usize = 12;
/// Aperture of an ordinary house for what it loses \[m²/(kW/K)\], and the share of it below which the sun counts as given up.
const USUAL_M2_PER_KW_PER_K: f64 = 8.0;
const LOST_SHARE: f64 = 0.2;
/// Rows at both ends of each segment that shifts leave out \[h\].
const MARGIN_H: f64 = 2.0;

/// Weather or heat that is recorded at another time, if either fits better.
pub(super) fn of_shifts(world: &World<'_>) -> Vec<Explanation> {
    let layout = &world.fit.structure.layout;
    let step_h = world.observations.step_s / 3600.0;
    let rows_of = |hours: f64| libm::round(hours / step_h) as isize;
    let fits = |hours: &&f64| (rows_of(**hours) as f64 * step_h - **hours).abs() < SHIFT_TOLERANCE_H;
    let margin = libm::ceil(MARGIN_H / step_h) as usize;
    let weather: Vec<usize> =
        (0..world.telemetry.boundaries.len()).chain(layout.sun.iter().flatten().copied()).collect();
    let heat: Vec<usize> = layout.heat.iter().flatten().copied().collect();
    let weather_rows: Vec<isize> = WEATHER_SHIFTS_H.iter().filter(fits).map(|&hours| rows_of(hours)).collect();
    let mut heat_rows: Vec<isize> =
        HEAT_SHIFTS_H.iter().filter(fits).map(|&hours| rows_of(hours)).chain([-1, 1]).collect();
    heat_rows.sort_unstable();
    heat_rows.dedup();
    let tried: Vec<Shift<'_>> = std::iter::once(Shift { columns: &[], rows: 0, is_heat: false })
        .chain(weather_rows.iter().map(|&rows| Shift { columns: &weather, rows, is_heat: false }))
        .chain(heat_rows.iter().map(|&rows| Shift { columns: &heat, rows, is_heat: true }))
        .filter(|shift| shift.rows == 0 || !shift.columns.is_empty())
        .collect();
    // Every shift with the chosen model and with smaller ones: a wrong clock buys states that a right one does not need.
    let models: Vec<&Fit> = std::iter::once(world.fit).chain(world.smaller).collect();
    let pairs: Vec<(&Shift<'_>, &Fit)> =
        tried.iter().flat_map(|shift| models.iter().map(move |model| (shift, *model))).collect();
    let fitted: Vec<Option<Fit>> = pairs
        .par_iter()
        .map(|(shift, model)| refit_with_sun(world, model, &shift.observations(world.observations, margin)))
        .collect();
    let Some(Some(as_recorded)) = fitted.first() else { return Vec::new() };
    let worth = |fit: &Fit| {
        fit.maximum.evaluation.log_likelihood - 0.5 * fit.structure.parameters.len() as f64 * libm::log(world.rows())
    };
    let best = |is_heat: bool| {
        let all = pairs.iter().zip(&fitted).filter(|((shift, _), _)| shift.rows != 0 && shift.is_heat == is_heat);
        let gains = all.filter_map(|((shift, _), fit)| Some((*shift, fit.as_ref()?)));
        let (shift, fit) = gains.max_by(|a, b| worth(a.1).total_cmp(&worth(b.1)))?;
        let gain = worth(fit) - worth(as_recorded);
        let is_material = world.is_material(&fit.structure, &fit.maximum.theta);
        (gain > LEAST_GAIN && is_material).then(|| shift.explanation(gain, step_h))
    };
    [best(false), best(true)].into_iter().flatten().collect()
}

/// Refits a model, also from where the sun acts: a fit that has given up the sun because of its hours does not find its way back.
fn refit_with_sun(world: &World<'_>, model: &Fit, observations: &Observations) -> Option<Fit> {
    let plain = model.refit(observations, MOST_STEPS);
    let mut sunny = model.clone();
    let mut is_changed = false;
    for (index, kind) in model.structure.parameters.iter().enumerate() {
        let ParameterKind::Aperture(zone) = *kind else { continue };
        let theta = numbers(&model.maximum.theta);
        let neighbours = world.telemetry.neighbours(zone).into_iter();
        let losses: f64 =
            neighbours.filter_map(|place| Some(model.structure.total_conductance(&theta, zone, place)?.re)).sum();
        let usual = USUAL_M2_PER_KW_PER_K * losses;
        if losses > 0.0 && libm::exp(model.maximum.theta[index]) < LOST_SHARE * usual {
            sunny.maximum.theta[index] = libm::log(usual);
            is_changed = true;
        }
    }
    let other = if is_changed { sunny.refit(observations, 2 * MOST_STEPS) } else { None };
    let likelihood = |fit: &Fit| fit.maximum.evaluation.log_likelihood;
    [plain, other].into_iter().flatten().max_by(|a, b| likelihood(a).total_cmp(&likelihood(b)))
}

/// Inputs that are taken from later rows.
struct Shift<'a> {
    columns: &'a [usize],
    rows: isize,
    is_heat: bool,
}

impl Shift<'_> {
    fn explanation(&self, gain: f64, step_h: f64) -> Explanation {
        let hours = self.rows as f64 * step_h;
        let way = if hours > 0.0 { "earlier" } else { "later" };
        let taken =
            format!("fits better when it is taken {:.2} h {way} (log-likelihood higher by {gain:.0})", hours.abs());
        let (cause, words) = if self.is_heat {
            (SuspectedCause::LateHeat, format!("the heat {taken}: is it recorded at another time than it is given?"))
        } else {
            (SuspectedCause::Clock, format!("the weather {taken}: check the clocks and time zones"))
        };
        Explanation { zone: None, cause, words, gain, parameters: 1 }
    }

    /// The observations with these inputs, without `margin` rows at both ends of each segment.
    fn observations(&self, observations: &Observations, margin: usize) -> Observations {
        let (p, m) = observations.widths;
        let mut shifted = observations.clone();
        for segment in &observations.segments {
            let last = segment.end as isize - 1;
            for row in segment.clone() {
                let from = (row as isize + self.rows).clamp(segment.start as isize, last) as usize;
                for &column in self.columns {
                    shifted.inputs[row * m + column] = observations.inputs[from * m + column];
                    shifted.slopes[row * m + column] = observations.slopes[from * m + column];
                }
                if self.is_heat {
                    shifted.heat.of_row[row] = observations.heat.of_row[from];
                }
            }
        }
        let inner = |segment: &Range<usize>| segment.start + margin..segment.end.saturating_sub(margin);
        let is_complete = |row: &usize| observations.outputs[row * p..(row + 1) * p].iter().all(|it| it.is_finite());
        let from_first = |segment: Range<usize>| {
            let first = segment.clone().find(is_complete)?;
            (segment.end >= first + 2).then_some(first..segment.end)
        };
        shifted.segments = observations.segments.iter().map(inner).filter_map(from_first).collect();
        shifted
    }
}
