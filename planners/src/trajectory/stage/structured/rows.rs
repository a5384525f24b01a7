//! The inequalities of a stage problem: bounds, then hard rows, then soft rows, then the rows over whole trajectories.

use crate::trajectory::penalty::Penalty;
use crate::trajectory::stage::qp::{Reach, StageQp};
use crate::trajectory::stage::solution::{ACTIVE_MULTIPLIER, StageSolution};

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
        let go = |values: &mut [f64], steps: &[f64]| {
            for (value, step) in values.iter_mut().zip(steps) {
                *value += share * step;
            }
        };
        go(self.states.as_flattened_mut(), step.states.as_flattened());
        go(self.inputs.as_flattened_mut(), step.inputs.as_flattened());
    }
}

/// One bound of a box: `room + sign · quantity ≥ 0`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bound {
    /// Whose, as an index into a [`Point`].
    pub at: usize,
    /// Of which quantity: acceleration, steering or speed.
    pub quantity: usize,
    /// 1 for a lower bound, −1 for an upper one.
    pub sign: f64,
    /// How far the iterate is inside.
    pub room: f64,
}

impl Bound {
    /// `g·z`.
    #[inline(always)]
    pub(super) fn slope(&self, point: &Point) -> f64 {
        let ([a, d], v) = (point.inputs[self.at], point.states[self.at][3]);
        self.sign * [a, d, v][self.quantity]
    }

    /// Adds `weight · g` to a gradient.
    #[inline(always)]
    pub(super) fn add_gradient(&self, weight: f64, gradient: &mut Point) {
        let pull = self.sign * weight;
        match self.quantity {
            2 => gradient.states[self.at][3] += pull,
            axis => gradient.inputs[self.at][axis] += pull,
        }
    }
}

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
    /// Which block it belongs to.
    pub block: usize,
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
    pub(super) fn add_gradient(&self, weight: f64, states: &mut [[f64; 4]]) {
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

/// All inequalities of a problem but those over whole trajectories: those that are solved with, and those so far away that
/// they are left out and only checked in the end.
#[derive(Clone, Debug, Default)]
pub(super) struct Inequalities {
    pub bounds: Vec<Bound>,
    /// Hard rows first.
    pub rows: Vec<Inequality>,
    /// Weights `(ℓ, q)` of the soft rows, which are the last of `rows`, and of the rows over whole trajectories.
    pub weights: Vec<[f64; 2]>,
    /// Multipliers of a neighbouring problem, in the order of bounds, rows and rows over whole trajectories.
    pub multipliers: Vec<f64>,
    far_bounds: Vec<Bound>,
    far_rows: Vec<Inequality>,
}

impl Inequalities {
    /// Lists the inequalities of a problem. Rows whose violation costs nothing are left out, and with a `reach` those that
    /// no deviation within it touches and that did not matter in the neighbouring problem whose multipliers `known` holds.
    pub(super) fn fill(&mut self, qp: &StageQp, known: &StageSolution, reach: Option<&Reach>) {
        self.bounds.clear();
        self.rows.clear();
        self.weights.clear();
        self.multipliers.clear();
        self.far_bounds.clear();
        self.far_rows.clear();
        for vehicle in 0..qp.vehicles.len() {
            self.list_bounds(qp, vehicle, known, reach);
        }
        for soft in [false, true] {
            for (index, block) in qp.blocks.iter().enumerate() {
                if block.penalty.is_some() == soft && block.costs_something() {
                    self.list_rows(qp, index, known, reach);
                }
            }
        }
        self.weights.extend(qp.trajectory_rows.iter().map(|row| weights(row.penalty)));
        self.multipliers.extend(&known.trajectory_multipliers);
    }

    fn list_bounds(&mut self, qp: &StageQp, vehicle: usize, known: &StageSolution, reach: Option<&Reach>) {
        let stages = &qp.vehicles[vehicle];
        for k in stages.first..qp.horizon {
            let [[a, d], v] = [stages.input_boxes[k], [stages.speed_boxes[k]; 2]];
            for (quantity, interval) in [a, d, v[0]].into_iter().enumerate() {
                let known = known.bound_multipliers[vehicle][k][quantity];
                let sides = [(1.0, -interval.lower), (-1.0, interval.upper)];
                for ((sign, room), multiplier) in sides.into_iter().zip(known) {
                    let bound = Bound { at: k * qp.vehicles.len() + vehicle, quantity, sign, room };
                    if multiplier > ACTIVE_MULTIPLIER || reach.is_none_or(|reach| room <= reach.of_bound(quantity)) {
                        self.bounds.push(bound);
                        self.multipliers.push(multiplier);
                    } else {
                        self.far_bounds.push(bound);
                    }
                }
            }
        }
    }

    fn list_rows(&mut self, qp: &StageQp, index: usize, known: &StageSolution, reach: Option<&Reach>) {
        let (block, vehicles) = (&qp.blocks[index], qp.vehicles.len());
        let rows = block.rows.iter().zip(&known.row_multipliers[index]).enumerate();
        for (k, (row, multiplier)) in rows.filter(|(_, (row, _))| row.active) {
            let other = block.other.map(|other| k * vehicles + other);
            let at = k * vehicles + block.vehicle;
            let row = Inequality { at, other, gradient: row.gradient, value: row.value, block: index };
            if *multiplier > ACTIVE_MULTIPLIER || reach.is_none_or(|reach| row.value <= reach.of_row(&row)) {
                self.rows.push(row);
                self.weights.extend(block.penalty.map(weights));
                self.multipliers.push(*multiplier);
            } else {
                self.far_rows.push(row);
            }
        }
    }

    /// Whether a point satisfies everything that was left out, so that it is the optimum with it too.
    pub(super) fn excluded_rows_hold(&self, point: &Point) -> bool {
        self.far_bounds.iter().all(|bound| bound.room + bound.slope(point) >= 0.0)
            && self.far_rows.iter().all(|row| row.value + row.slope(&point.states) >= 0.0)
    }
}

impl Reach {
    fn of_bound(&self, quantity: usize) -> f64 {
        [self.input[0], self.input[1], self.state[3]][quantity]
    }

    fn of_row(&self, row: &Inequality) -> f64 {
        let [x, y, turn] = row.gradient.map(f64::abs);
        let movers = if row.other.is_some() { 2.0 } else { 1.0 };
        movers * (x * self.state[0] + y * self.state[1]) + turn * self.state[2]
    }
}

/// `ℓ` and `q` of a violation's cost.
fn weights(penalty: Penalty) -> [f64; 2] {
    [penalty.linear, 2.0 * penalty.quadratic]
}
