//! `interplay suite`

use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::Args;
use interplay_presentation::report::{Case, junit, table};
use interplay_scenarios::{Scenario, embedded, load};
use interplay_simulation::report::Report;
use interplay_simulation::run::run;
use rayon::prelude::*;

use crate::ending::Ending;
use crate::files::{self, Found};
use crate::output::{complain, complain_about, json, print};
use crate::progress::Progress;

/// Run many scenarios side by side and say which of them do what they should.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    interplay suite\n  \
    interplay suite lane-change/front-nice my-scenarios/ --junit results.xml --jobs 4")]
pub(crate) struct Suite {
    /// Names of embedded scenarios, scenario files, or folders that are searched for .toml files [default: all embedded
    /// scenarios]
    #[arg(value_name = "NAME|FILE|DIR")]
    paths: Vec<String>,

    /// How many run at a time [default: one for each core]
    #[arg(long, value_name = "N")]
    jobs: Option<NonZeroUsize>,

    /// Also write the results as JUnit XML, which build servers show
    #[arg(long, value_name = "FILE")]
    junit: Option<PathBuf>,

    /// Print the reports as one JSON document: an array of what `interplay run --json` prints
    #[arg(long)]
    json: bool,
}

impl Suite {
    pub(crate) fn execute(self) -> Ending {
        let Some(scenarios) = self.load() else { return Ending::BadInput };
        let began = Instant::now();
        let cases = match self.run(&scenarios) {
            Ok(cases) => cases,
            Err(error) => {
                complain(&error);
                return Ending::Unfinished;
            }
        };
        for (name, error) in cases.iter().filter_map(|case| Some((&case.name, case.outcome.as_ref().err()?))) {
            complain(&format!("{name} could not be finished: {error}"));
        }
        match self.tell(&cases, began.elapsed().as_secs_f64()) {
            Ok(()) => ending(&cases),
            Err(error) => {
                complain(&error);
                Ending::Unfinished
            }
        }
    }

    /// All scenarios with their names; `None` if any cannot be used, once all that is wrong has been said.
    fn load(&self) -> Option<Vec<(String, Scenario)>> {
        let mut sound = true;
        let mut scenarios = Vec::new();
        for Found { name, scenario } in self.find(&mut sound) {
            match load(&scenario, &[]) {
                Ok(scenario) => scenarios.push((name, scenario)),
                Err(error) => {
                    complain_about(error);
                    sound = false;
                }
            }
        }
        sound.then_some(scenarios)
    }

    fn find(&self, sound: &mut bool) -> Vec<Found> {
        if self.paths.is_empty() {
            let name = |name: &str| Found { name: name.to_owned(), scenario: name.to_owned() };
            return embedded().iter().map(|file| name(file.name)).collect();
        }
        let mut found = Vec::new();
        for path in &self.paths {
            match files::find(path) {
                Ok(more) => found.extend(more),
                Err(error) => {
                    complain(&error);
                    *sound = false;
                }
            }
        }
        found
    }

    /// Runs every scenario in a world of its own; the cases come in the order of the scenarios.
    fn run(&self, scenarios: &[(String, Scenario)]) -> Result<Vec<Case>, String> {
        let jobs = self.jobs.map_or(0, NonZeroUsize::get);
        let pool = rayon::ThreadPoolBuilder::new().num_threads(jobs).build();
        let pool = pool.map_err(|error| format!("cannot start {jobs} threads: {error}"))?;
        let progress = Progress::of(scenarios.len());
        let case = |(name, scenario): &(String, Scenario)| {
            let outcome = run(name, scenario, Vec::new()).map_err(|error| error.to_string());
            progress.advance();
            Case { name: name.clone(), outcome }
        };
        let cases = pool.install(|| scenarios.par_iter().with_max_len(1).map(case).collect());
        progress.clear();
        Ok(cases)
    }

    /// Prints and writes the results as it was asked for.
    fn tell(&self, cases: &[Case], wall_s: f64) -> Result<(), String> {
        let reports: Vec<&Report> = cases.iter().filter_map(|case| case.outcome.as_ref().ok()).collect();
        print(&if self.json { json(&reports)? } else { table(cases, wall_s) });
        self.junit.as_deref().map_or(Ok(()), |path| write(path, &junit(cases, wall_s)))
    }
}

fn write(path: &Path, text: &str) -> Result<(), String> {
    std::fs::write(path, text).map_err(|error| format!("cannot write `{}`: {error}", path.display()))
}

/// A run that could not be finished weighs more than an expectation that failed.
fn ending(cases: &[Case]) -> Ending {
    let mut ending = Ending::Well;
    for case in cases {
        match &case.outcome {
            Err(_) => return Ending::Unfinished,
            Ok(report) if !report.passed => ending = Ending::Failed,
            Ok(_) => {}
        }
    }
    ending
}

#[cfg(test)]
mod tests {
    use super::*;

    fn case(outcome: Result<bool, &str>) -> Case {
        let mut scenario = load("lane-change/front-nice", &[]).expect("embedded");
        scenario.duration_s = scenario.step_s;
        let report = || run("short", &scenario, Vec::new()).expect("one tick");
        let outcome = outcome.map(|passed| Report { passed, ..report() });
        Case { name: "short".to_owned(), outcome: outcome.map_err(str::to_owned) }
    }

    #[test]
    fn the_worst_case_decides_how_the_suite_ends() {
        let ending =
            |outcomes: &[Result<bool, &str>]| ending(&outcomes.iter().map(|one| case(*one)).collect::<Vec<_>>());
        assert_eq!(ending(&[]), Ending::Well);
        assert_eq!(ending(&[Ok(true), Ok(true)]), Ending::Well);
        assert_eq!(ending(&[Ok(true), Ok(false), Ok(true)]), Ending::Failed);
        assert_eq!(ending(&[Ok(false), Err("broken"), Ok(true)]), Ending::Unfinished);
    }
}
