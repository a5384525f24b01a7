//! Scripts, which play a session without a page: each line is a message of a page with its tick.

use std::io;
use std::path::{Path, PathBuf};

use interplay_planners::Driver;
use serde_json::Value as Json;
use thiserror::Error;

use crate::protocol::PageMessage;
use crate::session::{Controls, Session, SessionError};

const MAX_LINES: usize = 1_000_000;

/// A message of a page, with the tick at which it arrives.
#[derive(Clone, Debug, PartialEq)]
pub struct ScriptLine {
    /// Number of ticks before the message.
    pub tick: usize,
    pub message: PageMessage,
}

#[derive(Debug, Error)]
pub enum ScriptError {
    /// A line is not a message.
    #[error("{file}:{line}: {reason}; a line is a message with its tick, such as {EXAMPLE}")]
    Line {
        file: String,
        /// The line, from 1.
        line: usize,
        reason: String,
    },
    /// The file is too long.
    #[error("{0}: more than {MAX_LINES} lines")]
    TooLong(String),
}

const EXAMPLE: &str = r#"{"tick": 5, "type": "input", "acceleration": -0.5, "steering": 0}"#;

/// Reads a script; empty lines are ignored.
///
/// # Errors
/// [`ScriptError`] with file, line and fault.
pub fn read_script(file: &str, text: &str) -> Result<Vec<ScriptLine>, ScriptError> {
    let mut lines: Vec<ScriptLine> = Vec::new();
    for (index, line) in text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()) {
        if index >= MAX_LINES {
            return Err(ScriptError::TooLong(file.to_owned()));
        }
        let refused = |reason: String| ScriptError::Line { file: file.to_owned(), line: index + 1, reason };
        let mut json: Json = serde_json::from_str(line).map_err(|error| refused(error.to_string()))?;
        let tick = json.as_object_mut().and_then(|object| object.remove("tick"));
        let tick = tick.as_ref().and_then(Json::as_u64).ok_or_else(|| refused("`tick` is missing".to_owned()))?;
        let message: PageMessage = serde_json::from_value(json).map_err(|error| refused(error.to_string()))?;
        if let PageMessage::HandOver { to: Some(kind) } = &message
            && Driver::at_wheel(kind).is_none()
        {
            let kinds = Driver::wheel_kinds();
            return Err(refused(format!("`{kind}` is not a planner that can take the wheel; choose from {kinds}")));
        }
        if lines.last().is_some_and(|last| last.tick as u64 > tick) {
            return Err(refused(format!("tick {tick} comes after a later one")));
        }
        lines.push(ScriptLine { tick: tick as usize, message });
    }
    Ok(lines)
}

/// Plays a script in a seat, to the end of the scenario or of the script. The ticks of lines count every simulated
/// tick, including those that a rewind discards.
///
/// # Errors
/// [`SessionError`] if the simulation fails, or if a message is refused.
pub fn play_script(session: &mut Session, seat: &str, lines: &[ScriptLine]) -> Result<(), SessionError> {
    let mut lines = lines.iter().peekable();
    let mut passed = 0;
    loop {
        while let Some(line) = lines.next_if(|line| line.tick <= passed) {
            match &line.message {
                PageMessage::Input { seq, acceleration, steering, assist } => {
                    let controls =
                        Controls { seq: *seq, acceleration: *acceleration, steering: *steering, assist: *assist };
                    session.set_controls(seat, controls)?;
                }
                PageMessage::HandOver { to } => session.hand_over(seat, to.as_deref())?,
                PageMessage::Rewind { seconds } => session.rewind(*seconds)?,
                PageMessage::Restart => session.rewind(f64::INFINITY)?,
                PageMessage::End => return Ok(()),
                // Messages that concern the page only.
                _ => {}
            }
        }
        if session.tick()?.is_none() {
            return Ok(());
        }
        passed += 1;
    }
}

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
    fn invalid_lines_are_refused_with_their_numbers() {
        let text = "{\"tick\": 0, \"type\": \"restart\"}\n\n{\"tick\": 3, \"type\": \"fly\"}\n";
        let error = read_script("drive.jsonl", text).expect_err("an unknown type").to_string();
        assert!(error.starts_with("drive.jsonl:3: unknown variant `fly`"), "{error}");
        for (line, part) in [
            ("{\"type\": \"restart\"}", "`tick` is missing"),
            ("[]", "`tick` is missing"),
            ("{\"tick\": 1, \"type\": \"input\", \"acceleration\": 0}", "missing field `steering`"),
            ("{\"tick\": 1, \"type\": \"rewind\", \"seconds\": 1, \"far\": 2}", "unknown field `far`"),
            ("{\"tick\": 1, \"type\": \"hand_over\", \"to\": \"x\"}", "drive.jsonl:1: `x` is not a planner"),
        ] {
            let error = read_script("drive.jsonl", line).expect_err("a fault").to_string();
            assert!(error.contains(part), "{error}");
        }
        assert!(read_script("a", "{\"tick\": 2, \"type\": \"end\"}\n{\"tick\": 1, \"type\": \"end\"}").is_err());
    }

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
