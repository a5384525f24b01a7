//! Files of played runs.

use std::io;
use std::path::{Path, PathBuf};

use crate::session::Session;

/// Saves the played run in a folder, under the name of the scenario and a free number. Returns the path.
///
/// # Errors
/// The error of the operating system.
pub fn save_played(session: &Session, folder: &Path) -> io::Result<PathBuf> {
    let text = session.played().to_file().to_toml();
    loop {
        let path = free_name(folder, session.name());
        match interplay_files::write_new(&path, text.as_bytes()) {
            // Another server has taken the name in the meantime.
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            written => return written.map(|()| path),
        }
    }
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
    (1..).map(named).find(|path| path.symlink_metadata().is_err()).unwrap_or_else(|| named(0))
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::sync::Barrier;
    use std::thread;

    use interplay_scenarios::load;

    use super::*;

    #[test]
    fn runs_that_are_saved_at_the_same_time_have_a_file_each() {
        const COUNT: usize = 8;
        let folder = tempfile::tempdir().expect("a folder");
        let scenario = load("lane-change/front-nice", &[]).expect("an authored scenario");
        let together = Barrier::new(COUNT);
        let save_one = || {
            let session = Session::new("lane-change/front-nice", &scenario, &["ego"]).expect("a session");
            together.wait();
            save_played(&session, folder.path()).expect("saved")
        };
        let paths: BTreeSet<PathBuf> = thread::scope(|scope| {
            let saving: Vec<_> = (0..COUNT).map(|_| scope.spawn(save_one)).collect();
            saving.into_iter().map(|thread| thread.join().expect("it ends")).collect()
        });
        assert_eq!(paths.len(), COUNT);
    }
}
