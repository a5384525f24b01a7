//! The QP subproblem: the trajectory problem expanded around an iterate, as a quadratic programme in stage form.
//!
//! First derivatives are exact, and so are second derivatives of the cost where it is convex. What the Hessian of the
//! Lagrangian adds — the curvature of dynamics and rows, weighted with multipliers of an earlier step, and that of concave
//! costs — is in the programme only after [`QpSubproblem::use_lagrangian`]; before, and after
//! [`QpSubproblem::use_gauss_newton`], the step is Gauss-Newton and convex ([`StageQp::hessian`] says which).

use crate::trajectory::iterate::Iterate;
use crate::trajectory::participant::Participant;
use crate::trajectory::problem::{Problem, TURN_WEIGHT};
use crate::trajectory::stage::{
    Costates, Hessian, Interval, RowBlock, StageQp, StageSolution, StateCost, TrajectoryRow, VehicleStages,
    fill_costates, kkt,
};
use crate::trajectory::terms::{MAX_ROWS_PER_STAGE, RowTerm, Shape, Subject, TrajectoryTerm};
use crate::vehicle::{DynamicsCurvature, PoseExpansion};

/// Tolerance of an ordinary QP subproblem.
const TOLERANCE: f64 = 1e-9;

/// A QP subproblem with the second derivatives that a Gauss-Newton step leaves out. It keeps its allocations from one
/// iterate to the next.
#[derive(Clone, Debug, Default)]
pub struct QpSubproblem {
    /// The quadratic programme in stage form.
    pub qp: StageQp,
    /// Per block and stage, `∇²c` over `(xx, xy, xθ, yy, yθ, θθ)`.
    row_hessians: Vec<Vec<[f64; 6]>>,
    /// Per vehicle and stage, the concave part of the costs' Hessian over `(xx, xy, yy)`.
    concave_costs: Vec<Vec<[f64; 3]>>,
    costates: Costates,
}

impl QpSubproblem {
    /// Expands `problem` at `iterate`, whose states obey the dynamics, into a Gauss-Newton QP subproblem.
    pub fn linearize(&mut self, problem: &Problem, iterate: &Iterate) {
        let qp = &mut self.qp;
        qp.horizon = problem.horizon;
        qp.shared_steps = problem.shared_steps;
        qp.damping = 0.0;
        qp.tolerance = TOLERANCE;
        qp.reach = None;
        qp.hessian = Hessian::GaussNewton;
        qp.vehicles.resize_with(problem.participants.len(), VehicleStages::default);
        self.concave_costs.resize_with(problem.participants.len(), Vec::new);
        for (vehicle, participant) in problem.participants.iter().enumerate() {
            pose_vehicle(participant, problem, vehicle, iterate, &mut qp.vehicles[vehicle]);
            add_state_costs(problem, vehicle, iterate, &mut qp.vehicles[vehicle], &mut self.concave_costs[vehicle]);
        }
        self.expand_rows(problem, iterate);
        fill_trajectory_rows(problem, iterate, &mut self.qp.trajectory_rows);
    }

    /// Adds the exact curvature of dynamics, rows and costs at the iterate of [`QpSubproblem::linearize`], weighted with the
    /// multipliers of an earlier step, whose deviations are set to zero.
    pub fn use_lagrangian(&mut self, problem: &Problem, iterate: &Iterate, multipliers: &mut StageSolution) {
        let qp = &mut self.qp;
        multipliers.rest();
        fill_costates(qp, multipliers, &mut self.costates);
        for (i, participant) in problem.participants.iter().enumerate() {
            let stages = &mut qp.vehicles[i];
            for k in stages.first..qp.horizon {
                let (state, input) = (&iterate.states[i][k], &iterate.inputs[i][k]);
                stages.curvatures[k] = participant.model.curvature(state, input, &self.costates[i][k]);
            }
            for (cost, concave) in stages.state_costs.iter_mut().zip(&self.concave_costs[i]) {
                cost.curvature = *concave;
            }
        }
        let blocks = qp.blocks.iter_mut().zip(&self.row_hessians).zip(&multipliers.row_multipliers);
        for ((block, hessians), multipliers) in blocks {
            for ((row, hessian), multiplier) in block.rows.iter_mut().zip(hessians).zip(multipliers) {
                row.curvature = hessian.map(|entry| -multiplier * entry);
            }
        }
        qp.hessian = Hessian::Lagrangian;
    }

