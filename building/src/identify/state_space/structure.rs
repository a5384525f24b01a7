//! Thermal networks with hidden states: which nodes and links there are, and which parameter each of them has.
//!
//! Every zone has a measured node (its air and whatever follows the air at once), and may have hidden ones:
//!
//! ```text
//! mass in the wall to a boundary     air ─ H ─ wall(C) ─ H ─ boundary         in place of  air ─ H ─ boundary
//! interior mass                      air ─ H ─ interior(C)
//! heater                             heat → heater(C) ─ H ─ air               in place of  heat → air
//! ```
//!
//! Random heat of a zone may be correlated in time: a further state q \[K/h\] that has no mass,
//! dq = −q/τ dt + √(2/τ) σ dw, adds to the rate of the air.
//!
//! The sun warms the air. It may also fall on a hidden mass, with an aperture of its own: on a floor, or on a wall.
//!
//! Every node gains random heat; its strength σ is stated as the standard deviation of temperature that it makes in one hour.

use nalgebra::DMatrix;

use super::elements::{Extension, HiddenNode};
pub(super) use super::elements::{ParameterKind, Place};
use super::exponential::{Number, exponential, real};
use super::linear_model::{ContinuousModel, InitialState};
use super::observations::InputLayout;
use crate::identify::telemetry::{Neighbour, Telemetry};

/// An hour \[s\].
pub(super) const HOUR_S: f64 = 3600.0;
/// Variance of the first temperature of a hidden node about what it would be in a steady state \[K²\]. Chosen: heavy walls are
/// a few kelvin away from it.
const HIDDEN_START_VARIANCE: f64 = 9.0;
/// What a row of unknown heat adds to the variance of the air \[K²\]. Chosen: as for the start.
const UNKNOWN_HEAT_VARIANCE: f64 = 9.0;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Node {
    pub zone: usize,
    pub place: Place,
}

impl Node {
    /// Whether it stores heat, as opposed to the state of coloured heat.
    pub fn is_mass(self) -> bool {
        self.place != Place::Hidden(HiddenNode::ColouredHeat)
    }
}

/// The other end of a link.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum End {
    Node(usize),
    Boundary(usize),
}

/// A conductance between a node and another, or a boundary.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Conductance {
    pub from: usize,
    pub to: End,
    pub parameter: usize,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Structure {
    /// The hidden nodes, sorted.
    pub hidden: Vec<HiddenNode>,
    /// Those of them that the sun falls on, sorted.
    pub sunlit: Vec<HiddenNode>,
    pub nodes: Vec<Node>,
    pub conductances: Vec<Conductance>,
    pub parameters: Vec<ParameterKind>,
    pub layout: InputLayout,
    zones: usize,
}

impl Structure {
    /// The network of the walls of the telemetry with these hidden nodes and sun on them.
    pub fn new(telemetry: &Telemetry, extensions: &[Extension]) -> Self {
        let of = |pick: fn(&Extension) -> Option<HiddenNode>| {
            let mut nodes: Vec<HiddenNode> = extensions.iter().filter_map(pick).collect();
            nodes.sort_unstable();
            nodes
        };
        let zones = telemetry.zones.len();
        let mut structure = Self {
            hidden: of(Extension::node),
            sunlit: of(Extension::sun),
            nodes: (0..zones).map(|zone| Node { zone, place: Place::Air }).collect(),
            conductances: Vec::new(),
            parameters: Vec::new(),
            layout: InputLayout::new(telemetry),
            zones,
        };
        structure.add_hidden_nodes(telemetry);
        for node in structure.nodes.clone() {
            if node.is_mass() {
                structure.parameter(ParameterKind::Capacity(node.zone, node.place));
            } else {
                structure.parameter(ParameterKind::CorrelationTime(node.zone));
            }
            structure.parameter(ParameterKind::RandomHeat(node.zone, node.place));
        }
        structure.add_walls(telemetry);
        for (zone, measured) in telemetry.zones.iter().enumerate() {
            if structure.layout.sun[zone].is_some() {
                structure.parameter(ParameterKind::Aperture(zone));
                for hidden in structure.sunlit.clone() {
                    if structure.node(zone, hidden).is_some() {
                        structure.parameter(ParameterKind::HiddenAperture(zone, hidden));
                    }
                }
            }
            if structure.layout.heat[zone].is_some() && !measured.power_has_unit {
                structure.parameter(ParameterKind::HeatGain(zone));
            }
            if structure.layout.switches[zone] {
                structure.parameter(ParameterKind::HeatSwing(zone));
            }
            structure.parameter(ParameterKind::Sensor(zone));
        }
        structure
    }

