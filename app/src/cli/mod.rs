//! The command line: one subcommand a file.
//!
//! Results go to stdout, everything else to stderr. Exit codes: 0 all well, 1 an expectation failed, 2 bad input, 3 a run
//! could not be finished.

mod check;
mod identify;
mod list;
mod run;
mod shell;

use std::io::Write;
use std::process::ExitCode;

use clap::{Parser, Subcommand};

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
    Identify(identify::Identify),
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
        Some(Command::Identify(command)) => command.execute(),
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
