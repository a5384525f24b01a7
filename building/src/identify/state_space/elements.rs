//! The elements of a thermal network: hidden nodes, extensions of a smaller network, and parameters.

use crate::identify::settings::HiddenTemperature;
use crate::identify::telemetry::Neighbour;

/// A hidden node that a model has beyond the measured one; all zones to which it can apply have it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum HiddenNode {
    /// Mass in the walls to a boundary.
    Wall(usize),
    /// Furniture, inner walls and floors.
    Interior,
    /// Mass between the source of heat and the air.
    Heater,
    /// Random heat into the air that is correlated in time: a state without mass.
    ColouredHeat,
}

/// What a model may have beyond a smaller one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Extension {
    Node(HiddenNode),
    /// Sun on a hidden node, in all zones whose sun is measured and which have the node.
    Sun(HiddenNode),
}

impl HiddenNode {
    /// The kind of hidden temperature of this node; `None` if the node is not a temperature.
    pub fn kind(self) -> Option<HiddenTemperature> {
        match self {
            Self::Wall(_) => Some(HiddenTemperature::Wall),
            Self::Interior => Some(HiddenTemperature::Interior),
            Self::Heater => Some(HiddenTemperature::Heater),
            Self::ColouredHeat => None,
        }
    }
}

impl Extension {
    /// The hidden node that the extension adds, or onto which it lets the sun fall.
    pub fn hidden(self) -> HiddenNode {
        match self {
            Self::Node(hidden) | Self::Sun(hidden) => hidden,
        }
    }

    /// The hidden node that the extension adds; `None` if it adds sun.
    pub fn node(&self) -> Option<HiddenNode> {
        match self {
            Self::Node(hidden) => Some(*hidden),
            Self::Sun(_) => None,
        }
    }

    /// The hidden node onto which the extension lets the sun fall; `None` if it adds a node.
    pub fn sun(&self) -> Option<HiddenNode> {
        match self {
            Self::Sun(hidden) => Some(*hidden),
            Self::Node(_) => None,
        }
    }
}

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
    /// Share of the full swing of a zone's heat within a row, where it switches inside of rows.
    HeatSwing(usize),
    /// Correlation time τ of a zone's coloured heat \[h\]; its [`ParameterKind::RandomHeat`] is its standard deviation \[K/h\].
    CorrelationTime(usize),
    /// Standard deviation of a zone's sensor \[K\].
    Sensor(usize),
}
