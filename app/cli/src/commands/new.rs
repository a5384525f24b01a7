//! `interplay new`

use std::path::{Path, PathBuf};
use std::{fs, io};

use clap::Args;
use interplay_files::{NewFolders, write_new};
use interplay_presentation::shell;
use interplay_scenarios::{LoadError, Registry};
use thiserror::Error;

use crate::commands::schema;
use crate::output::error::ExitStatus;
use crate::output::{print_error, print_load_error, printed};

/// What editors complete from, beside the scenario.
const SCHEMA_FILE: &str = "interplay.schema.json";

/// Write a commented scenario file to start from: each key with what it means and its unit.
///
/// The file means the same as the scenario that it starts from, and stands on its own. With `--all`, lines such as `#step_s = 0.1` show
/// all other keys with their defaults: take away the `#` to change them. The schema for editors is written beside it, unless it is there
/// already.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  interplay new my.toml --from intersection/nice && interplay run my.toml")]
pub(crate) struct New {
    /// The file to write; a file that exists is never overwritten
    #[arg(value_name = "FILE")]
    file: PathBuf,

    /// Name of an embedded scenario (see `interplay list`) or path of a scenario file
    #[arg(long, value_name = "NAME|FILE", default_value = crate::commands::run::DEFAULT_SCENARIO)]
    from: String,

    /// Also write every key that the scenario does not state, as a comment with its default
    #[arg(long)]
    all: bool,
}

/// Why no new file was written.
#[derive(Debug, Error)]
enum NewError {
    #[error(transparent)]
    Origin(#[from] LoadError),
    #[error("`{}` exists already, and `interplay new` overwrites nothing; choose another name", .0.display())]
    Exists(PathBuf),
    #[error("cannot write `{}`: {reason}", path.display())]
    Unwritable { path: PathBuf, reason: io::Error },
}

impl New {
    pub(crate) fn execute(self, registry: &Registry) -> ExitStatus {
        match self.write(registry) {
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

    fn write(&self, registry: &Registry) -> Result<(), NewError> {
        if self.file.exists() {
            return Err(NewError::Exists(self.file.clone()));
        }
        let folder = self.file.parent().unwrap_or(Path::new(""));
        let scenario = registry.commented(&self.from, folder, self.all)?;
        let words = ["interplay", "new", &self.file.to_string_lossy(), "--from", &self.from].map(str::to_owned);
        // A comment must stay one line, even if the name of the file contains a line break.
        let command = shell::line(words.iter().map(String::as_str)).replace(char::is_control, "·");
        let how = if self.all {
            "# Lines such as `#key = value` show defaults, or examples where there is none: take away the `#` to change them,\n\
             # and that of the `#[table]` above them.\n"
        } else {
            "# `interplay new --all` writes the keys that are not stated here, too, with their defaults.\n"
        };
        let head = format!("#:schema {SCHEMA_FILE}\n# Written by `{command}`.\n{how}\n");
        let folders = NewFolders::make_above(&self.file).map_err(unwritable(&self.file))?;
        // The schema is written first: if the scenario file exists, its schema exists too.
        let schema = folder.join(SCHEMA_FILE);
        let is_missing = !schema.exists();
        if is_missing {
            create(&schema, &schema::text(registry))?;
        }
        create(&self.file, &(head + &scenario)).inspect_err(|_| {
            if is_missing {
                let _ = fs::remove_file(&schema);
            }
        })?;
        folders.keep();
        Ok(())
    }
}

/// Writes a file that must not exist.
fn create(path: &Path, text: &str) -> Result<(), NewError> {
    write_new(path, text.as_bytes()).map_err(|reason| match reason.kind() {
        io::ErrorKind::AlreadyExists => NewError::Exists(path.to_owned()),
        _ => unwritable(path)(reason),
    })
}

fn unwritable(path: &Path) -> impl Fn(io::Error) -> NewError {
    move |reason| NewError::Unwritable { path: path.to_owned(), reason }
}
