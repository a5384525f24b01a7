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
