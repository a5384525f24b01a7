//! Many runs in one readable table.

use std::fmt::Write;

use interplay_simulation::report::{Expectation, Report};

/// One run of a suite: its report, or why it could not be finished.
#[derive(Clone, Debug)]
pub struct Case {
    /// What the run is called.
    pub name: String,
    /// How it ended.
    pub outcome: Result<Report, String>,
}

impl Case {
    /// The expectations that did not hold.
    pub(super) fn failed(&self) -> impl Iterator<Item = &Expectation> {
        let all = self.outcome.iter().flat_map(|report| &report.expectations);
        all.filter(|expectation| !expectation.passed)
    }

    fn verdict(&self) -> &'static str {
        match &self.outcome {
            Err(_) => "UNFINISHED",
            Ok(report) if !report.passed => "FAILED",
            Ok(report) if report.expectations.is_empty() => "nothing expected",
            Ok(_) => "passed",
        }
    }
}

/// A line for every run, below it whatever failed, and at the end how many passed; the suite took `wall_s` seconds.
pub fn table(cases: &[Case], wall_s: f64) -> String {
    let mut text = String::new();
    // Writing to a String cannot fail.
    let _ = write_table(&mut text, cases, wall_s);
    text
}

fn write_table(text: &mut String, cases: &[Case], wall_s: f64) -> std::fmt::Result {
    let longest = cases.iter().map(|case| case.name.chars().count()).max().unwrap_or(0);
    let width = longest.max("scenario".len());
    let header = ["outcome", "collisions", "smallest gap m", "time s"];
    writeln!(text, "{:width$}  {:16}  {:>10}  {:>14}  {:>7}", "scenario", header[0], header[1], header[2], header[3])?;
    for case in cases {
        write!(text, "{:width$}  {:16}", case.name, case.verdict())?;
        match &case.outcome {
            Ok(report) => {
                let gap = report.min_gap_m.map_or_else(|| "-".to_owned(), |gap| format!("{gap:.3}"));
                writeln!(text, "  {:>10}  {gap:>14}  {:>7.2}", report.collisions.len(), report.wall_s)?;
            }
            Err(error) => writeln!(text, "  {error}")?,
        }
        for failed in case.failed() {
            writeln!(text, "  FAIL {failed}")?;
        }
    }
    let passed = cases.iter().filter(|case| case.outcome.as_ref().is_ok_and(|report| report.passed)).count();
    let verdict = if passed == cases.len() { "PASSED" } else { "FAILED" };
    writeln!(text, "{verdict}: {passed} of {} did what they should, in {wall_s:.2} s", cases.len())
}
