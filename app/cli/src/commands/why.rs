//! `interplay why`

use std::num::NonZeroUsize;

use clap::Args;
use interplay_presentation::report;
use interplay_scenarios::{LoadError, Override, Registry, Scenario, StandardChange};
use interplay_simulation::why::{WhyReport, why};

use crate::flag_values::files::short_name;
use crate::flag_values::values;
use crate::output::error::{CommandError, ExitStatus};
use crate::output::progress::Progress;
use crate::output::{ending, json, print, print_error, print_load_error, without_input};
use crate::process::limits::pool;

/// Find out what the outcome of a drive depends on: run it again with one thing changed at a time.
#[derive(Debug, Args)]
#[command(after_help = "The changes: each human's style; the planner of each interactive vehicle, and each of its \
    mechanisms switched off; whether a vehicle knows the others' plans. Counterfactuals of the file are not run.\n\n\
    Examples:\n  \
    interplay why lane-change/front-nice\n  \
    interplay why lane-change/front-nice --at 1.5\n  \
    interplay why my.toml --set vehicle.ego.goal.speed_mps=1.2 --json")]
pub(crate) struct Why {
    /// Name of an embedded scenario (see `interplay list`) or path of a scenario file, with vehicles
    #[arg(value_name = "NAME|FILE")]
    scenario: String,

    /// Change one value of the scenario in all runs; may be repeated
    #[arg(long = "set", value_name = "PATH=VALUE")]
    sets: Vec<String>,

    /// How many run at a time [default: one for each core]
    #[arg(long, value_name = "N", value_parser = values::count::<NonZeroUsize>, allow_negative_numbers = true)]
    jobs: Option<NonZeroUsize>,

    /// Change things from this time of the run on, and not from the beginning: what decided then? Drivers keep what they remember
    #[arg(long = "at", value_name = "SECONDS", value_parser = values::time, allow_negative_numbers = true)]
    at_s: Option<f64>,

    /// Print the results as one JSON document
    #[arg(long)]
    json: bool,
}

impl Why {
    pub(crate) fn execute(self, registry: &Registry) -> ExitStatus {
        let (scenario, changes) = match self.load(registry) {
            Ok(loaded) => loaded,
            Err(error) => {
                print_load_error(error);
                return ExitStatus::BadInput;
            }
        };
        if scenario.vehicles.is_empty() {
            print_error(&format!(
                "`interplay why` changes drivers, and `{}` has no vehicles; to compare controllers, state a \
                 `[[counterfactual]]` for each",
                self.scenario
            ));
            return ExitStatus::BadInput;
        }
        if changes.is_empty() {
            print_error(&format!(
                "`interplay why` changes one driver at a time, and the vehicles of `{0}` come from flows; to compare drivers of a \
                 flow: `interplay sweep --scenario {0} --arm 'flow.NAME.vehicle.driver.style=tough'`",
                self.scenario
            ));
            return ExitStatus::BadInput;
        }
        if let Some(reason) = self.at_s.and_then(|at_s| too_late(at_s, &scenario)).or_else(|| without_input(&scenario))
        {
            print_error(&reason);
            return ExitStatus::BadInput;
        }
        let printed = self.run(&scenario, &changes).and_then(|report| {
            print(&if self.json {
                json("the results", &report)?
            } else {
                report::why(&scenario.title, &self.words(), &report)
            })
        });
        ending(printed)
    }

    /// The words that run the scenario itself.
    fn words(&self) -> Vec<String> {
        let sets = self.sets.iter().flat_map(|change| ["--set".to_owned(), change.clone()]);
        ["interplay", "run", &self.scenario].map(str::to_owned).into_iter().chain(sets).collect()
    }

    fn load(&self, registry: &Registry) -> Result<(Scenario, Vec<StandardChange>), LoadError> {
        let overrides: Vec<Override> = self.sets.iter().cloned().map(Override::Set).collect();
        let scenario = registry.load(&self.scenario, &overrides)?;
        let changes = registry.standard_changes(&self.scenario, &scenario, &overrides)?;
        Ok((scenario, changes))
    }

    fn run(&self, scenario: &Scenario, changes: &[StandardChange]) -> Result<WhyReport, CommandError> {
        let pool = pool(self.jobs, 1 + changes.len())?;
        let progress = Progress::start(1 + changes.len());
        let name = short_name(&self.scenario);
        let report = pool.install(|| why(&name, scenario, changes, self.at_s, &|| progress.advance()));
        progress.clear();
        Ok(report?)
    }
}

/// Why nothing can be changed at a time, if the run is over by then.
fn too_late(at_s: f64, scenario: &Scenario) -> Option<String> {
    let end_s = scenario.duration_s;
    (at_s >= end_s)
        .then(|| format!("`--at {at_s}` is not within the run, which takes {end_s} s; choose an earlier time"))
}
