//! An optimal control problem of stages.

use nalgebra::DMatrix;

use super::dense::{add_product, product};
use crate::discretise::Model;

/// A soft bound on the temperature of a node: `sign · x ≤ bound + s` at the cost `linear s + ½ quadratic s²`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SoftBound {
    /// The node.
    pub node: usize,
    /// 1 for an upper bound, −1 for a lower one.
    pub sign: f64,
    /// The bound \[°C\], times the sign.
    pub bound: f64,
    /// Cost of a kelvin beyond it.
    pub linear: f64,
    /// Twice the cost of a squared kelvin beyond it.
    pub quadratic: f64,
}

/// A stage: inputs that are held for some steps, and the temperatures at its end.
#[derive(Clone, Debug, PartialEq)]
pub struct PlanStage {
    /// Index of its map among [`StagedProgram::maps`].
    pub map: usize,
    /// What weather and gains add to the temperatures \[K\], of each node.
    pub drift_k: Vec<f64>,
    /// Least value of each input \[kW\].
    pub lower: Vec<f64>,
    /// Largest value of each input \[kW\]; above the least one.
    pub upper: Vec<f64>,
    /// Cost of a unit of each input.
    pub linear: Vec<f64>,
    /// Twice the cost of a squared unit of each input.
    pub quadratic: Vec<f64>,
    /// Costs of the temperatures at the end: node, linear cost, twice the quadratic one.
    pub nodes: Vec<(usize, f64, f64)>,
    /// Soft bounds of the temperatures at the end.
    pub soft: Vec<SoftBound>,
    /// Power that a unit of each input takes \[kW\]; empty without a peak.
    pub power: Vec<f64>,
}

/// The highest power over all stages, which has a price.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peak {
    /// Cost of a kilowatt.
    pub price: f64,
    /// The least value: a peak that has been reached before \[kW\].
    pub least_kw: f64,
}

/// An optimal control problem of stages.
#[derive(Clone, Debug)]
pub struct StagedProgram {
    /// Maps of the stages.
    pub maps: Vec<StageMap>,
    /// The inputs, the same in all stages.
    pub inputs: Vec<HeatInput>,
    /// Temperatures at the start \[°C\], of each node.
    pub initial_c: Vec<f64>,
    /// The stages.
    pub stages: Vec<PlanStage>,
    /// The peak, where it has a price.
    pub peak: Option<Peak>,
}

/// An optimal solution.
#[derive(Clone, Debug, PartialEq)]
pub struct StagedSolution {
    /// Inputs, stage by stage \[kW\].
    pub inputs: Vec<f64>,
    /// Temperatures at the ends of the stages \[°C\], stage by stage.
    pub states_c: Vec<f64>,
    /// How far each soft bound is exceeded \[K\], in the order of the stages.
    pub slack_k: Vec<f64>,
    /// The peak \[kW\]; 0 without one.
    pub peak_kw: f64,
    /// By how much the cost rises with the temperature of each node at the start \[1/K\]: the multipliers of the initial state.
    pub initial_value: Vec<f64>,
    /// The cost.
    pub objective: f64,
    /// By how much the cost can be above the least one, as the duality gap says.
    pub gap: f64,
    /// Number of iterations.
    pub iterations: u32,
}

/// Why a problem has no solution.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StagedError {
    /// A number of the problem is not finite, or an upper limit is not above the lower one.
    #[error("the problem of stage {stage} holds a number that is not finite, or limits that leave no room")]
    Malformed {
        /// The stage, from zero.
        stage: usize,
    },
    /// The limit of iterations was reached, or rounding errors prevent progress.
    #[error("the plan was not found within {iterations} iterations: its cost is still uncertain by {gap:.3e}")]
    Unsolved {
        /// Number of iterations.
        iterations: u32,
        /// The duality gap that was reached.
        gap: f64,
    },
}

impl StagedProgram {
    /// The cost of inputs, with the least slack and peak that they allow.
    ///
    /// # Panics
    /// When there are not as many inputs as in the stages.
    pub fn evaluate(&self, inputs: &[f64]) -> f64 {
        let m = self.inputs.len();
        let states_c = self.states(inputs);
        let mut cost = 0.0;
        let mut peak_kw = self.peak.map_or(0.0, |peak| peak.least_kw);
        for (t, (stage, x)) in self.stages.iter().zip(states_c.chunks_exact(self.initial_c.len())).enumerate() {
            let v = &inputs[t * m..(t + 1) * m];
            for (j, v) in v.iter().enumerate() {
                cost += stage.linear[j] * v + 0.5 * stage.quadratic[j] * v * v;
            }
            cost += stage.nodes.iter().map(|(i, g, q)| g * x[*i] + 0.5 * q * x[*i] * x[*i]).sum::<f64>();
            for soft in &stage.soft {
                let slack_k = (soft.sign * x[soft.node] - soft.bound).max(0.0);
                cost += soft.linear * slack_k + 0.5 * soft.quadratic * slack_k * slack_k;
            }
            peak_kw = peak_kw.max(stage.power.iter().zip(v).map(|(power, v)| power * v).sum());
        }
        cost + self.peak.map_or(0.0, |peak| peak.price * peak_kw)
    }

    /// Temperatures at the ends of the stages under these inputs \[°C\].
    ///
    /// # Panics
    /// When there are not as many inputs as in the stages.
    pub fn states(&self, inputs: &[f64]) -> Vec<f64> {
        let m = self.inputs.len();
        let mut x = self.initial_c.clone();
        let mut states_c = Vec::with_capacity(self.stages.len() * x.len());
        for (t, stage) in self.stages.iter().enumerate() {
            x = self.maps[stage.map].advance(&self.inputs, &x, &inputs[t * m..(t + 1) * m]);
            x.iter_mut().zip(&stage.drift_k).for_each(|(x, drift)| *x += drift);
            states_c.extend_from_slice(&x);
        }
        states_c
    }

    pub(super) fn check(&self) -> Result<(), StagedError> {
        let finite = |series: &[f64]| series.iter().all(|value| value.is_finite());
        if !finite(&self.initial_c) {
            return Err(StagedError::Malformed { stage: 0 });
        }
        for (stage, described) in self.stages.iter().enumerate() {
            let PlanStage { drift_k, lower, upper, linear, quadratic, power, soft, .. } = described;
            let series = [drift_k, lower, upper, linear, quadratic, power];
            let room = lower.iter().zip(upper).all(|(lower, upper)| lower < upper);
            let soft = soft.iter().all(|soft| (soft.bound + soft.linear + soft.quadratic).is_finite());
            if !(series.iter().all(|series| finite(series)) && room && soft) {
                return Err(StagedError::Malformed { stage });
            }
        }
        Ok(())
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
