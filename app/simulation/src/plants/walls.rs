//! Estimates the temperatures of unmeasured walls by a model from those of the zones.
//!
//! Walls follow the model, with the zones as measured at every step. Errors of the estimate decay at the rates of the walls between
//! zones of known temperature, so the estimate converges for every network.

use interplay_building::discretise::Model;
use interplay_building::network::Network;

use super::error::PlantError;
use super::interface::{StepInputs, ThermalPlant};
use crate::state::detail::NotCopied;

/// Temperatures of all nodes \[°C\] with the zones at `zones_c` and every wall at rest: the mean of its neighbours (zones and the
/// outdoor air) by their conductances. Walls have no walls as neighbours, so each is a formula.
pub fn at_rest_c(network: &Network, zones_c: &[f64], ambient_c: f64) -> Vec<f64> {
    let zones = zones_c.len();
    let mut conductance_kw_per_k = network.ambient_kw_per_k().to_vec();
    let mut heat_kw: Vec<f64> = conductance_kw_per_k.iter().map(|conductance| conductance * ambient_c).collect();
    for link in network.links() {
        for (node, other) in [(link.from, link.to), (link.to, link.from)] {
            if let (true, Some(other_c)) = (node >= zones, zones_c.get(other)) {
                conductance_kw_per_k[node] += link.conductance_kw_per_k;
                heat_kw[node] += link.conductance_kw_per_k * other_c;
            }
        }
    }
    let walls_c = heat_kw.iter().zip(&conductance_kw_per_k).skip(zones).map(|(heat, conductance)| heat / conductance);
    zones_c.iter().copied().chain(walls_c).collect()
}

/// The thermal network of the scenario as the plant. It never fails.
#[derive(Clone, Debug)]
pub struct NetworkPlant {
    /// The model of the network in steps of time.
    pub model: Model,
    /// Temperature of everything at the first midnight \[°C\].
    pub initial_c: f64,
}

impl ThermalPlant for NetworkPlant {
    fn start(&mut self) -> Result<Vec<f64>, PlantError> {
        Ok(vec![self.initial_c; self.model.network().node_count()])
    }

    fn step(&mut self, inputs: &StepInputs<'_>, nodes_c: &mut [f64]) -> Result<(), PlantError> {
        self.model.step(nodes_c, inputs.heat_kw, inputs.ambient_c, inputs.gains_kw);
        Ok(())
    }

    fn is_foreign(&self) -> bool {
        false
    }

    fn fork(&self) -> Result<Box<dyn ThermalPlant>, NotCopied> {
        Ok(Box::new(self.clone()))
    }
}

#[cfg(test)]
mod tests {
    use interplay_building::network::{Network, Wall, Zone};

    use super::*;

    /// A wall at rest has the temperature of its position between both sides, for any heat capacity.
    #[test]
    fn temperatures_of_walls_at_rest_lie_between_both_sides() {
        let zones = [Zone::named("office"), Zone::named("store")];
        let outer =
            Wall { mass_position: Some(0.25), ..Wall::new("office", "ambient", 6.0).with_capacity_kj_per_k(15_000.0) };
        let inner = Wall::new("office", "store", 40.0).with_capacity_kj_per_k(900.0);
        let network = Network::new(&zones, &[outer, inner]).expect("a network");
        let nodes_c = at_rest_c(&network, &[20.0, 12.0], -4.0);
        let expected_c = [20.0, 12.0, 20.0 + 0.25 * (-4.0 - 20.0), 16.0];
        assert!(nodes_c.iter().zip(expected_c).all(|(a, b)| (a - b).abs() < 1e-12), "{nodes_c:?}");
    }
}
