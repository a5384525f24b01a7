//! The cheapest inputs of a day whose disturbances are known.
//!
//! ```text
//! minimise    Σ W_e (r − T)² + W_u u² + c₁ s + c₂ s²                                      (eq. 3.2)
//! subject to  T = T_free + E y,   y(t+1) = A y(t) + B u(t),   y(0) = 0
//!             |u| ≤ limit,   |r − T| ≤ band + s while occupied,   s ≥ 0
//! ```
//!
//! With the actual disturbances this is the clairvoyant plan: no controller can be cheaper over the same day. The
//! regret of a controller is its cost minus this cost. With forecast disturbances it is the day-ahead plan, to which
//! the designs of chapters 3 to 5 reduce as printed. The states are variables (those of y, so that the rows have no
//! constants), which keeps the problem sparse; eliminating them would make it dense in G.

use interplay_convex::{Block, Program, Solver, SolverSettings, Variable, Variables};

use super::{ControlError, Disturbance};
use crate::comfort::Targets;
use crate::discretise::{DENSE_NODES, Discretisation, Model};
use crate::lifted::Lifted;
use crate::network::PowerLimits;

/// Tolerance of the solver, tighter than its default: inputs near a limit are accurate to about its square root only.
const SOLVER_TOLERANCE: f64 = 1e-10;

/// Cost of a kelvin beyond the comfort band while occupied.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BandPenalty {
    /// Cost c₁ per kelvin beyond the band and step.
    pub linear: f64,
    /// Cost c₂ per squared kelvin beyond the band and step.
    pub quadratic: f64,
}

/// The optimal inputs of a day with their temperatures and costs.
#[derive(Clone, Debug, PartialEq)]
pub struct DayOptimum {
    /// Inputs u(0) … u(N−1) \[kW\], stacked.
    pub heat_kw: Vec<f64>,
    /// Temperatures of the zones T(1) … T(N) under these inputs \[°C\], stacked.
    pub temperatures_c: Vec<f64>,
    /// Cost J (eq. 3.2) without the penalty of the comfort band.
    pub cost: f64,
    /// Objective: J with the penalty of the comfort band.
    pub objective: f64,
    /// Multipliers of the input limits: decrease of the objective per kilowatt of wider limits, stacked.
    pub limit_price: Vec<f64>,
}

/// The cheapest inputs for a day from the nodes' temperatures at midnight.
///
/// # Errors
/// [`ControlError`] if a series has the wrong length, the model is too large to have matrices, or the solver fails. The
/// problem itself always has a solution.
pub fn optimum(
    lifted: &Lifted,
    initial_c: &[f64],
    targets: &Targets,
    disturbance: &Disturbance,
    penalty: Option<BandPenalty>,
) -> Result<DayOptimum, ControlError> {
    let nodes = lifted.model().network().node_count();
    ControlError::check_length("the targets", targets.reference_c.len(), lifted.size())?;
    ControlError::check_length("the temperatures at midnight", initial_c.len(), nodes)?;
    disturbance.check(targets, lifted.model().network())?;
    let free_c = lifted.free_response(initial_c, &disturbance.ambient_c, &disturbance.gains_kw);
    plan(lifted, &free_c, targets, penalty, &ConstraintTightening::default())
}

/// The margin of an input is at most this share of its limit, so that the plan keeps some power.
const MAX_MARGIN_RATIO: f64 = 0.95;

/// By how much a plan keeps within the limits of the day.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct ConstraintTightening {
    /// Margin of the inputs to their limits \[kW\], stacked; none if empty. A limit keeps a share of itself in any case.
    pub input_margin_kw: Vec<f64>,
    /// Margin of the temperatures to the comfort band \[K\], stacked; none if empty.
    pub band_margin_k: Vec<f64>,
    /// A bound on the norm of the errors that have a weight (eq. 3.8).
    pub error_bound: Option<ErrorBound>,
}

/// Margins of the inputs to their limits \[kW\], for inputs with these standard deviations.
pub(super) fn margins_kw(input_deviation_kw: &[f64], quantile: f64) -> Vec<f64> {
    input_deviation_kw.iter().map(|deviation_kw| quantile * deviation_kw).collect()
}

/// ‖e‖₂ ≤ bound over the errors with a weight, per step and zone (eq. 3.8).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ErrorBound {
    /// The bound \[K\].
    pub norm_k: f64,
    /// Cost of a kelvin beyond it; without, the bound is hard and there may be no plan.
    pub slack_cost: Option<f64>,
}

