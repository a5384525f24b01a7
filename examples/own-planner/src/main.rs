//! Every command of Interplay, with one more kind of driver.

// shown from here
use std::process::ExitCode;

use interplay_scenarios::{Registry, RegistryError};

fn main() -> Result<ExitCode, RegistryError> {
    let registry = Registry::default().with_driver::<own_planner::GapAcceptance>()?;
    Ok(interplay::main_with(&registry))
}
// shown until here
