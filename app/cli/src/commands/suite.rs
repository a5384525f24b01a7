//! `interplay suite`

use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::Args;
use interplay_presentation::animation::AnimationFile;
use interplay_presentation::figures::RecordedRun;
use interplay_presentation::report::{Case, CaseError, junit, table};
use interplay_scenarios::{LoadError, Override, Registry, Scenario, embedded};
use interplay_simulation::report::Report;
use interplay_simulation::run::run_with_counterfactuals;
use rayon::prelude::*;

use crate::flag_values::files::{Found, destroyed};
use crate::flag_values::values;
use crate::output::error::{CommandError, ExitStatus, write_file};
use crate::output::progress::Progress;
use crate::output::{json, print, print_error, print_load_error};
use crate::process::limits::pool;

/// Run many scenarios side by side and say which of them do what they should.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    interplay suite\n  \
    interplay suite lane-change 'intersection/*' my-scenarios/ --junit results.xml --jobs 4\n  \
    interplay suite my-scenarios/ --planner conservative --seed 7\n  \
    interplay suite my-scenarios/ --animate-failures failures    (a moving picture of each that failed)")]
pub(crate) struct Suite {
    /// Embedded scenarios, families and patterns of them such as `intersection/*`, scenario files, or folders that are searched
    /// for scenarios [default: all embedded scenarios]
    #[arg(value_name = "NAME|FILE|DIR")]
    paths: Vec<String>,

    /// Planner of the ego instead of each scenario's own
    #[arg(long, value_name = "KIND")]
    planner: Option<String>,

    /// Change a value of each scenario, as `interplay run` does; may be repeated
    #[arg(long = "set", value_name = "PATH=VALUE")]
    sets: Vec<String>,

    /// Seed of all random numbers
    #[arg(long, value_name = "N", value_parser = values::seed, allow_negative_numbers = true)]
    seed: Option<u64>,

    /// Let a scenario that expects nothing pass although its ego begins a contact
    #[arg(long)]
    allow_contacts: bool,

    /// How many run at a time [default: one for each core]
    #[arg(long, value_name = "N", value_parser = values::count::<NonZeroUsize>, allow_negative_numbers = true)]
    jobs: Option<NonZeroUsize>,

    /// Also write the results as JUnit XML, which build servers show
    #[arg(long, value_name = "FILE")]
    junit: Option<PathBuf>,

    /// Draw a moving picture of each scenario whose expectations failed into this folder, as NAME.gif
    #[arg(long, value_name = "DIR")]
    animate_failures: Option<PathBuf>,

    /// Print the reports as one JSON document: an array of what `interplay run --json` prints
    #[arg(long)]
    json: bool,
}

/// What is run, in the order of the arguments: scenarios, and files that are unusable.
type Loaded = Vec<(String, Result<Scenario, LoadError>)>;

impl Suite {
    pub(crate) fn execute(self, registry: &Registry) -> ExitStatus {
        let mut found = self.find();
        found.errors.iter().for_each(|error| print_error(&error.to_string()));
        let has_faults = !found.errors.is_empty();
        if let Some(reason) = self.refused_outputs(&found, registry) {
            print_error(&reason);
            return ExitStatus::BadInput;
        }
        let loaded: Loaded = found
            .load(registry, &self.overrides())
            .into_iter()
            .map(|(argument, outcome)| (argument.name, outcome.map(|scenario| self.without_foreign_claims(scenario))))
            .collect();
        found.note().iter().for_each(|note| print_error(note));
        let unusable = loaded.iter().filter_map(|(_, outcome)| outcome.as_ref().err());
        unusable.for_each(|error| print_load_error(error.clone()));
        if loaded.is_empty() {
            print_error("nothing to run; `interplay list` shows those in the binary");
            return ExitStatus::BadInput;
        }
        let began = Instant::now();
        let scenarios: Vec<(String, Scenario)> =
            loaded.iter().filter_map(|(name, outcome)| Some((name.clone(), outcome.as_ref().ok()?.clone()))).collect();
        let cases = match self.run(loaded) {
            Ok(cases) => cases,
            Err(error) => {
                print_error(&error.to_string());
                return ExitStatus::Unfinished;
            }
        };
        for (name, error) in cases.iter().filter_map(|case| Some((&case.name, case.outcome.as_ref().err()?))) {
            if let CaseError::Unfinished(error) = error {
                print_error(&format!("{name} could not be finished: {error}"));
            }
        }
        let printed = self.print_results(&cases, began.elapsed().as_secs_f64());
        match printed.and_then(|()| self.animate_failures(&scenarios, &cases)) {
            Ok(()) if has_faults => ending(&cases).max(ExitStatus::BadInput),
            Ok(()) => ending(&cases),
            Err(error) => {
                print_error(&error.to_string());
                ExitStatus::Unfinished
            }
        }
    }

    /// Changes of all scenarios, the most specific last.
    fn overrides(&self) -> Vec<Override> {
        let planner = self.planner.iter().cloned().map(Override::Planner);
        let seed = self.seed.into_iter().map(Override::Seed);
        planner.chain(seed).chain(self.sets.iter().cloned().map(Override::Set)).collect()
    }

    /// The scenario without its counterfactuals if a flag replaces the planner: they are claims about the file's own planner.
    fn without_foreign_claims(&self, scenario: Scenario) -> Scenario {
        if self.planner.is_some() { scenario.without_counterfactuals() } else { scenario }
    }

    /// Why the results must not be written where the flags say.
    fn refused_outputs(&self, found: &Found, registry: &Registry) -> Option<String> {
        let path = self.junit.as_deref().and_then(|junit| self.destroyed_by(junit, found, registry));
        let junit = path.map(|path| {
            format!("the results would overwrite the scenario `{}`; choose another name for --junit", path.display())
        });
        junit.or_else(|| self.refused_animation(found, registry))
    }

