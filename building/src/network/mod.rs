//! The thermal network of zones and walls (section 2.2).
//!
//! # The model
//!
//! Every node i (the zones, and after them the walls that store heat) has one temperature Tᵢ and obeys
//!
//! ```text
//! cᵢ dTᵢ/dt = Σₖ (Tₖ − Tᵢ)/Rₖᵢ + (T₀ − Tᵢ)/R₀ᵢ + uᵢ + wᵢ                          (eqs. 2.1, 2.2)
//! C dT/dt   = −L T + k T₀ + u + w                                             (eq. 2.15)
//! ```
//!
//! with heat from equipment u (zones only) and from people, sun and machines w \[kW\] (sun also on walls that store heat), outdoor temperature T₀, kᵢ = 1/R₀ᵢ, and L the
//! conductance Laplacian of the graph plus diag(k). The dissertation prints −L as R_T and calls it a resistance matrix; it is a
//! matrix of conductances \[kW/K\] whose rows sum to −kᵢ. L is symmetric and positive semidefinite, so every network is
//! stable, and all its modes are real.
//!
//! Table 2.1 gives resistances in kW/K; the numbers only make sense in K·min/kJ. [`Network::testbed`] has them in K/kW.

mod checks;
mod error;
mod openings;
mod remarks;
mod settings;

use nalgebra::DMatrix;

pub use checks::PowerLimits;
pub use error::{NetworkError, Part, Remark};
use openings::Openings;
pub use openings::Window;
pub use remarks::ModelMismatch;
pub use settings::{AMBIENT, Wall, Zone};

/// A conductance between two nodes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Link {
    /// Index of one node.
    pub from: usize,
    /// Index of the other node.
    pub to: usize,
    /// Heat per kelvin of difference \[kW/K\].
    pub conductance_kw_per_k: f64,
}

/// A validated network. Nodes are numbered: first the zones in the order given, then the walls that store heat.
#[derive(Clone, Debug, PartialEq)]
pub struct Network {
    names: Vec<String>,
    zone_count: usize,
    capacities_kj_per_k: Vec<f64>,
    limits: PowerLimits,
    openings: Openings,
    links: Vec<Link>,
    ambient_kw_per_k: Vec<f64>,
    /// Pairs of zones with a wall between them, the smaller number first, sorted, without repetition.
    adjacent: Vec<(usize, usize)>,
}

impl Network {
    /// The network of `zones` and `walls`.
    ///
    /// Zones without walls, and groups of zones without a wall between them, are allowed; [`Network::remarks`] says so.
    ///
    /// # Errors
    /// [`NetworkError`] if a name is missing, repeated or unknown, if a wall has one place on both sides, or if a
    /// quantity is out of range.
    pub fn new(zones: &[Zone], walls: &[Wall]) -> Result<Self, NetworkError> {
        checks::check_zones(zones)?;
        let mut network = Self {
            names: zones.iter().map(|zone| zone.name.clone()).collect(),
            zone_count: zones.len(),
            capacities_kj_per_k: zones.iter().map(|zone| zone.capacity_kj_per_k).collect(),
            limits: PowerLimits {
                heating_kw: zones.iter().map(|zone| zone.heating_limit_kw.unwrap_or(zone.limit_kw)).collect(),
                cooling_kw: zones.iter().map(|zone| zone.cooling_limit_kw.unwrap_or(zone.limit_kw)).collect(),
            },
            openings: Openings::default(),
            links: Vec::new(),
            ambient_kw_per_k: vec![0.0; zones.len()],
            adjacent: Vec::new(),
        };
        zones.iter().for_each(|zone| network.openings.push(zone.solar_aperture_m2, &zone.windows));
        for (number, (wall, ends)) in walls.iter().zip(checks::check_walls(zones, walls)?).enumerate() {
            network.add(number, wall, ends);
        }
        network.adjacent.sort_unstable();
        network.adjacent.dedup();
        Ok(network)
    }

    /// Adds a checked wall; `None` is the air outside.
    fn add(&mut self, number: usize, wall: &Wall, ends: [Option<usize>; 2]) {
        if let [Some(one), Some(other)] = ends {
            self.adjacent.push((one.min(other), one.max(other)));
        }
        let conductance_kw_per_k = 1.0 / wall.resistance_k_per_kw;
        let Some(capacity_kj_per_k) = wall.capacity_kj_per_k else {
            self.connect(ends[0], ends[1], conductance_kw_per_k);
            return;
        };
        let node = self.capacities_kj_per_k.len();
        self.names.push(checks::wall_name(number, wall));
        self.capacities_kj_per_k.push(capacity_kj_per_k);
        self.ambient_kw_per_k.push(0.0);
        self.openings.push(wall.solar_aperture_m2, &wall.windows);
        let sides = match wall.mass_position {
            None => [2.0, 2.0],
            Some(position) => [1.0 / position, 1.0 / (1.0 - position)],
        };
        for (end, side) in ends.into_iter().zip(sides) {
            self.connect(Some(node), end, side * conductance_kw_per_k);
        }
    }

