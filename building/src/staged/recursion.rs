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
use super::program::{StageMap, StagedProgram};

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
