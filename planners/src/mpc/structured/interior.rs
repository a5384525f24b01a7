//! The interior-point iteration (see the parent module for the equations).

use super::riccati::{PairHessian, Riccati, VehicleHessian};
use super::row::{Row, Start};
use super::rows::{Inequality, Subject, list};
use crate::mpc::adjoint::curvature_gradient;
use crate::mpc::stage::{StageError, StageQp, StageSolution, StageSolver};

/// Tolerance on complementarity, primal and dual residuals.
const TOLERANCE: f64 = 1e-9;
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

/// Values over states and inputs of all vehicles, indexed `k * M + vehicle`.
#[derive(Clone, Debug, Default)]
struct Point {
    states: Vec<[f64; 4]>,
    inputs: Vec<[f64; 2]>,
}

impl Point {
    fn clear(&mut self, count: usize) {
        self.states.clear();
        self.states.resize(count, [0.0; 4]);
        self.inputs.clear();
        self.inputs.resize(count, [0.0; 2]);
    }

    fn add(&mut self, share: f64, step: &Point) {
        for (value, step) in self.states.iter_mut().zip(&step.states) {
            for axis in 0..4 {
                value[axis] += share * step[axis];
            }
        }
        for (value, step) in self.inputs.iter_mut().zip(&step.inputs) {
            for axis in 0..2 {
                value[axis] += share * step[axis];
            }
        }
    }
}

/// The memory of one solver of `W/2` vehicles; nothing is allocated once it has its size.
#[derive(Clone, Debug, Default)]
struct Interior<const W: usize, const Z: usize> {
    riccati: Riccati<W, Z>,
    inequalities: Vec<Inequality>,
    rows: Vec<Row>,
    hessians: Vec<VehicleHessian>,
    pairs: Vec<Vec<PairHessian>>,
    /// Where the iteration stands.
    point: Point,
    /// Its next step.
    step: Point,
    /// Gradient of the smooth cost at the point.
    cost_gradient: Point,
    /// The same with the rows' pull.
    gradient: Point,
    /// Gradient `v` of the row over the whole trajectory at the point; empty without such a row.
    along: Vec<[f64; 2]>,
    /// `H⁻¹ v`, for Sherman and Morrison.
    along_response: Point,
}

impl<const W: usize, const Z: usize> Interior<W, Z> {
    const VEHICLES: usize = W / 2;

    fn solve(&mut self, qp: &StageQp, solution: &mut StageSolution, warm: bool) -> Result<(), StageError> {
        list(qp, &mut self.inequalities);
        self.point.clear(qp.horizon * Self::VEHICLES);
        self.along.clear();
        self.along.resize(if qp.trajectory_row.is_some() { qp.horizon } else { 0 }, [0.0; 2]);
        let mut iterations = 0;
        let outcome = if warm && self.rows.len() == self.inequalities.len() {
            self.begin(qp, Start::WARM, true);
            self.iterate(qp, &mut iterations)
        } else {
            Err(StageError::Unsolved { status: String::new(), iterations: 0 })
        };
        let outcome = match outcome {
            Err(StageError::Unsolved { .. }) => {
                self.point.clear(qp.horizon * Self::VEHICLES);
                self.begin(qp, Start::COLD, false);
                self.iterate(qp, &mut iterations)
            }
            other => other,
        };
        solution.shape_like(qp);
        solution.iterations = iterations;
        outcome?;
        self.write(qp, solution);
        Ok(())
    }

    /// Slacks and multipliers at the start.
    fn begin(&mut self, qp: &StageQp, start: Start, warm: bool) {
        self.rows.resize(self.inequalities.len(), Row::default());
        self.refresh_along(qp);
        for (row, inequality) in self.rows.iter_mut().zip(&self.inequalities) {
            row.begin(inequality.value, inequality.soft, start, warm);
        }
    }

