//! Why a scenario cannot be exported.

use interplay_building::discretise::ModelError;
use interplay_building::network::NetworkError;
use interplay_simulation::climate::BuildingError;
use thiserror::Error;

/// Why a scenario cannot be exported.
#[derive(Debug, Error)]
pub enum FmuError {
    /// There is nothing to export.
    #[error(
        "the scenario has no building; an FMU is that of a building (`interplay list` shows scenarios of buildings)"
    )]
    NoBuilding,
    /// The building is another program.
    #[error(
        "`building.plant` of the scenario is another program; only a network can be exported: leave `building.plant` out"
    )]
    Foreign,
    /// The matrices would be too large.
    #[error("the network has {nodes} nodes (zones, and walls that store heat); an FMU has at most {limit}")]
    TooManyNodes {
        /// How many nodes there are.
        nodes: usize,
        /// The most.
        limit: usize,
    },
    /// The weather would be too large.
    #[error(
        "{numbers} numbers of weather and people (steps times zones) are more than the {limit} of an FMU; lower `iterations`"
    )]
    TooMuchWeather {
        /// How many numbers there are.
        numbers: usize,
        /// The most.
        limit: usize,
    },
    /// The compiler made no library for this system.
    #[error("this build of interplay has no FMU library: the compiler made none for {platform}, as its warnings said")]
    NoLibrary {
        /// The system.
        platform: String,
    },
    /// The network makes no sense.
    #[error("the building cannot be exported: {0}")]
    Network(#[from] NetworkError),
    /// The network has no discrete form.
    #[error("the building cannot be exported: {0}")]
    Model(#[from] ModelError),
    /// What acts on the building is unknown.
    #[error("the building cannot be exported: {0}")]
    Building(#[from] BuildingError),
}
