//! The temperatures of walls that nobody measures, estimated by a model from those of the zones.
//!
//! Walls follow the model, with the zones as measured at every step. Their errors decay at the rates of the walls between
//! zones of known temperature, so the estimate converges for every network.

use interplay_building::discretise::Model;

/// How long the walls are given to come to rest before the first midnight \[s\]: 100 days.
const SETTLING_S: f64 = 100.0 * 86_400.0;

/// Temperatures of all nodes \[°C\] with the zones at `zones_c` and the walls at rest between them and the outdoor air.
pub fn at_rest_c(model: &Model, zones_c: &[f64], ambient_c: f64) -> Vec<f64> {
    let (zones, nodes) = (zones_c.len(), model.network().node_count());
    let mut nodes_c = vec![ambient_c; nodes];
    nodes_c[..zones].copy_from_slice(zones_c);
    if nodes == zones {
        return nodes_c;
    }
    let nothing = vec![0.0; zones];
    for _ in 0..(SETTLING_S / model.step_s()).ceil() as usize {
        let before_c = nodes_c[zones..].to_vec();
        model.step(&mut nodes_c, &nothing, ambient_c, &nothing);
        nodes_c[..zones].copy_from_slice(zones_c);
        if before_c.iter().zip(&nodes_c[zones..]).all(|(before, after)| (before - after).abs() < 1e-9) {
            break;
        }
    }
    nodes_c
}

#[cfg(test)]
mod tests {
    use interplay_building::network::{Network, Wall, Zone};

    use super::*;

    /// A wall at rest has the temperature that its place between both sides gives it, whatever its heat capacity.
    #[test]
    fn walls_at_rest_lie_between_both_sides() {
        let zones = [Zone::named("office"), Zone::named("store")];
        let outer =
            Wall { mass_position: Some(0.25), ..Wall::new("office", "ambient", 6.0).with_capacity_kj_per_k(15_000.0) };
        let inner = Wall::new("office", "store", 40.0).with_capacity_kj_per_k(900.0);
        let network = Network::new(&zones, &[outer, inner]).expect("a network");
        for step_s in [900.0, 3600.0] {
            let model = Model::exact(&network, step_s).expect("a model");
            let nodes_c = at_rest_c(&model, &[20.0, 12.0], -4.0);
            let expected_c = [20.0, 12.0, 20.0 + 0.25 * (-4.0 - 20.0), 16.0];
            assert!(nodes_c.iter().zip(expected_c).all(|(a, b)| (a - b).abs() < 1e-6), "{nodes_c:?}");
        }
    }
}
