//! The interior-point iteration (see the parent module for the equations).

use super::along::Along;
use super::columns::{Columns, Start, larger};
use super::riccati::{PairHessian, Riccati, VehicleHessian};
use super::rows::{BOXES, Inequalities, Point};
use crate::mpc::adjoint::curvature_gradient;
use crate::mpc::stage::{StageError, StageQp, StageSolution, StageSolver};

/// Tolerance on the dual residual as a share of its start, per tolerance on everything else.
const DUAL_TOLERANCE: f64 = 1e-3;
/// What is accepted where rounding stops the iteration before that.
const ACCEPTED: f64 = 1e-7;
/// Below this complementarity the factorisation has lost digits that matter.
const REFINED_BELOW: f64 = 1e-4;
/// Most iterations.
const ITERATION_LIMIT: usize = 50;
/// A multiplier beyond this with a row still violated means that the rows contradict each other.
const INFEASIBLE_MULTIPLIER: f64 = 1e9;

/// The structured solver of stage problems with one to four vehicles.
#[derive(Clone, Debug, Default)]
pub struct Structured {
    one: Interior<2, 6>,
    two: Interior<4, 12>,
    three: Interior<6, 18>,
    four: Interior<8, 24>,
}

impl StageSolver for Structured {
    fn accepts_curvature(&self) -> bool {
        true
    }

    fn solve(&mut self, problem: &StageQp, solution: &mut StageSolution, warm: bool) -> Result<(), StageError> {
        match problem.vehicles.len() {
            1 => self.one.solve(problem, solution, warm),
            2 => self.two.solve(problem, solution, warm),
            3 => self.three.solve(problem, solution, warm),
            4 => self.four.solve(problem, solution, warm),
            count => {
                let status = format!("{count} deciding vehicles, at most 4 are supported");
                Err(StageError::Unsolved { status, iterations: 0 })
            }
        }
    }
}

/// The memory of one solver of `W/2` vehicles; nothing is allocated once it has its size.
#[derive(Clone, Debug, Default)]
pub(super) struct Interior<const W: usize, const Z: usize> {
    riccati: Riccati<W, Z>,
    pub(super) inequalities: Inequalities,
    pub(super) columns: Columns,
    pub(super) hessians: Vec<VehicleHessian>,
    pub(super) pairs: Vec<Vec<PairHessian>>,
    /// Where the iteration stands.
    pub(super) point: Point,
    /// Its next step.
    pub(super) step: Point,
    /// What refinement adds to it.
    correction: Point,
    /// Gradient of the smooth cost at the point.
    cost_gradient: Point,
    /// The same with the rows' pull.
    pub(super) gradient: Point,
    /// The rows over whole trajectories at the point.
    pub(super) along: Vec<Along>,
}

impl<const W: usize, const Z: usize> Interior<W, Z> {
    pub(super) const VEHICLES: usize = W / 2;

    fn solve(&mut self, qp: &StageQp, solution: &mut StageSolution, warm: bool) -> Result<(), StageError> {
        self.inequalities.fill(qp);
        let hard = BOXES * self.inequalities.boxes.len() + self.inequalities.rows.len() - self.soft_rows(qp);
        let same_shape = self.columns.shape(hard, self.inequalities.weights.iter().copied());
        self.along.resize_with(qp.trajectory_rows.len(), Along::default);
        self.along.iter_mut().zip(&qp.trajectory_rows).for_each(|(along, row)| along.shape_like(row));
        let mut iterations = 0;
        let mut outcome = Err(StageError::Unsolved { status: String::new(), iterations });
        if warm && same_shape {
            self.begin(qp, Start::WARM, true);
            outcome = self.iterate(qp, &mut iterations);
        }
        if let Err(StageError::Unsolved { .. }) = outcome {
            self.begin(qp, Start::COLD, false);
            outcome = self.iterate(qp, &mut iterations);
        }
        solution.shape_like(qp);
        solution.iterations = iterations;
        outcome.map_err(|error| match error {
            // Without curvature every problem is convex: it was rounding.
            StageError::NotConvex { stage } if !qp.is_curved() => {
                StageError::Unsolved { status: format!("the factorisation broke down at stage {stage}"), iterations }
            }
            other => other,
        })?;
        self.write(qp, solution);
        Ok(())
    }

    fn soft_rows(&self, qp: &StageQp) -> usize {
        self.inequalities.weights.len() - qp.trajectory_rows.len()
    }

    /// Slacks and multipliers at the iterate itself.
    fn begin(&mut self, qp: &StageQp, start: Start, warm: bool) {
        self.point.clear(qp.horizon * Self::VEHICLES);
        self.refresh_values(qp);
        self.columns.begin(start, warm);
    }

