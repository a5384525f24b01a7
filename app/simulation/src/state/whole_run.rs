//! The cost of a building's whole run compared with the optimum.

use interplay_building::day::RunHistory;
use interplay_building::discretise::Model;
use serde::Serialize;

use crate::state::day::DayFigures;

/// A run compared with the cheapest one with perfect foresight of all days, the true model and the same final state; its serialisation
/// is part of the output contract.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct WholeRun {
    /// Cost J of the run.
    pub cost: f64,
    /// The least cost J.
    pub least_cost: f64,
    /// Cost minus the least cost.
    pub regret: f64,
    /// Discomfort of the run \[K·h per zone\].
    pub discomfort_k_h: f64,
    /// Cost of the run's electricity \[currency\]; none without a tariff. Without the demand charge.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub energy_cost: Option<f64>,
    /// The demand charge of the run \[currency\]; none without one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub demand_cost: Option<f64>,
    /// Least cost of electricity without discomfort \[currency\], without the demand charge of that run; none without a tariff.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub least_energy_cost: Option<f64>,
    /// The demand charge of the run with the least cost of both \[currency\]; none without a demand charge.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub least_demand_cost: Option<f64>,
    /// Unavoidable discomfort, which remains even in that run \[K·h per zone\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub least_discomfort_k_h: Option<f64>,
}

impl WholeRun {
    /// Computes the comparison from the days of a run; `None` if no optimum is found.
    pub fn compute(model: &Model, history: &RunHistory, days: &[DayFigures]) -> Option<Self> {
        if days.is_empty() {
            return None;
        }
        let cost: f64 = days.iter().map(|day| day.figures.cost).sum();
        let energy_cost: Option<f64> = days.iter().map(|day| day.figures.energy_cost).sum();
        let least_cost = history.least_cost(model).ok()?.cost;
        let cheapest = energy_cost.and_then(|_| history.least_money(model).ok());
        let demand_per_kw = history.demand_per_kw();
        let peak_kw = days.iter().map(|day| day.figures.electric_peak_kw).fold(0.0, f64::max);
        let charged = |cost: f64| (demand_per_kw > 0.0).then_some(cost);
        Some(Self {
            cost,
            least_cost,
            regret: cost - least_cost,
            discomfort_k_h: days.iter().map(|day| day.figures.discomfort_k_h).sum(),
            energy_cost,
            demand_cost: charged(demand_per_kw * peak_kw).filter(|_| energy_cost.is_some()),
            least_energy_cost: cheapest.as_ref().map(|cheapest| cheapest.energy_cost - cheapest.demand_cost),
            least_demand_cost: cheapest.as_ref().and_then(|cheapest| charged(cheapest.demand_cost)),
            least_discomfort_k_h: cheapest.as_ref().map(|cheapest| cheapest.discomfort_k_h),
        })
    }
}
