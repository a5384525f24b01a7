//! Why a scenario cannot be exported.

use interplay_building::discretise::ModelError;
use interplay_building::network::NetworkError;
use interplay_simulation::climate::BuildingError;
use thiserror::Error;

/// Why a scenario cannot be exported.
#[derive(Debug, Error)]
pub enum FmuError {
    /// The scenario has no building.
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
        /// Number of nodes.
        nodes: usize,
        /// Largest number that can be exported.
        limit: usize,
    },
    /// The weather would be too large.
    #[error(
        "{numbers} numbers of weather and people (steps times zones) are more than the {limit} of an FMU; lower `iterations`"
    )]
    TooMuchWeather {
        /// Number of numbers that the weather has.
        numbers: usize,
        /// Largest number that can be exported.
        limit: usize,
    },
    /// The compiler made no library for this system.
    #[error("this build of interplay has no FMU library: the compiler made none for {platform}, as its warnings said")]
    NoLibrary {
        /// Name of the system.
        platform: String,
    },
    /// Zones and walls make no network.
    #[error("the building cannot be exported: {0}")]
    Network(#[from] NetworkError),
    /// The network has no discrete form.
    #[error("the building cannot be exported: {0}")]
    Model(#[from] ModelError),
    /// The weather of the building is not known.
    #[error("the building cannot be exported: {0}")]
    Building(#[from] BuildingError),
}
