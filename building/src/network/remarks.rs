//! Remarks on allowed properties of a network that may be mistakes.

use interplay_common::setting;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::error::Remark;
use super::{Network, NetworkError};

/// A zone that settles faster than this is remarked upon \[s\].
const FAST_S: f64 = 600.0;
/// A zone that settles more slowly than this is remarked upon \[s\].
const SLOW_S: f64 = 90.0 * 86_400.0;

impl Network {
    /// Remarks on allowed properties that may be mistakes: separate groups, heat that cannot leave, implausible time constants.
    pub fn remarks(&self) -> Vec<Remark> {
        let groups = self.groups();
        let named = |group: &[usize]| {
            group.iter().filter(|&&node| node < self.zone_count).map(|&node| self.names[node].clone()).collect()
        };
        let mut remarks = Vec::new();
        if groups.len() > 1 {
            remarks.push(Remark::Apart { groups: groups.iter().map(|group| named(group)).collect() });
        }
        let closed = groups.iter().filter(|group| group.iter().all(|&node| self.ambient_kw_per_k[node] == 0.0));
        let closed: Vec<String> = closed.flat_map(|group| -> Vec<String> { named(group) }).collect();
        if !closed.is_empty() {
            remarks.push(Remark::NoWayOut { zones: closed });
        }
        let time_constants = self.node_time_constants_s();
        for (zone, &time_constant_s) in self.names[..self.zone_count].iter().zip(&time_constants) {
            let zone = zone.clone();
            if time_constant_s < FAST_S {
                remarks.push(Remark::Fast { zone, time_constant_s });
            } else if time_constant_s > SLOW_S && time_constant_s.is_finite() {
                remarks.push(Remark::Slow { zone, time_constant_s });
            }
        }
        remarks
    }

    /// Capacity over total conductance of each node \[s\]; infinite for an isolated node.
    pub(crate) fn node_time_constants_s(&self) -> Vec<f64> {
        let mut conductance_kw_per_k = self.ambient_kw_per_k.clone();
        for link in &self.links {
            conductance_kw_per_k[link.from] += link.conductance_kw_per_k;
            conductance_kw_per_k[link.to] += link.conductance_kw_per_k;
        }
        self.capacities_kj_per_k.iter().zip(&conductance_kw_per_k).map(|(c, k)| c / k).collect()
    }

    /// Nodes that exchange heat with one another, directly or not; groups and nodes in the order of the network.
    fn groups(&self) -> Vec<Vec<usize>> {
        let mut leader: Vec<usize> = (0..self.node_count()).collect();
        fn find(leader: &mut [usize], mut node: usize) -> usize {
            while leader[node] != node {
                leader[node] = leader[leader[node]];
                node = leader[node];
            }
            node
        }
        for link in &self.links {
            let (one, other) = (find(&mut leader, link.from), find(&mut leader, link.to));
            leader[one.max(other)] = one.min(other);
        }
        let mut groups: Vec<Vec<usize>> = vec![Vec::new(); self.node_count()];
        for node in 0..self.node_count() {
            let first = find(&mut leader, node);
            groups[first].push(node);
        }
        groups.retain(|group| !group.is_empty());
        groups
    }
}

/// The factors by which a controller's model of a building is wrong. With all factors 1 it is right.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ModelMismatch {
    /// Believed heat capacities, as multiples of the real ones.
    #[schemars(range(min = 0.1, max = 10), extend("x-unit" = "dimensionless"))]
    pub capacity_factor: f64,
    /// Believed resistances between zones, as multiples of the real ones.
    #[schemars(range(min = 0.1, max = 10), extend("x-unit" = "dimensionless"))]
    pub inner_resistance_factor: f64,
    /// Believed resistances to the air outside, as multiples of the real ones.
    #[schemars(range(min = 0.1, max = 10), extend("x-unit" = "dimensionless"))]
    pub outer_resistance_factor: f64,
}

impl Default for ModelMismatch {
    fn default() -> Self {
        Self { capacity_factor: 1.0, inner_resistance_factor: 1.0, outer_resistance_factor: 1.0 }
    }
}

impl Network {
    /// The network of a model with this mismatch.
    ///
    /// # Errors
    /// [`NetworkError::Believed`] if a factor is out of range.
    pub fn believed(&self, mismatch: &ModelMismatch) -> Result<Network, NetworkError> {
        let ModelMismatch { capacity_factor, inner_resistance_factor, outer_resistance_factor } = *mismatch;
        setting::check(mismatch).map_err(NetworkError::Believed)?;
        let mut network = self.clone();
        network.capacities_kj_per_k.iter_mut().for_each(|capacity| *capacity *= capacity_factor);
        network.links.iter_mut().for_each(|link| link.conductance_kw_per_k /= inner_resistance_factor);
        network.ambient_kw_per_k.iter_mut().for_each(|conductance| *conductance /= outer_resistance_factor);
        Ok(network)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_mismatch_factor_scales_the_quantity_that_it_names() {
        let real = Network::testbed();
        assert_eq!(real.believed(&ModelMismatch::default()).expect("right"), real);
        let mismatch =
            ModelMismatch { capacity_factor: 2.0, inner_resistance_factor: 4.0, outer_resistance_factor: 0.5 };
        let believed = real.believed(&mismatch).expect("valid");
        assert_eq!(believed.capacities_kj_per_k(), [2000.0; 4]);
        assert_eq!(believed.links()[0].conductance_kw_per_k, 0.25 / 62.5);
        assert_eq!(believed.ambient_kw_per_k(), [2.0 / 31.25; 4]);
        let error = real.believed(&ModelMismatch { capacity_factor: 0.0, ..mismatch }).expect_err("nothing");
        assert!(error.to_string().contains("capacity_factor"), "{error}");
    }
}
