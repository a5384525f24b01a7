//! `interplay check`

use clap::Args;
use interplay_scenarios::{Override, Registry, Scenario};

use crate::flag_values::files::Found;
use crate::output::error::ExitStatus;
use crate::output::{print_error, print_load_error, printed};

/// Check scenario files without running them; every error is located.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  interplay check my.toml\n  interplay check scenarios/\n  interplay check my.toml --planner nash --set horizon_steps=40"
)]
pub(crate) struct Check {
    /// Scenario files, names of embedded scenarios, families and patterns of them, or folders that are searched for scenarios
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
        let mut found = Found::of(&self.paths);
        for error in &found.errors {
            print_error(&error.to_string());
            ending = ExitStatus::BadInput;
        }
        for (argument, outcome) in found.load(registry, &overrides) {
            match outcome {
                Ok(scenario) => ending = ending.max(printed(&approved(&argument.scenario, &scenario))),
                Err(error) => {
                    print_load_error(error);
                    ending = ending.max(ExitStatus::BadInput);
                }
            }
        }
        found.note().iter().for_each(|note| print_error(note));
        ending
    }
}

/// A line that a file is sound, the size of a run of it, and remarks about unusual values.
fn approved(file: &str, scenario: &Scenario) -> String {
    let network = scenario.building.as_ref().and_then(|building| building.network().ok());
    let remarks: Vec<_> = network.iter().flat_map(|network| network.remarks()).collect();
    let remarks = remarks.iter().map(ToString::to_string);
    let all = scenario.remarks.iter().map(ToString::to_string).chain(remarks);
    let others = scenario.counterfactuals.len();
    let others = match (others, scenario.counterfactual_cost()) {
        (0, _) => String::new(),
        (1, cost) => format!("    its counterfactual makes {cost}\n"),
        (count, cost) => format!("    its {count} counterfactuals make {cost}\n"),
    };
    all.fold(format!("ok  {file}\n    makes {}\n{others}", scenario.own_cost()), |text, remark| {
        text + &format!("    note: {remark}\n")
    })
}
