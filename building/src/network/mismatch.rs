//! The mismatch between a building and a controller's model of it.

use interplay_common::setting;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Network, NetworkError};

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
