//! What commands say: results on stdout, everything else on stderr.

pub(crate) mod error;
pub(crate) mod exit_status;
pub(crate) mod program;
pub(crate) mod progress;
pub(crate) mod refusal;

use std::borrow::Cow;
use std::io::{self, ErrorKind, Write};

use interplay_scenarios::{Scenario, is_plain};
use serde::Serialize;

use crate::output::error::CommandError;
use crate::output::exit_status::ExitStatus;

/// Prints a result. A reader that has gone away (a closed pipe) is no error of ours.
///
/// # Errors
/// [`CommandError::Output`] if the result is not where it should be, such as on a full disk.
pub(crate) fn print(text: &str) -> Result<(), CommandError> {
    let mut out = io::stdout().lock();
    delivered(out.write_all(harmless(text).as_bytes()).and_then(|()| out.flush()))
}

/// A reader that has gone away is no error.
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

/// Says what went wrong.
pub(crate) fn print_error(text: &str) {
    let _ = writeln!(io::stderr().lock(), "{}", harmless(text));
}

/// A text without what makes a terminal do anything but show it in colours: a title or a cell of a table may hold anything.
///
/// Line ends, tabs and sequences that choose a colour stay; any other character that is not plain becomes its escape, such as `\u{7}`.
fn harmless(text: &str) -> Cow<'_, str> {
    if text.chars().all(is_plain) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(letter) = rest.chars().next() {
        let length = colour_length(rest).unwrap_or(letter.len_utf8());
        let (part, after) = rest.split_at(length);
        if length > letter.len_utf8() || is_plain(letter) {
            shown.push_str(part);
        } else {
            shown.extend(letter.escape_unicode());
        }
        rest = after;
    }
    Cow::Owned(shown)
}

/// Length of the sequence at the begin of a text that chooses a colour, if there is one: `ESC [ digits ; … m`.
fn colour_length(text: &str) -> Option<usize> {
    let parameters = text.strip_prefix("\u{1b}[")?;
    let end = parameters.find(|letter: char| !letter.is_ascii_digit() && letter != ';')?;
    parameters[end..].starts_with('m').then_some("\u{1b}[".len() + end + 1)
}

/// Says what is wrong with a file, with the place underlined.
pub(crate) fn print_load_error(error: interplay_scenarios::LoadError) {
    print_error(format!("{:?}", miette::Report::new(error)).trim_end());
}

/// One JSON document; an error calls it `what`.
pub(crate) fn json(what: &'static str, value: &impl Serialize) -> Result<String, CommandError> {
    let text = serde_json::to_string_pretty(value);
    text.map(|text| text + "\n").map_err(|reason| CommandError::Json { what, reason })
}

/// Why a scenario cannot be run by the command: a vehicle of it waits for inputs from outside.
pub(crate) fn without_input(scenario: &Scenario) -> Option<String> {
    let external = scenario.vehicles.iter().find(|vehicle| vehicle.driver.kind() == "external")?;
    Some(format!(
        "`{name}` has `driver = {{ kind = \"external\" }}`, and nothing drives it here: a program of your own does \
         (`Simulation::apply`), or `--set 'vehicle.{name}.driver={{ kind = \"human\" }}'` gives it another driver",
        name = external.name
    ))
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    #[test]
    fn a_terminal_shows_a_text_and_obeys_only_its_colours() {
        assert_eq!(harmless("a\tb\nc"), "a\tb\nc");
        assert_eq!(harmless("\u{1b}[1;31mred\u{1b}[0m"), "\u{1b}[1;31mred\u{1b}[0m");
        assert_eq!(harmless("\u{1b}]0;title\u{7}"), "\\u{1b}]0;title\\u{7}");
        assert_eq!(harmless("\u{1b}[2Jgone\r"), "\\u{1b}[2Jgone\\u{d}");
        assert_eq!(harmless("a\u{202e}b"), "a\\u{202e}b");
        assert_eq!(harmless("\u{9b}31m\u{1b}[31"), "\\u{9b}31m\\u{1b}[31");
    }

    #[test]
    fn what_cannot_be_written_as_json_is_an_error() {
        let pairs = BTreeMap::from([([1, 2], 3)]);
        let error = json("the report", &pairs).expect_err("a key of JSON is a text").to_string();
        assert!(error.starts_with("the report cannot be written as JSON: "), "{error}");
        assert_eq!(json("numbers", &[0.1 + 0.2]).expect("numbers"), "[\n  0.30000000000000004\n]\n");
    }
}