    /// Leaves a share of what [`QpSubproblem::use_lagrangian`] has added.
    pub fn scale_curvature(&mut self, share: f64) {
        let qp = &mut self.qp;
        for curvature in qp.vehicles.iter_mut().flat_map(|stages| &mut stages.curvatures) {
            *curvature = curvature.scaled(share);
        }
        for cost in qp.vehicles.iter_mut().flat_map(|stages| &mut stages.state_costs) {
            cost.curvature = cost.curvature.map(|bend| share * bend);
        }
        for row in qp.blocks.iter_mut().flat_map(|block| &mut block.rows) {
            row.curvature = row.curvature.map(|bend| share * bend);
        }
    }

    /// Drops all that [`QpSubproblem::use_lagrangian`] has added.
    pub fn use_gauss_newton(&mut self) {
        let qp = &mut self.qp;
        if qp.hessian == Hessian::GaussNewton {
            return;
        }
        for stages in &mut qp.vehicles {
            stages.curvatures.fill(DynamicsCurvature::default());
            stages.state_costs.iter_mut().for_each(|cost| cost.curvature = [0.0; 3]);
        }
        for row in qp.blocks.iter_mut().flat_map(|block| &mut block.rows) {
            row.curvature = [0.0; 6];
        }
        qp.hessian = Hessian::GaussNewton;
    }

    /// The KKT residual of a step and its multipliers.
    pub(super) fn residual(&mut self, step: &StageSolution) -> f64 {
        kkt::residual_in(&self.qp, step, &mut self.costates).largest()
    }

    /// Moves the rows so that at the step's deviations they have the values they really have at `trial`: the second-order
    /// correction. Gradients and costs stay those of the iterate.
    pub(super) fn move_rows(&mut self, problem: &Problem, trial: &Iterate, step: &StageSolution) {
        let (mut at, mut room) = (0, [PoseExpansion::default(); MAX_ROWS_PER_STAGE]);
        for rows in problem.row_terms() {
            let group = at..at + rows.rows_per_stage();
            at = group.end;
            let Subject { vehicle, other } = rows.subject();
            let expansions = &mut room[..rows.rows_per_stage()];
            for stage in 0..problem.horizon {
                let own = step.states[vehicle][stage];
                let origin = other.map_or([0.0; 4], |other| step.states[other][stage]);
                rows.expand(stage, trial, expansions);
                for (block, there) in self.qp.blocks[group.clone()].iter_mut().zip(&*expansions) {
                    let row = &mut block.rows[stage];
                    let [x, y, turn] = row.gradient;
                    row.value = there.value - (x * (own[0] - origin[0]) + y * (own[1] - origin[1]) + turn * own[2]);
                }
            }
        }
    }

    /// One block for each row of each term, in the order of the terms.
    fn expand_rows(&mut self, problem: &Problem, iterate: &Iterate) {
        let count = problem.row_terms().map(|rows| rows.rows_per_stage()).sum();
        self.qp.blocks.resize_with(count, RowBlock::default);
        self.row_hessians.resize_with(count, Vec::new);
        let mut at = 0;
        for rows in problem.row_terms() {
            let group = at..at + rows.rows_per_stage();
            at = group.end;
            expand_term(problem, rows, iterate, &mut self.qp.blocks[group.clone()], &mut self.row_hessians[group]);
        }
    }
}

fn expand_term(
    problem: &Problem,
    rows: &dyn RowTerm,
    iterate: &Iterate,
    blocks: &mut [RowBlock],
    hessians: &mut [Vec<[f64; 6]>],
) {
    let (subject, far_value, horizon) = (rows.subject(), rows.far_value(), problem.horizon);
    let first = problem.first_stage(subject);
    for (block, hessians) in blocks.iter_mut().zip(hessians.iter_mut()) {
        (block.vehicle, block.other, block.penalty) = (subject.vehicle, subject.other, Some(rows.penalty()));
        block.rows.resize_with(horizon, Default::default);
        hessians.resize(horizon, [0.0; 6]);
    }
    let mut room = [PoseExpansion::default(); MAX_ROWS_PER_STAGE];
    let expansions = &mut room[..blocks.len()];
    for stage in 0..horizon {
        rows.expand(stage, iterate, expansions);
        for ((block, hessians), expansion) in blocks.iter_mut().zip(hessians.iter_mut()).zip(&*expansions) {
            let row = &mut block.rows[stage];
            row.active = stage >= first && expansion.value < far_value;
            (row.value, row.gradient, row.curvature) = (expansion.value, expansion.gradient, [0.0; 6]);
            hessians[stage] = expansion.hessian;
        }
    }
}

