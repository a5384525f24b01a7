//! `interplay completions`

use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser};
use clap_complete::Shell;
use interplay_scenarios::embedded;

use crate::output::exit_status::ExitStatus;
use crate::output::printed;

/// Commands that take a scenario, and the argument that is one.
const TAKES_SCENARIOS: [(&str, &str); 5] =
    [("run", "scenario"), ("suite", "paths"), ("why", "scenario"), ("play", "scenario"), ("export-fmu", "scenario")];

/// Print completions for a shell.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  interplay completions bash > ~/.local/share/bash-completion/completions/interplay")]
pub(crate) struct Completions {
    /// The shell
    #[arg(value_name = "SHELL")]
    shell: Shell,
}

impl Completions {
    pub(crate) fn execute(self, mut interplay: clap::Command) -> ExitStatus {
        // Those of zsh would not offer files any more.
        if self.shell != Shell::Zsh {
            for (name, argument) in TAKES_SCENARIOS {
                let names = embedded().iter().map(|file| PossibleValue::new(file.name));
                let names = PossibleValuesParser::new(names.collect::<Vec<PossibleValue>>());
                interplay = interplay
                    .mut_subcommand(name, |command| command.mut_arg(argument, |argument| argument.value_parser(names)));
            }
        }
        let mut script = Vec::new();
        clap_complete::generate(self.shell, &mut interplay, "interplay", &mut script);
        printed(&String::from_utf8_lossy(&script))
    }
}
