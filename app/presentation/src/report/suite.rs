//! Several runs in one table.

use std::fmt::Write;

use interplay_scenarios::LoadError;
use interplay_simulation::report::{CounterfactualReport, Expectation, Report};
use interplay_simulation::run::RunError;
use thiserror::Error;

use super::columns::{Align, lines, written};

/// One run of a suite: its report, or why there is none.
#[derive(Debug)]
pub struct Case {
    pub name: String,
    /// The report of the run, or why there is none.
    pub outcome: Result<Report, CaseError>,
}

/// Why a run has no report.
#[derive(Debug, Error)]
pub enum CaseError {
    /// The file is not a scenario that can be run.
    #[error(transparent)]
    Unusable(#[from] LoadError),
    /// The run could not be finished.
    #[error(transparent)]
    Unfinished(#[from] RunError),
}

impl Case {
    /// The expectations of the scenario's own run that did not hold.
    pub(super) fn failed(&self) -> impl Iterator<Item = &Expectation> {
        let all = self.outcome.iter().flat_map(|report| &report.expectations);
        all.filter(|expectation| !expectation.passed)
    }

    pub(super) fn counterfactuals(&self) -> impl Iterator<Item = &CounterfactualReport> {
        self.outcome.iter().flat_map(|report| &report.counterfactuals)
    }

    /// The outcome of the scenario's own run in words.
    fn verdict(&self) -> &'static str {
        match &self.outcome {
            Err(CaseError::Unusable(_)) => "UNUSABLE",
            Err(CaseError::Unfinished(_)) => "UNFINISHED",
            Ok(_) if self.failed().next().is_some() => "FAILED",
            Ok(report) if report.expectations.is_empty() => "nothing expected",
            Ok(_) => "passed",
        }
    }

    /// The rows of the table: one for the scenario's own run, one below it for each counterfactual.
    fn rows(&self) -> Vec<Vec<String>> {
        let mut first = vec![self.name.clone(), self.verdict().to_owned()];
        first.extend(self.outcome.iter().flat_map(figures));
        let others = self.counterfactuals().map(|one| {
            let verdict = if one.passed { "passed" } else { "FAILED" };
            [format!("  if: {}", one.name), verdict.to_owned()].into_iter().chain(figures(&one.run)).collect()
        });
        std::iter::once(first).chain(others).collect()
    }

    /// The failed expectations of each of these rows.
    fn failures(&self) -> Vec<Vec<String>> {
        let words = |failed: &mut dyn Iterator<Item = &Expectation>| failed.map(ToString::to_string).collect();
        let others = self.counterfactuals().map(|one| words(&mut one.failed()));
        std::iter::once(words(&mut self.failed())).chain(others).collect()
    }
}

/// The figures of a run in its row.
fn figures(report: &Report) -> [String; 3] {
    let gap = report.min_gap_m().map_or_else(|| "-".to_owned(), |gap| format!("{gap:.3}"));
    [report.collisions.len().to_string(), gap, format!("{:.2}", report.wall_s)]
}

/// A line for every run and, below it, for each counterfactual, with the failed expectations; at the end the number of passed
/// scenarios. The suite took `wall_s` seconds.
pub fn table(cases: &[Case], wall_s: f64) -> String {
    written(|text| write_suite(text, cases, wall_s))
}

fn write_suite(text: &mut String, cases: &[Case], wall_s: f64) -> std::fmt::Result {
    use Align::{Left, Right};
    let header =
        [("scenario", Left), ("outcome", Left), ("collisions", Right), ("smallest gap m", Right), ("time s", Right)];
    let lines = lines(&header, cases.iter().flat_map(Case::rows));
    lines.iter().take(1).try_for_each(|header| writeln!(text, "{header}"))?;
    let mut lines = lines[1..].iter();
    for case in cases {
        for (failures, line) in case.failures().iter().zip(&mut lines) {
            match &case.outcome {
                Ok(_) => writeln!(text, "{line}")?,
                Err(error) => writeln!(text, "{line}  {error}")?,
            }
            failures.iter().try_for_each(|failed| writeln!(text, "  FAIL {failed}"))?;
        }
    }
    let passed = cases.iter().filter(|case| case.outcome.as_ref().is_ok_and(|report| report.passed)).count();
    let verdict = if passed == cases.len() { "PASSED" } else { "FAILED" };
    writeln!(text, "{verdict}: {passed} of {} met their expectations, in {wall_s:.2} s", cases.len())
}
