//! Errors of the export of a building as an FMU.

use interplay_building::discretise::ModelError;
use interplay_building::network::NetworkError;
use interplay_simulation::climate::BuildingError;
use thiserror::Error;

#[derive(Debug, Error)]
pub enum FmuError {
    /// The scenario has no building.
    #[error(
        "the scenario has no building; only buildings can be exported (`interplay list` shows scenarios of buildings)"
    )]
    NoBuilding,
    /// The building is simulated by another program.
    #[error(
        "`building.plant` of the scenario is another program; only a network can be exported: leave `building.plant` out"
    )]
    Foreign,
    /// The matrices would be too large.
    #[error("the network has {nodes} nodes (zones, and walls that store heat); an FMU has at most {limit}")]
    TooManyNodes {
        nodes: usize,
        /// Largest number that can be exported.
        limit: usize,
    },
    /// The weather would be too large.
    #[error("the weather has {numbers} numbers (steps times zones); an FMU has at most {limit}; lower `iterations`")]
    TooMuchWeather {
        /// Number of numbers of the weather.
        numbers: usize,
        /// Largest number that can be exported.
        limit: usize,
    },
    /// The compiler could not build the library for this system.
    #[error("this build of interplay has no FMU library: the compiler could not build it for {platform}")]
    NoLibrary { platform: String },
    /// The network is invalid.
    #[error("the building cannot be exported: {0}")]
    Network(#[from] NetworkError),
    /// The network has no discrete model.
    #[error("the building cannot be exported: {0}")]
    Model(#[from] ModelError),
    /// The weather of the building cannot be computed.
    #[error("the building cannot be exported: {0}")]
    Building(#[from] BuildingError),
}
