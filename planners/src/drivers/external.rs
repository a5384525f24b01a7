//! A driver whose inputs come from outside: from a person at the wheel, from another program, from recorded data.
//!
//! It plans nothing itself. The caller of the simulation hands in an input for each tick; without one the vehicle cannot be driven.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::drivers::drive::{Drive, DriverKind};
use crate::prediction::Prediction;
use crate::scene::inferred_futures::InferredFutures;
use crate::{Plan, PlanError, PlanTime, Scene};

/// A driver whose inputs come from outside; it has no settings.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {}

impl DriverKind for Settings {
    fn kind(&self) -> &'static str {
        "external"
    }

    fn driver(&self) -> Box<dyn Drive> {
        Box::new(External)
    }

    fn plan_time(&self) -> PlanTime {
        PlanTime::SIMPLE
    }

    fn prediction(&self) -> Option<Prediction> {
        None
    }

    fn is_driven_from_outside(&self) -> bool {
        true
    }
}

/// The driver that is asked where no input has come from outside.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct External;

impl Drive for External {
    /// # Errors
    /// Always [`PlanError::NoInput`].
    fn plan(&mut self, _: &Scene, _: &InferredFutures) -> Result<Plan, PlanError> {
        Err(PlanError::NoInput)
    }

    fn fork(&self) -> Option<Box<dyn Drive>> {
        Some(Box::new(*self))
    }
}
