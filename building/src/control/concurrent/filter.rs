//! The design of the Youla filter Q with the least expected cost (eq. 4.27, corrected).
//!
//! As printed, Q does not enter the optimal cost at all, only its bounds, and the Q that a solver returns can be far worse
//! than Q = 0. Here Q minimises the expected cost under disturbances with their actual spectrum,
//!
//! ```text
//! ‖W_e^½ (I − GQ) G H‖² + ‖W_u^½ Q G H‖²             H: impulse responses of first-order noise, own and common
//! ```
//!
//! which is linear least squares in the taps, m n² numbers. The bounds are added when its solution violates them:
//!
//! ```text
//! Σ over a row of |Q_l|  ≤ γ_q,        ‖G (I − QG) α‖_F ≤ γ₂
//! ```
//!
//! γ₂ has a floor: a disturbance acts for one step before the feedback can respond, and this response alone has the norm ‖h₁‖_F.

use interplay_convex::{ConicSolution, Program, SolveError, Solver, SolverSettings, Variable, Variables};
use nalgebra::{Cholesky, DMatrix, DVector};

use super::settings::ConcurrentSettings;
use super::youla::{YoulaFilter, impulses};
use crate::comfort::Targets;
use crate::control::ControlError;
use crate::control::uncertainty::Uncertainty;
use crate::lifted::Lifted;
use crate::staged::dense::dot;

/// The largest number of entries of all taps that is designed.
const MOST_UNKNOWNS: usize = 1024;
/// Cost of the sum of the squares of all taps, which keeps the normal equations definite where a tap has no effect. It is taken
/// off the reported cost again.
const TAP_COST: f64 = 1e-9;
/// The largest number of inputs of a day: the covariance has the square of that many entries.
const MOST_INPUTS: usize = 2400;
/// The default of γ₂, as a multiple of ‖h₁‖.
const DEFAULT_GAMMA_2_RATIO: f64 = 4.6 / 3.6;
/// The default of γ₂ where no taps within γ_q satisfy that, as a multiple of the least that they do.
const GAMMA_2_ABOVE_FLOOR_RATIO: f64 = 1.02;

/// A designed Youla filter Q with its cost.
#[derive(Clone, Debug, PartialEq)]
pub struct FilterDesign {
    /// The filter Q.
    pub filter: YoulaFilter,
    /// The coloured H₂ cost: the expected cost of a day under random disturbances with the covariance Σ.
    pub cost: f64,
    /// The coloured H₂ cost without feedback.
    pub open_cost: f64,
}

/// How temperatures move with each entry of the taps, for some disturbances: t = t₀ + Σ θ_k t_k, and likewise inputs.
/// Entry (l, a, c) of the taps is θ at (l n + a) n + c.
struct Responses {
    /// t₀, all disturbances one after the other.
    open: Vec<f64>,
    temperatures: Vec<Vec<f64>>,
    inputs: Vec<Vec<f64>>,
}

impl Responses {
    fn new(lifted: &Lifted, disturbances: &DMatrix<f64>, taps: usize) -> Self {
        let (n, size, q) = (lifted.zones(), lifted.size(), disturbances.ncols());
        let open: Vec<f64> =
            (0..q).flat_map(|k| lifted.product(disturbances.column(k).clone_owned().as_slice())).collect();
        let mut temperatures = vec![Vec::new(); taps * n * n];
        let mut inputs = temperatures.clone();
        for a in 0..n {
            for c in 0..n {
                let (mut u, mut t) = (Vec::with_capacity(size * q), Vec::with_capacity(size * q));
                for y in open.chunks_exact(size) {
                    let mut input = vec![0.0; size];
                    for step in 1..lifted.steps() {
                        input[step * n + a] = -y[(step - 1) * n + c];
                    }
                    t.extend(lifted.product(&input));
                    u.extend(input);
                }
                // The response to a later tap is the same, delayed by the number of the tap.
                for l in 0..taps {
                    temperatures[(l * n + a) * n + c] = delayed(&t, size, l * n);
                    inputs[(l * n + a) * n + c] = delayed(&u, size, l * n);
                }
            }
        }
        Self { open, temperatures, inputs }
    }

