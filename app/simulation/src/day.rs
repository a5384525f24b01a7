//! How a day of a building turned out: plain values, made by `measure`.

use interplay_building::control::Exchange;
use interplay_building::day::KeyFigures;
use serde::Serialize;

use crate::worst_zones::WorstZones;

/// The key figures of a day; their serialisation is part of the output contract.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct DayFigures {
    /// The key figures, as defined by BOPTEST.
    #[serde(flatten)]
    pub figures: KeyFigures,
    /// The zones that did worst.
    #[serde(skip)]
    pub worst_zones: WorstZones,
    /// How much dearer the day was than the cheapest one that knows everything beforehand; not for large buildings.
    pub regret: Option<f64>,
    /// Heat brought in and taken out before the first occupied time of the day \[kWh\].
    pub early_kwh: f64,
    /// Spectral radius where it is known: of the learning from day to day, or of a designed feedback's closed loop.
    pub spectral_radius: Option<f64>,
    /// Whether the controller had no plan of its own and repeated the day before.
    pub fallback: bool,
    /// How zones that plan together came to their plan.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub exchange: Option<ExchangeFigures>,
    /// Wall time of planning and learning \[s\]; not reproducible.
    pub design_s: f64,
}

/// How zones came to a common plan; its serialisation is part of the output contract.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ExchangeFigures {
    /// Rounds of messages.
    pub rounds: usize,
    /// Messages sent to neighbours, all zones together; one has a number for each step of the day.
    pub messages: usize,
    /// Messages that did not arrive in their round.
    pub undelivered: usize,
    /// What the plan was expected to cost before the first round.
    pub first_cost: f64,
    /// The same after the last.
    pub cost: f64,
    /// Whether no round made it dearer, but for rounding.
    pub never_rises: bool,
    /// What the centralised plan would have cost, if that was asked for.
    pub centralised_cost: Option<f64>,
}

impl ExchangeFigures {
    /// A rise by less than this share is rounding.
    const COST_ROUNDING_SHARE: f64 = 1e-9;

    /// Sums an exchange up; `None` if not even the first guess has a cost.
    pub fn of(exchange: &Exchange) -> Option<Self> {
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
