//! Runs as JUnit XML for build servers: a test case for every run and counterfactual, a failure for failed expectations, an error
//! for a file that is unusable or an unfinished run.

use std::time::Duration;

use interplay_simulation::report::Expectation;
use quick_junit::{NonSuccessKind, Report, SerializeError, TestCase, TestCaseStatus, TestSuite, XmlString};

use super::{Case, CaseError};

/// The document; the suite took `wall_s` seconds.
///
/// # Errors
/// [`SerializeError`] if the writer of XML refuses a text.
pub fn junit(cases: &[Case], wall_s: f64) -> Result<String, SerializeError> {
    let mut suite = TestSuite::new("scenarios");
    suite.set_time(seconds(wall_s)).add_test_cases(cases.iter().flat_map(test_cases));
    let mut report = Report::new("interplay");
    report.set_time(seconds(wall_s)).add_test_suite(suite);
    report.to_string()
}

/// `family/name` is the case `name` of the class `family`; each of its counterfactuals is the case `name: claim` of that class.
fn test_cases(case: &Case) -> Vec<TestCase> {
    let (family, name) = case.name.rsplit_once('/').unwrap_or(("scenarios", &case.name));
    let (status, time_s) = match &case.outcome {
        Ok(report) => (failures(&mut case.failed()), report.wall_s),
        Err(error) => {
            let mut status = TestCaseStatus::non_success(NonSuccessKind::Error);
            status.set_message(text(&error_message(error)));
            (status, 0.0)
        }
    };
    let others = case.counterfactuals().map(|one| {
        let name = format!("{name}: {}", one.name);
        test_case(family, &name, failures(&mut one.failed()), one.run.wall_s)
    });
    std::iter::once(test_case(family, name, status, time_s)).chain(others).collect()
}

/// An error with the first fault of a file, which names its place.
fn error_message(error: &CaseError) -> String {
    match error {
        CaseError::Unusable(load) => {
            let faults = load.faults().iter().map(|fault| {
                let place = fault.line_and_column().map_or_else(String::new, |(line, _)| format!(" in line {line}"));
                format!("{}{place}", fault.message())
            });
            format!("{error}: {}", faults.collect::<Vec<_>>().join("; "))
        }
        CaseError::Unfinished(_) => error.to_string(),
    }
}

/// The status of a test case with these failed expectations.
fn failures(failed: &mut dyn Iterator<Item = &Expectation>) -> TestCaseStatus {
    let failed: Vec<String> = failed.map(ToString::to_string).collect();
    let Some(first) = failed.first() else { return TestCaseStatus::success() };
    let mut status = TestCaseStatus::non_success(NonSuccessKind::Failure);
    status.set_message(text(first)).set_description(text(&failed.join("\n")));
    status
}

fn test_case(class: &str, name: &str, status: TestCaseStatus, time_s: f64) -> TestCase {
    let mut test_case = TestCase::new(text(name), status);
    test_case.set_classname(text(class)).set_time(seconds(time_s));
    test_case
}

fn seconds(time_s: f64) -> Duration {
    Duration::try_from_secs_f64(time_s).unwrap_or_default()
}

/// Replaces characters that XML 1.0 does not allow by `?`. The library would leave two of them in, and drop others together with
/// the text after an escape character.
fn text(text: &str) -> XmlString {
    let is_refused = |c: char| (c.is_control() && !matches!(c, '\n' | '\t')) || matches!(c, '\u{fffe}' | '\u{ffff}');
    XmlString::new(text.replace(is_refused, "?"))
}

#[cfg(test)]
mod tests {
    use interplay_simulation::run::RunError;

    use super::*;

    fn unfinished(name: &str, error: &str) -> String {
        let case = Case { name: name.to_owned(), outcome: Err(RunError::Watch(error.into()).into()) };
        junit(&[case], 1.0).expect("it can be written")
    }

    #[test]
    fn markup_in_texts_is_escaped() {
        let written = unfinished("a<b & \"c\">\u{1b}\u{ffff}", "grün – 1.5 m/s²");
        assert!(written.contains(r#"name="a&lt;b &amp; &quot;c&quot;&gt;??""#), "{written}");
        assert!(written.contains(r#"message="grün – 1.5 m/s²""#), "{written}");
    }

    #[test]
    fn an_unfinished_run_is_an_error() {
        let written = unfinished("family/one", "the \"loop\" broke");
        assert!(written.contains(r#"tests="1" skipped="0" failures="0" errors="1" time="1.000""#), "{written}");
        assert!(written.contains(r#"name="one" classname="family" time="0.000">"#), "{written}");
        assert!(written.contains(r#"<error message="the &quot;loop&quot; broke"/>"#), "{written}");
    }
}
