//! The second stage solver: the same problem handed to a general sparse interior point.
//!
//! It is an order of magnitude slower than [`super::Structured`] and takes Gauss-Newton problems only, but it shares no
//! code with it and proves infeasibility: the oracle of the tests, and the fallback.
//!
//! Variables are `w_k`, `d_{k+1}` and the violations `s`; dynamics are equality rows; boxes, rows and `s ≥ 0` are
//! inequality rows. A row over a whole trajectory, `value + b·(p, v) + β‖p‖² ≤ s`, is the second-order cone
//! `‖(2√β p, t − 1)‖ ≤ t + 1` with `t = s − value − b·(p, v)`; without `β` it is `−t ≤ 0`.

use interplay_convex::{
    Block, ConicSolution, ProblemError, Program, SolveError, Solver, SolverSettings, Variable, Variables,
};

use super::qp::{RowBlock, StageQp, TrajectoryRow};
use super::solution::StageSolution;
use super::solver::{StageError, StageSolver, StageStatus};

/// The general solver; it keeps the symbolic factorisation as long as the shape of the problem stays the same.
#[derive(Default)]
pub struct Sparse {
    kept: Option<Kept>,
}

impl Clone for Sparse {
    /// A fresh solver: what is kept between calls is only a cache.
    fn clone(&self) -> Self {
        Sparse::default()
    }
}

impl std::fmt::Debug for Sparse {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("Sparse").field("kept", &self.kept.is_some()).finish()
    }
}

struct Kept {
    shape: Shape,
    layout: Layout,
    program: Program,
    solver: Solver,
}

/// What decides the sparsity pattern.
#[derive(Clone, Debug, PartialEq)]
struct Shape {
    horizon: usize,
    shared_steps: usize,
    firsts: Vec<usize>,
    blocks: Vec<(usize, Option<usize>, bool)>,
    /// For each row over a whole trajectory, whose, and whether it is curved.
    trajectories: Vec<(usize, bool)>,
}

/// Where everything stands in the program.
struct Layout {
    inputs: Vec<Variables>,
    states: Vec<Variables>,
    violations: Vec<Option<Variables>>,
    shortfalls: Option<Variables>,
    dynamics: Block,
    bounds: Block,
    rows: Block,
    signs: Block,
    straight: Block,
    cones: Vec<Option<Block>>,
}

impl Shape {
    fn of(qp: &StageQp) -> Shape {
        Shape {
            horizon: qp.horizon,
            shared_steps: qp.shared_steps,
            firsts: qp.vehicles.iter().map(|stages| stages.first).collect(),
            blocks: qp.blocks.iter().map(|block| (block.vehicle, block.other, block.penalty.is_some())).collect(),
            trajectories: qp.trajectory_rows.iter().map(|row| (row.vehicle, is_curved(row))).collect(),
        }
    }
}

impl StageSolver for Sparse {
    fn accepts_curvature(&self) -> bool {
        false
    }

    fn solve(&mut self, qp: &StageQp, solution: &mut StageSolution, _warm: bool) -> Result<(), StageError> {
        let shape = Shape::of(qp);
        solution.shape_like(qp);
        let refused = |error: ProblemError| StageError::Unsolved { status: error.into(), iterations: 0 };
        let mut kept = match self.kept.take() {
            Some(mut kept) if kept.shape == shape => {
                kept.program.clear();
                kept.layout.write(qp, &mut kept.program);
                kept.solver.update(&kept.program).map_err(refused)?;
                kept
            }
            _ => {
                let mut program = Program::new();
                let layout = Layout::new(qp, &mut program);
                layout.write(qp, &mut program);
                let solver = Solver::new(&program, &SolverSettings::default()).map_err(refused)?;
                Kept { shape, layout, program, solver }
            }
        };
        let outcome = kept.solver.solve();
        if let Ok(found) = &outcome {
            kept.layout.read(qp, found, solution);
        }
        self.kept = Some(kept);
        solution.iterations = match &outcome {
            Ok(found) => found.iterations as usize,
            Err(_) => 0,
        };
        outcome.map(|_| ()).map_err(|error| match error {
            SolveError::PrimalInfeasible { iterations, .. } => {
                StageError::Infeasible { iterations: iterations as usize }
            }
            SolveError::DualInfeasible { .. } => StageError::NotConvex { stage: 0 },
            SolveError::Unsolved { status, iterations } => {
                StageError::Unsolved { status: StageStatus::General(status), iterations: iterations as usize }
            }
        })
    }
}

