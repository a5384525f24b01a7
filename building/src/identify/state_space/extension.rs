//! What a thermal network may have beyond the measured temperatures of its zones.

use crate::identify::settings::HiddenTemperature;

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
    /// A hidden node.
    Node(HiddenNode),
    /// Sun on a hidden node, in all zones whose sun is measured and which have the node.
    Sun(HiddenNode),
}

impl HiddenNode {
    /// Which kind of hidden temperature it has; `None` where it has none.
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
    /// The hidden node that it is, or that it gives sun to.
    pub fn hidden(self) -> HiddenNode {
        match self {
            Self::Node(hidden) | Self::Sun(hidden) => hidden,
        }
    }

    /// The hidden node, if it is one.
    pub fn node(&self) -> Option<HiddenNode> {
        match self {
            Self::Node(hidden) => Some(*hidden),
            Self::Sun(_) => None,
        }
    }

    /// The hidden node that the sun falls on, if it is that.
    pub fn sun(&self) -> Option<HiddenNode> {
        match self {
            Self::Sun(hidden) => Some(*hidden),
            Self::Node(_) => None,
        }
    }
}
