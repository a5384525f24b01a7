//! Output of commands: results on stdout, everything else on stderr.

pub(crate) mod error;
pub(crate) mod progress;
pub(crate) mod usage;

use std::borrow::Cow;
use std::env;
use std::io::{self, ErrorKind, Write};

use interplay_presentation::shell::is_on_path;
use interplay_scenarios::{Scenario, is_plain};
use interplay_sweep::SweepError;
use miette::{GraphicalReportHandler, GraphicalTheme};
use serde::Serialize;

use crate::output::error::{CommandError, ExitStatus};
use crate::run_outputs::OutputError;

/// Prints a result. A closed pipe is not an error.
///
/// # Errors
/// [`CommandError::Output`] if the result is not where it should be, such as on a full disk.
pub(crate) fn print(text: &str) -> Result<(), CommandError> {
    let mut out = io::stdout().lock();
    delivered(out.write_all(harmless(text).as_bytes()).and_then(|()| out.flush()))
}

/// A closed pipe is not an error.
fn delivered(written: io::Result<()>) -> Result<(), CommandError> {
    match written {
        Err(reason) if reason.kind() != ErrorKind::BrokenPipe => Err(CommandError::Output(reason)),
        _ => Ok(()),
    }
}

/// Prints a result, or says why it could not.
pub(crate) fn printed(text: &str) -> ExitStatus {
    ending(print(text))
}

/// How a command ends that only shows something on the standard output.
pub(crate) fn ended(written: io::Result<()>) -> ExitStatus {
    ending(delivered(written))
}

/// How a command ends whose result was shown or not; says why not.
pub(crate) fn ending(shown: Result<(), CommandError>) -> ExitStatus {
    match shown {
        Ok(()) => ExitStatus::Well,
        Err(error) => {
            print_error(&error.to_string());
            ExitStatus::Unfinished
        }
    }
}

pub(crate) fn print_error(text: &str) {
    let _ = writeln!(io::stderr().lock(), "{}", harmless(text));
}

/// A text without what a terminal obeys instead of showing it: a title or a cell of a table may hold anything.
///
/// Line ends and tabs stay; any other character that is not plain becomes its escape, such as `\u{7}`.
fn harmless(text: &str) -> Cow<'_, str> {
    if text.chars().all(is_plain) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len());
    for letter in text.chars() {
        if is_plain(letter) {
            shown.push(letter);
        } else {
            shown.extend(letter.escape_unicode());
        }
    }
    Cow::Owned(shown)
}

/// Prints the error in a file with its place underlined; in colour only if none of the texts in it contains colours.
pub(crate) fn print_load_error(error: interplay_scenarios::LoadError) {
    let mut plain = String::new();
    let handler = GraphicalReportHandler::new_themed(GraphicalTheme::unicode_nocolor());
    let is_written = handler.render_report(&mut plain, &error).is_ok();
    if is_written && plain.chars().all(is_plain) {
        let _ = writeln!(io::stderr().lock(), "{}", format!("{:?}", miette::Report::new(error)).trim_end());
    } else {
        print_error(plain.trim_end());
    }
}

/// Prints the error in the arguments; in colour only if none of them contains colours.
pub(crate) fn print_usage_error(said: &clap::Error) {
    let plain = said.render().to_string();
    if plain.chars().all(is_plain) {
        let _ = said.print();
    } else {
        print_error(plain.trim_end());
    }
}

/// One JSON document; an error calls it `what`.
pub(crate) fn json(what: &'static str, value: &impl Serialize) -> Result<String, CommandError> {
    let text = serde_json::to_string_pretty(value);
    text.map(|text| text + "\n").map_err(|reason| CommandError::Json { what, reason })
}

/// Why a scenario cannot be run by the command: a vehicle of it waits for inputs from outside.
pub(crate) fn without_input(scenario: &Scenario) -> Option<String> {
    let external = scenario.awaiting_inputs()?;
    Some(format!(
        "`{name}` has `driver = {{ kind = \"external\" }}`, and nothing drives it here: a program of your own does \
         (`Simulation::apply`), or `--set 'vehicle.{name}.driver={{ kind = \"human\" }}'` gives it another driver",
        name = external.name
    ))
}

/// The name by which a shell finds this program again: `interplay` if that is on the path, otherwise what it was called by.
pub(crate) fn this_program() -> String {
    const NAME: &str = "interplay";
    env::args().next().filter(|_| !is_on_path(NAME)).unwrap_or_else(|| NAME.to_owned())
}

/// Prints why a command has no result.
pub(crate) fn gave_up(error: SweepError) -> ExitStatus {
    let ending = if error.is_bad_input() { ExitStatus::BadInput } else { ExitStatus::Unfinished };
    match error {
        SweepError::Refused(refusal) => print_load_error(*refusal),
        other => print_error(&other.to_string()),
    }
    ending
}

/// Says why an output of a run cannot be written.
pub(crate) fn unwritten(error: OutputError) -> ExitStatus {
    match error {
        OutputError::Refused(refusal) => {
            print_load_error(*refusal);
            ExitStatus::BadInput
        }
        OutputError::Table(error) => gave_up(error.into()),
        other => {
            print_error(&other.to_string());
            ExitStatus::Unfinished
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    #[test]
    fn control_characters_are_not_sent_to_a_terminal() {
        assert_eq!(harmless("a\tb\nc"), "a\tb\nc");
        assert_eq!(harmless("\u{1b}[1;31mred"), "\\u{1b}[1;31mred");
        assert_eq!(harmless("\u{1b}]0;title\u{7}"), "\\u{1b}]0;title\\u{7}");
        assert_eq!(harmless("gone\r\u{9b}31m"), "gone\\u{d}\\u{9b}31m");
        assert_eq!(harmless("a\u{202e}b"), "a\\u{202e}b");
    }

    #[test]
    fn a_value_without_a_json_form_is_an_error() {
        let pairs = BTreeMap::from([([1, 2], 3)]);
        let error = json("the report", &pairs).expect_err("a key of JSON is a text").to_string();
        assert!(error.starts_with("the report cannot be written as JSON: "), "{error}");
        assert_eq!(json("numbers", &[0.1 + 0.2]).expect("numbers"), "[\n  0.30000000000000004\n]\n");
    }
}
