//! `interplay completions`

use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser};
use clap_complete::Shell;
use interplay_scenarios::{Registry, embedded};

use crate::output::error::ExitStatus;
use crate::output::printed;

/// Commands that take a scenario, and the argument that is one.
const TAKES_SCENARIOS: [(&str, &str); 6] = [
    ("run", "scenario"),
    ("check", "paths"),
    ("suite", "paths"),
    ("why", "scenario"),
    ("play", "scenario"),
    ("export-fmu", "scenario"),
];

/// Print completions for a shell.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  interplay completions bash > ~/.local/share/bash-completion/completions/interplay")]
pub(crate) struct Completions {
    /// The shell
    #[arg(value_name = "SHELL")]
    shell: Shell,
}

impl Completions {
    pub(crate) fn execute(self, mut interplay: clap::Command, registry: &Registry) -> ExitStatus {
        for name in with_planner(&interplay) {
            // Values of arguments live as long as the process.
            let kinds = planners(registry).map(|kind| PossibleValue::new(&*kind.to_owned().leak()));
            let kinds = PossibleValuesParser::new(kinds.collect::<Vec<PossibleValue>>());
            interplay = interplay
                .mut_subcommand(name, |command| command.mut_arg("planner", |planner| planner.value_parser(kinds)));
        }
        for (name, argument) in TAKES_SCENARIOS {
            let names = embedded().iter().map(|file| PossibleValue::new(file.name));
            let names = PossibleValuesParser::new(names.collect::<Vec<PossibleValue>>());
            interplay = interplay
                .mut_subcommand(name, |command| command.mut_arg(argument, |argument| argument.value_parser(names)));
        }
        let mut script = Vec::new();
        clap_complete::generate(self.shell, &mut interplay, "interplay", &mut script);
        let script = String::from_utf8_lossy(&script);
        printed(&match self.shell {
            Shell::Zsh => zsh_with_files(&script),
            Shell::Fish => fish_with_names(&script),
            _ => script.into_owned(),
        })
    }
}

/// Kinds of drivers that `--planner` refuses: they need more than their name.
const NO_PLANNERS: [&str; 4] = ["external", "inputs", "recorded", "walker"];

/// The kinds of drivers that `--planner` takes.
pub(crate) fn planners(registry: &Registry) -> impl Iterator<Item = &str> {
    registry.driver_kinds().into_iter().filter(|kind| !NO_PLANNERS.contains(kind))
}

/// The subcommands with a flag `--planner`.
fn with_planner(interplay: &clap::Command) -> Vec<String> {
    let has_planner = |command: &&clap::Command| command.get_arguments().any(|argument| argument.get_id() == "planner");
    interplay.get_subcommands().filter(has_planner).map(|command| command.get_name().to_owned()).collect()
}

fn names() -> String {
    embedded().iter().map(|file| file.name).collect::<Vec<&str>>().join(" ")
}

/// A script for fish with the names of scenarios: what is generated completes the values of options alone.
fn fish_with_names(script: &str) -> String {
    let names = names();
    let line = |(command, _): &(&str, &str)| {
        format!("complete -c interplay -n \"__fish_interplay_using_subcommand {command}\" -a \"{names}\"\n")
    };
    script.to_owned() + &TAKES_SCENARIOS.iter().map(line).collect::<String>()
}

/// A script for zsh where scenarios are offered beside files: values alone would be all that it offers.
fn zsh_with_files(script: &str) -> String {
    let names = names();
    let function = format!(
        "_interplay_scenarios() {{\n    _alternative 'scenarios:scenario:({names})' 'files:file:_files'\n}}\n\n_interplay() {{"
    );
    script.replace(&format!("({names})"), "_interplay_scenarios").replacen("_interplay() {", &function, 1)
}
