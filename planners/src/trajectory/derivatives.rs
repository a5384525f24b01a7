//! One checker of derivatives for every cost and constraint, those of another crate included.
//!
//! It compares the cost of a trajectory problem with the model that [`QpSubproblem`] makes of it, along a
//! direction `w` of the inputs. With the rows' multipliers set to the slopes of their penalties, the model's odd and even parts
//! must be the first and second derivatives of the cost:
//!
//! ```text
//! (J(u + εw) − J(u − εw))/2ε          →  first derivative along w, extrapolated from ε and ε/2
//! (J(u + εw) − 2J(u) + J(u − εw))/ε²  →  second derivative along w
//! ```

use interplay_common::random::SplitMix64;
use thiserror::Error;

use super::iterate::Iterate;
use super::penalty::Penalty;
use super::problem::Problem;
use super::sqp::QpSubproblem;
use super::stage::{StageQp, StageSolution};
use crate::Input;

/// Step of the differences.
const STEP: f64 = 1e-4;
/// How many directions are tried.
const DIRECTIONS: usize = 8;
/// How much of a first and of a second derivative may be missing, as a share of `1 +` its size: the error of the differences.
const TOLERANCES: [f64; 2] = [1e-5, 1e-3];
/// The most that a model may bend downward that must be convex: its rounding error.
const MAX_CONCAVITY: f64 = 1e-6;

/// The largest first and second derivative that were met: what was checked is more than zeros only if they are.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LargestDerivatives {
    /// Of first derivatives along a direction.
    pub first: f64,
    /// Of second derivatives along a direction.
    pub second: f64,
}

/// What is wrong with a stated derivative.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum DerivativeError {
    /// The stated derivative is not that of the values.
    #[error("the {which} derivative along a direction is {numeric} by differences and {stated} as stated")]
    Differs {
        /// Which one.
        which: &'static str,
        /// By differences of the cost.
        numeric: f64,
        /// As the terms state it.
        stated: f64,
    },
    /// Without what is said not to be convex, the model is not convex.
    #[error("the convex part of the stated Hessian bends by {0} along a direction, which must not be negative")]
    NotConvex(f64),
}

/// Checks the first and second derivatives that the terms of a problem state, at an iterate along eight random directions, every time the
/// same ones.
///
/// The states of the iterate are rolled out ([`Problem::start`]). Rows should not be within a ten-thousandth of their bound: there
/// the penalty has a kink.
///
/// # Errors
/// [`DerivativeError`] says which derivative is wrong.
pub fn check_derivatives(problem: &Problem, iterate: &Iterate) -> Result<LargestDerivatives, DerivativeError> {
    let (exact, convex) = (exact_model(problem, iterate), linearized(problem, iterate).qp);
    let mut largest = LargestDerivatives::default();
    let mut random = SplitMix64::new(0);
    for _ in 0..DIRECTIONS {
        let direction = direction(problem, &mut random);
        let cost = |share: f64| problem.cost(&moved(problem, iterate, &direction, share)).total;
        let change = |qp: &StageQp, share: f64| qp.change(&deviation(qp, &direction, share));
        let here = cost(0.0);
        let parts = |up: f64, down: f64| [(up - down) / (2.0 * STEP), (up + down) / (STEP * STEP)];
        let [wide, second] = parts(cost(STEP) - here, cost(-STEP) - here);
        let narrow = (cost(0.5 * STEP) - cost(-0.5 * STEP)) / STEP;
        // Richardson's extrapolation: what is left of the third derivative would be larger than a small first one.
        let numeric = [(4.0 * narrow - wide) / 3.0, second];
        let stated = parts(change(&exact, STEP), change(&exact, -STEP));
        let [convex_first, convex_second] = parts(change(&convex, STEP), change(&convex, -STEP));
        compare("first", numeric[0], stated[0], TOLERANCES[0])?;
        compare("second", numeric[1], stated[1], TOLERANCES[1])?;
        compare("first (Gauss-Newton)", numeric[0], convex_first, TOLERANCES[0])?;
        if convex_second < -MAX_CONCAVITY {
            return Err(DerivativeError::NotConvex(convex_second));
        }
        largest.first = largest.first.max(numeric[0].abs());
        largest.second = largest.second.max(numeric[1].abs());
    }
    Ok(largest)
}

fn compare(which: &'static str, numeric: f64, stated: f64, tolerance: f64) -> Result<(), DerivativeError> {
    let bound = tolerance * (1.0 + numeric.abs().max(stated.abs()));
    let is_close = (numeric - stated).abs() <= bound;
    if is_close { Ok(()) } else { Err(DerivativeError::Differs { which, numeric, stated }) }
}

/// The QP subproblem at an iterate with the exact Hessian of the cost, penalties included.
pub fn exact_model(problem: &Problem, iterate: &Iterate) -> StageQp {
    let mut step = linearized(problem, iterate);
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

/// The QP subproblem at an iterate with the Hessian of Gauss and Newton.
fn linearized(problem: &Problem, iterate: &Iterate) -> QpSubproblem {
    let mut step = QpSubproblem::default();
    step.linearize(problem, iterate);
    step
}

/// What one more unit of a violation costs.
fn slope(penalty: Penalty, violation: f64) -> f64 {
    if violation > 0.0 { penalty.linear + 2.0 * penalty.quadratic * violation } else { 0.0 }
}

/// Per vehicle and stage, a random direction of the inputs; zero where the inputs are known.
fn direction(problem: &Problem, random: &mut SplitMix64) -> Vec<Vec<[f64; 2]>> {
    let mut next = || random.uniform(-1.0, 1.0);
    let stages = problem.participants.iter().map(|participant| {
        let stage = |k: usize| if k < participant.first() { [0.0; 2] } else { [next(), next()] };
        (0..problem.horizon).map(stage).collect()
    });
    stages.collect()
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
