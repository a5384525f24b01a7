//! Files of played runs.

use std::io;
use std::path::{Path, PathBuf};

use crate::session::Session;

/// Saves the played run in a folder, under the name of the scenario and a free number. Returns the path.
///
/// # Errors
/// The error of the operating system.
pub fn save_played(session: &Session, folder: &Path) -> io::Result<PathBuf> {
    let path = free_name(folder, session.name());
    write_played(session, &path)?;
    Ok(path)
}

/// Writes the played run to a file, atomically.
///
/// # Errors
/// The error of the operating system.
pub fn write_played(session: &Session, path: &Path) -> io::Result<()> {
    interplay_files::write(path, session.played().to_file().to_toml().as_bytes())
}

/// A file name in a folder that is free.
fn free_name(folder: &Path, scenario: &str) -> PathBuf {
    let stem = scenario.strip_suffix(".toml").unwrap_or(scenario);
    let plain: String =
        stem.chars().map(|letter| if letter.is_alphanumeric() || letter == '-' { letter } else { '-' }).collect();
    let name = plain.trim_matches('-');
    let named = |number: u64| folder.join(format!("{name}-{number}.toml"));
    (1..).map(named).find(|path| !path.exists()).unwrap_or_else(|| named(0))
}