    fn parameter(&mut self, kind: ParameterKind) -> usize {
        self.parameters.push(kind);
        self.parameters.len() - 1
    }

    fn add_hidden_nodes(&mut self, telemetry: &Telemetry) {
        for hidden in self.hidden.clone() {
            for zone in (0..self.zones).filter(|&zone| applies(telemetry, &self.layout, zone, hidden)) {
                self.nodes.push(Node { zone, place: Place::Hidden(hidden) });
            }
        }
    }

    fn add_walls(&mut self, telemetry: &Telemetry) {
        for wall in &telemetry.walls {
            let through = match wall.other {
                Neighbour::Boundary(boundary) => {
                    self.node(wall.zone, HiddenNode::Wall(boundary)).map(|node| (boundary, node))
                }
                Neighbour::Zone(_) => None,
            };
            if let Some((boundary, node)) = through {
                let outer = self.parameter(ParameterKind::Outer(wall.zone, boundary));
                self.conductances.push(Conductance { from: node, to: End::Boundary(boundary), parameter: outer });
            } else {
                let direct = self.parameter(ParameterKind::Direct(wall.zone, wall.other));
                let to = match wall.other {
                    Neighbour::Zone(other) => End::Node(other),
                    Neighbour::Boundary(boundary) => End::Boundary(boundary),
                };
                self.conductances.push(Conductance { from: wall.zone, to, parameter: direct });
            }
        }
        for (index, node) in self.nodes.clone().into_iter().enumerate() {
            if let Place::Hidden(hidden) = node.place
                && node.is_mass()
            {
                let inner = self.parameter(ParameterKind::Inner(node.zone, hidden));
                self.conductances.push(Conductance { from: node.zone, to: End::Node(index), parameter: inner });
            }
        }
    }

    pub fn node(&self, zone: usize, hidden: HiddenNode) -> Option<usize> {
        self.nodes.iter().position(|node| *node == Node { zone, place: Place::Hidden(hidden) })
    }

    /// The index of a parameter.
    pub fn index(&self, kind: ParameterKind) -> Option<usize> {
        self.parameters.iter().position(|known| *known == kind)
    }

    /// The largest number of temperatures of a zone.
    pub fn order(&self) -> usize {
        1 + self.hidden.iter().filter(|hidden| hidden.kind().is_some()).count()
    }

    /// The value of a parameter, or 1 if the structure does not have it.
    pub fn value(&self, theta: &[Number], kind: ParameterKind) -> Number {
        self.index(kind).map_or(real(1.0), |index| exponential(theta[index]))
    }

    /// The model in continuous time.
    pub fn model(&self, theta: &[Number]) -> ContinuousModel {
        let count = self.nodes.len();
        let capacity: Vec<Number> =
            self.nodes.iter().map(|node| self.value(theta, ParameterKind::Capacity(node.zone, node.place))).collect();
        let mut dynamics = DMatrix::from_element(count, count, real(0.0));
        let mut inputs = DMatrix::from_element(count, self.layout.count, real(0.0));
        for link in &self.conductances {
            let conductance = exponential(theta[link.parameter]);
            let rate = conductance / capacity[link.from];
            dynamics[(link.from, link.from)] -= rate;
            match link.to {
                End::Boundary(boundary) => inputs[(link.from, boundary)] += rate,
                End::Node(other) => {
                    let back = conductance / capacity[other];
                    dynamics[(link.from, other)] += rate;
                    dynamics[(other, other)] -= back;
                    dynamics[(other, link.from)] += back;
                }
            }
        }
        for (index, node) in self.nodes.iter().enumerate().filter(|(_, node)| !node.is_mass()) {
            dynamics[(index, index)] -= real(1.0) / self.correlation_s(theta, node.zone);
            dynamics[(node.zone, index)] += real(1.0 / HOUR_S);
        }
        for zone in 0..self.zones {
            if let Some(column) = self.layout.heat[zone] {
                let node = self.heated_node(zone);
                inputs[(node, column)] += self.value(theta, ParameterKind::HeatGain(zone)) / capacity[node];
            }
            if let Some(column) = self.layout.sun[zone] {
                inputs[(zone, column)] += self.value(theta, ParameterKind::Aperture(zone)) / capacity[zone];
                for (node, aperture) in self.hidden_apertures(theta, zone) {
                    inputs[(node, column)] += aperture / capacity[node];
                }
            }
        }
        let random = |node: &Node| {
            let deviation = self.value(theta, ParameterKind::RandomHeat(node.zone, node.place));
            match node.is_mass() {
                true => deviation * deviation / HOUR_S,
                false => deviation * deviation * real(2.0) / self.correlation_s(theta, node.zone),
            }
        };
        let sensor = |zone: usize| {
            let deviation = self.value(theta, ParameterKind::Sensor(zone));
            deviation * deviation
        };
        ContinuousModel {
            dynamics,
            inputs,
            diffusion: self.nodes.iter().map(random).collect(),
            outputs: (0..self.zones).collect(),
            sensor_variance: (0..self.zones).map(sensor).collect(),
            heat_swing: (0..self.zones).map(|zone| self.heat_swing(theta, zone)).collect(),
            initial: self.initial(theta, sensor),
            unknown_heat_variance: (0..self.nodes.len()).map(|index| self.unknown_heat_variance(index)).collect(),
        }
    }

