//! The command line: one subcommand a file.
//!
//! Results go to stdout, everything else to stderr. Exit codes: 0 all well, 1 an expectation failed or, where nothing was expected, the
//! ego began a contact, 2 bad input, 3 a run could not be finished.
//!
//! The binary is this and nothing else:
//!
//! ```no_run
//! fn main() -> std::process::ExitCode {
//!     interplay::main()
//! }
//! ```

mod commands;
mod flag_values;
mod output;
mod process;
pub mod run_outputs;

use std::ffi::OsString;
use std::io::Write;
use std::process::ExitCode;
use std::sync::LazyLock;

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
use interplay_scenarios::Registry;
use interplay_simulation::environment::RegisterPolicies;
use interplay_simulation::measure::RegisterMetrics;

use crate::output::error::ExitStatus;
use commands::{
    bench, check, compare, completions, export_fmu, fit, fmu_host, identify, import, list, man, new, play, predict,
    reproduce, run, schema, suite, sweep, view, why,
};

/// The version and the commit it was built from, which packages name in the environment variable `INTERPLAY_COMMIT`.
static VERSION: LazyLock<String> = LazyLock::new(|| {
    let commit = option_env!("INTERPLAY_COMMIT").unwrap_or("unknown");
    format!("{} (commit {commit})", env!("CARGO_PKG_VERSION"))
});

/// Simulate agents that must interact: scenarios in, verdicts and recordings out.
#[derive(Debug, Parser)]
#[command(name = "interplay", version = VERSION.as_str(), max_term_width = 100)]
#[command(after_help = "Without a command: interplay run people/intersection --no-record.\n\n\
    Exit codes: 0 all well, 1 an expectation failed or, where nothing was expected, the ego began a contact, \
    2 bad input, 3 a run could not be finished.")]
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
    Bench(bench::Bench),
    Compare(compare::Compare),
    New(new::New),
    Import(import::Import),
    Play(play::Play),
    Predict(predict::Predict),
    Fit(fit::Fit),
    Schema(schema::Schema),
    View(view::View),
    Reproduce(reproduce::Reproduce),
    Identify(identify::Identify),
    ExportFmu(export_fmu::ExportFmu),
    /// Run a functional mock-up unit for a run of ours; runs start it by themselves
    #[command(hide = true)]
    FmuHost(fmu_host::FmuHost),
    Completions(completions::Completions),
    Man(man::Man),
}

/// Runs the command with the arguments of this process and the kinds that Interplay provides.
pub fn main() -> ExitCode {
    main_with(Registry::standard())
}

/// Runs the command with the kinds of drivers and the metrics of a registry: the whole command for a crate that adds its own.
pub fn main_with(registry: &Registry) -> ExitCode {
    process::limits::writing_too_much_is_an_error();
    let ending = process::limits::on_a_thread_of_its_own(|| exit_code(registry, std::env::args_os()));
    ending
        .unwrap_or_else(|reason| {
            output::print_error(&format!("cannot start a thread: {reason}; `ulimit -u` says how many a user may have"));
            ExitStatus::Unfinished as u8
        })
        .into()
}

/// Runs the command inside another program, with a registry and these arguments, of which the first is the program's
/// name. Returns the exit code.
pub fn exit_code(registry: &Registry, arguments: impl IntoIterator<Item = OsString>) -> u8 {
    let ending = match registry.clone().with_own_metrics().and_then(RegisterPolicies::with_policies) {
        Ok(registry) => run_command(&registry, arguments),
        Err(error) => {
            output::print_error(&error.to_string());
            ExitStatus::BadInput
        }
    };
    ending as u8
}

fn run_command(registry: &Registry, arguments: impl IntoIterator<Item = OsString>) -> ExitStatus {
    let mut command = command(registry);
    let parsed = command.try_get_matches_from_mut(arguments);
    let interplay = match parsed.and_then(|found| Interplay::from_arg_matches(&found)) {
        Ok(interplay) => interplay,
        Err(said) if said.use_stderr() => {
            output::print_usage_error(&output::usage::with_advice(said, &command));
            return ExitStatus::BadInput;
        }
        Err(asked) => return output::ended(asked.print().and_then(|()| std::io::stdout().flush())),
    };
    match interplay.command {
        None => run::Run::first().execute(registry),
        Some(Command::Run(command)) => command.execute(registry),
        Some(Command::List(command)) => command.execute(),
        Some(Command::Check(command)) => command.execute(registry),
        Some(Command::Suite(command)) => command.execute(registry),
        Some(Command::Why(command)) => command.execute(registry),
        Some(Command::Sweep(command)) => command.execute(registry),
        Some(Command::Bench(command)) => command.execute(registry),
        Some(Command::Compare(command)) => command.execute(registry),
        Some(Command::New(command)) => command.execute(registry),
        Some(Command::Import(command)) => command.execute(registry),
        Some(Command::Play(command)) => command.execute(registry),
        Some(Command::Predict(command)) => command.execute(),
        Some(Command::Fit(command)) => command.execute(),
        Some(Command::Schema(command)) => command.execute(registry),
        Some(Command::View(command)) => command.execute(),
        Some(Command::Reproduce(command)) => command.execute(),
        Some(Command::Identify(command)) => command.execute(),
        Some(Command::ExportFmu(command)) => command.execute(registry),
        Some(Command::FmuHost(command)) => command.execute(),
        Some(Command::Completions(asked)) => asked.execute(command, registry),
        Some(Command::Man(asked)) => asked.execute(command),
    }
}

/// The arguments, with the kinds of drivers that `--planner` takes.
fn command(registry: &Registry) -> clap::Command {
    let kinds = completions::planners(registry).collect::<Vec<&str>>().join(", ");
    let drivers = format!("Driver of the ego instead of the scenario's own: {kinds}");
    let mut command = Interplay::command();
    for name in ["run", "suite", "check"] {
        command = command.mut_subcommand(name, |one| one.mut_arg("planner", |planner| planner.help(drivers.clone())));
    }
    command
}
