//! The description of a controller's plan for a day.

use super::ControlError;

/// How a controller planned a day. Controllers that do not plan leave it empty.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Design {
    /// Why no plan was found for the day, which then repeats the inputs of the day before (Remark 1 of chapter 3), or for a step,
    /// which then follows the plan before it.
    pub fallback: Option<ControlError>,
    /// For how many days so far no plan was found.
    pub fallbacks: usize,
    /// Why the feedback is certified less well than was asked for.
    pub weaker_feedback: Option<ControlError>,
    /// Planned inputs \[kW\], stacked; empty on a day without a plan.
    pub planned_kw: Vec<f64>,
    /// Temperatures that are expected under the planned inputs \[°C\], stacked.
    pub planned_c: Vec<f64>,
    /// What the plan is expected to cost, with penalties.
    pub objective: Option<f64>,
    /// The learned bias of the forecast: zone heat that is expected beyond it \[kW\], stacked.
    pub bias_kw: Vec<f64>,
    /// Gain K of a static feedback, by rows \[kW/K\].
    pub gain_kw_per_k: Vec<Vec<f64>>,
    /// Taps of the filter Q of a Youla-parametrised feedback, each by rows \[kW/K\].
    pub taps_kw_per_k: Vec<Vec<Vec<f64>>>,
    /// Spectral radius of A − BK for a static feedback, of the learning law for the distributed design; below one it converges.
    pub spectral_radius: Option<f64>,
    /// Largest singular value of the learning law; at most one, errors never grow from one day to the next.
    pub largest_singular_value: Option<f64>,
    /// How zones agreed on the plan, if they planned by messages.
    pub exchange: Option<Exchange>,
}

/// The exchange of messages in which zones agreed on a plan.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Exchange {
    /// Cost J before the first round and after each.
    pub costs: Vec<f64>,
    /// Cost J of the centralised optimum, if it was computed for comparison.
    pub centralised: Option<f64>,
    /// Messages that each zone sent to neighbours; a message is one number for each step of the day, and one that
    /// is sent again counts again.
    pub messages: Vec<usize>,
    /// Messages that were lost, each time that they were sent, and those that did not arrive in their round.
    pub undelivered: usize,
    /// Number of sums over all zones that the step lengths needed.
    pub sums: usize,
}
