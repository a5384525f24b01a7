//! A fitted network as zones and walls of a scenario.

use super::elements::HiddenNode;
use super::exponential::Number;
use super::likelihood::numbers;
use super::profile::Profiler;
use super::quantities::QuantityKind;
use super::structure::{ParameterKind, Place};
use crate::identify::report::{IdentifiedNetwork, NetworkUncertainty};
use crate::identify::telemetry::{Neighbour, Telemetry};
use crate::network::{AMBIENT, Wall, Zone};

/// A mass that only one zone exchanges heat with is a wall to the air outside, with this share of its resistance on the side
/// of the zone.
const ENCLOSED: f64 = 1e-6;

/// The network as zones and walls.
///
/// # Errors
/// A sentence that says which quantity the data do not determine.
pub(super) fn identified_network(profiler: &Profiler<'_>, scale_is_known: bool) -> Result<IdentifiedNetwork, String> {
    if !scale_is_known {
        return Err("no heat of a known unit was measured, so capacities and resistances have no scale".into());
    }
    let telemetry = profiler.telemetry;
    let structure = &profiler.fit.structure;
    let theta = numbers(&profiler.fit.maximum.theta);
    let uncertainty = uncertainty(profiler)?;
    let mut remarks = Vec::new();
    let mut zones = Vec::new();
    for (index, measured) in telemetry.zones.iter().enumerate() {
        let value = |kind| structure.value(&theta, kind).re;
        let mut capacity = value(ParameterKind::Capacity(index, Place::Air));
        if structure.node(index, HiddenNode::Heater).is_some() {
            capacity += value(ParameterKind::Capacity(index, Place::Hidden(HiddenNode::Heater)));
            remarks.push(format!("{}: the heater's mass is counted with the air, so heat acts at once", measured.name));
        }
        let sun = structure.index(ParameterKind::Aperture(index)).map(|_| value(ParameterKind::Aperture(index)));
        zones.push(Zone {
            capacity_kj_per_k: capacity,
            limit_kw: limit_kw(telemetry, index, 1.0).max(limit_kw(telemetry, index, -1.0)),
            heating_limit_kw: Some(limit_kw(telemetry, index, 1.0)),
            cooling_limit_kw: Some(limit_kw(telemetry, index, -1.0)),
            solar_aperture_m2: sun.unwrap_or(0.0),
            ..Zone::named(measured.name.clone())
        });
    }
    for boundary in telemetry.boundaries.iter().skip(1) {
        remarks.push(format!("`{}` is taken for the air outside, which a scenario has only one of", boundary.name));
    }
    let mean = |values: &[f64]| {
        let finite: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
        finite.iter().sum::<f64>() / finite.len().max(1) as f64
    };
    let inside: Vec<f64> = telemetry.zones.iter().map(|zone| mean(&zone.temperature_c)).collect();
    Ok(IdentifiedNetwork {
        walls: walls(profiler, &theta),
        zones,
        uncertainty,
        mean_c: (mean(&inside), telemetry.boundaries.first().map(|boundary| mean(&boundary.temperature_c))),
        remarks,
    })
}

/// The largest heat that was measured with this sign, rounded up to a tenth of a kilowatt.
fn limit_kw(telemetry: &Telemetry, zone: usize, sign: f64) -> f64 {
    let measured = &telemetry.zones[zone];
    let heats = (0..telemetry.rows()).map(|row| sign * measured.heat_kw(row, measured.temperature_c[row]));
    let largest = heats.filter(|heat| heat.is_finite()).fold(0.0_f64, f64::max);
    libm::ceil(10.0 * largest) / 10.0
}

fn walls(profiler: &Profiler<'_>, theta: &[Number]) -> Vec<Wall> {
    let telemetry = profiler.telemetry;
    let structure = &profiler.fit.structure;
    let value = |kind| structure.value(theta, kind).re;
    let aperture = |zone, hidden| {
        let kind = ParameterKind::HiddenAperture(zone, hidden);
        structure.index(kind).map_or(0.0, |_| value(kind))
    };
    let mut walls = Vec::new();
    for wall in &telemetry.walls {
        let name = &telemetry.zones[wall.zone].name;
        let Some(conductance) = structure.total_conductance(theta, wall.zone, wall.other) else { continue };
        let resistance = 1.0 / conductance.re;
        let boundary = match wall.other {
            Neighbour::Zone(other) => {
                walls.push(Wall::new(name, &telemetry.zones[other].name, resistance));
                continue;
            }
            Neighbour::Boundary(boundary) => boundary,
        };
        let plain = Wall::new(name, AMBIENT, resistance);
        let hidden = HiddenNode::Wall(boundary);
        walls.push(match structure.node(wall.zone, hidden) {
            None => plain,
            Some(_) => Wall {
                capacity_kj_per_k: Some(value(ParameterKind::Capacity(wall.zone, Place::Hidden(hidden)))),
                mass_position: Some(1.0 / value(ParameterKind::Inner(wall.zone, hidden)) / resistance),
                solar_aperture_m2: aperture(wall.zone, hidden),
                ..plain
            },
        });
    }
    for node in structure.nodes.iter().filter(|node| node.place == Place::Hidden(HiddenNode::Interior)) {
        let inner = 1.0 / value(ParameterKind::Inner(node.zone, HiddenNode::Interior));
        walls.push(Wall {
            capacity_kj_per_k: Some(value(ParameterKind::Capacity(node.zone, node.place))),
            mass_position: Some(ENCLOSED),
            solar_aperture_m2: aperture(node.zone, HiddenNode::Interior),
            ..Wall::new(&telemetry.zones[node.zone].name, AMBIENT, inner / ENCLOSED)
        });
    }
    walls
}

/// The widest intervals; an error for a quantity that has none.
fn uncertainty(profiler: &Profiler<'_>) -> Result<NetworkUncertainty, String> {
    let mut found =
        NetworkUncertainty { capacity: (1.0, 1.0), inner_resistance: (1.0, 1.0), outer_resistance: (1.0, 1.0) };
    let telemetry = profiler.telemetry;
    for zone in 0..telemetry.zones.len() {
        let neighbours = telemetry.neighbours(zone).into_iter();
        for kind in std::iter::once(QuantityKind::Capacity).chain(neighbours.map(QuantityKind::Resistance)) {
            let estimated = profiler.estimated(kind, zone);
            let ends = estimated.and_then(|it| Some((it.interval.0? / it.value, it.interval.1? / it.value)));
            let Some((low, high)) = ends else {
                let name = kind.labels(telemetry).0;
                return Err(format!("the data do not determine the {name} of zone `{}`", telemetry.zones[zone].name));
            };
            let widest = match kind {
                QuantityKind::Resistance(Neighbour::Zone(_)) => &mut found.inner_resistance,
                QuantityKind::Resistance(Neighbour::Boundary(_)) => &mut found.outer_resistance,
                _ => &mut found.capacity,
            };
            *widest = (widest.0.min(low), widest.1.max(high));
        }
    }
    Ok(found)
}
