//! Physical quantities as functions of the parameters, with their uncertainty.
//!
//! All are positive, so estimates and intervals are stated on the scale of logarithms: f ∈ exp(ln f(θ̂) ± 1.96 s) with
//! s² = ∇ln f ᵀ I⁻¹ ∇ln f. The estimate always lies within its interval, and neither is ever negative.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

use super::elements::HiddenNode;
use super::exponential::{INFINITESIMAL, Number, real};
use super::likelihood::{changed, numbers};
use super::scoring::free_parameters;
use super::selection::Fit;
use super::structure::{ParameterKind, Place, Structure};
use crate::identify::telemetry::{Neighbour, Telemetry};

/// Directions of the scaled information with less than this share of the largest eigenvalue are not determined by the data.
const LEAST_EIGENVALUE_SHARE: f64 = 1e-9;
/// Share of a gradient along such directions from which on a quantity is not determined.
const MAX_UNDETERMINED_SHARE: f64 = 1e-4;
/// A parameter within this distance of its bound has run there.
const AT_BOUND: f64 = 1e-3;
/// A quantity depends on a parameter if a change of its logarithm changes its own by more than this share.
const DEPENDENCE: f64 = 0.2;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum QuantityKind {
    /// Sum of the capacities of a zone.
    Capacity,
    /// Capacity of one node of a zone that has several.
    NodeCapacity(Place),
    /// Conductance to a neighbour, through all that is between.
    Conductance(Neighbour),
    /// Its inverse.
    Resistance(Neighbour),
    /// Between the air and a hidden node.
    InnerConductance(HiddenNode),
    /// Of all that the sun falls on, as much as reaches the air.
    Aperture,
    /// Of one node of a zone that the sun falls on in several places.
    NodeAperture(Place),
    /// Capacity over all conductances \[h\].
    TimeConstant,
    /// Steady warming by one unit of a heat signal \[K\].
    Warming,
}

impl QuantityKind {
    /// All quantities of a zone that the structure determines.
    pub fn of_zone(telemetry: &Telemetry, structure: &Structure, zone: usize) -> Vec<Self> {
        let neighbours = telemetry.neighbours(zone);
        let places: Vec<Place> =
            structure.nodes.iter().filter(|node| node.zone == zone && node.is_mass()).map(|node| node.place).collect();
        let mut kinds = vec![Self::Capacity];
        if places.len() > 1 {
            kinds.extend(places.iter().map(|&place| Self::NodeCapacity(place)));
        }
        for &neighbour in &neighbours {
            kinds.extend([Self::Conductance(neighbour), Self::Resistance(neighbour)]);
        }
        kinds.extend(places.iter().filter_map(|place| match place {
            Place::Hidden(hidden) => Some(Self::InnerConductance(*hidden)),
            Place::Air => None,
        }));
        if structure.layout.sun[zone].is_some() {
            kinds.push(Self::Aperture);
            let is_sunlit = |place: &&Place| match place {
                Place::Air => true,
                Place::Hidden(hidden) => structure.sunlit.contains(hidden),
            };
            let sunlit: Vec<Self> = places.iter().filter(is_sunlit).map(|&place| Self::NodeAperture(place)).collect();
            if sunlit.len() > 1 {
                kinds.extend(sunlit);
            }
        }
        if !neighbours.is_empty() {
            kinds.push(Self::TimeConstant);
            if structure.layout.heat[zone].is_some() && !telemetry.zones[zone].power_has_unit {
                kinds.push(Self::Warming);
            }
        }
        kinds
    }