    /// Newton's method with predictor and corrector until every residual is small.
    fn iterate(&mut self, qp: &StageQp, iterations: &mut usize) -> Result<(), StageError> {
        let count = self.rows.iter().map(Row::pairs).sum::<usize>() as f64;
        // The dual residual is linear in the unknowns, so every step of length α leaves 1 − α of it.
        let mut dual_share = 1.0;
        for _ in 0..ITERATION_LIMIT {
            let (complementarity, primal) = self.measure(qp, count);
            if complementarity < TOLERANCE && primal < TOLERANCE && dual_share < TOLERANCE {
                return Ok(());
            }
            if !complementarity.is_finite() {
                break;
            }
            let largest = self.rows.iter().map(|row| row.multiplier).fold(0.0, f64::max);
            if largest > INFEASIBLE_MULTIPLIER && primal > TOLERANCE.sqrt() {
                return Err(StageError::Infeasible { iterations: *iterations });
            }
            *iterations += 1;
            self.factor(qp)?;
            self.fill_cost_gradient(qp);
            self.rows.iter_mut().for_each(Row::aim_at_zero);
            let ratio = self.newton(qp);
            let share = if ratio > 1.0 { 1.0 / ratio } else { 1.0 };
            let affine = self.rows.iter().map(|row| row.complementarity_after(share)).sum::<f64>() / count;
            let centring = (affine / complementarity).powi(3).max(1e-8) * complementarity;
            self.rows.iter_mut().for_each(|row| row.aim_at(centring));
            let ratio = self.newton(qp);
            let boundary = 1.0 - complementarity.clamp(1e-6, 5e-3);
            let share = if ratio > boundary { boundary / ratio } else { 1.0 };
            self.rows.iter_mut().for_each(|row| row.advance(share));
            self.point.add(share, &self.step);
            dual_share *= 1.0 - share;
        }
        let worst = self.rows.iter().map(|row| row.residual.abs()).fold(0.0, f64::max);
        let status = format!("residual {worst:.1e}, dual residual at {dual_share:.1e} of its start");
        Err(StageError::Unsolved { status, iterations: *iterations })
    }

    /// Refreshes the rows' residuals; returns mean complementarity and the largest residual.
    fn measure(&mut self, qp: &StageQp, count: f64) -> (f64, f64) {
        self.refresh_along(qp);
        let (mut complementarity, mut primal) = (0.0, 0.0_f64);
        for (row, inequality) in self.rows.iter_mut().zip(&self.inequalities) {
            let value = match (inequality.subject, &qp.trajectory_row) {
                (Subject::Trajectory { stride }, Some(trajectory)) => {
                    -trajectory.value_at(self.point.states.iter().step_by(stride).map(|d| [d[0], d[1]]))
                }
                _ => inequality.value + inequality.slope(&self.point.states, &self.point.inputs, &[]),
            };
            row.residual = value + row.violation - row.slack;
            complementarity += row.complementarity();
            primal = primal.max(row.residual.abs());
        }
        (complementarity / count, primal)
    }

    fn refresh_along(&mut self, qp: &StageQp) {
        if let Some(row) = &qp.trajectory_row {
            for (k, v) in self.along.iter_mut().enumerate() {
                let d = &self.point.states[k * Self::VEHICLES];
                *v = std::array::from_fn(|axis| row.gradients[k][axis] + 2.0 * row.bends[k] * d[axis]);
            }
        }
    }

    /// Assembles the second derivatives with the rows' weights `ω` and factors them.
    fn factor(&mut self, qp: &StageQp) -> Result<(), StageError> {
        self.cost_hessians(qp);
        let mut bend = 0.0;
        for (row, inequality) in self.rows.iter_mut().zip(&self.inequalities) {
            let weight = row.weigh(inequality.soft);
            match inequality.subject {
                Subject::Box { at, axis: 2, .. } => self.hessians[at].speed += weight,
                Subject::Box { at, axis, .. } => self.hessians[at].input[axis] += weight,
                Subject::Pose { at, gradient: [x, y, t] } => {
                    let pose = &mut self.hessians[at].pose;
                    for (value, product) in pose.iter_mut().zip([x * x, x * y, x * t, y * y, y * t, t * t]) {
                        *value += weight * product;
                    }
                }
                Subject::Pair { at, other, gradient: [x, y] } => {
                    let position = [weight * x * x, weight * x * y, weight * y * y];
                    add_pair(&mut self.hessians, &mut self.pairs, Self::VEHICLES, [at, other], position);
                }
                Subject::Trajectory { .. } => bend = 2.0 * row.multiplier,
            }
        }
        if let Some(row) = &qp.trajectory_row {
            for (k, beta) in row.bends.iter().enumerate() {
                let pose = &mut self.hessians[k * Self::VEHICLES].pose;
                pose[0] += bend * beta;
                pose[3] += bend * beta;
            }
        }
        self.riccati.factor(qp, &self.hessians, &self.pairs)?;
        if qp.trajectory_row.is_some() {
            self.gradient.clear(qp.horizon * Self::VEHICLES);
            for (k, v) in self.along.iter().enumerate() {
                // The gradient −v makes the solve return H⁻¹ v.
                self.gradient.states[k * Self::VEHICLES] = [-v[0], -v[1], 0.0, 0.0];
            }
            self.along_response.clear(qp.horizon * Self::VEHICLES);
            let response = &mut self.along_response;
            let gradient = &self.gradient;
            self.riccati.solve(qp, &gradient.states, &gradient.inputs, &mut response.states, &mut response.inputs);
        }
        Ok(())
    }

