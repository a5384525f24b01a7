//! The starting points of the ascents, and the bounds of the parameters.

use super::elements::{Extension, HiddenNode};
use super::structure::{HOUR_S, ParameterKind, Place, Structure};
use crate::identify::telemetry::{Neighbour, Telemetry};

/// Time constants of a zone with its walls that are tried \[h\].
const TIME_CONSTANTS_H: [f64; 3] = [3.0, 15.0, 75.0];
/// A conductance may be this many times larger or smaller than the first guess.
const CONDUCTANCE_RANGE: f64 = 1e4;
/// A capacity likewise.
const CAPACITY_RANGE: f64 = 1e4;
/// Random heat of a node \[K/√h\].
const RANDOM_HEAT_RANGE: (f64, f64) = (1e-4, 50.0);
/// Standard deviation of a sensor \[K\].
const SENSOR_RANGE: (f64, f64) = (1e-4, 5.0);
/// Correlation time of coloured heat \[h\].
const CORRELATION_RANGE_H: (f64, f64) = (0.3, 48.0);
const CORRELATION_TIME_H: f64 = 3.0;
/// Share of the full swing of heat within a row: 1 for a heater that switches on once in a row, 0 for heat that is held.
const HEAT_SWING: f64 = 0.7;
const HEAT_SWING_RANGE: (f64, f64) = (0.02, 1.0);
/// Capacity of the zone that sets the scale where no heat has a unit \[kJ/K\].
const UNIT_CAPACITY_KJ_PER_K: f64 = 1000.0;

/// A way to split the capacity of a model when a hidden node is added to it: the share that stays with the air, the node's
/// capacity as a multiple of the whole, and the conductance of a mass to the air as a multiple of all conductances of the zone.
struct Split {
    air: f64,
    node: f64,
    conductance: f64,
}

/// The last one of each list is nearly the model without the node.
const MASS_SPLITS: [Split; 7] = [
    Split { air: 0.3, node: 1.0, conductance: 5.0 },
    Split { air: 0.6, node: 4.0, conductance: 3.0 },
    Split { air: 0.1, node: 1.0, conductance: 12.0 },
    Split { air: 0.9, node: 1.0, conductance: 2.0 },
    Split { air: 0.3, node: 0.3, conductance: 20.0 },
    Split { air: 0.9, node: 0.3, conductance: 6.0 },
    Split { air: 1.0, node: 1e-3, conductance: 10.0 },
];
const HEATER_SPLITS: [Split; 3] = [
    Split { air: 0.95, node: 0.05, conductance: 2.0 },
    Split { air: 0.7, node: 0.3, conductance: 2.0 },
    Split { air: 1.0, node: 1e-3, conductance: 60.0 },
];

/// Shares of the sun that fall on a hidden node.
const SUN_SHARES: [f64; 3] = [0.8, 0.4, 1e-3];

/// Deviation of coloured heat as a share of what the air's random heat is in an hour, and its correlation time \[h\]. The last
/// one is nearly the model without it.
const COLOURS: [(f64, f64); 3] = [(1.0, 2.0), (0.5, 10.0), (1e-3, 3.0)];

/// What the data suggest at first sight.
pub(super) struct Guess {
    /// Of each zone, over all its neighbours \[kW/K\].
    conductance: Vec<f64>,
    /// Aperture \[m²\].
    aperture: Vec<f64>,
    /// Heat per unit of a signal without unit \[kW\].
    heat_gain: Vec<f64>,
    /// Deviation of the change of temperature in an hour \[K\].
    change_k: Vec<f64>,
    /// Least standard deviation of each sensor \[K\]: that of rounding to its steps, or the bound.
    least_sensor_k: Vec<f64>,
    /// Whether some heat is in kW.
    pub scale_is_known: bool,
}

