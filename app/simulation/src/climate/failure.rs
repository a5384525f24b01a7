//! Why the run of a building cannot go on.

use interplay_building::control::ControlError;
use thiserror::Error;

use crate::plants::PlantError;

/// Why the run of a building cannot go on.
#[derive(Debug, Error)]
pub enum BuildingFailure {
    /// The controller gave up.
    #[error("the controller of the building gave up: {0}")]
    Control(#[from] ControlError),
    /// The program that is the building did not answer as agreed.
    #[error(transparent)]
    Plant(#[from] PlantError),
}