    fn connect(&mut self, one: Option<usize>, other: Option<usize>, conductance_kw_per_k: f64) {
        match (one, other) {
            (Some(from), Some(to)) => self.links.push(Link { from, to, conductance_kw_per_k }),
            (Some(node), None) | (None, Some(node)) => self.ambient_kw_per_k[node] += conductance_kw_per_k,
            (None, None) => {}
        }
    }

    /// Number of zones.
    pub fn zone_count(&self) -> usize {
        self.zone_count
    }

    /// Number of temperatures: zones and walls that store heat.
    pub fn node_count(&self) -> usize {
        self.capacities_kj_per_k.len()
    }

    /// Number of nodes that receive heat from people, machines or sun: the zones, or all nodes if the sun falls on a
    /// wall that stores heat.
    pub fn gain_count(&self) -> usize {
        if self.openings.any_from(self.zone_count) { self.node_count() } else { self.zone_count }
    }

    /// Names of the nodes.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Index of the zone with this name.
    pub fn zone(&self, name: &str) -> Option<usize> {
        self.names[..self.zone_count].iter().position(|zone| zone == name)
    }

    /// Heat capacity of each node \[kJ/K\].
    pub fn capacities_kj_per_k(&self) -> &[f64] {
        &self.capacities_kj_per_k
    }

    /// The largest heating and cooling power of each zone.
    pub fn limits(&self) -> &PowerLimits {
        &self.limits
    }

    /// Conductances between nodes, in the order of the walls.
    pub fn links(&self) -> &[Link] {
        &self.links
    }

    /// Conductance of each node to the air outside \[kW/K\].
    pub fn ambient_kw_per_k(&self) -> &[f64] {
        &self.ambient_kw_per_k
    }

    /// Pairs of zones with a wall between them, the smaller number first, sorted.
    pub fn adjacent_zones(&self) -> &[(usize, usize)] {
        &self.adjacent
    }

    /// The product L x with the Laplacian, for any x over the nodes: heat that leaves each node when outdoors is at
    /// zero \[kW\].
    ///
    /// # Panics
    /// When `x` has not one number per node.
    pub fn conduct(&self, x: &[f64]) -> Vec<f64> {
        assert_eq!(x.len(), self.node_count(), "one temperature per node");
        let mut out: Vec<f64> = self.ambient_kw_per_k.iter().zip(x).map(|(k, x)| k * x).collect();
        for link in &self.links {
            let heat_kw = link.conductance_kw_per_k * (x[link.from] - x[link.to]);
            out[link.from] += heat_kw;
            out[link.to] -= heat_kw;
        }
        out
    }

    /// The Laplacian L of the network as a matrix \[kW/K\].
    pub fn laplacian(&self) -> DMatrix<f64> {
        let mut laplacian = DMatrix::from_diagonal(&self.ambient_kw_per_k.clone().into());
        for &Link { from, to, conductance_kw_per_k } in &self.links {
            laplacian[(from, from)] += conductance_kw_per_k;
            laplacian[(to, to)] += conductance_kw_per_k;
            laplacian[(from, to)] -= conductance_kw_per_k;
            laplacian[(to, from)] -= conductance_kw_per_k;
        }
        laplacian
    }

    /// Heat flowing into each node, k (T₀ − T) + … + u + w \[kW\]: the right-hand side of eq. 2.15.
    ///
    /// `temperatures_c` has one number per node, `heat_kw` (equipment) one per zone, and `gains_kw` (people, sun, machines) one
    /// for each of the first [`Network::gain_count`] nodes.
    ///
    /// # Panics
    /// When a slice has another length.
    pub(crate) fn net_heat_kw(
        &self,
        temperatures_c: &[f64],
        heat_kw: &[f64],
        ambient_c: f64,
        gains_kw: &[f64],
    ) -> Vec<f64> {
        assert_eq!(heat_kw.len(), self.zone_count, "one heat input per zone");
        assert_eq!(gains_kw.len(), self.gain_count(), "one gain per zone, or per node where the sun falls on walls");
        let mut net_kw = self.conduct(temperatures_c);
        for (net_kw, k) in net_kw.iter_mut().zip(&self.ambient_kw_per_k) {
            *net_kw = k * ambient_c - *net_kw;
        }
        for (zone, (heat_kw, gains_kw)) in heat_kw.iter().zip(gains_kw).enumerate() {
            net_kw[zone] += heat_kw + gains_kw;
        }
        for (net_kw, gain_kw) in net_kw.iter_mut().zip(gains_kw).skip(self.zone_count) {
            *net_kw += gain_kw;
        }
        net_kw
    }
}