impl Guess {
    pub fn new(telemetry: &Telemetry) -> Self {
        let scale_is_known = telemetry.zones.iter().any(|zone| zone.has_heat() && zone.power_has_unit);
        let by_size: Vec<f64> = (0..telemetry.zones.len()).map(|zone| conductance(telemetry, zone)).collect();
        let unit = UNIT_CAPACITY_KJ_PER_K / (15.0 * HOUR_S);
        let heat_gain = by_size.iter().map(|by_size| if scale_is_known { 1.0 } else { unit / by_size }).collect();
        let conductance = if scale_is_known { by_size } else { vec![unit; by_size.len()] };
        let aperture = |zone: usize| {
            let sun = telemetry.zones[zone].irradiance_kw_per_m2.as_deref().unwrap_or_default();
            2.0 * conductance[zone] / mean(sun.iter().copied()).max(0.01)
        };
        let change = |zone: usize| {
            let temperature = &telemetry.zones[zone].temperature_c;
            let changes = temperature.windows(2).map(|pair| pair[1] - pair[0]).filter(|change| change.is_finite());
            libm::sqrt(mean(changes.map(|change| change * change)) * HOUR_S / telemetry.step_s).max(1e-3)
        };
        let zones = 0..telemetry.zones.len();
        Self {
            aperture: zones.clone().map(aperture).collect(),
            change_k: zones.clone().map(change).collect(),
            least_sensor_k: zones.map(|zone| rounding_k(&telemetry.zones[zone].temperature_c)).collect(),
            conductance,
            heat_gain,
            scale_is_known,
        }
    }

    /// Starts of the smallest model.
    pub fn of_smallest(&self, telemetry: &Telemetry, structure: &Structure) -> Vec<Vec<f64>> {
        TIME_CONSTANTS_H.map(|hours| self.start(telemetry, structure, hours * HOUR_S)).to_vec()
    }

    fn start(&self, telemetry: &Telemetry, structure: &Structure, time_constant_s: f64) -> Vec<f64> {
        let value = |kind: &ParameterKind| match *kind {
            ParameterKind::Capacity(zone, _) if self.is_unit(zone) => UNIT_CAPACITY_KJ_PER_K,
            ParameterKind::Capacity(zone, _) => self.conductance[zone] * time_constant_s,
            ParameterKind::RandomHeat(zone, _) => 0.3 * self.change_k[zone],
            ParameterKind::Direct(zone, _) | ParameterKind::Inner(zone, _) | ParameterKind::Outer(zone, _) => {
                let share = self.conductance[zone] / telemetry.neighbours(zone).len().max(1) as f64;
                if self.is_unit(zone) {
                    share * UNIT_CAPACITY_KJ_PER_K / (self.conductance[zone] * time_constant_s)
                } else {
                    share
                }
            }
            ParameterKind::Aperture(zone) | ParameterKind::HiddenAperture(zone, _) => self.aperture[zone],
            ParameterKind::HeatGain(zone) => self.heat_gain[zone],
            ParameterKind::HeatSwing(_) => HEAT_SWING,
            ParameterKind::CorrelationTime(_) => CORRELATION_TIME_H,
            ParameterKind::Sensor(zone) => 0.2 * self.change_k[zone] * libm::sqrt(telemetry.step_s / HOUR_S),
        };
        structure.parameters.iter().map(|kind| libm::log(value(kind))).collect()
    }

    /// Whether the capacity of a zone is fixed to set the scale.
    fn is_unit(&self, zone: usize) -> bool {
        !self.scale_is_known && zone == 0
    }

