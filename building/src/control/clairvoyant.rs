//! A controller that knows the disturbances of the day in advance. The cost of the other controllers is compared with its.

use super::{Control, ControlError, DayAhead, DayRecord, Observation, optimum};
use crate::lifted::Lifted;

/// What to look for in a recording of a building with this controller.
pub(super) const LOOK_FOR: &str =
    "knowing the day beforehand, it cools before people come; no controller can be cheaper";

/// Applies the optimum of the day under its actual disturbances.
#[derive(Clone, Debug)]
pub struct Clairvoyant {
    lifted: Lifted,
    planned_kw: Vec<f64>,
}

impl Clairvoyant {
    /// A clairvoyant controller whose model of a day is `lifted`.
    pub fn new(lifted: Lifted) -> Self {
        let planned_kw = vec![0.0; lifted.size()];
        Self { lifted, planned_kw }
    }
}

impl Control for Clairvoyant {
    fn start_of_day(&mut self, day_ahead: &DayAhead<'_>) -> Result<(), ControlError> {
        let actual = day_ahead.actual.ok_or(ControlError::NotClairvoyant)?;
        self.planned_kw = optimum(&self.lifted, day_ahead.initial_c, day_ahead.targets, actual, None)?.heat_kw;
        Ok(())
    }

    fn act(&mut self, observation: &Observation<'_>) -> Vec<f64> {
        let n = self.lifted.zones();
        self.planned_kw[observation.step * n..(observation.step + 1) * n].to_vec()
    }

    fn end_of_day(&mut self, _: &DayRecord) -> Result<(), ControlError> {
        Ok(())
    }
}
