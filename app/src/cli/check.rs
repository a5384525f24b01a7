//! `interplay check`

use clap::Args;
use interplay_scenarios::load;

use super::{Ending, complain, complain_about, files, print};

/// Check scenario files without running them; every error is located.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  interplay check my.toml\n  interplay check scenarios/")]
pub(super) struct Check {
    /// Scenario files, names of embedded scenarios, or folders that are searched for .toml files
    #[arg(value_name = "FILE|DIR", required = true)]
    paths: Vec<String>,
}

impl Check {
    pub(super) fn execute(self) -> Ending {
        let mut ending = Ending::Well;
        for path in &self.paths {
            match files::find(path) {
                Ok(found) => {
                    for file in found.into_iter().map(|found| found.scenario) {
                        match load(&file, &[]) {
                            Ok(_) => print(&format!("ok  {file}\n")),
                            Err(error) => {
                                complain_about(error);
                                ending = Ending::BadInput;
                            }
                        }
                    }
                }
                Err(error) => {
                    complain(&error);
                    ending = Ending::BadInput;
                }
            }
        }
        ending
    }
}