    /// Newton's method with predictor and corrector until every residual is small.
    fn iterate(&mut self, qp: &StageQp, iterations: &mut usize) -> Result<(), StageError> {
        let count = self.columns.pairs() as f64;
        // The dual residual is linear in the unknowns, so every step of length α leaves 1 − α of it.
        let mut dual_share = 1.0;
        for _ in 0..ITERATION_LIMIT {
            let (complementarity, primal) = self.columns.measure();
            if complementarity < qp.tolerance && primal < qp.tolerance && dual_share < DUAL_TOLERANCE * qp.tolerance {
                return Ok(());
            }
            if !complementarity.is_finite() {
                break;
            }
            let largest = self.columns.multiplier.iter().copied().fold(0.0, larger);
            if largest > INFEASIBLE_MULTIPLIER && primal > qp.tolerance.sqrt() {
                return Err(StageError::Infeasible { iterations: *iterations });
            }
            *iterations += 1;
            self.columns.weigh();
            self.factor(qp)?;
            self.fill_cost_gradient(qp);
            self.columns.aim(0.0, false);
            self.newton(qp, false);
            let affine = self.columns.step();
            let share = if affine.ratio > 1.0 { 1.0 / affine.ratio } else { 1.0 };
            let left = complementarity + share * (affine.linear + share * affine.quadratic) / count;
            let centring = (left / complementarity).powi(3).max(1e-8) * complementarity;
            self.columns.aim(centring, true);
            self.newton(qp, complementarity < REFINED_BELOW);
            let ratio = self.columns.step().ratio;
            let boundary = 1.0 - complementarity.clamp(1e-6, 5e-3);
            let share = if ratio > boundary { boundary / ratio } else { 1.0 };
            self.columns.advance(share);
            self.point.add(share, &self.step);
            dual_share *= 1.0 - share;
            self.refresh_values(qp);
        }
        let (complementarity, worst) = self.columns.measure();
        if complementarity < ACCEPTED && worst < ACCEPTED && dual_share < ACCEPTED {
            return Ok(());
        }
        let status = format!("residual {worst:.1e}, dual residual at {dual_share:.1e} of its start");
        Err(StageError::Unsolved { status, iterations: *iterations })
    }

    /// Every inequality at the point, and the gradients of rows over whole trajectories.
    fn refresh_values(&mut self, qp: &StageQp) {
        let values = &mut self.columns.value;
        let (boxed, rows) = values.split_at_mut(BOXES * self.inequalities.boxes.len());
        for (boxes, values) in self.inequalities.boxes.iter().zip(boxed.chunks_exact_mut(BOXES)) {
            let ([a, d], v) = (self.point.inputs[boxes.at], self.point.states[boxes.at][3]);
            for (value, (room, moved)) in values.iter_mut().zip(boxes.room.iter().zip([a, -a, d, -d, v, -v])) {
                *value = room + moved;
            }
        }
        let (rows, trajectories) = rows.split_at_mut(self.inequalities.rows.len());
        for (row, value) in self.inequalities.rows.iter().zip(rows) {
            *value = row.value + row.slope(&self.point.states);
        }
        for ((row, along), value) in qp.trajectory_rows.iter().zip(&mut self.along).zip(trajectories) {
            *value = along.refresh(row, &self.point, Self::VEHICLES);
        }
    }

    /// Assembles the second derivatives with the weights `ω` and factors them.
    fn factor(&mut self, qp: &StageQp) -> Result<(), StageError> {
        self.cost_hessians(qp);
        let (boxed, rows) = self.columns.weight.split_at(BOXES * self.inequalities.boxes.len());
        for (boxes, w) in self.inequalities.boxes.iter().zip(boxed.chunks_exact(BOXES)) {
            let hessian = &mut self.hessians[boxes.at];
            hessian.input[0] += w[0] + w[1];
            hessian.input[1] += w[2] + w[3];
            hessian.speed += w[4] + w[5];
        }
        for (row, weight) in self.inequalities.rows.iter().zip(rows) {
            let [x, y, t] = row.gradient;
            if let Some(other) = row.other {
                let position = [weight * x * x, weight * x * y, weight * y * y];
                add_pair(&mut self.hessians, &mut self.pairs, Self::VEHICLES, [row.at, other], position);
            } else {
                let pose = &mut self.hessians[row.at].pose;
                for (value, product) in pose.iter_mut().zip([x * x, x * y, x * t, y * y, y * t, t * t]) {
                    *value += weight * product;
                }
            }
        }
        let multipliers = &self.columns.multiplier[self.columns.len() - self.along.len()..];
        for (row, multiplier) in qp.trajectory_rows.iter().zip(multipliers) {
            for (k, beta) in row.bends.iter().enumerate() {
                let pose = &mut self.hessians[k * Self::VEHICLES + row.vehicle].pose;
                pose[0] += 2.0 * multiplier * beta;
                pose[3] += 2.0 * multiplier * beta;
            }
        }
        self.riccati.factor(qp, &self.hessians, &self.pairs)?;
        self.respond(qp);
        Ok(())
    }

