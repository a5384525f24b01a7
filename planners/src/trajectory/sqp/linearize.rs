//! From the trajectory problem at an iterate to a quadratic programme in stage form.
//!
//! First derivatives are exact, and so are second derivatives of the cost where it is convex. The curvature of
//! dynamics, rows and concave costs enters only when multipliers of a previous step are given (the exact Hessian of the Lagrangian);
//! without them the step is Gauss-Newton.

use crate::trajectory::penalty::Penalty;
use crate::trajectory::problem::{Iterate, Leaning, Participant, Problem};
use crate::trajectory::stage::costates;
use crate::trajectory::stage::{Interval, Row, RowBlock, StageQp, StageSolution, TrajectoryRow, VehicleStages};
use crate::vehicle::DynamicsCurvature;
use crate::{Axes, State};

/// Tolerance of an ordinary step problem.
pub(super) const TOLERANCE: f64 = 1e-9;
/// Blocks of rows that keep a vehicle on its road.
const CORNERS: usize = 4;
/// Beyond this squared elliptical distance an ellipse is left out of the step: the merit still counts it.
const FAR_SQUARED: f64 = 25.0;

/// Fills `qp` with the Gauss-Newton step problem of `problem` at `iterate` (whose states obey the dynamics).
pub fn linearise(problem: &Problem, iterate: &Iterate, qp: &mut StageQp) {
    qp.horizon = problem.horizon;
    qp.damping = 0.0;
    qp.tolerance = TOLERANCE;
    qp.reach = None;
    qp.vehicles.resize_with(problem.participants.len(), VehicleStages::default);
    for (i, participant) in problem.participants.iter().enumerate() {
        linearise_vehicle(participant, problem.horizon, i, iterate, &mut qp.vehicles[i]);
    }
    fill_blocks(problem, iterate, qp);
    fill_trajectory_rows(problem, iterate, &mut qp.trajectory_rows);
}

/// Adds the exact curvature of dynamics and rows, weighted with the multipliers of an earlier step, to a problem that
/// [`linearise`] has just filled.
pub fn add_curvature(problem: &Problem, iterate: &Iterate, multipliers: &mut StageSolution, qp: &mut StageQp) {
    multipliers.rest();
    let costates = costates(qp, multipliers);
    for (i, participant) in problem.participants.iter().enumerate() {
        let stages = &mut qp.vehicles[i];
        for k in stages.first..qp.horizon {
            let (state, input) = (&iterate.states[i][k], &iterate.inputs[i][k]);
            stages.curvatures[k] = participant.model.curvature(state, input, &costates[i][k]);
        }
    }
    for (block, multipliers) in qp.blocks.iter_mut().zip(&multipliers.row_multipliers) {
        for (row, multiplier) in block.rows.iter_mut().zip(multipliers) {
            // `Row::curvature` holds ∇²c until here.
            row.curvature = row.curvature.map(|bend| -multiplier * bend);
        }
    }
}

/// Moves the rows so that at the step's deviations they have the values they really have at `trial`: the second-order
/// correction. Gradients and costs stay those of the iterate.
pub fn move_rows(problem: &Problem, trial: &Iterate, step: &StageSolution, qp: &mut StageQp) {
    let mut blocks = std::mem::take(&mut qp.blocks).into_iter();
    let mut moved = Vec::with_capacity(blocks.len());
    for_each_block(problem, trial, |vehicle, other, penalty, rows| {
        let Some(mut block) = blocks.next() else { return };
        debug_assert!(block.vehicle == vehicle && block.other == other && block.penalty == Some(penalty));
        for (k, (row, there)) in block.rows.iter_mut().zip(rows).enumerate() {
            let own = step.states[vehicle][k];
            let origin = other.map_or([0.0; 4], |other| step.states[other][k]);
            let [x, y, turn] = row.gradient;
            row.value = there.value - (x * (own[0] - origin[0]) + y * (own[1] - origin[1]) + turn * own[2]);
        }
        moved.push(block);
    });
    qp.blocks = moved;
}

/// Sets every curvature to zero, which makes the step Gauss-Newton (and convex).
pub fn drop_curvature(qp: &mut StageQp) {
    for stages in &mut qp.vehicles {
        stages.curvatures.fill(DynamicsCurvature::default());
        stages.state_costs.iter_mut().for_each(|cost| cost.curvature = [0.0; 3]);
    }
    for block in &mut qp.blocks {
        for row in &mut block.rows {
            row.curvature = [0.0; 4];
        }
    }
}

fn linearise_vehicle(
    participant: &Participant,
    horizon: usize,
    index: usize,
    iterate: &Iterate,
    stages: &mut VehicleStages,
) {
    let (states, inputs) = (&iterate.states[index], &iterate.inputs[index]);
    let limits = &participant.limits;
    stages.first = participant.first();
    stages.change_weights = participant.comfort;
    stages.jacobians.clear();
    stages.state_costs.clear();
    stages.changes.clear();
    stages.input_boxes.clear();
    stages.speed_boxes.clear();
    stages.curvatures.clear();
    stages.curvatures.resize(horizon, DynamicsCurvature::default());
    let mut previous = participant.previous_input.to_array();
    for k in 0..horizon {
        let input = inputs[k].to_array();
        stages.jacobians.push(participant.model.jacobian(&states[k], &inputs[k]));
        let mut cost = participant.tracking.cost(k, &states[k + 1]);
        for distance_cost in &participant.distance_costs {
            distance_cost.add_to(k, states[k + 1].position(), &mut cost);
        }
        stages.state_costs.push(cost);
        stages.changes.push([input[0] - previous[0], input[1] - previous[1]]);
        previous = input;
        stages.input_boxes.push([
            Interval { lower: limits.acceleration_min_mps2 - input[0], upper: limits.acceleration_max_mps2 - input[0] },
            Interval { lower: -limits.steering_max_rad - input[1], upper: limits.steering_max_rad - input[1] },
        ]);
        let [slowest, fastest] = participant.speed_bounds(k + 1);
        stages
            .speed_boxes
            .push(Interval { lower: slowest - states[k + 1].speed_mps, upper: fastest - states[k + 1].speed_mps });
    }
}

