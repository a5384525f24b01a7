//! `interplay fmu-host`: the process in which a unit runs. It is started by a run, not by people.

use std::path::PathBuf;

use clap::Args;
use interplay_fmu_host::serve;

use crate::output::error::ExitStatus;
use crate::output::print_error;

/// Run a functional mock-up unit and answer lines of JSON: a run whose building is an FMU starts this by itself.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  interplay fmu-host unit/binaries/linux64/unit.so '{guid}' file:///unit/resources")]
pub(crate) struct FmuHost {
    /// Its library
    #[arg(value_name = "LIBRARY")]
    library: PathBuf,

    /// Its identity, as its description states it
    #[arg(value_name = "GUID")]
    guid: String,

    /// The folder of its resources
    #[arg(value_name = "URI")]
    resources: String,

    /// Numbers of states and event indicators, whether completed steps are told, and the tolerance, of a unit for model exchange
    #[arg(value_name = "EXCHANGE")]
    exchange: Option<String>,
}

impl FmuHost {
    pub(crate) fn execute(self) -> ExitStatus {
        match serve(&self.library, &self.guid, &self.resources, self.exchange.as_deref()) {
            Ok(()) => ExitStatus::Well,
            Err(error) => {
                print_error(&format!("the FMU cannot be served: {error}"));
                ExitStatus::Unfinished
            }
        }
    }
}
