//! The command line: one subcommand a file.
//!
//! Results go to stdout, everything else to stderr. Exit codes: 0 all well, 1 an expectation failed, 2 bad input, 3 a run
//! could not be finished.
//!
//! The binary is this and nothing else:
//!
//! ```no_run
//! fn main() -> std::process::ExitCode {
//!     interplay::main()
//! }
//! ```

mod check;
mod compare;
mod completions;
mod error;
mod exit_status;
mod export_fmu;
mod files;
mod identify;
mod list;
mod man;
mod new;
mod out_of_memory;
mod output;
mod plan_flags;
mod program;
mod progress;
mod refusal;
mod reproduce;
mod run;
mod schema;
mod suite;
mod sweep;
mod threads;
mod values;
mod view;
mod watch;
mod why;

use std::io::Write;
use std::process::ExitCode;

use clap::{CommandFactory, Parser, Subcommand};

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
    Why(why::Why),
    Sweep(sweep::Sweep),
    Compare(compare::Compare),
    New(new::New),
    Schema(schema::Schema),
    View(view::View),
    Reproduce(reproduce::Reproduce),
    Identify(identify::Identify),
    ExportFmu(export_fmu::ExportFmu),
    Completions(completions::Completions),
    Man(man::Man),
}

/// Reads the arguments and does what they say.
pub fn main() -> ExitCode {
    let interplay = match Interplay::try_parse() {
        Ok(interplay) => interplay,
        Err(said) if said.use_stderr() => said.exit(),
        Err(asked) => return output::ended(asked.print().and_then(|()| std::io::stdout().flush())).into(),
    };
    let ending = match interplay.command {
        None => run::Run::default().execute(),
        Some(Command::Run(command)) => command.execute(),
        Some(Command::List(command)) => command.execute(),
        Some(Command::Check(command)) => command.execute(),
        Some(Command::Suite(command)) => command.execute(),
        Some(Command::Why(command)) => command.execute(),
        Some(Command::Sweep(command)) => command.execute(),
        Some(Command::Compare(command)) => command.execute(),
        Some(Command::New(command)) => command.execute(),
        Some(Command::Schema(command)) => command.execute(),
        Some(Command::View(command)) => command.execute(),
        Some(Command::Reproduce(command)) => command.execute(),
        Some(Command::Identify(command)) => command.execute(),
        Some(Command::ExportFmu(command)) => command.execute(),
        Some(Command::Completions(command)) => command.execute(Interplay::command()),
        Some(Command::Man(command)) => command.execute(Interplay::command()),
    };
    ending.into()
}