    /// The cost as ½ θᵀ P θ + qᵀ θ + constant.
    fn cost(&self, error_weight: f64, input_weight: f64) -> (DMatrix<f64>, DVector<f64>, f64) {
        let count = self.temperatures.len();
        let mut gram = DMatrix::zeros(count, count);
        for j in 0..count {
            for i in 0..=j {
                let errors = error_weight * dot(&self.temperatures[i], &self.temperatures[j]);
                let value = 2.0 * (errors + input_weight * dot(&self.inputs[i], &self.inputs[j]));
                gram[(i, j)] = value;
                gram[(j, i)] = value;
            }
            gram[(j, j)] += 2.0 * TAP_COST;
        }
        let linear = DVector::from_fn(count, |i, _| 2.0 * error_weight * dot(&self.temperatures[i], &self.open));
        (gram, linear, error_weight * dot(&self.open, &self.open))
    }
}

fn delayed(series: &[f64], size: usize, by: usize) -> Vec<f64> {
    let mut out = vec![0.0; series.len()];
    for (out, series) in out.chunks_exact_mut(size).zip(series.chunks_exact(size)) {
        out[by.min(size)..].copy_from_slice(&series[..size - by.min(size)]);
    }
    out
}

/// The arithmetic mean; of equal values exactly their value.
fn mean(values: &[f64]) -> f64 {
    let first = values.first().copied().unwrap_or(0.0);
    first + values.iter().map(|value| value - first).sum::<f64>() / values.len().max(1) as f64
}

/// Refuses settings that no disturbance and no day can satisfy.
///
/// # Errors
/// [`ControlError::TooManyUnknowns`]; [`ControlError::BelowFloor`] if γ₂ is stated, and no Q within γ_q satisfies it.
pub(super) fn check(settings: &ConcurrentSettings, lifted: &Lifted) -> Result<(), ControlError> {
    let n = lifted.zones();
    for (found, most) in [(settings.taps * n * n, MOST_UNKNOWNS), (lifted.size(), MOST_INPUTS)] {
        if found > most {
            return Err(ControlError::TooManyUnknowns { design: "concurrent", found, most });
        }
    }
    let Some(value) = settings.gamma_2 else { return Ok(()) };
    let mut floor = lifted.product_norm_of_a_step();
    if value >= floor {
        floor = Robust::new(lifted, settings.taps).floor(n, settings.gamma_q)?;
    }
    if value < floor { Err(ControlError::BelowFloor { bound: "gamma_2", value, floor }) } else { Ok(()) }
}

/// Designs Q for the weights of the occupied steps and the mean weights of the inputs.
///
/// # Errors
/// [`ControlError::BelowFloor`] if no Q satisfies the bounds; [`ControlError::TooManyUnknowns`]; [`ControlError`] if the
/// solver fails.
pub fn design(
    settings: &ConcurrentSettings,
    lifted: &Lifted,
    targets: &Targets,
    uncertainty: &Uncertainty,
) -> Result<FilterDesign, ControlError> {
    let n = lifted.zones();
    let found = settings.taps * n * n;
    if found > MOST_UNKNOWNS {
        return Err(ControlError::TooManyUnknowns { design: "concurrent", found, most: MOST_UNKNOWNS });
    }
    let step_floor = lifted.product_norm_of_a_step();
    let gamma_2 = settings.gamma_2.unwrap_or(DEFAULT_GAMMA_2_RATIO * step_floor);
    if gamma_2 < step_floor {
        return Err(ControlError::BelowFloor { bound: "gamma_2", value: gamma_2, floor: step_floor });
    }
    let shaped = uncertainty.impulse_responses(n, lifted.steps());
    let error_weight = targets.error_weight.iter().copied().fold(0.0, f64::max);
    let responses = Responses::new(lifted, &shaped, settings.taps);
    let (gram, linear, constant) = responses.cost(error_weight, mean(&targets.input_weight));
    let free = Cholesky::new(gram.clone()).ok_or(ControlError::Covariance { order: found })?.solve(&-&linear);
    let mut filter = unstacked(free.as_slice(), n);
    let mut theta = free;
    if filter.row_norm() > settings.gamma_q || filter.impulse_norm(lifted) > gamma_2 {
        let within = |gamma_2: f64| bounded(settings, gamma_2, lifted, &gram, &linear);
        let bounded = match within(gamma_2) {
            Err(ControlError::BelowFloor { floor, .. }) if settings.gamma_2.is_none() => {
                within(GAMMA_2_ABOVE_FLOOR_RATIO * floor)
            }
            found => found,
        };
        theta = DVector::from_vec(bounded?);
        filter = unstacked(theta.as_slice(), n);
    }
    let mut curved = DVector::zeros(found);
    for (column, theta) in gram.column_iter().zip(&theta) {
        curved.axpy(*theta, &column, 1.0);
    }
    let cost = 0.5 * theta.dot(&curved) + linear.dot(&theta) + constant - TAP_COST * theta.norm_squared();
    Ok(FilterDesign { filter, cost, open_cost: constant })
}

