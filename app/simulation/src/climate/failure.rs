//! Errors that end the run of a building.

use interplay_building::control::ControlError;
use thiserror::Error;

use crate::plants::PlantError;

/// Why the run of a building cannot continue.
#[derive(Debug, Error)]
pub enum BuildingFailure {
    /// The controller failed.
    #[error("the controller of the building gave up: {0}")]
    Control(#[from] ControlError),
    /// The program that simulates the building did not answer as agreed.
    #[error(transparent)]
    Plant(#[from] PlantError),
}
