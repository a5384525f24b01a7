//! The command line: one subcommand a file.
//!
//! Results go to stdout, everything else to stderr. Exit codes: 0 all well, 1 an expectation failed, 2 bad input, 3 a run
//! could not be finished.

mod check;
mod completions;
mod files;
mod identify;
mod list;
mod man;
mod new;
mod progress;
mod reproduce;
mod run;
mod schema;
mod suite;
mod view;
mod watch;

use std::io::Write;
use std::process::ExitCode;

use clap::{CommandFactory, Parser, Subcommand};
use serde::Serialize;

/// Simulate agents that must interact: scenarios in, verdicts and recordings out.
#[derive(Debug, Parser)]
#[command(name = "interplay", version, max_term_width = 100)]
#[command(after_help = "Without a command: interplay run lane-change/front-nice.\n\n\
    Exit codes: 0 all well, 1 an expectation failed, 2 bad input, 3 a run could not be finished.")]
struct Interplay {
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Debug, Subcommand)]
enum Command {
    Run(run::Run),
    List(list::List),
    Check(check::Check),
    Suite(suite::Suite),
    New(new::New),
    Schema(schema::Schema),
    View(view::View),
    Reproduce(reproduce::Reproduce),
    Identify(identify::Identify),
    Completions(completions::Completions),
    Man(man::Man),
}

/// How a command ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Ending {
    /// All well.
    Well,
    /// An expectation failed.
    Failed,
    /// Bad input.
    BadInput,
    /// A run could not be finished.
    Unfinished,
}

impl From<Ending> for ExitCode {
    fn from(ending: Ending) -> Self {
        match ending {
            Ending::Well => ExitCode::SUCCESS,
            Ending::Failed => ExitCode::from(1),
            Ending::BadInput => ExitCode::from(2),
            Ending::Unfinished => ExitCode::from(3),
        }
    }
}

/// Reads the arguments and does what they say.
pub fn main() -> ExitCode {
    let interplay = Interplay::parse();
    let ending = match interplay.command {
        None => run::Run::default().execute(),
        Some(Command::Run(command)) => command.execute(),
        Some(Command::List(command)) => command.execute(),
        Some(Command::Check(command)) => command.execute(),
        Some(Command::Suite(command)) => command.execute(),
        Some(Command::New(command)) => command.execute(),
        Some(Command::Schema(command)) => command.execute(),
        Some(Command::View(command)) => command.execute(),
        Some(Command::Reproduce(command)) => command.execute(),
        Some(Command::Identify(command)) => command.execute(),
        Some(Command::Completions(command)) => command.execute(Interplay::command()),
        Some(Command::Man(command)) => command.execute(Interplay::command()),
    };
    ending.into()
}

/// Prints a result. A reader that has gone away (a closed pipe) is no error of ours.
pub(crate) fn print(text: &str) {
    let mut out = std::io::stdout().lock();
    let _ = out.write_all(text.as_bytes()).and_then(|()| out.flush());
}

/// Says what went wrong.
pub(crate) fn complain(text: &str) {
    let _ = writeln!(std::io::stderr().lock(), "{text}");
}

/// Says what is wrong with a file, with the place underlined.
pub(crate) fn complain_about(error: interplay_scenarios::LoadError) {
    complain(format!("{:?}", miette::Report::new(error)).trim_end());
}

/// One JSON document.
pub(crate) fn json(value: &impl Serialize) -> Result<String, String> {
    let text = serde_json::to_string_pretty(value);
    text.map(|text| text + "\n").map_err(|error| format!("the report cannot be written as JSON: {error}"))
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    #[test]
    fn what_cannot_be_written_as_json_is_an_error() {
        let pairs = BTreeMap::from([([1, 2], 3)]);
        let error = json(&pairs).expect_err("a key of JSON is a text");
        assert!(error.starts_with("the report cannot be written as JSON: "), "{error}");
        assert_eq!(json(&[0.1 + 0.2]).expect("numbers"), "[\n  0.30000000000000004\n]\n");
    }
}
