//! The Riccati recursion: the Newton system of a problem of stages.
//!
//! ```text
//! minimise    Σ_t fₜᵀΔv + ½ Δvᵀ(diag Eₜ + θₜ κκᵀ)Δv + hₜᵀΔx⁺ + ½ Δx⁺ᵀ diag(Dₜ) Δx⁺       subject to  Δx⁺ = A Δx + B Δv
//! P ← D + AᵀPA − YᵀY,    Y = L_R⁻¹ BᵀPA,    L_R L_Rᵀ = E + θκκᵀ + BᵀPB
//! ```
//!
//! With `A = I − B L`, `F = P B` and `H = B F`, the products are `AᵀPA = P − F L − (F L)ᵀ + L H L` and `BᵀPA = Fᵀ − H L`. Products
//! with L are sparse, so `F` and `H` are the only dense ones of nodes by nodes.

use nalgebra::DMatrix;

use super::dense::{
    add_product, cholesky, product, solve_lower, solve_lower_transposed, solve_right, subtract_square,
    symmetric_product, transposed_product,
};
use super::program::StagedProgram;
use crate::discretise::Model;

#[derive(Debug)]
pub(super) struct Curvature {
    /// E, inputs stage by stage.
    pub inputs: Vec<f64>,
    /// D of the temperatures at the ends of stages, stage by stage.
    pub nodes: Vec<f64>,
    /// θ of each stage; empty without a peak.
    pub power: Vec<f64>,
}

#[derive(Debug)]
struct StageFactor {
    /// `L_R`, inputs by inputs.
    lower: DMatrix<f64>,
    /// Yᵀ, nodes by inputs.
    y: DMatrix<f64>,
}

#[derive(Debug)]
pub(super) struct Recursion<'a> {
    program: &'a StagedProgram,
    factors: Vec<StageFactor>,
}

impl<'a> Recursion<'a> {
    /// Factors the system; `None` if rounding errors make it indefinite.
    pub fn factor(program: &'a StagedProgram, curvature: &Curvature) -> Option<Self> {
        let (n, m) = (program.initial_c.len(), program.inputs.len());
        let mut factors = Vec::with_capacity(program.stages.len());
        let mut p = DMatrix::zeros(n, n);
        for (t, stage) in program.stages.iter().enumerate().rev() {
            for i in 0..n {
                p[(i, i)] += curvature.nodes[t * n + i];
            }
            let map = &program.maps[stage.map];
            let f = product(&p, &map.gain);
            let h = symmetric_product(&map.gain, &f);
            let mut r = DMatrix::zeros(m, m);
            for (k, second) in program.inputs.iter().enumerate() {
                for (j, first) in program.inputs.iter().enumerate() {
                    r[(j, k)] = first.sign * second.sign * h[(first.zone, second.zone)];
                }
                r[(k, k)] += curvature.inputs[t * m + k];
            }
            if let Some(theta) = curvature.power.get(t) {
                for k in 0..m {
                    for j in 0..m {
                        r[(j, k)] += theta * stage.power[j] * stage.power[k];
                    }
                }
            }
            let lower = cholesky(r)?;
            let mut y = DMatrix::zeros(n, m);
            for (j, input) in program.inputs.iter().enumerate() {
                let conducted = map.conduct(&h.as_slice()[input.zone * n..(input.zone + 1) * n]);
                for i in 0..n {
                    y[(i, j)] = input.sign * (f[(i, input.zone)] - conducted[i]);
                }
            }
            solve_right(&lower, &mut y);
            if t > 0 {
                propagate(&mut p, map, &f, &h);
                subtract_square(&mut p, &y);
            }
            factors.push(StageFactor { lower, y });
        }
        factors.reverse();
        Some(Self { program, factors })
    }

    /// The directions Δv and Δx for the gradients f and h, stage by stage.
    pub fn solve(&self, f: &[f64], h: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let Self { program, factors } = self;
        let (n, m, steps) = (program.initial_c.len(), program.inputs.len(), program.stages.len());
        let mut y = vec![0.0; steps * m];
        let mut p = vec![0.0; n];
        for (t, stage) in program.stages.iter().enumerate().rev() {
            p.iter_mut().zip(&h[t * n..(t + 1) * n]).for_each(|(p, h)| *p += h);
            let (back, driven) = program.maps[stage.map].transposed(&program.inputs, &p);
            let y = &mut y[t * m..(t + 1) * m];
            for (j, y) in y.iter_mut().enumerate() {
                *y = driven[j] + f[t * m + j];
            }
            solve_lower(&factors[t].lower, y);
            p = back;
            add_product(&factors[t].y, y, -1.0, &mut p);
        }
        let mut x = vec![0.0; n];
        let (mut inputs, mut states) = (Vec::with_capacity(steps * m), Vec::with_capacity(steps * n));
        for (t, stage) in program.stages.iter().enumerate() {
            let mut v = transposed_product(&factors[t].y, &x);
            v.iter_mut().zip(&y[t * m..(t + 1) * m]).for_each(|(v, y)| *v = -(*v + y));
            solve_lower_transposed(&factors[t].lower, &mut v);
            x = program.maps[stage.map].advance(&program.inputs, &x, &v);
            inputs.extend_from_slice(&v);
            states.extend_from_slice(&x);
        }
        (inputs, states)
    }
}

/// AᵀPA in place of P.
fn propagate(p: &mut DMatrix<f64>, map: &StageMap, f: &DMatrix<f64>, h: &DMatrix<f64>) {
    let n = p.nrows();
    // F L and H L, by columns.
    let by_laplacian = |dense: &DMatrix<f64>, j: usize| -> Vec<f64> {
        let mut column = vec![0.0; n];
        for (k, value) in &map.laplacian[j] {
            let source = &dense.as_slice()[k * n..(k + 1) * n];
            column.iter_mut().zip(source).for_each(|(target, source)| *target += value * source);
        }
        column
    };
    for j in 0..n {
        let outer = by_laplacian(f, j);
        let inner = map.conduct(&by_laplacian(h, j));
        for i in 0..n {
            p[(i, j)] += inner[i] - outer[i];
            p[(j, i)] -= outer[i];
        }
    }
}

/// One input: equipment that heats a zone, or cools it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeatInput {
    /// The zone.
    pub zone: usize,
    /// Heat that a unit of the input brings into the zone: 1, or −1 where it cools.
    pub sign: f64,
}

/// How temperatures move over a stage: `x⁺ = x + B (M v − L x) + d`, where M brings inputs into their zones.
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
        // B of k steps is that of one, and what k − 1 steps have left of B.
        let mut gain = one.clone();
        for _ in 1..span {
            let mut conducted = DMatrix::zeros(nodes, nodes);
            for j in 0..nodes {
                let column = conduct(&laplacian, &gain.as_slice()[j * nodes..(j + 1) * nodes]);
                conducted.column_mut(j).copy_from_slice(&column);
            }
            gain += &one - product(&one, &conducted);
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
        add_product(&self.gain, &net_kw, 1.0, &mut next);
        next
    }

    /// Aᵀ y and Mᵀ Bᵀ y.
    pub(super) fn transposed(&self, inputs: &[HeatInput], y: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let mut gained = vec![0.0; y.len()];
        add_product(&self.gain, y, 1.0, &mut gained);
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
