//! `interplay completions`

use clap::Args;
use clap_complete::Shell;

use crate::output::exit_status::ExitStatus;
use crate::output::printed;

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
        let mut script = Vec::new();
        clap_complete::generate(self.shell, &mut interplay, "interplay", &mut script);
        printed(&String::from_utf8_lossy(&script))
    }
}
