//! Starting the command as a user would.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::{Mutex, PoisonError};
use std::thread;

use serde_json::Value;

/// The output of the command and its exit code.
#[derive(Debug)]
pub struct Outcome {
    pub code: Option<i32>,
    pub stdout: String,
    pub stderr: String,
}

impl From<Output> for Outcome {
    fn from(output: Output) -> Self {
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("the command speaks UTF-8");
        Outcome { code: output.status.code(), stdout: text(output.stdout), stderr: text(output.stderr) }
    }
}

impl Outcome {
    /// The one JSON document on stdout.
    pub fn json(&self) -> Value {
        serde_json::from_str(&self.stdout).unwrap_or_else(|error| panic!("not one JSON document ({error}): {self:?}"))
    }
}

/// The command with a clean environment, to be started in `folder`.
pub fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_interplay-under-test"));
    command.args(arguments).current_dir(folder).stdin(Stdio::null());
    for colour in ["NO_COLOR", "FORCE_COLOR", "CLICOLOR", "CLICOLOR_FORCE"] {
        command.env_remove(colour);
    }
    command
}

/// Runs the command in `folder` to its end.
pub fn interplay(folder: &Path, arguments: &[&str]) -> Outcome {
    command(folder, arguments).output().expect("the command can be started").into()
}

/// The test that uses each scratch folder.
static SCRATCH_USERS: Mutex<BTreeMap<String, String>> = Mutex::new(BTreeMap::new());

/// An empty folder of that name for one test.
///
/// # Panics
/// If another test has used the name: tests run in parallel, and each would remove the files of the other.
pub fn scratch(name: &str) -> PathBuf {
    let test = thread::current().name().unwrap_or_default().to_owned();
    let mut users = SCRATCH_USERS.lock().unwrap_or_else(PoisonError::into_inner);
    assert_eq!(
        *users.entry(name.to_owned()).or_insert_with(|| test.clone()),
        test,
        "two tests use the scratch folder `{name}`"
    );
    drop(users);
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    if folder.exists() {
        fs::remove_dir_all(&folder).expect("what an earlier run left can be removed");
    }
    fs::create_dir_all(&folder).expect("a scratch folder can be made");
    folder
}

/// Everything below `folder`, as sorted paths relative to it.
pub fn contents(folder: &Path) -> Vec<String> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        for entry in fs::read_dir(next).expect("the folder can be read") {
            let path = entry.expect("the entry can be read").path();
            found.push(path.strip_prefix(folder).expect("below the folder").to_string_lossy().into_owned());
            if path.is_dir() {
                folders.push(path);
            }
        }
    }
    found.sort();
    found
}
