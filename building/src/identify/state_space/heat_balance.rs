//! The heat balance of a zone over the whole record, which errors of the dynamics do not affect:
//!
//! ```text
//! mean heat + A · mean sun + Σ_k G_k mean(T_k − T) = stored heat / duration + mean random heat
//! ```
//!
//! Solved for one conductance G_k at a time. Heat stored in a wall counts by the share H_in/(H_in + H_out) of it that comes from
//! the room.

use std::ops::Range;

use super::exponential::Number;
use super::likelihood::{Filtered, Observations, numbers};
use super::selection::Fit;
use super::structure::{HOUR_S, ParameterKind, Place};
use crate::identify::telemetry::{Neighbour, Telemetry};

/// With a smaller mean temperature difference \[K\], the balance says nothing of a conductance.
const LEAST_DIFFERENCE_K: f64 = 1.0;

/// What the filter needs until it knows hidden temperatures: at first they are a guess, and the stored heat would be
/// wrong by the error of that guess \[s\].
const SETTLING_S: f64 = 86_400.0;

/// The rows of each segment over which heat is balanced: without those in which the filter settles, if at least as many remain.
fn balanced(observations: &Observations) -> Vec<Range<usize>> {
    let settling = (SETTLING_S / observations.step_s).round() as usize;
    let settled = |segment: &Range<usize>| {
        let is_long = segment.len() >= 2 * settling;
        segment.start + if is_long { settling } else { 0 }..segment.end
    };
    observations.segments.iter().map(settled).collect()
}

/// A conductance by the heat balance \[kW/K\], and its standard error from the random heat of the model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct BalancedConductance {
    pub value: f64,
    pub standard_error: f64,
}

/// The conductance between a zone and a neighbour that closes the zone's balance with all else as estimated; `None` where the
/// mean difference of temperatures is too small.
pub(super) fn conductance(
    telemetry: &Telemetry,
    observations: &Observations,
    fit: &Fit,
    filtered: &Filtered,
    (zone, neighbour): (usize, Neighbour),
) -> Option<BalancedConductance> {
    let theta = numbers(&fit.maximum.theta);
    let structure = &fit.structure;
    let segments = balanced(observations);
    let rows: Vec<usize> = segments.iter().flat_map(|segment| segment.start..segment.end.saturating_sub(1)).collect();
    // These are the filter's temperatures, because measured ones may be missing.
    let count = structure.nodes.len();
    let zone_c = |zone: usize, row: usize| filtered.states[row * count + zone];
    let temperature_c = |place: Neighbour, row: usize| match place {
        Neighbour::Zone(other) => zone_c(other, row),
        Neighbour::Boundary(boundary) => telemetry.boundaries[boundary].temperature_c[row],
    };
    let mean =
        |value: &dyn Fn(usize) -> f64| rows.iter().map(|&row| value(row)).sum::<f64>() / rows.len().max(1) as f64;
    let difference = |other: Neighbour| mean(&|row| temperature_c(other, row) - zone_c(zone, row));
    let input = |column: Option<usize>| {
        column.map_or(0.0, |column| mean(&|row| observations.inputs[row * observations.widths.1 + column]))
    };
    let gain = structure.value(&theta, ParameterKind::HeatGain(zone)).re;
    let mut known_kw = gain * input(structure.layout.heat[zone]);
    if let Some(aperture) = structure.total_aperture(&theta, zone) {
        known_kw += aperture.re * input(structure.layout.sun[zone]);
    }
    for other in telemetry.neighbours(zone).into_iter().filter(|&other| other != neighbour) {
        known_kw += structure.total_conductance(&theta, zone, other)?.re * difference(other);
    }
    let difference = difference(neighbour);
    if difference.is_nan() || difference.abs() < LEAST_DIFFERENCE_K {
        return None;
    }
    let duration_s = rows.len() as f64 * observations.step_s;
    let (stored_kj, random_kj2) = stored(fit, &segments, filtered, &theta, zone, duration_s);
    Some(BalancedConductance {
        value: (stored_kj / duration_s - known_kw) / difference,
        standard_error: libm::sqrt(random_kj2) / duration_s / difference.abs(),
    })
}

/// Heat that the zone's nodes stored over all segments \[kJ\], and the variance of their random heat \[kJ²\].
fn stored(
    fit: &Fit,
    segments: &[Range<usize>],
    filtered: &Filtered,
    theta: &[Number],
    zone: usize,
    duration_s: f64,
) -> (f64, f64) {
    let structure = &fit.structure;
    let count = structure.nodes.len();
    let (mut stored_kj, mut random_kj2) = (0.0, 0.0);
    for (index, node) in structure.nodes.iter().enumerate().filter(|(_, node)| node.zone == zone) {
        if !node.is_mass() {
            // Over times far beyond its correlation time τ, coloured heat of deviation σ sums up to a variance of 2σ²τ an hour.
            let deviation = structure.value(theta, ParameterKind::RandomHeat(zone, node.place)).re
                * structure.value(theta, ParameterKind::Capacity(zone, Place::Air)).re;
            let correlation_h = structure.value(theta, ParameterKind::CorrelationTime(zone)).re;
            random_kj2 += 2.0 * deviation * deviation * correlation_h * duration_s / HOUR_S;
            continue;
        }
        let share = structure.share_to_air(theta, index).re;
        let capacity = share * structure.value(theta, ParameterKind::Capacity(zone, node.place)).re;
        let random = capacity * structure.value(theta, ParameterKind::RandomHeat(zone, node.place)).re;
        random_kj2 += random * random * duration_s / HOUR_S;
        for segment in segments {
            let state = |row: usize| filtered.states[row * count + index];
            stored_kj += capacity * (state(segment.end - 1) - state(segment.start));
        }
    }
    (stored_kj, random_kj2)
}