/// Q from the stacked entries of its taps.
fn unstacked(theta: &[f64], n: usize) -> YoulaFilter {
    YoulaFilter(theta.chunks_exact(n * n).map(|tap| DMatrix::from_row_slice(n, n, tap)).collect())
}

/// The same cost within the bounds, or the floor of γ₂ under γ_q.
fn bounded(
    settings: &ConcurrentSettings,
    gamma_2: f64,
    lifted: &Lifted,
    gram: &DMatrix<f64>,
    linear: &DVector<f64>,
) -> Result<Vec<f64>, ControlError> {
    let robust = Robust::new(lifted, settings.taps);
    let mut program = Program::new();
    let theta = program.variables("taps", linear.len());
    for (j, second) in theta.iter().enumerate() {
        program.linear(second, linear[j]);
        for (i, first) in theta.iter().enumerate().take(j + 1) {
            program.quadratic(first, second, gram[(i, j)]);
        }
    }
    rows_within(&mut program, theta, lifted.zones(), settings.gamma_q);
    robust.within(&mut program, theta, gamma_2, None);
    match solved(&program) {
        Ok(solution) => Ok(solution.value(theta).to_vec()),
        Err(ControlError::Solve(SolveError::PrimalInfeasible { .. })) => {
            let floor = robust.floor(lifted.zones(), settings.gamma_q)?;
            Err(ControlError::BelowFloor { bound: "gamma_2", value: gamma_2, floor })
        }
        Err(other) => Err(other),
    }
}

fn solved(program: &Program) -> Result<ConicSolution, ControlError> {
    Ok(Solver::new(program, &SolverSettings::default())?.solve()?)
}

/// Σ over a row of the magnitudes of the taps ≤ γ_q.
fn rows_within(program: &mut Program, theta: Variables, n: usize, gamma_q: f64) {
    let size = program.variables("|taps|", theta.count());
    let (above, below, sums) =
        (program.at_most("upper side"), program.at_most("lower side"), program.at_most("gamma_q"));
    for (theta, size) in theta.iter().zip(size.iter()) {
        program.row(above, [(theta, 1.0), (size, -1.0)], 0.0);
        program.row(below, [(theta, -1.0), (size, -1.0)], 0.0);
    }
    for a in 0..n {
        let row = (0..theta.count()).filter(|k| k / n % n == a);
        program.row(sums, row.map(|k| (size.at(k), 1.0)), gamma_q);
    }
}

/// The norm ‖t₀ + Σ θ_k t_k‖ under impulses of heat, written as ‖R [θ; 1]‖ with R triangular.
struct Robust {
    triangular: DMatrix<f64>,
}

impl Robust {
    fn new(lifted: &Lifted, taps: usize) -> Self {
        let responses = Responses::new(lifted, &impulses(lifted), taps);
        let count = responses.temperatures.len();
        let mut stacked = DMatrix::zeros(responses.open.len().max(count + 1), count + 1);
        for (k, column) in responses.temperatures.iter().chain([&responses.open]).enumerate() {
            stacked.view_mut((0, k), (column.len(), 1)).copy_from_slice(column);
        }
        Self { triangular: stacked.qr().r() }
    }

    /// ‖R [θ; 1]‖ ≤ γ₂, or ≤ a variable.
    fn within(&self, program: &mut Program, theta: Variables, gamma_2: f64, variable: Option<Variable>) {
        let count = theta.count();
        let block = program.second_order("gamma_2", count + 2);
        program.row(block, variable.map(|variable| (variable, -1.0)), gamma_2);
        for i in 0..=count {
            let row = (i..count).map(|k| (theta.at(k), -self.triangular[(i, k)]));
            program.row(block, row, self.triangular[(i, count)]);
        }
    }

    /// The least γ₂ under a bound on the rows.
    fn floor(&self, n: usize, gamma_q: f64) -> Result<f64, ControlError> {
        let mut program = Program::new();
        let theta = program.variables("taps", self.triangular.ncols() - 1);
        let least = program.variables("gamma_2", 1).at(0);
        program.linear(least, 1.0);
        rows_within(&mut program, theta, n, gamma_q);
        self.within(&mut program, theta, 0.0, Some(least));
        Ok(solved(&program)?.at(least))
    }
}

impl Lifted {
    /// ‖h₁‖ in the Frobenius norm: the effect of an impulse of heat in each zone before the feedback can act \[K/kW\].
    fn product_norm_of_a_step(&self) -> f64 {
        let b = self.model().gain_matrix();
        b.view((0, 0), (self.zones(), self.zones())).norm()
    }
}
