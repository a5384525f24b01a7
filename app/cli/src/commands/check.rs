//! `interplay check`

use clap::Args;
use interplay_scenarios::{Override, Registry, Scenario};

use crate::flag_values::files;
use crate::output::error::ExitStatus;
use crate::output::{print_error, print_load_error, printed};

/// Check scenario files without running them; every error is located.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  interplay check my.toml\n  interplay check scenarios/\n  interplay check my.toml --planner nash --set horizon_steps=40"
)]
pub(crate) struct Check {
    /// Scenario files, names of embedded scenarios, or folders that are searched for .toml files
    #[arg(value_name = "FILE|DIR", required = true)]
    paths: Vec<String>,

    /// Planner of the ego instead of each scenario's own
    #[arg(long, value_name = "KIND")]
    planner: Option<String>,

    /// Change a value of each scenario, as `interplay run` does; may be repeated
    #[arg(long = "set", value_name = "PATH=VALUE")]
    sets: Vec<String>,
}

impl Check {
    pub(crate) fn execute(self, registry: &Registry) -> ExitStatus {
        let planner = self.planner.iter().cloned().map(Override::Planner);
        let overrides: Vec<Override> = planner.chain(self.sets.iter().cloned().map(Override::Set)).collect();
        let mut ending = ExitStatus::Well;
        for path in &self.paths {
            match files::find(path) {
                Ok(found) => {
                    for file in found.into_iter().map(|found| found.scenario) {
                        match registry.load(&file, &overrides) {
                            Ok(scenario) => ending = ending.max(printed(&approved(&file, &scenario))),
                            Err(error) => {
                                print_load_error(error);
                                ending = ending.max(ExitStatus::BadInput);
                            }
                        }
                    }
                }
                Err(error) => {
                    print_error(&error.to_string());
                    ending = ExitStatus::BadInput;
                }
            }
        }
        ending
    }
}

/// A line that a file is sound, the size of a run of it, and remarks about unusual values.
fn approved(file: &str, scenario: &Scenario) -> String {
    let network = scenario.building.as_ref().and_then(|building| building.network().ok());
    let remarks: Vec<_> = network.iter().flat_map(|network| network.remarks()).collect();
    let remarks = remarks.iter().map(ToString::to_string);
    let all = scenario.remarks.iter().map(ToString::to_string).chain(remarks);
    all.fold(format!("ok  {file}\n    makes {}\n", scenario.cost()), |text, remark| {
        text + &format!("    note: {remark}\n")
    })
}
