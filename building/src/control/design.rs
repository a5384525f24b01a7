//! What a controller says of its plan for a day.

use super::ControlError;

/// How a day was planned. Controllers that do not plan say nothing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Design {
    /// Why the day has no plan of its own; it then repeats the day before (Remark 1 of chapter 3).
    pub fallback: Option<ControlError>,
    /// How many days had none so far.
    pub fallbacks: usize,
    /// Planned inputs \[kW\], stacked; empty on a day without a plan.
    pub planned_kw: Vec<f64>,
    /// Temperatures expected under them \[°C\], stacked.
    pub planned_c: Vec<f64>,
    /// What the plan is expected to cost, with penalties.
    pub objective: Option<f64>,
    /// Heat that earlier days had beyond their forecasts, as far as it is believed to return \[kW\], stacked.
    pub bias_kw: Vec<f64>,
    /// K, by rows \[kW/K\], of a static feedback.
    pub gain_kw_per_k: Vec<Vec<f64>>,
    /// Taps of Q, each by rows \[kW/K\], of a Youla-parametrised feedback.
    pub taps_kw_per_k: Vec<Vec<Vec<f64>>>,
    /// Of A − BK for a static feedback; of the learning law for the distributed design: below one it settles in the end.
    pub spectral_radius: Option<f64>,
    /// Of the learning law: at most one, errors never grow from day to day.
    pub largest_singular_value: Option<f64>,
    /// How the zones came to their plan.
    pub exchange: Option<Exchange>,
}

/// How zones that only speak with their neighbours came to a plan.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Exchange {
    /// J before the first round and after each.
    pub costs: Vec<f64>,
    /// J of the centralised optimum, when it was asked for.
    pub centralised: Option<f64>,
    /// Messages that each zone sent to neighbours; a message is one number for each step of the day.
    pub messages: Vec<usize>,
    /// Messages that did not arrive in their round.
    pub undelivered: usize,
    /// Sums over all zones that were formed on the way, for step lengths.
    pub sums: usize,
}
