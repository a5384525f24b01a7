//! The map of temperatures over a stage.

use nalgebra::DMatrix;

use super::dense;
use crate::discretise::Model;

/// One input: equipment that heats a zone, or cools it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeatInput {
    /// The zone.
    pub zone: usize,
    /// Heat that a unit of the input brings into the zone: 1, or −1 where it cools.
    pub sign: f64,
}

/// The change of temperatures over a stage: `x⁺ = x + B (M v − L x) + d`, where M assigns inputs to their zones.
#[derive(Clone, Debug)]
pub struct StageMap {
    /// Steps of the model over which inputs are held.
    pub span: usize,
    /// B over the stage, nodes by nodes \[K/kW\]; symmetric.
    pub(super) gain: DMatrix<f64>,
    /// Columns of the Laplacian, without zeros \[kW/K\].
    pub(super) laplacian: Vec<Vec<(usize, f64)>>,
}

impl StageMap {
    /// The map of a stage of `span` steps of the model.
    pub fn new(model: &Model, span: usize) -> Self {
        let nodes = model.network().node_count();
        let one = model.full_gain();
        let laplacian = model.network().laplacian();
        let laplacian: Vec<Vec<(usize, f64)>> = (0..nodes)
            .map(|j| (0..nodes).map(|i| (i, laplacian[(i, j)])).filter(|(_, value)| *value != 0.0).collect())
            .collect();
        // The gain B of k steps is that of one step, plus the part of B that remains after k − 1 further steps.
        let mut gain = one.clone();
        for _ in 1..span {
            let mut conducted = DMatrix::zeros(nodes, nodes);
            for j in 0..nodes {
                let column = conduct(&laplacian, &gain.as_slice()[j * nodes..(j + 1) * nodes]);
                conducted.column_mut(j).copy_from_slice(&column);
            }
            gain += &one - dense::product(&one, &conducted);
            gain = 0.5 * (&gain + gain.transpose());
        }
        Self { span, gain, laplacian }
    }

    /// L x.
    pub(super) fn conduct(&self, x: &[f64]) -> Vec<f64> {
        conduct(&self.laplacian, x)
    }

    /// A x + B M v.
    pub(super) fn advance(&self, inputs: &[HeatInput], x: &[f64], v: &[f64]) -> Vec<f64> {
        let mut net_kw: Vec<f64> = self.conduct(x).iter().map(|conducted| -conducted).collect();
        for (input, v) in inputs.iter().zip(v) {
            net_kw[input.zone] += input.sign * v;
        }
        let mut next = x.to_vec();
        dense::add_product(&self.gain, &net_kw, 1.0, &mut next);
        next
    }

    /// Aᵀ y and Mᵀ Bᵀ y.
    pub(super) fn transposed(&self, inputs: &[HeatInput], y: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let mut gained = vec![0.0; y.len()];
        dense::add_product(&self.gain, y, 1.0, &mut gained);
        let back = y.iter().zip(self.conduct(&gained)).map(|(y, conducted)| y - conducted).collect();
        (back, inputs.iter().map(|input| input.sign * gained[input.zone]).collect())
    }
}

fn conduct(laplacian: &[Vec<(usize, f64)>], x: &[f64]) -> Vec<f64> {
    let mut conducted = vec![0.0; x.len()];
    for (column, x) in laplacian.iter().zip(x) {
        for (i, value) in column {
            conducted[*i] += value * x;
        }
    }
    conducted
}
