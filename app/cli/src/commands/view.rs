//! `interplay view`

use std::io::Read;
use std::path::PathBuf;
use std::process::{Command, Stdio};

use clap::Args;
use interplay_presentation::record::{MAGIC, viewer_version};
use interplay_scenarios::open_regular;
use thiserror::Error;

use crate::output::error::ExitStatus;
use crate::output::print_error;

/// Open recordings in the installed Rerun viewer, once its version is seen to be the right one.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  interplay view recordings/lane-change/front-nice.rrd")]
pub(crate) struct View {
    /// Recordings, opened side by side
    #[arg(value_name = "FILE.rrd", required = true)]
    files: Vec<PathBuf>,
}

#[derive(Debug, Error)]
enum ViewError {
    #[error("cannot read `{}`: {reason}; `interplay run` writes recordings", path.display())]
    Unreadable { path: PathBuf, reason: String },
    #[error("`{}` is not a recording; `interplay run` writes recordings, usually into recordings/", .0.display())]
    NoRecording(PathBuf),
    #[error("there is no Rerun viewer here; to get it: pip install rerun-sdk=={0}")]
    NoViewer(String),
    #[error(
        "the Rerun viewer here is of version {found}, and the recording of {wanted}; to get it: pip install rerun-sdk=={wanted}"
    )]
    OtherVersion { found: String, wanted: String },
    #[error("the Rerun viewer ended with an error ({0})")]
    Ended(String),
}

impl View {
    pub(crate) fn execute(self) -> ExitStatus {
        match self.view() {
            Ok(()) => ExitStatus::Well,
            Err(error) => {
                print_error(&error.to_string());
                match error {
                    ViewError::Unreadable { .. } | ViewError::NoRecording(_) => ExitStatus::BadInput,
                    _ => ExitStatus::Unfinished,
                }
            }
        }
    }

    /// Opens the recordings and waits until the viewer is closed.
    fn view(&self) -> Result<(), ViewError> {
        for path in &self.files {
            let mut start = [0; MAGIC.len()];
            let unreadable =
                |error: std::io::Error| ViewError::Unreadable { path: path.clone(), reason: error.to_string() };
            let mut file = open_regular(path).map_err(unreadable)?;
            if file.read_exact(&mut start).is_err() || start != MAGIC {
                return Err(ViewError::NoRecording(path.clone()));
            }
        }
        let wanted = viewer_version();
        let asked = Command::new("rerun").arg("--version").stdin(Stdio::null()).output();
        let asked = asked.map_err(|_| ViewError::NoViewer(wanted.clone()))?;
        let found = version_in(&String::from_utf8_lossy(&asked.stdout)).unwrap_or_else(|| "unknown".to_owned());
        if line_of(&found) != line_of(&wanted) {
            return Err(ViewError::OtherVersion { found, wanted });
        }
        let ended = Command::new("rerun").args(&self.files).status();
        match ended {
            Ok(status) if status.success() => Ok(()),
            Ok(status) => Err(ViewError::Ended(status.to_string())),
            Err(error) => Err(ViewError::Ended(error.to_string())),
        }
    }
}

/// The first word like `0.36.3` in what `rerun --version` says.
fn version_in(said: &str) -> Option<String> {
    let is_version = |word: &&str| word.split('.').count() >= 3 && word.starts_with(|c: char| c.is_ascii_digit());
    said.split_whitespace().find(is_version).map(str::to_owned)
}

/// Recordings can be read within a line of versions, such as 0.36.
fn line_of(version: &str) -> Vec<&str> {
    version.split('.').take(2).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_viewer_of_the_same_minor_version_is_accepted() {
        let said =
            "rerun-cli 0.36.3 [rustc 1.92.0, LLVM 21.1.3] x86_64-unknown-linux-gnu release-0.36.3 abc, built 2026";
        assert_eq!(version_in(said).as_deref(), Some("0.36.3"));
        assert_eq!(version_in("command not found"), None);
        assert_eq!(line_of("0.36.3"), line_of("0.36.0"));
        assert_ne!(line_of("0.36.3"), line_of("0.37.0"));
    }
}
