//! The inequalities of a stage problem: boxes, then hard rows, then soft rows, then the rows over whole trajectories.

use crate::mpc::Penalty;
use crate::mpc::stage::{RowBlock, StageQp};

/// Values over states and inputs of all vehicles, indexed `k * M + vehicle`.
#[derive(Clone, Debug, Default)]
pub(super) struct Point {
    /// `(x, y, θ, v)` after stage `k`.
    pub states: Vec<[f64; 4]>,
    /// `(a, δ)` at stage `k`.
    pub inputs: Vec<[f64; 2]>,
}

impl Point {
    pub(super) fn clear(&mut self, count: usize) {
        self.states.clear();
        self.states.resize(count, [0.0; 4]);
        self.inputs.clear();
        self.inputs.resize(count, [0.0; 2]);
    }

    pub(super) fn add(&mut self, share: f64, step: &Point) {
        for (value, step) in self.states.iter_mut().flatten().zip(step.states.iter().flatten()) {
            *value += share * step;
        }
        for (value, step) in self.inputs.iter_mut().flatten().zip(step.inputs.iter().flatten()) {
            *value += share * step;
        }
    }
}

/// The six boxes of one vehicle at one stage: lower and upper bound of acceleration, steering and speed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Boxes {
    /// Index into a [`Point`].
    pub at: usize,
    /// `value`: how far the iterate is inside.
    pub room: [f64; 6],
}

/// Number of inequalities in [`Boxes`].
pub(super) const BOXES: usize = 6;

/// One row `c + g·p + σ ≥ 0`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Inequality {
    /// Whose pose, as an index into a [`Point`].
    pub at: usize,
    /// For a pair, whose position is subtracted.
    pub other: Option<usize>,
    /// `g` over `(x, y, θ)`.
    pub gradient: [f64; 3],
    /// `c`.
    pub value: f64,
}

impl Inequality {
    /// `g·p`.
    #[inline(always)]
    pub(super) fn slope(&self, states: &[[f64; 4]]) -> f64 {
        let [x, y, turn] = self.gradient;
        let own = &states[self.at];
        let slope = x * own[0] + y * own[1] + turn * own[2];
        match self.other {
            None => slope,
            Some(other) => slope - x * states[other][0] - y * states[other][1],
        }
    }

    /// Adds `weight · g` to the gradients of states.
    #[inline(always)]
    pub(super) fn pull(&self, weight: f64, states: &mut [[f64; 4]]) {
        for axis in 0..3 {
            states[self.at][axis] += weight * self.gradient[axis];
        }
        if let Some(other) = self.other {
            for axis in 0..2 {
                states[other][axis] -= weight * self.gradient[axis];
            }
        }
    }
}

/// All inequalities of a problem but those over whole trajectories.
#[derive(Clone, Debug, Default)]
pub(super) struct Inequalities {
    pub boxes: Vec<Boxes>,
    /// Hard rows first.
    pub rows: Vec<Inequality>,
    /// Weights `(ℓ, q)` of the soft rows, which are the last of `rows`, and of the rows over whole trajectories.
    pub weights: Vec<[f64; 2]>,
}

impl Inequalities {
    /// Lists the inequalities of a problem. Rows whose violation costs nothing are left out.
    pub(super) fn fill(&mut self, qp: &StageQp) {
        let vehicles = qp.vehicles.len();
        self.boxes.clear();
        for (i, stages) in qp.vehicles.iter().enumerate() {
            for k in stages.first..qp.horizon {
                let [[a, d], v] = [stages.input_boxes[k], [stages.speed_boxes[k]; 2]];
                let room = [-a.lower, a.upper, -d.lower, d.upper, -v[0].lower, v[0].upper];
                self.boxes.push(Boxes { at: k * vehicles + i, room });
            }
        }
        self.rows.clear();
        self.weights.clear();
        for block in listed(qp, false) {
            self.push(block, vehicles);
        }
        for block in listed(qp, true) {
            let before = self.rows.len();
            self.push(block, vehicles);
            let added = self.rows.len() - before;
            self.weights.extend(block.penalty.map(weights).into_iter().cycle().take(added));
        }
        self.weights.extend(qp.trajectory_rows.iter().map(|row| weights(row.penalty)));
    }

    fn push(&mut self, block: &RowBlock, vehicles: usize) {
        let active = block.rows.iter().enumerate().filter(|(_, row)| row.active);
        self.rows.extend(active.map(|(k, row)| Inequality {
            at: k * vehicles + block.vehicle,
            other: block.other.map(|other| k * vehicles + other),
            gradient: row.gradient,
            value: row.value,
        }));
    }
}

/// The blocks that are listed, hard or soft.
fn listed(qp: &StageQp, soft: bool) -> impl Iterator<Item = &RowBlock> {
    qp.blocks.iter().filter(move |block| block.penalty.is_some() == soft && block.costs_something())
}

/// `ℓ` and `q` of a violation's cost.
fn weights(penalty: Penalty) -> [f64; 2] {
    [penalty.linear, 2.0 * penalty.quadratic]
}