impl Layout {
    fn new(qp: &StageQp, program: &mut Program) -> Layout {
        let horizon = qp.horizon;
        let vehicles = 0..qp.vehicles.len();
        let inputs = vehicles.clone().map(|i| program.variables(format!("inputs {i}"), 2 * horizon)).collect();
        let states = vehicles.map(|i| program.variables(format!("states {i}"), 4 * horizon)).collect();
        let violations = qp.blocks.iter().enumerate();
        let violations = violations
            .map(|(i, block)| block.penalty.map(|_| program.variables(format!("violations {i}"), horizon)))
            .collect();
        let count = qp.trajectory_rows.len();
        let shortfalls = (count > 0).then(|| program.variables("shortfalls", count));
        let cones =
            qp.trajectory_rows.iter().enumerate().map(|(i, row)| {
                is_curved(row).then(|| program.second_order(format!("trajectory {i}"), 2 * horizon + 2))
            });
        let cones: Vec<Option<Block>> = cones.collect();
        Layout {
            inputs,
            states,
            violations,
            shortfalls,
            dynamics: program.equal("dynamics"),
            bounds: program.at_most("bounds"),
            rows: program.at_most("rows"),
            signs: program.at_most("signs"),
            straight: program.at_most("straight"),
            cones,
        }
    }

    fn input(&self, vehicle: usize, k: usize, axis: usize) -> Variable {
        self.inputs[vehicle].at(2 * k + axis)
    }

    fn state(&self, vehicle: usize, k: usize, axis: usize) -> Variable {
        self.states[vehicle].at(4 * k + axis)
    }

    fn write(&self, qp: &StageQp, program: &mut Program) {
        for vehicle in 0..qp.vehicles.len() {
            for k in 0..qp.horizon {
                self.write_cost(qp, vehicle, k, program);
                self.write_dynamics(qp, vehicle, k, program);
                self.write_bounds(qp, vehicle, k, program);
            }
        }
        for (block, violations) in qp.blocks.iter().zip(&self.violations) {
            self.write_block(block, *violations, program);
        }
        for (index, row) in qp.trajectory_rows.iter().enumerate() {
            self.write_trajectory(row, index, program);
        }
    }

    fn write_cost(&self, qp: &StageQp, vehicle: usize, k: usize, program: &mut Program) {
        let stages = &qp.vehicles[vehicle];
        let cost = &stages.state_costs[k];
        for axis in 0..4 {
            let variable = self.state(vehicle, k, axis);
            program.quadratic(variable, variable, cost.hessian[axis]);
            program.linear(variable, cost.gradient[axis]);
        }
        program.quadratic(self.state(vehicle, k, 0), self.state(vehicle, k, 1), cost.cross);
        for (axis, cross) in cost.heading_cross.into_iter().enumerate().filter(|(_, cross)| *cross != 0.0) {
            program.quadratic(self.state(vehicle, k, axis), self.state(vehicle, k, 2), cross);
        }
        if k < stages.first {
            return;
        }
        for axis in 0..2 {
            let (weight, now) = (2.0 * stages.change_weight(k, axis), self.input(vehicle, k, axis));
            program.quadratic(now, now, weight + stages.damping(qp.damping, axis));
            program.linear(now, weight * stages.changes[k][axis]);
            if k > stages.first {
                let before = self.input(vehicle, k - 1, axis);
                program.quadratic(before, before, weight);
                program.quadratic(before, now, -weight);
                program.linear(before, -weight * stages.changes[k][axis]);
            }
        }
    }

    fn write_dynamics(&self, qp: &StageQp, vehicle: usize, k: usize, program: &mut Program) {
        let stages = &qp.vehicles[vehicle];
        let j = &stages.jacobians[k];
        let inputs = [[0.0, j.x_steering], [0.0, j.y_steering], [0.0, j.heading_steering], [j.speed_acceleration, 0.0]];
        let states = [
            [1.0, 0.0, j.x_heading, j.x_speed],
            [0.0, 1.0, j.y_heading, j.y_speed],
            [0.0, 0.0, 1.0, j.heading_speed],
            [0.0, 0.0, 0.0, 1.0],
        ];
        for axis in 0..4 {
            let next = [(self.state(vehicle, k, axis), 1.0)];
            let from_inputs = (0..2).map(|i| (self.input(vehicle, k, i), -inputs[axis][i]));
            let from_states = (0..if k > 0 { 4 } else { 0 }).map(|i| (self.state(vehicle, k - 1, i), -states[axis][i]));
            program.row(self.dynamics, next.into_iter().chain(from_inputs).chain(from_states), 0.0);
        }
        if k < stages.first {
            for axis in 0..2 {
                program.row(self.dynamics, [(self.input(vehicle, k, axis), 1.0)], 0.0);
            }
        }
        if vehicle > 0 && k < qp.shared_steps {
            for axis in 0..2 {
                let same = [(self.input(vehicle, k, axis), 1.0), (self.input(0, k, axis), -1.0)];
                program.row(self.dynamics, same, 0.0);
            }
        }
    }

