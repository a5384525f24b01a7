//! `interplay suite`

use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::Args;
use interplay_presentation::animation::AnimationFile;
use interplay_presentation::figures::RecordedRun;
use interplay_presentation::report::{Case, junit, table};
use interplay_scenarios::{Registry, Scenario, embedded};
use interplay_simulation::report::Report;
use interplay_simulation::run::run_with_counterfactuals;
use rayon::prelude::*;

use crate::flag_values::files::{self, ScenarioArgument, destroyed};
use crate::flag_values::values;
use crate::output::error::{CommandError, ExitStatus, write_file};
use crate::output::progress::Progress;
use crate::output::{json, print, print_error, print_load_error};
use crate::process::limits::pool;

/// Run many scenarios side by side and say which of them do what they should.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    interplay suite\n  \
    interplay suite lane-change/front-nice my-scenarios/ --junit results.xml --jobs 4\n  \
    interplay suite my-scenarios/ --animate-failures failures    (a moving picture of each that failed)")]
pub(crate) struct Suite {
    /// Names of embedded scenarios, scenario files, or folders that are searched for .toml files [default: all embedded
    /// scenarios]
    #[arg(value_name = "NAME|FILE|DIR")]
    paths: Vec<String>,

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

impl Suite {
    pub(crate) fn execute(self, registry: &Registry) -> ExitStatus {
        let Some(scenarios) = self.load(registry) else { return ExitStatus::BadInput };
        if let Some(path) = self.junit.as_deref().and_then(|junit| self.destroyed_by(junit, registry)) {
            print_error(&format!(
                "the results would overwrite the scenario `{}`; choose another name for --junit",
                path.display()
            ));
            return ExitStatus::BadInput;
        }
        if let Some(reason) = self.refused_animation(&scenarios, registry) {
            print_error(&reason);
            return ExitStatus::BadInput;
        }
        let began = Instant::now();
        let cases = match self.run(&scenarios) {
            Ok(cases) => cases,
            Err(error) => {
                print_error(&error.to_string());
                return ExitStatus::Unfinished;
            }
        };
        for (name, error) in cases.iter().filter_map(|case| Some((&case.name, case.outcome.as_ref().err()?))) {
            print_error(&format!("{name} could not be finished: {error}"));
        }
        let printed = self.print_results(&cases, began.elapsed().as_secs_f64());
        match printed.and_then(|()| self.animate_failures(&scenarios, &cases)) {
            Ok(()) => ending(&cases),
            Err(error) => {
                print_error(&error.to_string());
                ExitStatus::Unfinished
            }
        }
    }

    /// All scenarios with their names; `None` if any cannot be used, after all errors are printed.
    fn load(&self, registry: &Registry) -> Option<Vec<(String, Scenario)>> {
        let mut sound = true;
        let mut scenarios = Vec::new();
        for ScenarioArgument { name, scenario } in self.find(&mut sound) {
            match registry.load(&scenario, &[]) {
                Ok(scenario) => scenarios.push((name, scenario)),
                Err(error) => {
                    print_load_error(error);
                    sound = false;
                }
            }
        }
        sound.then_some(scenarios)
    }

    /// The scenario that writing to a file would destroy.
    fn destroyed_by(&self, output: &Path, registry: &Registry) -> Option<PathBuf> {
        let found = self.find(&mut true);
        destroyed(registry, output, found.iter().map(|found| found.scenario.as_str()), &[])
    }

    fn find(&self, sound: &mut bool) -> Vec<ScenarioArgument> {
        if self.paths.is_empty() {
            let name = |name: &str| ScenarioArgument { name: name.to_owned(), scenario: name.to_owned() };
            return embedded().iter().map(|file| name(file.name)).collect();
        }
        let mut found = Vec::new();
        for path in &self.paths {
            match files::find(path) {
                Ok(more) => found.extend(more),
                Err(error) => {
                    print_error(&error.to_string());
                    *sound = false;
                }
            }
        }
        files::with_names_of_their_own(found)
    }

    /// Runs every scenario in a world of its own; the cases come in the order of the scenarios.
    fn run(&self, scenarios: &[(String, Scenario)]) -> Result<Vec<Case>, CommandError> {
        let pool = pool(self.jobs, scenarios.len())?;
        let progress = Progress::start(scenarios.len());
        let case = |(name, scenario): &(String, Scenario)| {
            let outcome = run_with_counterfactuals(name, scenario, Vec::new());
            progress.advance();
            Case { name: name.clone(), outcome }
        };
        let cases = pool.install(|| scenarios.par_iter().with_max_len(1).map(case).collect());
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
    fn refused_animation(&self, scenarios: &[(String, Scenario)], registry: &Registry) -> Option<String> {
        let folder = self.animate_failures.as_ref()?;
        if folder.exists() && !folder.is_dir() {
            return Some(format!("`{}` is not a folder; choose another name for --animate-failures", folder.display()));
        }
        let animations = scenarios.iter().filter_map(|(name, _)| self.animation(name));
        let path = animations.into_iter().find_map(|animation| self.destroyed_by(animation.path(), registry))?;
        Some(format!(
            "an animation would overwrite the scenario `{}`; choose another folder for --animate-failures",
            path.display()
        ))
    }

    /// Runs what failed again, with everything kept that is drawn, and draws it: a run gives the same every time.
    fn animate_failures(&self, scenarios: &[(String, Scenario)], cases: &[Case]) -> Result<(), CommandError> {
        let failed = |case: &Case| case.outcome.as_ref().is_ok_and(|report| !report.passed);
        for ((name, scenario), case) in scenarios.iter().zip(cases) {
            let Some(animation) = self.animation(name).filter(|_| failed(case)) else { continue };
            let recorded = RecordedRun::record(name, scenario.clone(), Vec::new(), "")?;
            let unwritten = |reason| CommandError::FailedAnimation { scenario: name.clone(), reason };
            animation.write(&recorded).map_err(unwritten)?;
            print_error(&format!("animation in {}", animation.path().display()));
        }
        Ok(())
    }
}

/// A run that could not be finished weighs more than an expectation that failed.
fn ending(cases: &[Case]) -> ExitStatus {
    let mut ending = ExitStatus::Well;
    for case in cases {
        match &case.outcome {
            Err(_) => return ExitStatus::Unfinished,
            Ok(report) if !report.passed => ending = ExitStatus::Failed,
            Ok(_) => {}
        }
    }
    ending
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
        Case { name: "short".to_owned(), outcome: outcome.map_err(|error| RunError::Watch(error.into())) }
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