    /// The smooth cost's second derivatives and the rows' own curvature.
    fn cost_hessians(&mut self, qp: &StageQp) {
        let vehicles = Self::VEHICLES;
        self.hessians.clear();
        self.pairs.resize_with(qp.horizon, Vec::new);
        for k in 0..qp.horizon {
            self.pairs[k].clear();
            for stages in &qp.vehicles {
                let [x, y, heading, speed] = stages.state_costs[k].hessian;
                let pose = [x, 0.0, 0.0, y, 0.0, heading];
                self.hessians.push(VehicleHessian { pose, speed, input: [0.0; 2] });
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
                let (cost, d) = (&stages.state_costs[k], &states[at]);
                for axis in 0..4 {
                    self.cost_gradient.states[at][axis] += cost.gradient[axis] + cost.hessian[axis] * d[axis];
                }
                if k < stages.first {
                    continue;
                }
                for axis in 0..2 {
                    let before = if k > stages.first { inputs[at - vehicles][axis] } else { 0.0 };
                    let pull =
                        2.0 * stages.change_weights[axis] * (stages.changes[k][axis] + inputs[at][axis] - before);
                    self.cost_gradient.inputs[at][axis] += pull;
                    if k > stages.first {
                        self.cost_gradient.inputs[at - vehicles][axis] -= pull;
                    }
                }
                if k > 0 {
                    let (before, curvature) = (at - vehicles, &stages.curvatures[k]);
                    let ([heading, speed], steering) = curvature_gradient(curvature, &states[before], &inputs[at]);
                    self.cost_gradient.states[before][2] += heading;
                    self.cost_gradient.states[before][3] += speed;
                    self.cost_gradient.inputs[at][1] += steering;
                } else {
                    self.cost_gradient.inputs[at][1] += stages.curvatures[0].steering_steering * inputs[at][1];
                }
            }
        }
        self.row_curvature_gradient(qp);
    }

    fn row_curvature_gradient(&mut self, qp: &StageQp) {
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

    /// One Newton step towards the rows' targets; returns the largest share by which a slack or multiplier would shrink.
    fn newton(&mut self, qp: &StageQp) -> f64 {
        self.gradient.states.clone_from(&self.cost_gradient.states);
        self.gradient.inputs.clone_from(&self.cost_gradient.inputs);
        let mut along_weight = 0.0;
        for (row, inequality) in self.rows.iter_mut().zip(&self.inequalities) {
            let pull = row.pull(inequality.soft);
            inequality.pull(-pull, &mut self.gradient.states, &mut self.gradient.inputs, &self.along);
            if let Subject::Trajectory { .. } = inequality.subject {
                along_weight = row.weigh(inequality.soft);
            }
        }
        let (gradient, step) = (&self.gradient, &mut self.step);
        step.states.resize(gradient.states.len(), [0.0; 4]);
        step.inputs.resize(gradient.inputs.len(), [0.0; 2]);
        self.riccati.solve(qp, &gradient.states, &gradient.inputs, &mut step.states, &mut step.inputs);
        if qp.trajectory_row.is_some() {
            let dot = |point: &Point| -> f64 {
                let terms = self.along.iter().enumerate().map(|(k, v)| (v, &point.states[k * Self::VEHICLES]));
                terms.map(|(v, d)| v[0] * d[0] + v[1] * d[1]).sum()
            };
            let share = along_weight * dot(&self.step) / (1.0 + along_weight * dot(&self.along_response));
            self.step.add(-share, &self.along_response);
        }
        let mut ratio = 1e-12_f64;
        for (row, inequality) in self.rows.iter_mut().zip(&self.inequalities) {
            let slope = inequality.slope(&self.step.states, &self.step.inputs, &self.along);
            ratio = ratio.max(row.step(slope, inequality.soft));
        }
        ratio
    }

    /// Copies point and multipliers into the solution's shape.
    fn write(&self, qp: &StageQp, solution: &mut StageSolution) {
        let vehicles = Self::VEHICLES;
        for (at, (state, input)) in self.point.states.iter().zip(&self.point.inputs).enumerate() {
            solution.states[at % vehicles][at / vehicles] = *state;
            solution.inputs[at % vehicles][at / vehicles] = *input;
        }
        solution.bound_multipliers.iter_mut().for_each(|bounds| bounds.fill([[0.0; 2]; 3]));
        let mut rows = self.rows.iter();
        for (i, stages) in qp.vehicles.iter().enumerate() {
            for k in stages.first..qp.horizon {
                for axis in 0..3 {
                    for side in 0..2 {
                        let multiplier = rows.next().map_or(0.0, |row| row.multiplier);
                        solution.bound_multipliers[i][k][axis][side] = multiplier;
                    }
                }
            }
        }
        for (block, multipliers) in qp.blocks.iter().zip(&mut solution.row_multipliers) {
            let listed = block.costs_something();
            for (row, multiplier) in block.rows.iter().zip(multipliers) {
                let here = row.active && listed;
                *multiplier = if here { rows.next().map_or(0.0, |row| row.multiplier) } else { 0.0 };
            }
        }
        solution.trajectory_multiplier = rows.next().map_or(0.0, |row| row.multiplier);
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