    /// Least and greatest value of each parameter.
    pub fn bounds(&self, structure: &Structure) -> Vec<(f64, f64)> {
        let around = |value: f64, range: f64| (libm::log(value / range), libm::log(value * range));
        let bound = |kind: &ParameterKind| match *kind {
            ParameterKind::Capacity(zone, Place::Air) if self.is_unit(zone) => {
                (libm::log(UNIT_CAPACITY_KJ_PER_K), libm::log(UNIT_CAPACITY_KJ_PER_K))
            }
            ParameterKind::Capacity(zone, _) => around(self.conductance[zone] * 15.0 * HOUR_S, CAPACITY_RANGE),
            ParameterKind::RandomHeat(..) => (libm::log(RANDOM_HEAT_RANGE.0), libm::log(RANDOM_HEAT_RANGE.1)),
            ParameterKind::Direct(zone, _) | ParameterKind::Inner(zone, _) | ParameterKind::Outer(zone, _) => {
                around(self.conductance[zone], CONDUCTANCE_RANGE)
            }
            ParameterKind::Aperture(zone) | ParameterKind::HiddenAperture(zone, _) => {
                around(self.aperture[zone], CONDUCTANCE_RANGE)
            }
            ParameterKind::HeatGain(zone) => around(self.heat_gain[zone], CONDUCTANCE_RANGE),
            ParameterKind::CorrelationTime(_) => (libm::log(CORRELATION_RANGE_H.0), libm::log(CORRELATION_RANGE_H.1)),
            ParameterKind::HeatSwing(_) => (libm::log(HEAT_SWING_RANGE.0), libm::log(HEAT_SWING_RANGE.1)),
            ParameterKind::Sensor(zone) => (libm::log(self.least_sensor_k[zone]), libm::log(SENSOR_RANGE.1)),
        };
        structure.parameters.iter().map(bound).collect()
    }

    /// Starts of a model with `added`, from the estimate `theta` of the model without it. The last one is nearly the smaller model.
    pub fn of_larger(&self, smaller: &Structure, theta: &[f64], larger: &Structure, added: Extension) -> Vec<Vec<f64>> {
        match added {
            Extension::Node(HiddenNode::ColouredHeat) => of_coloured_heat(smaller, theta, larger),
            Extension::Node(hidden) => self.of_node(smaller, theta, larger, hidden),
            Extension::Sun(hidden) => of_sun(smaller, theta, larger, hidden),
        }
    }

    fn of_node(&self, smaller: &Structure, theta: &[f64], larger: &Structure, added: HiddenNode) -> Vec<Vec<f64>> {
        let splits: &[Split] = if added == HiddenNode::Heater { &HEATER_SPLITS } else { &MASS_SPLITS };
        let known = |kind: ParameterKind| smaller.index(kind).map(|index| libm::exp(theta[index]));
        let value = |split: &Split, kind: &ParameterKind| {
            let air = |zone| known(ParameterKind::Capacity(zone, Place::Air)).unwrap_or(1.0);
            let to_boundary = |zone, boundary| known(ParameterKind::Direct(zone, Neighbour::Boundary(boundary)));
            match *kind {
                ParameterKind::Capacity(zone, Place::Air) if self.is_unit(zone) => air(zone),
                ParameterKind::Capacity(zone, Place::Air) if larger.node(zone, added).is_some() => {
                    split.air * air(zone)
                }
                ParameterKind::Capacity(zone, Place::Hidden(hidden)) if hidden == added => split.node * air(zone),
                ParameterKind::RandomHeat(zone, Place::Hidden(hidden)) if hidden == added => {
                    0.1 * known(ParameterKind::RandomHeat(zone, Place::Air)).unwrap_or(1.0)
                }
                ParameterKind::Inner(zone, hidden) if hidden == added => match hidden {
                    HiddenNode::ColouredHeat => 1.0,
                    HiddenNode::Heater => split.conductance * split.node * air(zone) / HOUR_S,
                    HiddenNode::Interior => split.conductance * conductances(smaller, theta, zone),
                    HiddenNode::Wall(boundary) => split.conductance * to_boundary(zone, boundary).unwrap_or(1.0),
                },
                ParameterKind::Outer(zone, boundary) if known(*kind).is_none() => {
                    // In series with the inner conductance, this gives the conductance of the smaller model.
                    split.conductance / (split.conductance - 1.0) * to_boundary(zone, boundary).unwrap_or(1.0)
                }
                kind => known(kind).unwrap_or(1.0),
            }
        };
        let start = |split: &Split| larger.parameters.iter().map(|kind| libm::log(value(split, kind))).collect();
        splits.iter().map(start).collect()
    }
}