/// Whether the day's optimum can be computed with this model.
///
/// # Errors
/// [`ControlError::TooLarge`] for an exact model without matrices.
pub(super) fn check_size(model: &Model) -> Result<(), ControlError> {
    let nodes = model.network().node_count();
    if model.method() == Discretisation::Exact && nodes > DENSE_NODES {
        return Err(ControlError::TooLarge { nodes, most: DENSE_NODES });
    }
    Ok(())
}

/// The cheapest inputs on top of known temperatures without equipment `free_c`.
pub(super) fn plan(
    lifted: &Lifted,
    free_c: &[f64],
    targets: &Targets,
    penalty: Option<BandPenalty>,
    tightening: &ConstraintTightening,
) -> Result<DayOptimum, ControlError> {
    let model = lifted.model();
    check_size(model)?;
    let posed = Posed::new(model, targets, free_c, penalty, tightening);
    let settings = SolverSettings { tolerance: SOLVER_TOLERANCE, ..SolverSettings::default() };
    let solution = Solver::new(&posed.program, &settings)?.solve()?;

    let mut heat_kw = solution.value(posed.input).to_vec();
    for (i, heat_kw) in heat_kw.iter_mut().enumerate() {
        *heat_kw = model.network().limits().limited(i % targets.zones, *heat_kw);
    }
    let temperatures_c: Vec<f64> =
        free_c.iter().zip(lifted.product(&heat_kw)).map(|(free_c, risen_k)| free_c + risen_k).collect();
    let cost = targets.cost(&temperatures_c, &heat_kw);
    let objective = cost + penalty.map_or(0.0, |penalty| penalty.evaluate(targets, &temperatures_c));
    let [most, least] = posed.limits.map(|block| solution.dual(block));
    let limit_price = most.iter().zip(least).map(|(most, least)| most + least).collect();
    Ok(DayOptimum { heat_kw, temperatures_c, cost, objective, limit_price })
}

impl BandPenalty {
    /// The cost of temperatures beyond the band while occupied.
    pub fn evaluate(self, targets: &Targets, temperatures_c: &[f64]) -> f64 {
        let beyond_k = |(i, temperature_c): (usize, &f64)| targets.beyond_k(i, *temperature_c);
        temperatures_c.iter().enumerate().map(beyond_k).map(|s| self.linear * s + self.quadratic * s * s).sum()
    }
}

/// The problem with the handles of its variables.
struct Posed {
    program: Program,
    /// u, stacked.
    input: Variables,
    /// y(1) … y(N), nodes of a time together.
    state: Variables,
    /// Rows of u ≤ limit, and of −u ≤ limit, stacked each.
    limits: [Block; 2],
}

impl Posed {
    fn new(
        model: &Model,
        targets: &Targets,
        free_c: &[f64],
        penalty: Option<BandPenalty>,
        tightening: &ConstraintTightening,
    ) -> Self {
        let mut program = Program::new();
        let input = program.variables("heat", free_c.len());
        let state = program.variables("state", model.network().node_count() * targets.steps());
        let limits = [program.at_most("heating limit"), program.at_most("cooling limit")];
        let mut posed = Self { program, input, state, limits };
        posed.costs(model, targets, free_c);
        posed.dynamics(model, targets.steps());
        posed.limits(model.network().limits(), &tightening.input_margin_kw);
        if let Some(penalty) = penalty {
            posed.band(model, targets, free_c, penalty, &tightening.band_margin_k);
        }
        if let Some(bound) = tightening.error_bound {
            posed.error_bound(model, targets, free_c, bound);
        }
        posed
    }

    /// The variable part of T(t + 1) of a zone: its node's y.
    fn risen(&self, model: &Model, zones: usize, i: usize) -> Variable {
        self.state.at(i / zones * model.network().node_count() + i % zones)
    }

    /// W_e (r − T_free − y)² + W_u u², up to a constant.
    fn costs(&mut self, model: &Model, targets: &Targets, free_c: &[f64]) {
        for (i, free_c) in free_c.iter().enumerate() {
            let (u, y) = (self.input.at(i), self.risen(model, targets.zones, i));
            self.program.quadratic(u, u, 2.0 * targets.input_weight[i]);
            self.program.quadratic(y, y, 2.0 * targets.error_weight[i]);
            self.program.linear(y, -2.0 * targets.error_weight[i] * (targets.reference_c[i] - free_c));
        }
    }

