//! `interplay man`

use clap::Args;

use crate::ending::Ending;
use crate::output::{complain, print};

/// Print a manual page: of the whole, or of one command.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  interplay man > interplay.1\n  interplay man run > interplay-run.1")]
pub(crate) struct Man {
    /// The command [default: all of them in brief]
    #[arg(value_name = "COMMAND")]
    of: Option<String>,
}

impl Man {
    pub(crate) fn execute(self, mut interplay: clap::Command) -> Ending {
        interplay.build();
        let page = match &self.of {
            None => Some(interplay),
            Some(name) => interplay.find_subcommand(name).cloned(),
        };
        let Some(page) = page else {
            complain("there is no such command; `interplay help` lists all of them");
            return Ending::BadInput;
        };
        let mut text = Vec::new();
        match clap_mangen::Man::new(page).render(&mut text) {
            Ok(()) => {
                print(&String::from_utf8_lossy(&text));
                Ending::Well
            }
            Err(error) => {
                complain(&format!("the manual page cannot be written: {error}"));
                Ending::Unfinished
            }
        }
    }
}
