//! Which parameters a thermal network has, and where.

use super::extension::HiddenNode;
use crate::identify::telemetry::Neighbour;

/// Which node of a zone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Place {
    Air,
    Hidden(HiddenNode),
}

/// What a parameter is. All are logarithms.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ParameterKind {
    /// Heat capacity of a node \[kJ/K\].
    Capacity(usize, Place),
    /// Random heat of a node, as the deviation of its temperature in an hour \[K/√h\].
    RandomHeat(usize, Place),
    /// Conductance from a zone's air to a neighbour without mass between \[kW/K\].
    Direct(usize, Neighbour),
    /// Conductance between a zone's air and a hidden node of it \[kW/K\].
    Inner(usize, HiddenNode),
    /// Conductance between the wall's mass and the boundary \[kW/K\].
    Outer(usize, usize),
    /// Aperture of a zone's air \[m²\].
    Aperture(usize),
    /// Aperture of a hidden node of a zone \[m²\].
    HiddenAperture(usize, HiddenNode),
    /// Heat per unit of a signal without unit \[kW\].
    HeatGain(usize),
    /// Correlation time τ of a zone's coloured heat \[h\]; its [`ParameterKind::RandomHeat`] is its standard deviation \[K/h\].
    CorrelationTime(usize),
    /// Standard deviation of a zone's sensor \[K\].
    Sensor(usize),
}