    /// Share of the full swing of a zone's heat within a row.
    fn heat_swing(&self, theta: &[Number], zone: usize) -> Number {
        self.index(ParameterKind::HeatSwing(zone)).map_or(real(0.0), |index| exponential(theta[index]))
    }

    /// Correlation time of a zone's coloured heat \[s\].
    fn correlation_s(&self, theta: &[Number], zone: usize) -> Number {
        self.value(theta, ParameterKind::CorrelationTime(zone)) * real(HOUR_S)
    }

    /// What a row of unknown heat adds to the variance of a node \[K²\]: heat goes to the air and to the heater.
    fn unknown_heat_variance(&self, index: usize) -> f64 {
        match self.nodes[index].place {
            Place::Air | Place::Hidden(HiddenNode::Heater) => UNKNOWN_HEAT_VARIANCE,
            Place::Hidden(_) => 0.0,
        }
    }

    /// The node that the known heat of a zone enters.
    pub fn heated_node(&self, zone: usize) -> usize {
        self.node(zone, HiddenNode::Heater).unwrap_or(zone)
    }

    /// Air begins at its measured temperature, hidden nodes at what they would have in a steady state beside it.
    fn initial(&self, theta: &[Number], sensor: impl Fn(usize) -> Number) -> InitialState {
        let count = self.nodes.len();
        let mut from_outputs = DMatrix::from_element(count, self.zones, real(0.0));
        let mut from_inputs = DMatrix::from_element(count, self.layout.count, real(0.0));
        let mut variance = vec![real(HIDDEN_START_VARIANCE); count];
        for (index, node) in self.nodes.iter().enumerate() {
            let zone = node.zone;
            from_outputs[(index, zone)] = real(if node.is_mass() { 1.0 } else { 0.0 });
            match node.place {
                Place::Hidden(HiddenNode::ColouredHeat) => {
                    let deviation = self.value(theta, ParameterKind::RandomHeat(zone, node.place));
                    variance[index] = deviation * deviation;
                }
                Place::Air => variance[index] = sensor(zone),
                Place::Hidden(HiddenNode::Interior) => {}
                Place::Hidden(hidden @ HiddenNode::Wall(boundary)) => {
                    let inner = self.value(theta, ParameterKind::Inner(zone, hidden));
                    let outer = self.value(theta, ParameterKind::Outer(zone, boundary));
                    from_outputs[(index, zone)] = inner / (inner + outer);
                    from_inputs[(index, boundary)] = outer / (inner + outer);
                }
                Place::Hidden(hidden @ HiddenNode::Heater) => {
                    let inner = self.value(theta, ParameterKind::Inner(zone, hidden));
                    if let Some(column) = self.layout.heat[zone] {
                        from_inputs[(index, column)] = self.value(theta, ParameterKind::HeatGain(zone)) / inner;
                    }
                }
            }
        }
        InitialState {
            offset: vec![real(0.0); count],
            from_outputs,
            from_inputs,
            variance,
            contains_first_outputs: true,
        }
    }

