//! Errors of runs and simulations.

use thiserror::Error;

use crate::climate::{BuildingError, BuildingFailure};
use crate::phases::watch::WatchError;
use crate::state::detail::NotCopied;

/// Why a run failed.
#[derive(Debug, Error)]
pub enum RunError {
    /// A watcher failed.
    #[error("{0}")]
    Watch(WatchError),
    /// The threads on which vehicles decide cannot be started.
    #[error("cannot start the threads on which vehicles decide: {0}")]
    Threads(rayon::ThreadPoolBuildError),
    /// The building cannot be built.
    #[error("the building cannot be simulated: {0}")]
    Building(#[from] BuildingError),
    /// The building's controller failed, or the program that simulates the building did not answer as agreed.
    #[error("the run ended on day {day}: {reason}")]
    Climate {
        /// Number of the day, from 1.
        day: usize,
        /// The reason.
        reason: BuildingFailure,
    },
    /// A counterfactual run failed.
    #[error("the counterfactual \"{name}\" could not be finished: {reason}")]
    Counterfactual {
        /// Claim of the counterfactual.
        name: String,
        /// The reason.
        reason: Box<RunError>,
    },
    /// No vehicle has this name.
    #[error("there is no vehicle `{vehicle}`; the vehicles are {names}")]
    NoVehicle {
        /// The name.
        vehicle: String,
        /// The existing names.
        names: String,
    },
    /// A vehicle with an external driver has no input.
    #[error("`{vehicle}` is driven from outside, and was given no input for the tick at {time_s} s")]
    NoInput {
        /// The vehicle.
        vehicle: String,
        /// Time at which the tick begins \[s\].
        time_s: f64,
    },
    /// The caller gave an input for a vehicle that decides for itself.
    #[error("`{vehicle}` has a driver of its own; `driver = {{ kind = \"external\" }}` lets it be driven from outside")]
    NotExternal {
        /// Name of the vehicle.
        vehicle: String,
    },
    /// An input is not a finite number.
    #[error("the input for `{vehicle}` is not finite")]
    NotFinite {
        /// Name of the vehicle.
        vehicle: String,
    },
    /// A plan has the wrong length.
    #[error("the plan for `{vehicle}` has {found} inputs, and the horizon is {steps} steps")]
    WrongPlan {
        /// The vehicle.
        vehicle: String,
        /// Number of inputs of the plan.
        found: usize,
        /// Number of steps of the scenario's horizon.
        steps: usize,
    },
    /// The scenario has no building.
    #[error("the scenario has no building")]
    NoBuilding,
    /// The caller gave heat for another number of zones.
    #[error("the number of heats handed in is {found}, and that of the building's zones {zones}")]
    WrongHeats {
        /// Number of heats.
        found: usize,
        /// Number of zones of the building.
        zones: usize,
    },
    /// A part of the world cannot be copied.
    #[error(transparent)]
    NotCopied(#[from] NotCopied),
    /// The caller has ended the run.
    #[error("the run was cancelled")]
    Cancelled,
    /// An earlier step has failed.
    #[error("the run has ended with an error: restore a snapshot, or begin anew")]
    Ended,
    /// An added system names a component or resource that the world does not have.
    #[error("an added system uses `{name}`, which the world does not have; add it by `with_state`")]
    UnknownState {
        /// The type of the component or resource.
        name: String,
    },
    /// The loop could not be built.
    #[error("the loop could not be built: {0}")]
    Loop(String),
}
