//! A controller that knows the disturbances of the day in advance. It is the reference for the cost of the other controllers.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::interface::ControllerKind;
use super::optimum::{check_size, operations_of_optimum, optimum};
use super::{Control, ControlError, DayAhead, Observation};
use crate::discretise::Model;
use crate::lifted::Lifted;

/// The clairvoyant controller has no settings.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ClairvoyantSettings {}

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

impl ControllerKind for ClairvoyantSettings {
    fn kind(&self) -> &'static str {
        "clairvoyant"
    }

    fn look_for(&self) -> &'static str {
        "it knows the day in advance and cools before people come; no controller is cheaper on that day alone"
    }

    fn controller(&self, model: &Model, steps: usize) -> Result<Box<dyn Control>, ControlError> {
        check_size(model)?;
        Ok(Box::new(Clairvoyant::new(Lifted::new(model, steps))))
    }

    fn operations_per_day(&self, zones: f64, steps: f64) -> f64 {
        operations_of_optimum(zones, steps)
    }
}

impl Control for Clairvoyant {
    fn start_of_day(&mut self, day_ahead: &DayAhead<'_>) -> Result<(), ControlError> {
        let actual = day_ahead.actual.ok_or(ControlError::NotClairvoyant)?;
        self.planned_kw = {
            let targets = day_ahead.targets.under(&actual.ambient_c);
            optimum(&self.lifted, day_ahead.initial_c, &targets, actual, None)?.heat_kw
        };
        Ok(())
    }

    fn act(&mut self, observation: &Observation<'_>) -> Vec<f64> {
        let n = self.lifted.zones();
        self.planned_kw[observation.step * n..(observation.step + 1) * n].to_vec()
    }

    fn fork(&self) -> Option<Box<dyn Control>> {
        Some(Box::new(self.clone()))
    }
}
