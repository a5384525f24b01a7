//! The result of a building's day: plain values, made by `measure`.

use interplay_building::control::Exchange;
use interplay_building::day::{Day, KeyFigures};
use interplay_building::discretise::Model;
use serde::Serialize;

use crate::state::worst_zones::WorstZones;

/// Readings of the electricity meter on a day; their serialisation is part of the output contract.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Metered {
    /// Electricity \[kWh\].
    pub electric_kwh: f64,
    /// Highest electric power, averaged as BOPTEST does \[kW\].
    pub electric_peak_kw: f64,
    /// Cost of the electricity \[currency\].
    pub electric_cost: f64,
}

/// The key figures of a day; their serialisation is part of the output contract.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct DayFigures {
    /// The key figures, as defined by BOPTEST.
    #[serde(flatten)]
    pub figures: KeyFigures,
    /// The zones with the worst figures.
    #[serde(skip)]
    pub worst_zones: WorstZones,
    /// Cost of the day minus that of the cheapest day with perfect foresight; `None` for large
    /// buildings.
    pub regret: Option<f64>,
    /// Heat supplied and removed before the first occupied time of the day \[kWh\].
    pub early_kwh: f64,
    /// Spectral radius, if it is known: of the learning from day to day, or of a designed feedback's closed loop.
    pub spectral_radius: Option<f64>,
    /// Whether the controller had no plan of its own and repeated the day before.
    pub fallback: bool,
    /// Accuracy of the predictions of the day, if another program simulates the building.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub day_ahead: Option<DayAheadErrors>,
    /// Readings of the electricity meter, if another program simulates the building and has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub metered: Option<Metered>,
    /// The exchange of zones that plan together.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub exchange: Option<ExchangeFigures>,
    /// Wall time of the controller: of planning at midnight and at every step, and of learning \[s\]; not reproducible.
    pub design_s: f64,
}

/// The exchange that led zones to a common plan; its serialisation is part of the output contract.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ExchangeFigures {
    /// Number of rounds of messages.
    pub rounds: usize,
    /// Messages sent to neighbours, all zones together; one has a number for each step of the day.
    pub messages: usize,
    /// Messages that did not arrive in their round.
    pub undelivered: usize,
    /// Predicted cost of the plan before the first round.
    pub first_cost: f64,
    /// Predicted cost of the plan after the last round.
    pub cost: f64,
    /// Whether no round increased the cost, up to rounding.
    pub never_rises: bool,
    /// Cost of the centralised plan, if it was computed for comparison.
    pub centralised_cost: Option<f64>,
}

impl ExchangeFigures {
    /// Relative increases below this are rounding errors.
    const COST_ROUNDING_SHARE: f64 = 1e-9;

    /// Summarises an exchange; `None` if even the first guess has no cost.
    pub fn sum_up(exchange: &Exchange) -> Option<Self> {
        let costs = &exchange.costs;
        Some(Self {
            rounds: costs.len().checked_sub(1)?,
            messages: exchange.messages.iter().sum(),
            undelivered: exchange.undelivered,
            first_cost: *costs.first()?,
            cost: *costs.last()?,
            never_rises: costs.windows(2).all(|pair| pair[1] <= pair[0] * (1.0 + Self::COST_ROUNDING_SHARE)),
            centralised_cost: exchange.centralised,
        })
    }
}

/// Prediction errors: differences between the prediction at midnight and the day, as root mean squares over zones and
/// steps \[K\]. Their serialisation is part of the output contract.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct DayAheadErrors {
    /// Error of the controller's model, from the temperatures at midnight, with the given heat and the forecast. It ignores
    /// learning and measurements during the day.
    pub model_rmse_c: f64,
    /// The same with the controller's learning before that day: its planned temperatures, plus the response of its model to
    /// the difference between the given and the planned heat. None without a plan.
    pub learned_rmse_c: Option<f64>,
    /// Error of the temperatures that the controller planned; none without a plan. The feedback of the day keeps them near the plan.
    pub plan_rmse_c: Option<f64>,
}

impl DayAheadErrors {
    /// The errors of a completed day. `believed` is the controller's model.
    pub fn compute(today: &Day, believed: &Model) -> Self {
        let (record, design) = (&today.record, &today.record.design);
        let rmse_c = |predicted_c: &[f64]| {
            let errors_k = predicted_c.iter().zip(&record.temperatures_c).map(|(p, t)| p - t);
            (errors_k.map(|error_k| error_k * error_k).sum::<f64>() / predicted_c.len().max(1) as f64).sqrt()
        };
        let given_c = predicted_c(today, believed, &record.heat_kw);
        let is_planned = !design.planned_c.is_empty();
        let learned_c = || {
            let planned_c = predicted_c(today, believed, &design.planned_kw);
            let differences_k = given_c.iter().zip(planned_c).map(|(given, planned)| given - planned);
            design.planned_c.iter().zip(differences_k).map(|(planned, k)| planned + k).collect::<Vec<f64>>()
        };
        Self {
            model_rmse_c: rmse_c(&given_c),
            learned_rmse_c: is_planned.then(|| rmse_c(&learned_c())),
            plan_rmse_c: is_planned.then(|| rmse_c(&design.planned_c)),
        }
    }
}

/// Temperatures of the zones that a model predicts for a day with this heat under the forecast \[°C\], stacked.
fn predicted_c(today: &Day, believed: &Model, heat_kw: &[f64]) -> Vec<f64> {
    let (zones, gained) = (believed.network().zone_count(), believed.network().gain_count());
    let mut nodes_c = today.initial_c.clone();
    let mut predicted_c = Vec::with_capacity(heat_kw.len());
    let inputs = heat_kw.chunks_exact(zones).zip(today.forecast.gains_kw.chunks_exact(gained));
    for ((heat_kw, gains_kw), ambient_c) in inputs.zip(&today.forecast.ambient_c) {
        believed.step(&mut nodes_c, heat_kw, *ambient_c, gains_kw);
        predicted_c.extend_from_slice(&nodes_c[..zones]);
    }
    predicted_c
}
