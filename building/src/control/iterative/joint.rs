//! Feedback and plan that share the limits of the inputs, found together.
//!
//! ```text
//! minimise    J(û) + tr(W_e G Y Σ Yᵀ Gᵀ) + tr(W_u (I − Y) Σ (I − Y)ᵀ)
//! subject to  |û_i| + q σ_i ≤ limit_i,      σ_i = ‖i-th row of (I − Y) L‖,   q = Φ⁻¹(η)      (eqs. 3.15, 3.18, 3.21)
//! ```
//!
//! is a second-order cone programme in about (nN)² unknowns. It need not be solved as such: at its solution, with
//! multipliers μ_i of the limits, the feedback is that of least expected cost with
//!
//! ```text
//! W_u + diag(μ_i q / (2 σ_i))      in place of      W_u
//! ```
//!
//! since the gradient of μ_i q σ_i with respect to the row is μ_i q / σ_i times the row. So the two are solved in turn: the
//! feedback by columns ([`super::feedback`]), then the plan within the remaining limits, whose damped multipliers are the
//! next prices. The problem is
//! convex, so a fixed point is its solution; the first round is the two-stage design, and the best round is kept.

use nalgebra::DMatrix;

use super::feedback::{Response, optimal_causal};
use crate::comfort::Targets;
use crate::control::optimum::{ConstraintTightening, margins_kw, plan};
use crate::control::{ControlError, DayOptimum};
use crate::lifted::Lifted;

/// Largest number of rounds; the best round so far is then kept. Chosen to bound the time of the design.
const MAX_ROUNDS: usize = 60;
/// The share of the new prices in those of the next round. Chosen: it damps prices that overshoot from round to round.
const NEW_PRICE_SHARE: f64 = 0.5;
/// The rounds end when the cost changes by at most this share of it. Chosen well above the accuracy of the plan's solver
/// (10⁻¹⁰).
const MAX_FINAL_COST_CHANGE_RATIO: f64 = 1e-7;
/// Standard deviations below this are treated as zero, and have no price \[kW\].
const LEAST_DEVIATION_KW: f64 = 1e-9;

/// Feedback and plan that are designed together.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// What is added to W_u for each input in the design of the feedback, stacked.
    pub price: Vec<f64>,
    /// The response under the feedback.
    pub response: Response,
    /// The plan of the day.
    pub plan: DayOptimum,
    /// The expected cost: that of the plan, and that added by the disturbance.
    pub cost: f64,
    /// The expected cost of the two-stage design.
    pub two_stage_cost: f64,
    /// Number of rounds of the design.
    pub rounds: usize,
}

/// Designs feedback and plan for the expected temperatures without equipment `free_c`, stacked. `factor` is L with Σ =
/// LLᵀ, and `quantile` is q.
///
/// # Errors
/// [`ControlError`] if W_u is zero or the solver fails.
pub fn design(
    lifted: &Lifted,
    targets: &Targets,
    free_c: &[f64],
    factor: &DMatrix<f64>,
    quantile: f64,
) -> Result<Joint, ControlError> {
    let round = |price: &[f64]| -> Result<(Joint, Vec<f64>), ControlError> {
        let response = optimal_causal(lifted, targets, factor, price)?;
        let deviation_kw = response.input_deviation_kw();
        let input_margin_kw = margins_kw(&deviation_kw, quantile);
        let tightening = ConstraintTightening { input_margin_kw, ..ConstraintTightening::default() };
        let plan = plan(lifted, free_c, targets, None, &tightening)?;
        let next = plan.limit_price.iter().zip(&deviation_kw).map(|(price, deviation_kw)| {
            if *deviation_kw > LEAST_DEVIATION_KW { price * quantile / (2.0 * deviation_kw) } else { 0.0 }
        });
        let (next, cost) = (next.collect(), plan.objective + response.cost(targets));
        Ok((Joint { price: price.to_vec(), response, plan, cost, two_stage_cost: cost, rounds: 1 }, next))
    };
    let mut price = vec![0.0; lifted.size()];
    let (mut best, mut next) = round(&price)?;
    let mut before = best.cost;
    for rounds in 2..=MAX_ROUNDS {
        for (price, next) in price.iter_mut().zip(&next) {
            *price += NEW_PRICE_SHARE * (next - *price);
        }
        let (found, wanted) = round(&price)?;
        next = wanted;
        let moved = (found.cost - before).abs();
        before = found.cost;
        let two_stage_cost = best.two_stage_cost;
        if found.cost < best.cost {
            best = found;
        }
        best = Joint { two_stage_cost, rounds, ..best };
        if moved <= MAX_FINAL_COST_CHANGE_RATIO * before {
            break;
        }
    }
    Ok(best)
}