    /// `H⁻¹ v` of every row over a whole trajectory, for Sherman and Morrison.
    fn respond(&mut self, qp: &StageQp) {
        let weights = &self.columns.weight[self.columns.len() - self.along.len()..];
        for index in 0..self.along.len() {
            let (before, after) = self.along.split_at_mut(index);
            let along = &mut after[0];
            self.gradient.clear(qp.horizon * Self::VEHICLES);
            // The gradient −v makes the solve return H⁻¹ v.
            along.pull(-1.0, &mut self.gradient, Self::VEHICLES);
            along.response.clear(qp.horizon * Self::VEHICLES);
            self.riccati.solve(qp, &self.gradient, &mut along.response);
            for (earlier, weight) in before.iter().zip(weights) {
                earlier.correct(*weight, &mut along.response, Self::VEHICLES);
            }
        }
    }

    /// The smooth cost's second derivatives and the rows' own curvature.
    fn cost_hessians(&mut self, qp: &StageQp) {
        let vehicles = Self::VEHICLES;
        self.hessians.clear();
        self.pairs.resize_with(qp.horizon, Vec::new);
        for k in 0..qp.horizon {
            self.pairs[k].clear();
            for stages in &qp.vehicles {
                let cost = &stages.state_costs[k];
                let ([xx, xy, yy], [.., heading, speed]) = (cost.position_hessian(), cost.hessian);
                let pose = [xx, xy, 0.0, yy, 0.0, heading];
                let input = [0, 1].map(|axis| stages.damping(qp.damping, axis));
                self.hessians.push(VehicleHessian { pose, speed, input });
            }
        }
        for block in &qp.blocks {
            for (k, row) in block.rows.iter().enumerate().filter(|(_, row)| row.active) {
                let ([xx, xy, yy, turn], at) = (row.curvature, k * vehicles + block.vehicle);
                if let Some(other) = block.other {
                    let indices = [at, k * vehicles + other];
                    add_pair(&mut self.hessians, &mut self.pairs, vehicles, indices, [xx, xy, yy]);
                } else {
                    let pose = &mut self.hessians[at].pose;
                    pose[0] += xx;
                    pose[1] += xy;
                    pose[3] += yy;
                    pose[5] += turn;
                }
            }
        }
    }

    /// Gradient of the smooth cost (with curvature) at the point.
    fn fill_cost_gradient(&mut self, qp: &StageQp) {
        let vehicles = Self::VEHICLES;
        self.cost_gradient.clear(qp.horizon * vehicles);
        let (states, inputs) = (&self.point.states, &self.point.inputs);
        for (i, stages) in qp.vehicles.iter().enumerate() {
            for k in 0..qp.horizon {
                let at = k * vehicles + i;
                let gradient = stages.state_costs[k].gradient_at(&states[at]);
                for axis in 0..4 {
                    self.cost_gradient.states[at][axis] += gradient[axis];
                }
                if k < stages.first {
                    continue;
                }
                for axis in 0..2 {
                    let before = if k > stages.first { inputs[at - vehicles][axis] } else { 0.0 };
                    let change = stages.changes[k][axis] + inputs[at][axis] - before;
                    let pull = 2.0 * stages.change_weights[axis] * change;
                    self.cost_gradient.inputs[at][axis] += pull + stages.damping(qp.damping, axis) * inputs[at][axis];
                    if k > stages.first {
                        self.cost_gradient.inputs[at - vehicles][axis] -= pull;
                    }
                }
                let before = if k > 0 { states[at - vehicles] } else { [0.0; 4] };
                let ([heading, speed], steering) = curvature_gradient(&stages.curvatures[k], &before, &inputs[at]);
                self.cost_gradient.inputs[at][1] += steering;
                if k > 0 {
                    self.cost_gradient.states[at - vehicles][2] += heading;
                    self.cost_gradient.states[at - vehicles][3] += speed;
                }
            }
        }
        self.add_row_curvature(qp);
    }

