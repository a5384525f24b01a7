//! The inequalities of a stage problem in one list: boxes first, then the active rows.

use crate::mpc::Penalty;
use crate::mpc::stage::{RowBlock, StageQp};

/// What an inequality `value + gradient·z + σ ≥ 0` speaks of.
#[derive(Clone, Copy, Debug)]
pub(super) enum Subject {
    /// One of the two inputs `w_k` (`axis` 0 or 1) or the speed of `d_{k+1}` (`axis` 2), with the sign of its gradient.
    Box { at: usize, axis: usize, sign: f64 },
    /// The pose of a vehicle after stage `k`.
    Pose { at: usize, gradient: [f64; 3] },
    /// The difference of the positions of two vehicles after stage `k`.
    Pair { at: usize, other: usize, gradient: [f64; 2] },
    /// The whole trajectory of vehicle 0, whose positions stand `stride` apart; the gradient changes with the point.
    Trajectory { stride: usize },
}

/// One inequality. `at` and `other` index stage and vehicle as `k * M + vehicle`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Inequality {
    pub subject: Subject,
    pub value: f64,
    /// Linear weight `ℓ` and curvature `q` of the violation's cost; `None` for a hard row.
    pub soft: Option<[f64; 2]>,
}

impl Inequality {
    /// `gradient·z` at the given deviations; `along` is the gradient `v` of the row over the whole trajectory.
    #[inline(always)]
    pub(super) fn slope(&self, states: &[[f64; 4]], inputs: &[[f64; 2]], along: &[[f64; 2]]) -> f64 {
        match self.subject {
            Subject::Box { at, axis: 2, sign } => sign * states[at][3],
            Subject::Box { at, axis, sign } => sign * inputs[at][axis],
            Subject::Pose { at, gradient: g } => {
                let d = &states[at];
                g[0] * d[0] + g[1] * d[1] + g[2] * d[2]
            }
            Subject::Pair { at, other, gradient: g } => {
                g[0] * (states[at][0] - states[other][0]) + g[1] * (states[at][1] - states[other][1])
            }
            Subject::Trajectory { stride } => {
                let terms = along.iter().enumerate().map(|(k, v)| (v, &states[k * stride]));
                -terms.map(|(v, d)| v[0] * d[0] + v[1] * d[1]).sum::<f64>()
            }
        }
    }

    /// Adds `weight · gradient` to the gradients of states and inputs.
    #[inline(always)]
    pub(super) fn pull(&self, weight: f64, states: &mut [[f64; 4]], inputs: &mut [[f64; 2]], along: &[[f64; 2]]) {
        match self.subject {
            Subject::Box { at, axis: 2, sign } => states[at][3] += weight * sign,
            Subject::Box { at, axis, sign } => inputs[at][axis] += weight * sign,
            Subject::Pose { at, gradient } => {
                for axis in 0..3 {
                    states[at][axis] += weight * gradient[axis];
                }
            }
            Subject::Pair { at, other, gradient } => {
                for axis in 0..2 {
                    states[at][axis] += weight * gradient[axis];
                    states[other][axis] -= weight * gradient[axis];
                }
            }
            Subject::Trajectory { stride } => {
                for (k, v) in along.iter().enumerate() {
                    states[k * stride][0] -= weight * v[0];
                    states[k * stride][1] -= weight * v[1];
                }
            }
        }
    }
}

/// Lists the inequalities of a problem: for every vehicle and free stage the lower and upper bounds of acceleration,
/// steering and speed, then the active rows block by block, then the row over the whole trajectory.
///
/// Rows whose violation costs nothing are left out.
pub(super) fn list(qp: &StageQp, inequalities: &mut Vec<Inequality>) {
    inequalities.clear();
    let vehicles = qp.vehicles.len();
    for (i, stages) in qp.vehicles.iter().enumerate() {
        for k in stages.first..qp.horizon {
            let at = k * vehicles + i;
            let [acceleration, steering] = stages.input_boxes[k];
            for (axis, interval) in [acceleration, steering, stages.speed_boxes[k]].into_iter().enumerate() {
                for (sign, value) in [(1.0, -interval.lower), (-1.0, interval.upper)] {
                    inequalities.push(Inequality { subject: Subject::Box { at, axis, sign }, value, soft: None });
                }
            }
        }
    }
    for block in &qp.blocks {
        if !block.costs_something() {
            continue;
        }
        let soft = block.penalty.map(weights);
        for (k, row) in block.rows.iter().enumerate().filter(|(_, row)| row.active) {
            let subject = subject(block, k, vehicles, row.gradient);
            inequalities.push(Inequality { subject, value: row.value, soft });
        }
    }
    if let Some(row) = &qp.trajectory_row {
        let (subject, soft) = (Subject::Trajectory { stride: vehicles }, Some(weights(row.penalty)));
        inequalities.push(Inequality { subject, value: -row.value, soft });
    }
}

/// `ℓ` and `q` of a violation's cost.
fn weights(penalty: Penalty) -> [f64; 2] {
    [penalty.linear, 2.0 * penalty.quadratic]
}

fn subject(block: &RowBlock, k: usize, vehicles: usize, gradient: [f64; 3]) -> Subject {
    let at = k * vehicles + block.vehicle;
    match block.other {
        None => Subject::Pose { at, gradient },
        Some(other) => Subject::Pair { at, other: k * vehicles + other, gradient: [gradient[0], gradient[1]] },
    }
}
