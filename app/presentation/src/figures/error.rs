//! Errors of figures.

use std::io;
use std::path::PathBuf;
use std::sync::Arc;

use interplay_building::discretise::ModelError;
use interplay_building::identify::IdentifyError;
use interplay_scenarios::LoadError;
use interplay_simulation::run::RunError;
use thiserror::Error;

use crate::plot::PlotError;

/// Why a figure, or a page of figures, was not made.
#[derive(Debug, Error)]
pub enum FigureError {
    /// A scenario cannot be loaded.
    #[error("{}", with_faults(.0))]
    Load(LoadError),
    /// A run could not be finished.
    #[error(transparent)]
    Run(#[from] RunError),
    /// A run that several figures share failed.
    #[error("{scenario}: {reason}")]
    Shared {
        /// Name of the scenario.
        scenario: String,
        /// Why the run failed.
        reason: Arc<FigureError>,
    },
    /// A run that the figure needs was not made.
    #[error("{0}: the run was not made")]
    NotRun(String),
    /// A picture cannot be drawn or written.
    #[error(transparent)]
    Plot(#[from] PlotError),
    /// The parameters of the classroom cannot be identified.
    #[error(transparent)]
    Identify(#[from] IdentifyError),
    /// The classroom was identified without a zone.
    #[error("the classroom has no zone")]
    NoZone,
    /// A building has no model at its step.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// The page cannot be written.
    #[error("cannot write {}: {reason}; name another folder with --report", path.display())]
    Page {
        /// Path of the page.
        path: PathBuf,
        /// The system's reason.
        reason: io::Error,
    },
}

fn with_faults(error: &LoadError) -> String {
    let faults = error.faults().iter().map(ToString::to_string).collect::<Vec<_>>();
    format!("{error}: {}", faults.join("; "))
}

impl From<LoadError> for FigureError {
    fn from(error: LoadError) -> Self {
        FigureError::Load(error)
    }
}
