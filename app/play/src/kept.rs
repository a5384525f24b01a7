//! What was played as a file.

use std::io;
use std::path::{Path, PathBuf};

use crate::session::Session;

/// Writes what was played into a folder, under a name that nobody has: the scenario's and a number. Returns the path.
///
/// # Errors
/// What the system says.
pub fn keep(session: &Session, folder: &Path) -> io::Result<PathBuf> {
    let path = free_name(folder, session.name());
    write(session, &path)?;
    Ok(path)
}

/// Writes what was played to a file, whole or not at all.
///
/// # Errors
/// What the system says.
pub fn write(session: &Session, path: &Path) -> io::Result<()> {
    interplay_files::write(path, session.played().to_file().to_toml().as_bytes())
}

/// A name in a folder that no file has.
fn free_name(folder: &Path, scenario: &str) -> PathBuf {
    let stem = scenario.strip_suffix(".toml").unwrap_or(scenario);
    let plain: String =
        stem.chars().map(|letter| if letter.is_alphanumeric() || letter == '-' { letter } else { '-' }).collect();
    let name = plain.trim_matches('-');
    let named = |number: u64| folder.join(format!("{name}-{number}.toml"));
    (1..).map(named).find(|path| !path.exists()).unwrap_or_else(|| named(0))
}