    /// The value of the quantity; `None` if the structure does not have it.
    pub fn value(self, telemetry: &Telemetry, structure: &Structure, theta: &[Number], zone: usize) -> Option<Number> {
        let of = |kind| structure.index(kind).map(|_| structure.value(theta, kind));
        let all = || {
            let each = telemetry.neighbours(zone).into_iter();
            each.filter_map(|neighbour| structure.total_conductance(theta, zone, neighbour))
                .fold(real(0.0), |sum, conductance| sum + conductance)
        };
        match self {
            Self::Capacity => Some(structure.total_capacity(theta, zone)),
            Self::NodeCapacity(place) => of(ParameterKind::Capacity(zone, place)),
            Self::Conductance(neighbour) => structure.total_conductance(theta, zone, neighbour),
            Self::Resistance(neighbour) => {
                structure.total_conductance(theta, zone, neighbour).map(|conductance| real(1.0) / conductance)
            }
            Self::InnerConductance(hidden) => of(ParameterKind::Inner(zone, hidden)),
            Self::Aperture => structure.total_aperture(theta, zone),
            Self::NodeAperture(Place::Air) => of(ParameterKind::Aperture(zone)),
            Self::NodeAperture(Place::Hidden(hidden)) => of(ParameterKind::HiddenAperture(zone, hidden)),
            Self::TimeConstant => Some(structure.total_capacity(theta, zone) / all() / super::structure::HOUR_S),
            Self::Warming => Some(structure.value(theta, ParameterKind::HeatGain(zone)) / all()),
        }
    }

    /// Whether the quantity is known only if the heat is measured in kW.
    pub fn needs_scale(self) -> bool {
        !matches!(self, Self::TimeConstant | Self::Warming)
    }

    /// Name, symbol and unit.
    pub fn labels(self, telemetry: &Telemetry) -> (String, &'static str, &'static str) {
        let node = |place: Place| match place {
            Place::Air => "air".to_owned(),
            Place::Hidden(hidden) => hidden_name(telemetry, hidden),
        };
        match self {
            Self::Capacity => ("heat capacity".into(), "c", "kJ/K"),
            Self::NodeCapacity(place) => (format!("heat capacity of the {}", node(place)), "c", "kJ/K"),
            Self::Conductance(neighbour) => (format!("conductance to {}", telemetry.name(neighbour)), "1/R", "kW/K"),
            Self::Resistance(neighbour) => (format!("resistance to {}", telemetry.name(neighbour)), "R", "K/kW"),
            Self::InnerConductance(hidden) => {
                (format!("conductance between air and {}", hidden_name(telemetry, hidden)), "1/R", "kW/K")
            }
            Self::Aperture => ("aperture to the sun".into(), "A", "m²"),
            Self::NodeAperture(place) => (format!("aperture of the {}", node(place)), "A", "m²"),
            Self::TimeConstant => ("time constant through the walls".into(), "τ", "h"),
            Self::Warming => ("warming by a steady heat signal".into(), "g", "K/unit"),
        }
    }
}

fn hidden_name(telemetry: &Telemetry, hidden: HiddenNode) -> String {
    match hidden {
        HiddenNode::Wall(boundary) => format!("wall to {}", telemetry.boundaries[boundary].name),
        HiddenNode::Interior => "interior mass".into(),
        HiddenNode::Heater => "heater".into(),
        HiddenNode::ColouredHeat => "coloured heat".into(),
    }
}

/// ln f and its gradient; `None` where the structure has no such quantity.
pub(super) fn logarithm(
    telemetry: &Telemetry,
    structure: &Structure,
    (kind, zone): (QuantityKind, usize),
    theta: &[f64],
) -> Option<(f64, Vec<f64>)> {
    let value = kind.value(telemetry, structure, &numbers(theta), zone)?.re;
    let derivative = |parameter: usize| {
        let changed = kind.value(telemetry, structure, &changed(theta, parameter), zone);
        changed.map_or(0.0, |changed| changed.im / INFINITESIMAL / value)
    };
    Some((libm::log(value), (0..theta.len()).map(derivative).collect()))
}