    fn add_row_curvature(&mut self, qp: &StageQp) {
        let vehicles = Self::VEHICLES;
        for block in &qp.blocks {
            for (k, row) in block.rows.iter().enumerate().filter(|(_, row)| row.active) {
                let [xx, xy, yy, turn] = row.curvature;
                let (at, other) = (k * vehicles + block.vehicle, block.other.map(|other| k * vehicles + other));
                let own = self.point.states[at];
                let origin = other.map_or([0.0; 4], |other| self.point.states[other]);
                let (x, y) = (own[0] - origin[0], own[1] - origin[1]);
                let pull = [xx * x + xy * y, xy * x + yy * y];
                let gradients = &mut self.cost_gradient.states;
                gradients[at][2] += turn * own[2];
                for axis in 0..2 {
                    gradients[at][axis] += pull[axis];
                    if let Some(other) = other {
                        gradients[other][axis] -= pull[axis];
                    }
                }
            }
        }
    }

    /// One Newton step towards the targets, if asked with a refinement; leaves its slopes in the columns.
    fn newton(&mut self, qp: &StageQp, refined: bool) {
        self.gradient.states.clone_from(&self.cost_gradient.states);
        self.gradient.inputs.clone_from(&self.cost_gradient.inputs);
        let boxed = BOXES * self.inequalities.boxes.len();
        let (pulls, row_pulls) = self.columns.pull.split_at(boxed);
        for (boxes, p) in self.inequalities.boxes.iter().zip(pulls.chunks_exact(BOXES)) {
            let input = &mut self.gradient.inputs[boxes.at];
            input[0] += p[1] - p[0];
            input[1] += p[3] - p[2];
            self.gradient.states[boxes.at][3] += p[5] - p[4];
        }
        for (row, pull) in self.inequalities.rows.iter().zip(row_pulls) {
            row.pull(-pull, &mut self.gradient.states);
        }
        for (along, pull) in self.along.iter().zip(&row_pulls[self.inequalities.rows.len()..]) {
            along.pull(*pull, &mut self.gradient, Self::VEHICLES);
        }
        self.step.states.resize(self.gradient.states.len(), [0.0; 4]);
        self.step.inputs.resize(self.gradient.inputs.len(), [0.0; 2]);
        self.riccati.solve(qp, &self.gradient, &mut self.step);
        correct(&self.columns, &self.along, &mut self.step, Self::VEHICLES);
        if refined {
            self.leave_residual(qp);
            self.correction.clear(qp.horizon * Self::VEHICLES);
            self.riccati.solve(qp, &self.gradient, &mut self.correction);
            correct(&self.columns, &self.along, &mut self.correction, Self::VEHICLES);
            self.step.add(1.0, &self.correction);
        }
        self.fill_slopes();
    }

    fn fill_slopes(&mut self) {
        let (boxed, rows) = self.columns.slope.split_at_mut(BOXES * self.inequalities.boxes.len());
        for (boxes, slopes) in self.inequalities.boxes.iter().zip(boxed.chunks_exact_mut(BOXES)) {
            let ([a, d], v) = (self.step.inputs[boxes.at], self.step.states[boxes.at][3]);
            slopes.copy_from_slice(&[a, -a, d, -d, v, -v]);
        }
        let (rows, trajectories) = rows.split_at_mut(self.inequalities.rows.len());
        for (row, slope) in self.inequalities.rows.iter().zip(rows) {
            *slope = row.slope(&self.step.states);
        }
        for (along, slope) in self.along.iter().zip(trajectories) {
            *slope = -along.dot(&self.step, Self::VEHICLES);
        }
    }
}

/// Turns a step of the factored Hessian into one with the rows over whole trajectories.
fn correct(columns: &Columns, along: &[Along], step: &mut Point, vehicles: usize) {
    for (along, weight) in along.iter().zip(&columns.weight[columns.len() - along.len()..]) {
        along.correct(*weight, step, vehicles);
    }
}

/// Adds a Hessian over the difference of two positions.
#[inline(always)]
fn add_pair(
    hessians: &mut [VehicleHessian],
    pairs: &mut [Vec<PairHessian>],
    vehicles: usize,
    [at, other]: [usize; 2],
    position: [f64; 3],
) {
    for index in [at, other] {
        let pose = &mut hessians[index].pose;
        pose[0] += position[0];
        pose[1] += position[1];
        pose[3] += position[2];
    }
    let (i, j) = (at % vehicles, other % vehicles);
    pairs[at / vehicles].push(PairHessian { pair: [i.max(j), i.min(j)], position });
}
