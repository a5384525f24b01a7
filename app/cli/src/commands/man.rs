//! `interplay man`

use clap::Args;

use crate::output::error::ExitStatus;
use crate::output::{print_error, printed};

/// Print a manual page: of the whole, or of one command.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  interplay man > interplay.1\n  interplay man run > interplay-run.1")]
pub(crate) struct Man {
    /// The command [default: all of them in brief]
    #[arg(value_name = "COMMAND")]
    of: Option<String>,
}

impl Man {
    pub(crate) fn execute(self, mut interplay: clap::Command) -> ExitStatus {
        interplay.build();
        let page = match &self.of {
            None => Some(interplay),
            Some(name) => interplay.find_subcommand(name).cloned(),
        };
        let Some(page) = page else {
            print_error("there is no such command; `interplay help` lists all of them");
            return ExitStatus::BadInput;
        };
        let mut text = Vec::new();
        match clap_mangen::Man::new(page).render(&mut text) {
            Ok(()) => printed(&String::from_utf8_lossy(&text)),
            Err(error) => {
                print_error(&format!("the manual page cannot be written: {error}"));
                ExitStatus::Unfinished
            }
        }
    }
}
