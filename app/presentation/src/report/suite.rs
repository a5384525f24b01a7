//! Many runs in one readable table.

use std::fmt::Write;

use interplay_simulation::report::{Expectation, Report};
use interplay_simulation::run::RunError;

use super::columns::{Align, lines};

/// One run of a suite: its report, or why it could not be finished.
#[derive(Debug)]
pub struct Case {
    /// What the run is called.
    pub name: String,
    /// How it ended.
    pub outcome: Result<Report, RunError>,
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
    use Align::{Left, Right};
    let header =
        [("scenario", Left), ("outcome", Left), ("collisions", Right), ("smallest gap m", Right), ("time s", Right)];
    let row = |case: &Case| {
        let mut row = vec![case.name.clone(), case.verdict().to_owned()];
        if let Ok(report) = &case.outcome {
            let gap = report.min_gap_m.map_or_else(|| "-".to_owned(), |gap| format!("{gap:.3}"));
            row.extend([report.collisions.len().to_string(), gap, format!("{:.2}", report.wall_s)]);
        }
        row
    };
    let lines = lines(&header, cases.iter().map(row));
    lines.iter().take(1).try_for_each(|header| writeln!(text, "{header}"))?;
    for (case, line) in cases.iter().zip(&lines[1..]) {
        match &case.outcome {
            Ok(_) => writeln!(text, "{line}")?,
            Err(error) => writeln!(text, "{line}  {error}")?,
        }
        case.failed().try_for_each(|failed| writeln!(text, "  FAIL {failed}"))?;
    }
    let passed = cases.iter().filter(|case| case.outcome.as_ref().is_ok_and(|report| report.passed)).count();
    let verdict = if passed == cases.len() { "PASSED" } else { "FAILED" };
    writeln!(text, "{verdict}: {passed} of {} did what they should, in {wall_s:.2} s", cases.len())
}
