//! Every command of Interplay, with one more kind of driver, controller and road and one more metric.

// shown from here
use std::process::ExitCode;

use interplay_scenarios::{Registry, RegistryError};
use interplay_simulation::measure::RegisterMetrics;

fn main() -> Result<ExitCode, RegistryError> {
    let registry = Registry::default().with_driver::<own_planner::GapAcceptance>()?;
    let registry = registry.with_controller::<own_planner::Proportional>()?.with_road::<own_planner::OneWay>()?;
    let registry = registry.with_obstacle(own_planner::BOLLARD)?;
    let registry = registry.with_metric(own_planner::WAITING_SHARE)?;
    Ok(interplay::main_with(&registry))
}
// shown until here