    /// Conductance from a zone to a neighbour, through the wall's mass if it has one \[kW/K\].
    pub fn total_conductance(&self, theta: &[Number], zone: usize, neighbour: Neighbour) -> Option<Number> {
        let direct = |kind| self.index(kind).map(|index| exponential(theta[index]));
        if let Neighbour::Boundary(boundary) = neighbour
            && let Some(outer) = direct(ParameterKind::Outer(zone, boundary))
        {
            let inner = self.value(theta, ParameterKind::Inner(zone, HiddenNode::Wall(boundary)));
            return Some(inner * outer / (inner + outer));
        }
        let other_way = match neighbour {
            Neighbour::Zone(other) => direct(ParameterKind::Direct(other, Neighbour::Zone(zone))),
            Neighbour::Boundary(_) => None,
        };
        direct(ParameterKind::Direct(zone, neighbour)).or(other_way)
    }

    /// The hidden nodes of a zone that the sun falls on, with their apertures \[m²\].
    fn hidden_apertures(&self, theta: &[Number], zone: usize) -> Vec<(usize, Number)> {
        let aperture = |hidden: &HiddenNode| {
            let index = self.index(ParameterKind::HiddenAperture(zone, *hidden))?;
            Some((self.node(zone, *hidden)?, exponential(theta[index])))
        };
        self.sunlit.iter().filter_map(aperture).collect()
    }

    /// Total aperture of a zone \[m²\]: that of its air, and of each mass the part whose heat reaches the air in a steady state.
    pub fn total_aperture(&self, theta: &[Number], zone: usize) -> Option<Number> {
        let of_air = exponential(theta[self.index(ParameterKind::Aperture(zone))?]);
        let of_masses = self.hidden_apertures(theta, zone).into_iter();
        Some(of_masses.fold(of_air, |sum, (node, aperture)| sum + aperture * self.share_to_air(theta, node)))
    }

    /// The share of steady heat into a node that reaches the air of its zone; the rest reaches the boundary.
    pub fn share_to_air(&self, theta: &[Number], node: usize) -> Number {
        let Node { zone, place } = self.nodes[node];
        let Place::Hidden(hidden @ HiddenNode::Wall(boundary)) = place else { return real(1.0) };
        let inner = self.value(theta, ParameterKind::Inner(zone, hidden));
        inner / (inner + self.value(theta, ParameterKind::Outer(zone, boundary)))
    }

    /// The extensions of the smallest model that this structure contains.
    pub fn extensions(&self) -> Vec<Extension> {
        let nodes = self.hidden.iter().map(|&hidden| Extension::Node(hidden));
        nodes.chain(self.sunlit.iter().map(|&hidden| Extension::Sun(hidden))).collect()
    }

    /// The extensions that may still be added: hidden nodes, and sun on the existing masses.
    pub fn candidates(&self, telemetry: &Telemetry) -> Vec<Extension> {
        let walls = (0..telemetry.boundaries.len()).map(HiddenNode::Wall);
        let all = walls.chain([HiddenNode::Interior, HiddenNode::Heater, HiddenNode::ColouredHeat]);
        let possible = |hidden: &HiddenNode| {
            let applies = |zone| applies(telemetry, &self.layout, zone, *hidden);
            !self.hidden.contains(hidden) && (0..self.zones).any(applies)
        };
        let can_be_sunlit = |&&hidden: &&HiddenNode| {
            let shines = |zone: usize| self.layout.sun[zone].is_some() && self.node(zone, hidden).is_some();
            matches!(hidden, HiddenNode::Wall(_) | HiddenNode::Interior)
                && !self.sunlit.contains(&hidden)
                && (0..self.zones).any(shines)
        };
        let sun = self.hidden.iter().filter(can_be_sunlit).copied().map(Extension::Sun);
        all.filter(possible).map(Extension::Node).chain(sun).collect()
    }

    /// Sum of the capacities of a zone's nodes \[kJ/K\].
    pub fn total_capacity(&self, theta: &[Number], zone: usize) -> Number {
        let of_zone = self.nodes.iter().filter(|node| node.zone == zone && node.is_mass());
        of_zone.fold(real(0.0), |sum, node| sum + self.value(theta, ParameterKind::Capacity(zone, node.place)))
    }
}

/// Whether a zone can have a hidden node of this kind.
fn applies(telemetry: &Telemetry, layout: &InputLayout, zone: usize, hidden: HiddenNode) -> bool {
    match hidden {
        HiddenNode::Wall(boundary) => telemetry.neighbours(zone).contains(&Neighbour::Boundary(boundary)),
        HiddenNode::Interior | HiddenNode::ColouredHeat => true,
        HiddenNode::Heater => layout.heat[zone].is_some(),
    }
}
