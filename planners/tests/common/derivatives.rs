//! One checker of derivatives for every cost and constraint.
//!
//! It compares the cost of a trajectory problem with the model that [`QpSubproblem`] makes of it, along a
//! direction `w` of the inputs. With the rows' multipliers set to the slopes of their penalties, the model's odd and even parts
//! must be the first and second derivatives of the cost:
//!
//! ```text
//! (J(u + εw) − J(u − εw))/2ε          →  first derivative along w
//! (J(u + εw) − 2J(u) + J(u − εw))/ε²  →  second derivative along w
//! ```

use interplay_planners::Input;
use interplay_planners::trajectory::{Iterate, Penalty, Problem, QpSubproblem, StageQp, StageSolution};

use super::SplitMix64;

/// Step of the differences.
const STEP: f64 = 1e-4;
const DIRECTIONS: usize = 8;

/// The largest first and second derivative met.
pub struct Seen {
    pub first: f64,
    pub second: f64,
}

/// Checks first and second derivatives of the cost of `problem` at `iterate` along random directions.
pub fn check(problem: &Problem, iterate: &Iterate, random: &mut SplitMix64) -> Seen {
    let exact = model(problem, iterate, true);
    let convex = model(problem, iterate, false);
    let mut seen = Seen { first: 0.0, second: 0.0 };
    for _ in 0..DIRECTIONS {
        let direction = direction(problem, random);
        let cost = |share: f64| problem.cost(&moved(problem, iterate, &direction, share)).total;
        let change = |qp: &StageQp, share: f64| qp.change(&deviation(qp, &direction, share));
        let here = cost(0.0);
        let parts = |up: f64, down: f64| [(up - down) / (2.0 * STEP), (up + down) / (STEP * STEP)];
        let [first, second] = parts(cost(STEP) - here, cost(-STEP) - here);
        let [model_first, model_second] = parts(change(&exact, STEP), change(&exact, -STEP));
        close("first", first, model_first, 1e-5);
        close("second", second, model_second, 1e-3);
        let [convex_first, convex_second] = parts(change(&convex, STEP), change(&convex, -STEP));
        close("first, Gauss-Newton", first, convex_first, 1e-5);
        assert!(convex_second >= -1e-6, "the Gauss-Newton model bends by {convex_second}");
        seen = Seen { first: seen.first.max(first.abs()), second: seen.second.max(second.abs()) };
    }
    seen
}

fn close(what: &str, numeric: f64, analytic: f64, tolerance: f64) {
    let bound = tolerance * (1.0 + numeric.abs().max(analytic.abs()));
    assert!((numeric - analytic).abs() <= bound, "{what} derivative: {numeric} by differences, {analytic} stated");
}

/// The QP subproblem at an iterate, with the exact Hessian or the Gauss-Newton one.
pub fn model(problem: &Problem, iterate: &Iterate, exact: bool) -> StageQp {
    let mut step = QpSubproblem::default();
    step.linearize(problem, iterate);
    if !exact {
        return step.qp;
    }
    let mut multipliers = StageSolution::default();
    multipliers.shape_like(&step.qp);
    for (multipliers, block) in multipliers.row_multipliers.iter_mut().zip(&step.qp.blocks) {
        for (multiplier, row) in multipliers.iter_mut().zip(&block.rows) {
            *multiplier = block.penalty.map_or(0.0, |penalty| slope(penalty, -row.value));
        }
    }
    for (multiplier, row) in multipliers.trajectory_multipliers.iter_mut().zip(&step.qp.trajectory_rows) {
        *multiplier = slope(row.penalty, row.value);
    }
    step.use_lagrangian(problem, iterate, &mut multipliers);
    step.qp
}

/// What one more unit of a violation costs.
fn slope(penalty: Penalty, violation: f64) -> f64 {
    if violation > 0.0 { penalty.linear + 2.0 * penalty.quadratic * violation } else { 0.0 }
}

/// Per vehicle and stage, a direction of the inputs.
fn direction(problem: &Problem, random: &mut SplitMix64) -> Vec<Vec<[f64; 2]>> {
    let stages = |first: usize, random: &mut SplitMix64| {
        let mut stage = |k: usize| {
            let w = [random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)];
            if k < first { [0.0; 2] } else { w }
        };
        (0..problem.horizon).map(&mut stage).collect()
    };
    problem.participants.iter().map(|participant| stages(participant.first(), random)).collect()
}

fn moved(problem: &Problem, iterate: &Iterate, direction: &[Vec<[f64; 2]>], share: f64) -> Iterate {
    let step = |(input, w): (&Input, &[f64; 2])| Input {
        acceleration_mps2: input.acceleration_mps2 + share * w[0],
        steering_rad: input.steering_rad + share * w[1],
    };
    let vehicles = iterate.inputs.iter().zip(direction);
    let inputs = vehicles.map(|(inputs, direction)| inputs.iter().zip(direction).map(step).collect()).collect();
    let mut moved = Iterate::of_inputs(inputs);
    problem.roll_out(&mut moved);
    moved
}

/// The deviation that a share of a direction is to the linearised dynamics.
fn deviation(qp: &StageQp, direction: &[Vec<[f64; 2]>], share: f64) -> StageSolution {
    let mut solution = StageSolution::default();
    solution.shape_like(qp);
    for (i, direction) in direction.iter().enumerate() {
        let mut state = [0.0; 4];
        for (k, w) in direction.iter().enumerate() {
            let input = w.map(|w| share * w);
            state = qp.vehicles[i].jacobians[k].apply(&state, &input);
            solution.inputs[i][k] = input;
            solution.states[i][k] = state;
        }
    }
    solution
}