    /// y(t+1) = A y(t) + B u(t), without the entries of A and B that are zero.
    fn dynamics(&mut self, model: &Model, steps: usize) {
        let (a, b) = (model.state_matrix(), model.gain_matrix());
        let (nodes, zones) = b.shape();
        let rows = self.program.equal("dynamics");
        let nonzero = |row: nalgebra::DVector<f64>| -> Vec<(usize, f64)> {
            row.iter().copied().enumerate().filter(|(_, value)| *value != 0.0).collect()
        };
        let a: Vec<Vec<(usize, f64)>> = (0..nodes).map(|node| nonzero(a.row(node).transpose())).collect();
        let b: Vec<Vec<(usize, f64)>> = (0..nodes).map(|node| nonzero(b.row(node).transpose())).collect();
        for t in 0..steps {
            for node in 0..nodes {
                let after = [(self.state.at(t * nodes + node), 1.0)];
                let (state, input) = (self.state, self.input);
                let before = a[node].iter().filter(|_| t > 0).map(|&(j, a)| (state.at((t - 1) * nodes + j), -a));
                let driven = b[node].iter().map(|&(j, b)| (input.at(t * zones + j), -b));
                self.program.row(rows, after.into_iter().chain(before).chain(driven), 0.0);
            }
        }
    }

    /// −limit of cooling ≤ u ≤ limit of heating, less the margins.
    fn limits(&mut self, limits: &PowerLimits, margin_kw: &[f64]) {
        let [most, least] = self.limits;
        for (i, u) in self.input.iter().enumerate() {
            let margin_kw = margin_kw.get(i).copied().unwrap_or(0.0);
            let within = |limit_kw: f64| limit_kw - margin_kw.min(MAX_MARGIN_RATIO * limit_kw);
            let zone = i % limits.zones();
            self.program.row(most, [(u, 1.0)], within(limits.heating_kw[zone]));
            self.program.row(least, [(u, -1.0)], within(limits.cooling_kw[zone]));
        }
    }

    /// |r − T_free − y| ≤ band − margin + s, s ≥ 0 for the occupied times, at c₁ s + c₂ s².
    fn band(&mut self, model: &Model, targets: &Targets, free_c: &[f64], penalty: BandPenalty, margin_k: &[f64]) {
        let n = targets.zones;
        let occupied: Vec<usize> = (0..free_c.len()).filter(|&i| targets.occupied[i]).collect();
        let slack = self.program.variables("discomfort", occupied.len());
        let (warm, cold) = (self.program.at_most("too warm"), self.program.at_most("too cold"));
        let sign = self.program.at_most("discomfort is not negative");
        for (s, i) in slack.iter().zip(occupied) {
            let y = self.risen(model, n, i);
            let wanted_k = targets.reference_c[i] - free_c[i];
            let band_k = targets.band_k[i] - margin_k.get(i).copied().unwrap_or(0.0);
            self.program.row(warm, [(y, 1.0), (s, -1.0)], band_k + wanted_k);
            self.program.row(cold, [(y, -1.0), (s, -1.0)], band_k - wanted_k);
            self.program.row(sign, [(s, -1.0)], 0.0);
            self.program.linear(s, penalty.linear);
            self.program.quadratic(s, s, 2.0 * penalty.quadratic);
        }
    }

    /// ‖r − T_free − y‖ ≤ bound + s over the errors with a weight.
    fn error_bound(&mut self, model: &Model, targets: &Targets, free_c: &[f64], bound: ErrorBound) {
        let counted: Vec<usize> = (0..free_c.len()).filter(|&i| targets.error_weight[i] > 0.0).collect();
        let excess = bound.slack_cost.map(|cost| {
            let excess = self.program.variables("growth of the error", 1).at(0);
            self.program.linear(excess, cost);
            let sign = self.program.at_most("growth is not negative");
            self.program.row(sign, [(excess, -1.0)], 0.0);
            (excess, -1.0)
        });
        let cone = self.program.second_order("errors do not grow", counted.len() + 1);
        self.program.row(cone, excess, bound.norm_k);
        for i in counted {
            self.program.row(cone, [(self.risen(model, targets.zones, i), 1.0)], targets.reference_c[i] - free_c[i]);
        }
    }
}

/// About how many operations the sparse problem of a whole day takes: each step fills in a dense block of its zones.
pub(super) fn operations_of_optimum(zones: f64, steps: f64) -> f64 {
    15.0 * zones.powi(3) * steps
}
