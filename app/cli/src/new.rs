//! `interplay new`

use std::fs::{self, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};

use clap::Args;
use interplay_presentation::shell;
use interplay_scenarios::{LoadError, commented};
use thiserror::Error;

use crate::exit_status::ExitStatus;
use crate::output::{print_error, print_load_error, printed};
use crate::schema;

/// What editors complete from, beside the scenario.
const SCHEMA_FILE: &str = "interplay.schema.json";

/// Write a commented scenario file to start from: every key with what it means, its unit and its default.
///
/// The file means the same as the scenario that it starts from, and stands on its own. Lines such as `#step_s = 0.1` show
/// defaults: take away the `#` to change them. The schema for editors is written beside it, unless it is there already.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  interplay new my.toml --from intersection/nice && interplay run my.toml")]
pub(crate) struct New {
    /// The file to write; a file that exists is never overwritten
    #[arg(value_name = "FILE")]
    file: PathBuf,

    /// Name of an embedded scenario (see `interplay list`) or path of a scenario file
    #[arg(long, value_name = "NAME|FILE", default_value = crate::run::DEFAULT_SCENARIO)]
    from: String,
}

/// Why there is no new file.
#[derive(Debug, Error)]
enum NewError {
    #[error(transparent)]
    Origin(#[from] LoadError),
    #[error("`{}` exists already, and `interplay new` overwrites nothing; choose another name", .0.display())]
    Exists(PathBuf),
    #[error("cannot write `{}`: {reason}", path.display())]
    Unwritable { path: PathBuf, reason: String },
}

impl New {
    pub(crate) fn execute(self) -> ExitStatus {
        match self.write() {
            Ok(()) => {
                let run = shell::line(["interplay", "run", &self.file.to_string_lossy()]);
                printed(&format!("wrote {}; to run it: {run}\n", self.file.display()))
            }
            Err(NewError::Origin(error)) => {
                print_load_error(error);
                ExitStatus::BadInput
            }
            Err(error) => {
                print_error(&error.to_string());
                if matches!(error, NewError::Exists(_)) { ExitStatus::BadInput } else { ExitStatus::Unfinished }
            }
        }
    }

    fn write(&self) -> Result<(), NewError> {
        if self.file.exists() {
            return Err(NewError::Exists(self.file.clone()));
        }
        let folder = self.file.parent().unwrap_or(Path::new(""));
        let scenario = commented(&self.from, folder)?;
        let words = ["interplay", "new", &self.file.to_string_lossy(), "--from", &self.from].map(str::to_owned);
        // A comment is one line, whatever the file is called.
        let command = shell::line(words.iter().map(String::as_str)).replace(char::is_control, "·");
        let head = format!(
            "#:schema {SCHEMA_FILE}\n# Written by `{command}`.\n\
             # Lines such as `#key = value` show defaults, or examples where there is none: take away the `#` to change them,\n\
             # and that of the `#[table]` above them.\n\n"
        );
        create(&self.file, &(head + &scenario))?;
        let schema = folder.join(SCHEMA_FILE);
        if schema.exists() { Ok(()) } else { create(&schema, &schema::text()) }
    }
}

/// Writes a file that must not exist, making folders as needed.
fn create(path: &Path, text: &str) -> Result<(), NewError> {
    let unwritable = |error: std::io::Error| NewError::Unwritable { path: path.to_owned(), reason: error.to_string() };
    if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        fs::create_dir_all(folder).map_err(unwritable)?;
    }
    let mut file = OpenOptions::new().write(true).create_new(true).open(path).map_err(unwritable)?;
    file.write_all(text.as_bytes()).and_then(|()| file.sync_all()).map_err(|error| {
        // What is there is ours, and incomplete.
        let _ = fs::remove_file(path);
        unwritable(error)
    })
}