/// One block for each corner and keep-out of each participant, then one for each separation.
fn fill_blocks(problem: &Problem, iterate: &Iterate, qp: &mut StageQp) {
    let mut blocks = std::mem::take(&mut qp.blocks).into_iter();
    let mut filled = Vec::with_capacity(blocks.len());
    for_each_block(problem, iterate, |vehicle, other, penalty, new| {
        let mut rows = blocks.next().map(|block: RowBlock| block.rows).unwrap_or_default();
        rows.clear();
        rows.extend(new);
        filled.push(RowBlock { vehicle, other, penalty: Some(penalty), rows });
    });
    qp.blocks = filled;
}

/// Hands over vehicle, other vehicle, penalty and rows of every block at an iterate.
fn for_each_block(
    problem: &Problem,
    iterate: &Iterate,
    mut take: impl FnMut(usize, Option<usize>, Penalty, &mut dyn Iterator<Item = Row>),
) {
    for (i, participant) in problem.participants.iter().enumerate() {
        let states = &iterate.states[i][1..];
        let mut corners: [Vec<Row>; CORNERS] = Default::default();
        for (k, state) in states.iter().enumerate() {
            let clearances = participant.corridor.clearances(&participant.body, state);
            for (rows, c) in corners.iter_mut().zip(clearances) {
                let active = k >= participant.first();
                rows.push(Row { active, value: c.value, gradient: c.gradient, curvature: c.curvature });
            }
        }
        for rows in corners {
            take(i, None, Penalty::EXACT, &mut rows.into_iter());
        }
        for keep_out in &participant.keep_outs {
            let [xx, xy, yy] = keep_out.ellipse.oriented(keep_out.heading_rad).hessian();
            let rows = states.iter().zip(&keep_out.centres).map(|(state, centre)| {
                let d = keep_out.ellipse.oriented(keep_out.heading_rad).distance(state.position(), *centre);
                ellipse_row(d.squared, d.gradient, [xx, xy, yy, 0.0])
            });
            take(i, None, keep_out.penalty, &mut { rows });
        }
    }
    for pair in &problem.separations {
        let [xx, xy, yy] = pair.ellipse.oriented(pair.heading_rad).hessian();
        let states = iterate.states[pair.of][1..].iter().zip(&iterate.states[pair.from][1..]);
        let rows = states.map(|(of, from)| {
            let d = pair.ellipse.oriented(pair.heading_rad).distance(of.position(), from.position());
            ellipse_row(d.squared, d.gradient, [xx, xy, yy, 0.0])
        });
        take(pair.of, Some(pair.from), pair.penalty, &mut { rows });
    }
}

/// Index of the block and axes of every ellipse, in the order of [`for_each_block`].
pub(super) fn ellipses(problem: &Problem) -> Vec<(usize, Axes)> {
    let own = problem.participants.iter().flat_map(|participant| {
        let keep_outs = participant.keep_outs.iter().map(|keep_out| Some(keep_out.heading_rad));
        [None; CORNERS].into_iter().chain(keep_outs)
    });
    let pairs = problem.separations.iter().map(|pair| Some(pair.heading_rad));
    let blocks = own.chain(pairs).enumerate();
    blocks.filter_map(|(block, heading)| Some((block, Axes::along(heading?)))).collect()
}

fn ellipse_row(squared: f64, [x, y]: [f64; 2], curvature: [f64; 4]) -> Row {
    Row { active: squared < FAR_SQUARED, value: squared - 1.0, gradient: [x, y, 0.0], curvature }
}

/// The persuasion row, then those of mean speeds.
fn fill_trajectory_rows(problem: &Problem, iterate: &Iterate, rows: &mut Vec<TrajectoryRow>) {
    let old = rows.drain(..).next();
    rows.extend(problem.leaning.as_ref().map(|leaning| leaning_row(leaning, &iterate.states[0], old)));
    for (vehicle, participant) in problem.participants.iter().enumerate() {
        let bounds = participant.mean_speed.iter();
        rows.extend(bounds.flat_map(|bound| bound.rows(vehicle, &iterate.states[vehicle])));
    }
}

/// The persuasion constraint is quadratic in the positions, so it is exact here:
/// `α‖p − toward‖² − ‖p − away‖²` has gradient `2(α(p − toward) − (p − away))` and `β = α − 1`.
fn leaning_row(leaning: &Leaning, states: &[State], old: Option<TrajectoryRow>) -> TrajectoryRow {
    let (mut gradients, mut bends) = old.map(|row| (row.gradients, row.bends)).unwrap_or_default();
    gradients.clear();
    bends.clear();
    for (t, state) in states.iter().enumerate().skip(1) {
        let references = leaning.toward.get(t).zip(leaning.away.get(t));
        let (gradient, bend) = references.map_or(([0.0; 3], 0.0), |(toward, away)| {
            let p = state.position();
            let slope = |i: usize| 2.0 * (leaning.strength * (p[i] - toward[i]) - (p[i] - away[i]));
            ([slope(0), slope(1), 0.0], leaning.strength - 1.0)
        });
        gradients.push(gradient);
        bends.push(bend);
    }
    TrajectoryRow { vehicle: 0, value: leaning.value(states), gradients, bends, penalty: leaning.penalty }
}

/// Leaves a share of every curvature.
pub fn soften_curvature(qp: &mut StageQp, share: f64) {
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