    /// The scenario that writing to a file would destroy.
    fn destroyed_by(&self, output: &Path, found: &Found, registry: &Registry) -> Option<PathBuf> {
        destroyed(registry, output, found.scenarios.iter().map(|found| found.scenario.as_str()), &self.overrides())
    }

    fn find(&self) -> Found {
        if !self.paths.is_empty() {
            return Found::of(&self.paths);
        }
        let names: Vec<String> = embedded().iter().map(|file| file.name.to_owned()).collect();
        Found::of(&names)
    }

    /// Runs every scenario in a world of its own; the cases come in the order of the arguments.
    fn run(&self, loaded: Loaded) -> Result<Vec<Case>, CommandError> {
        let pool = pool(self.jobs, loaded.len())?;
        let progress = Progress::start(loaded.len());
        let case = |(name, scenario): (String, Result<Scenario, LoadError>)| {
            let run = |scenario: Scenario| {
                let report = run_with_counterfactuals(&name, &scenario, Vec::new());
                report.map(|report| if self.allow_contacts { report } else { report.without_contacts_by_ego() })
            };
            let outcome = scenario.map_err(CaseError::from).and_then(|scenario| run(scenario).map_err(CaseError::from));
            progress.advance();
            Case { name, outcome }
        };
        let cases = pool.install(|| loaded.into_par_iter().with_max_len(1).map(case).collect());
        progress.clear();
        Ok(cases)
    }

    /// Prints the results, and writes them with `--junit`.
    fn print_results(&self, cases: &[Case], wall_s: f64) -> Result<(), CommandError> {
        let reports: Vec<&Report> = cases.iter().filter_map(|case| case.outcome.as_ref().ok()).collect();
        print(&if self.json { json("the reports", &reports)? } else { table(cases, wall_s) })?;
        let Some(path) = &self.junit else { return Ok(()) };
        let xml = junit(cases, wall_s).map_err(|error| CommandError::Xml(Box::new(error)))?;
        write_file(path, xml.as_bytes())
    }
}

impl Suite {
    /// Path of the animation of a scenario, with `--animate-failures`.
    fn animation(&self, name: &str) -> Option<AnimationFile> {
        let folder = self.animate_failures.as_ref()?;
        Some(AnimationFile::gif(folder.join(format!("{name}.gif"))))
    }

    /// Why an animation must not be written: it would take the place of a scenario, or its folder is none.
    fn refused_animation(&self, found: &Found, registry: &Registry) -> Option<String> {
        let folder = self.animate_failures.as_ref()?;
        if folder.exists() && !folder.is_dir() {
            return Some(format!("`{}` is not a folder; choose another name for --animate-failures", folder.display()));
        }
        let mut animations = found.scenarios.iter().filter_map(|argument| self.animation(&argument.name));
        let path = animations.find_map(|animation| self.destroyed_by(animation.path(), found, registry))?;
        Some(format!(
            "an animation would overwrite the scenario `{}`; choose another folder for --animate-failures",
            path.display()
        ))
    }

    /// Runs what failed again, with everything kept that is drawn, and draws it: a run gives the same every time.
    fn animate_failures(&self, scenarios: &[(String, Scenario)], cases: &[Case]) -> Result<(), CommandError> {
        let failed = |case: &Case| case.outcome.as_ref().is_ok_and(|report| !report.passed);
        for (name, scenario) in scenarios {
            let has_failed = cases.iter().any(|case| case.name == *name && failed(case));
            let Some(animation) = self.animation(name).filter(|_| has_failed) else { continue };
            let recorded = RecordedRun::record(name, scenario.clone(), Vec::new(), "")?;
            let unwritten = |reason| CommandError::FailedAnimation { scenario: name.clone(), reason };
            animation.write(&recorded).map_err(unwritten)?;
            print_error(&format!("animation in {}", animation.path().display()));
        }
        Ok(())
    }
}

/// A run that could not be finished weighs more than a file that is unusable, and that more than an expectation that failed.
fn ending(cases: &[Case]) -> ExitStatus {
    let of = |case: &Case| match &case.outcome {
        Err(CaseError::Unfinished(_)) => ExitStatus::Unfinished,
        Err(CaseError::Unusable(_)) => ExitStatus::BadInput,
        Ok(report) if !report.passed => ExitStatus::Failed,
        Ok(_) => ExitStatus::Well,
    };
    cases.iter().map(of).max().unwrap_or(ExitStatus::Well)
}

#[cfg(test)]
mod tests {
    use interplay_simulation::run::{RunError, run};

    use super::*;

    fn case(outcome: Result<bool, &str>) -> Case {
        let mut scenario = Registry::standard().load("lane-change/front-nice", &[]).expect("embedded");
        scenario.duration_s = scenario.step_s;
        let report = || run("short", &scenario, Vec::new()).expect("one tick");
        let outcome = outcome.map(|passed| Report { passed, ..report() });
        Case { name: "short".to_owned(), outcome: outcome.map_err(|error| RunError::Watch(error.into()).into()) }
    }

    #[test]
    fn the_worst_case_decides_the_exit_code_of_a_suite() {
        let ending =
            |outcomes: &[Result<bool, &str>]| ending(&outcomes.iter().map(|one| case(*one)).collect::<Vec<_>>());
        assert_eq!(ending(&[]), ExitStatus::Well);
        assert_eq!(ending(&[Ok(true), Ok(true)]), ExitStatus::Well);
        assert_eq!(ending(&[Ok(true), Ok(false), Ok(true)]), ExitStatus::Failed);
        assert_eq!(ending(&[Ok(false), Err("broken"), Ok(true)]), ExitStatus::Unfinished);
    }
}
