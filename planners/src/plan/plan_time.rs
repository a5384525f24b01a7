//! How long a plan takes, roughly: what a check of a scenario counts before anything is run.

use crate::trajectory::HomotopySearch;

/// Processor time of a plan, on one core of the reference machine, an AMD EPYC at 2.6 GHz.
///
/// Measured on random runs, most of which take between a third of this time and three times as long; `tests/peers/plan_times.py` compares
/// it with other runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanTime {
    /// A plan of 30 stages without other vehicles near \[s\].
    pub alone_s: f64,
    /// By which share of that each other vehicle near makes it longer.
    pub share_of_each_other: f64,
}

impl PlanTime {
    /// Of a driver that does not optimise.
    pub const SIMPLE: PlanTime = PlanTime { alone_s: 25e-6, share_of_each_other: 0.0 };
    /// Of a driver of which nothing is known: it is taken for one that optimises.
    pub const UNKNOWN: PlanTime = PlanTime { alone_s: 1e-3, share_of_each_other: 0.0 };

    /// The same for a driver that looks for passing orders in this way: a global search tries all of them.
    #[must_use]
    pub fn searching(self, passing_orders: HomotopySearch) -> PlanTime {
        const GLOBAL_SEARCH_FACTOR: f64 = 1000.0;
        match passing_orders {
            HomotopySearch::Global => PlanTime { alone_s: GLOBAL_SEARCH_FACTOR * self.alone_s, ..self },
            HomotopySearch::Off | HomotopySearch::Classes => self,
        }
    }
}