    fn write_bounds(&self, qp: &StageQp, vehicle: usize, k: usize, program: &mut Program) {
        let stages = &qp.vehicles[vehicle];
        if k < stages.first {
            return;
        }
        let [acceleration, steering] = stages.input_boxes[k];
        for (variable, interval) in [
            (self.input(vehicle, k, 0), acceleration),
            (self.input(vehicle, k, 1), steering),
            (self.state(vehicle, k, 3), stages.speed_boxes[k]),
        ] {
            program.row(self.bounds, [(variable, -1.0)], -interval.lower);
            program.row(self.bounds, [(variable, 1.0)], interval.upper);
        }
    }

    /// `−∇c·p − s ≤ c` and `−s ≤ 0`. A row that is not active keeps its place with a gradient of zero.
    fn write_block(&self, block: &RowBlock, violations: Option<Variables>, program: &mut Program) {
        for (k, row) in block.rows.iter().enumerate() {
            let (gradient, value) = if row.active { (row.gradient, row.value) } else { ([0.0; 3], 1.0) };
            let own = (0..3).map(|axis| (self.state(block.vehicle, k, axis), -gradient[axis]));
            let other = block.other.into_iter().flat_map(|other| {
                (0..2).map(move |axis| (other, axis)).map(|(other, axis)| (self.state(other, k, axis), gradient[axis]))
            });
            let violation = violations.map(|variables| variables.at(k));
            let terms = own.chain(other).chain(violation.map(|variable| (variable, -1.0)));
            program.row(self.rows, terms, value);
            if let (Some(variable), Some(penalty)) = (violation, block.penalty) {
                program.quadratic(variable, variable, 2.0 * penalty.quadratic);
                program.linear(variable, penalty.linear);
                program.row(self.signs, [(variable, -1.0)], 0.0);
            }
        }
    }

    fn write_trajectory(&self, row: &TrajectoryRow, index: usize, program: &mut Program) {
        let Some(shortfall) = self.shortfalls.map(|shortfalls| shortfalls.at(index)) else { return };
        program.quadratic(shortfall, shortfall, 2.0 * row.penalty.quadratic);
        program.linear(shortfall, row.penalty.linear);
        program.row(self.signs, [(shortfall, -1.0)], 0.0);
        // t = s − value − b·(p, v); the slack of a block is right side minus terms.
        let t = || {
            let slopes = row.gradients.iter().enumerate().flat_map(|(k, [x, y, speed])| {
                [(0, x), (1, y), (3, speed)].map(|(axis, slope)| (self.state(row.vehicle, k, axis), *slope))
            });
            slopes.chain([(shortfall, -1.0)])
        };
        let Some(cone) = self.cones[index] else {
            program.row(self.straight, t(), -row.value);
            return;
        };
        program.row(cone, t(), 1.0 - row.value);
        program.row(cone, t(), -1.0 - row.value);
        for (k, bend) in row.bends.iter().enumerate() {
            for axis in 0..2 {
                program.row(cone, [(self.state(row.vehicle, k, axis), -2.0 * bend.sqrt())], 0.0);
            }
        }
    }

    fn read(&self, qp: &StageQp, found: &ConicSolution, solution: &mut StageSolution) {
        let (bounds, rows) = (found.dual(self.bounds), found.dual(self.rows));
        let mut bounds = bounds.iter();
        for (i, stages) in qp.vehicles.iter().enumerate() {
            for k in 0..qp.horizon {
                solution.inputs[i][k] = std::array::from_fn(|axis| found.at(self.input(i, k, axis)));
                solution.states[i][k] = std::array::from_fn(|axis| found.at(self.state(i, k, axis)));
                let mut next = || if k < stages.first { 0.0 } else { bounds.next().copied().unwrap_or_default() };
                solution.bound_multipliers[i][k] = std::array::from_fn(|_| [next(), next()]);
            }
        }
        for (multipliers, duals) in solution.row_multipliers.iter_mut().zip(rows.chunks(qp.horizon.max(1))) {
            multipliers.copy_from_slice(duals);
        }
        let mut straight = found.dual(self.straight).iter();
        for (multiplier, cone) in solution.trajectory_multipliers.iter_mut().zip(&self.cones) {
            *multiplier = match cone {
                // The cone's dual is (κ₀, κ₁, …) with κ₀ + κ₁ the multiplier of t.
                Some(cone) => found.dual(*cone)[..2].iter().sum(),
                None => straight.next().copied().unwrap_or_default(),
            };
        }
    }
}

/// Whether a row needs a cone.
fn is_curved(row: &TrajectoryRow) -> bool {
    row.bends.iter().any(|bend| *bend > 0.0)
}
