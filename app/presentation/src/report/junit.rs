//! Many runs as JUnit XML, which build servers show: a test case for every run, a failure for what was not as expected,
//! an error for a run that could not be finished.

use std::fmt::Write;

use super::Case;

/// The document; the suite took `wall_s` seconds.
pub fn junit(cases: &[Case], wall_s: f64) -> String {
    let mut text = String::new();
    // Writing to a String cannot fail.
    let _ = write_document(&mut text, cases, wall_s);
    text
}

fn write_document(text: &mut String, cases: &[Case], wall_s: f64) -> std::fmt::Result {
    let errors = cases.iter().filter(|case| case.outcome.is_err()).count();
    let failures = cases.iter().filter(|case| case.failed().next().is_some()).count();
    let counts = format!(r#"tests="{}" failures="{failures}" errors="{errors}" time="{wall_s:.3}""#, cases.len());
    writeln!(text, r#"<?xml version="1.0" encoding="UTF-8"?>"#)?;
    writeln!(text, r#"<testsuites name="interplay" {counts}>"#)?;
    writeln!(text, r#"  <testsuite name="scenarios" {counts}>"#)?;
    for case in cases {
        write_case(text, case)?;
    }
    writeln!(text, "  </testsuite>\n</testsuites>")
}

/// `family/name` is the case `name` of the class `family`.
fn write_case(text: &mut String, case: &Case) -> std::fmt::Result {
    let (family, name) = case.name.rsplit_once('/').unwrap_or(("scenarios", &case.name));
    let time_s = case.outcome.as_ref().map_or(0.0, |report| report.wall_s);
    write!(text, r#"    <testcase classname="{}" name="{}" time="{time_s:.3}""#, escaped(family), escaped(name))?;
    let failed: Vec<String> = case.failed().map(ToString::to_string).collect();
    match &case.outcome {
        Ok(_) if failed.is_empty() => writeln!(text, "/>"),
        Ok(_) => {
            let all = escaped(&failed.join("\n"));
            writeln!(text, ">\n      <failure message=\"{}\">{all}</failure>\n    </testcase>", escaped(&failed[0]))
        }
        Err(error) => writeln!(text, ">\n      <error message=\"{}\"/>\n    </testcase>", escaped(error)),
    }
}

/// A text as XML 1.0 takes it, in content and between double quotes; characters that XML cannot hold become `?`.
fn escaped(text: &str) -> String {
    let mut escaped = String::new();
    for character in text.chars() {
        match character {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\n' | '\t' | '\r' => escaped.push_str(&format!("&#{};", u32::from(character))),
            _ if character.is_control() || matches!(character, '\u{fffe}' | '\u{ffff}') => escaped.push('?'),
            _ => escaped.push(character),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_in_a_text_is_taken_for_markup() {
        assert_eq!(escaped("a<b & \"c\">\u{1b}\n"), "a&lt;b &amp; &quot;c&quot;&gt;?&#10;");
        assert_eq!(escaped("grün – 1.5 m/s²"), "grün – 1.5 m/s²");
    }

    #[test]
    fn an_unfinished_run_is_an_error() {
        let case = Case { name: "family/one".to_owned(), outcome: Err("the \"loop\" broke".to_owned()) };
        let text = junit(&[case], 1.0);
        assert!(text.contains(r#"tests="1" failures="0" errors="1" time="1.000""#), "{text}");
        assert!(text.contains(r#"classname="family" name="one" time="0.000">"#), "{text}");
        assert!(text.contains(r#"<error message="the &quot;loop&quot; broke"/>"#), "{text}");
    }
}