/// Starts of a model whose sun falls on a hidden node, too: shares of the air's aperture go there.
fn of_sun(smaller: &Structure, theta: &[f64], larger: &Structure, sunlit: HiddenNode) -> Vec<Vec<f64>> {
    let known = |kind: ParameterKind| smaller.index(kind).map(|index| libm::exp(theta[index]));
    let value = |share: f64, kind: &ParameterKind| match *kind {
        ParameterKind::Aperture(zone) => {
            let moves = if larger.node(zone, sunlit).is_some() { share } else { 0.0 };
            (1.0 - moves) * known(*kind).unwrap_or(1.0)
        }
        ParameterKind::HiddenAperture(zone, hidden) if hidden == sunlit => {
            share * known(ParameterKind::Aperture(zone)).unwrap_or(1.0)
        }
        kind => known(kind).unwrap_or(1.0),
    };
    let start = |share: &f64| larger.parameters.iter().map(|kind| libm::log(value(*share, kind))).collect();
    SUN_SHARES.iter().map(start).collect()
}

/// Starts of a model with coloured heat.
fn of_coloured_heat(smaller: &Structure, theta: &[f64], larger: &Structure) -> Vec<Vec<f64>> {
    let known = |kind: ParameterKind| smaller.index(kind).map(|index| libm::exp(theta[index]));
    let value = |(share, correlation_h): (f64, f64), kind: &ParameterKind| match *kind {
        ParameterKind::CorrelationTime(_) => correlation_h,
        ParameterKind::RandomHeat(zone, Place::Hidden(HiddenNode::ColouredHeat)) => {
            share * known(ParameterKind::RandomHeat(zone, Place::Air)).unwrap_or(1.0)
        }
        kind => known(kind).unwrap_or(1.0),
    };
    let start = |colour: &(f64, f64)| larger.parameters.iter().map(|kind| libm::log(value(*colour, kind))).collect();
    COLOURS.iter().map(start).collect()
}

/// Standard deviation of rounding to the steps of a sensor \[K\], q/√12 of steps q; the least bound where it has none.
///
/// A sensor has steps of q if all its values are multiples of one of the customary steps and at least a third of all rows
/// repeat the value before: then rounding, not noise, is what its error is made of.
fn rounding_k(temperature_c: &[f64]) -> f64 {
    let finite: Vec<f64> = temperature_c.iter().copied().filter(|value| value.is_finite()).collect();
    let is_multiple = |step: f64| {
        let off = |value: &f64| {
            let steps = value / step;
            (steps - libm::round(steps)).abs() > 1e-6 * steps.abs().max(1.0)
        };
        !finite.iter().any(off)
    };
    let repeated = finite.windows(2).filter(|pair| pair[0] == pair[1]).count();
    let step = [1.0, 0.5, 0.2, 0.1, 0.0625, 0.05].into_iter().find(|&step| is_multiple(step));
    match step {
        Some(step) if 3 * repeated > finite.len() => step / libm::sqrt(12.0),
        _ => SENSOR_RANGE.0,
    }
}

/// All conductances out of a zone's air \[kW/K\].
fn conductances(structure: &Structure, theta: &[f64], zone: usize) -> f64 {
    let of_air = |link: &&super::structure::Conductance| {
        link.from == zone || matches!(link.to, super::structure::End::Node(other) if other == zone)
    };
    let all: f64 = structure.conductances.iter().filter(of_air).map(|link| libm::exp(theta[link.parameter])).sum();
    all.max(1e-9)
}

/// Heat over temperature difference, both by their size; 0.1 kW/K without heat.
fn conductance(telemetry: &Telemetry, zone: usize) -> f64 {
    let measured = &telemetry.zones[zone];
    let rows = || (0..telemetry.rows()).filter(|&row| measured.temperature_c[row].is_finite());
    let heat = mean(rows().map(|row| measured.heat_kw(row, measured.temperature_c[row]).abs()));
    let neighbours = telemetry.neighbours(zone);
    let difference = |row: usize| {
        let differences =
            neighbours.iter().map(|&other| (telemetry.temperature_c(other)[row] - measured.temperature_c[row]).abs());
        differences.filter(|difference| difference.is_finite()).fold(0.0, f64::max)
    };
    let difference = mean(rows().map(difference)).max(0.5);
    if heat > 0.0 { heat / difference } else { 0.1 }
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (count, sum) = values.fold((0_usize, 0.0), |(count, sum), value| (count + 1, sum + value));
    sum / count.max(1) as f64
}
