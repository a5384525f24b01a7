//! `interplay check`

use std::path::{Path, PathBuf};

use clap::Args;
use interplay_scenarios::load;

use super::{Ending, complain, complain_about, print};

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
            match files(path) {
                Ok(files) => {
                    for file in files {
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
                    complain(&format!("cannot read folder `{path}`: {error}"));
                    ending = Ending::BadInput;
                }
            }
        }
        ending
    }
}

/// The files that an argument stands for, sorted.
fn files(path: &str) -> std::io::Result<Vec<String>> {
    if !Path::new(path).is_dir() {
        return Ok(vec![path.to_owned()]);
    }
    let (mut folders, mut found) = (vec![PathBuf::from(path)], Vec::new());
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder)? {
            let entry = entry?;
            let kind = entry.file_type()?;
            if kind.is_dir() {
                folders.push(entry.path());
            } else if entry.path().extension().is_some_and(|extension| extension == "toml") {
                found.push(entry.path().to_string_lossy().into_owned());
            }
        }
    }
    found.sort();
    if found.is_empty() {
        return Err(std::io::Error::other("there is no .toml file in it"));
    }
    Ok(found)
}