/// Dynamics, boxes and changes of input of one vehicle.
fn pose_vehicle(
    participant: &Participant,
    problem: &Problem,
    vehicle: usize,
    iterate: &Iterate,
    stages: &mut VehicleStages,
) {
    let (states, inputs) = (&iterate.states[vehicle], &iterate.inputs[vehicle]);
    stages.first = participant.first();
    stages.jacobians.clear();
    stages.changes.clear();
    stages.input_boxes.clear();
    stages.speed_boxes.clear();
    stages.curvatures.clear();
    stages.curvatures.resize(problem.horizon, DynamicsCurvature::default());
    for k in 0..problem.horizon {
        let input = inputs[k].to_array();
        let bounds = [participant.acceleration_bounds_mps2(k), participant.steering_bounds_rad(k)];
        let within = |axis: usize| {
            let [lower, upper] = bounds[axis].map(|bound| bound - input[axis]);
            Interval { lower, upper }
        };
        stages.jacobians.push(participant.model.jacobian(&states[k], &inputs[k]));
        stages.changes.push(problem.input_change(vehicle, k, iterate));
        stages.input_boxes.push([within(0), within(1)]);
        let [slowest, fastest] = participant.speed_bounds(k + 1);
        let speed = states[k + 1].speed_mps;
        stages.speed_boxes.push(Interval { lower: slowest - speed, upper: fastest - speed });
    }
}

/// The costs of one vehicle's states and of its changes of input.
fn add_state_costs(
    problem: &Problem,
    vehicle: usize,
    iterate: &Iterate,
    stages: &mut VehicleStages,
    concave: &mut Vec<[f64; 3]>,
) {
    stages.change_weights = [0.0; 2];
    stages.state_costs.clear();
    stages.state_costs.resize(problem.horizon, StateCost::default());
    concave.clear();
    concave.resize(problem.horizon, [0.0; 3]);
    for term in &problem.terms {
        match term.shape() {
            Shape::InputChange(comfort) if comfort.vehicle == vehicle => {
                for (sum, weight) in stages.change_weights.iter_mut().zip(comfort.weights) {
                    *sum += weight;
                }
            }
            Shape::StateCost(cost) if cost.vehicle() == vehicle => {
                for (stage, (sum, concave)) in stages.state_costs.iter_mut().zip(concave.iter_mut()).enumerate() {
                    cost.add_expansion(stage, iterate, sum, concave);
                }
            }
            _ => {}
        }
    }
    add_turns(&problem.participants[vehicle], stages);
}

/// The cost of steering faster than the wheels turn, `w (c − m)²` where a change `c` is beyond the most `m` of its sign. With the weight
/// `r` of comfort, `r c² + w (c − m)²` is `(r + w) (c − w m/(r + w))²` and a constant.
fn add_turns(participant: &Participant, stages: &mut VehicleStages) {
    stages.turn_weights.clear();
    for (k, [_, change_rad]) in stages.changes.iter_mut().enumerate().skip(stages.first) {
        let excess_rad = participant.excess_turn_rad(k, *change_rad);
        if excess_rad != 0.0 {
            stages.turn_weights.resize(k, 0.0);
            stages.turn_weights.push(TURN_WEIGHT);
            *change_rad -= (*change_rad - excess_rad) * TURN_WEIGHT / (stages.change_weights[1] + TURN_WEIGHT);
        }
    }
}

fn fill_trajectory_rows(problem: &Problem, iterate: &Iterate, rows: &mut Vec<TrajectoryRow>) {
    let terms = || {
        problem.terms.iter().filter_map(|term| match term.shape() {
            Shape::Trajectory(term) => Some(term),
            _ => None,
        })
    };
    rows.resize_with(terms().count(), TrajectoryRow::default);
    for (term, row) in terms().zip(rows) {
        fill_trajectory_row(term, problem.horizon, iterate, row);
    }
}

fn fill_trajectory_row(term: &dyn TrajectoryTerm, horizon: usize, iterate: &Iterate, row: &mut TrajectoryRow) {
    let states = &iterate.states[term.vehicle()];
    (row.vehicle, row.value, row.penalty) = (term.vehicle(), term.excess(states), term.penalty());
    row.gradients.resize(horizon, [0.0; 3]);
    row.bends.resize(horizon, 0.0);
    term.expand(states, row);
}