/// The eigenvalues and eigenvectors of a symmetric matrix, which may have no rows: every parameter is held by a bound then.
fn eigen_of(matrix: DMatrix<f64>) -> SymmetricEigen<f64, nalgebra::Dyn> {
    if matrix.is_empty() {
        return SymmetricEigen { eigenvalues: DVector::zeros(0), eigenvectors: matrix };
    }
    SymmetricEigen::new(matrix)
}

/// The covariance of the estimate, and what it says of a function of the parameters.
pub(super) struct Precision {
    free: Vec<usize>,
    at_bound: Vec<usize>,
    /// Scale of each free parameter, √I_jj.
    scale: Vec<f64>,
    eigen: SymmetricEigen<f64, nalgebra::Dyn>,
}

impl Precision {
    pub fn new(fit: &Fit) -> Self {
        let evaluation = &fit.maximum.evaluation;
        let near = |&j: &usize| {
            let ((low, high), value) = (fit.bounds[j], fit.maximum.theta[j]);
            low < high && (value < low + AT_BOUND || value > high - AT_BOUND)
        };
        let at_bound: Vec<usize> = (0..fit.bounds.len()).filter(near).collect();
        let mut free = free_parameters(&fit.maximum.theta, &fit.bounds, &evaluation.gradient);
        free.retain(|j| !at_bound.contains(j));
        let scale: Vec<f64> =
            free.iter().map(|&j| libm::sqrt(evaluation.information[(j, j)]).max(f64::MIN_POSITIVE)).collect();
        let scaled = DMatrix::from_fn(free.len(), free.len(), |a, b| {
            evaluation.information[(free[a], free[b])] / (scale[a] * scale[b])
        });
        Self { free, at_bound, scale, eigen: eigen_of(scaled) }
    }

    /// Standard error of a function with this gradient; infinite where the data do not determine it.
    pub fn standard_error(&self, gradient: &[f64]) -> f64 {
        if self.free.is_empty() || self.at_bound.iter().any(|&j| gradient[j].abs() > DEPENDENCE) {
            return f64::INFINITY;
        }
        let (along, undetermined) = self.along(gradient);
        let length: f64 = along.iter().map(|(value, _)| value * value).sum();
        if undetermined > MAX_UNDETERMINED_SHARE * length {
            return f64::INFINITY;
        }
        libm::sqrt(along.iter().map(|(value, inverse)| value * value * inverse).sum())
    }

    /// The inverse information matrix I⁻¹ times a gradient: the direction of the parameters in which a function with
    /// this gradient changes at the least loss of likelihood.
    pub fn direction(&self, gradient: &[f64], parameters: usize) -> Vec<f64> {
        let (along, _) = self.along(gradient);
        let weighted = DVector::from_iterator(along.len(), along.iter().map(|(value, inverse)| value * inverse));
        let mut direction = vec![0.0; parameters];
        for (a, &j) in self.free.iter().enumerate() {
            let sum: f64 = (0..weighted.len()).map(|k| self.eigen.eigenvectors[(a, k)] * weighted[k]).sum();
            direction[j] = sum / self.scale[a];
        }
        direction
    }

    /// The gradient along the eigenvectors with the inverse of each eigenvalue, zero for directions that are not determined;
    /// and the square of the part along those.
    fn along(&self, gradient: &[f64]) -> (Vec<(f64, f64)>, f64) {
        let largest = self.eigen.eigenvalues.iter().fold(0.0_f64, |largest, value| largest.max(*value));
        let mut undetermined = 0.0;
        let project = |k: usize| {
            let value: f64 = self
                .free
                .iter()
                .enumerate()
                .map(|(a, &j)| self.eigen.eigenvectors[(a, k)] * gradient[j] / self.scale[a])
                .sum();
            let eigenvalue = self.eigen.eigenvalues[k];
            if eigenvalue <= LEAST_EIGENVALUE_SHARE * largest {
                undetermined += value * value;
                return (value, 0.0);
            }
            (value, 1.0 / eigenvalue)
        };
        let along = (0..self.free.len()).map(project).collect();
        (along, undetermined)
    }
}
