//! The parent's side: the process that calls the unit, with a deadline for each answer.

use std::ffi::OsString;
use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, ChildStdin, Command, ExitStatus, Stdio};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::sync::{Arc, Mutex};
use std::time::Duration;
use std::{env, thread};

use crate::error::HostError;
use crate::protocol::{HostAnswer, Request, Values};
use crate::unit::Unit;

/// Time in which a process that has closed its output must end and its last output must be read.
const ENDING: Duration = Duration::from_secs(2);
const ENDING_POLL: Duration = Duration::from_millis(5);
const PROGRAM: &str = "interplay";

/// The program that is started for a unit. Its last arguments are the library, the identity, the folder of resources, and the
/// [`Shape`](crate::Shape) of a unit for model exchange, with which it calls [`serve`](crate::serve).
#[derive(Clone, Debug)]
pub struct HostProgram {
    pub program: OsString,
    pub arguments: Vec<OsString>,
}

impl Default for HostProgram {
    /// `interplay fmu-host`: the current program if that is `interplay`, and otherwise the one in the search path.
    fn default() -> Self {
        let this = env::current_exe()
            .ok()
            .filter(|path| path.file_stem().is_some_and(|stem| stem.to_string_lossy().starts_with(PROGRAM)));
        let program = this.map_or_else(|| OsString::from(PROGRAM), OsString::from);
        Self { program, arguments: vec![OsString::from("fmu-host")] }
    }
}

/// A process that calls a unit.
#[derive(Debug)]
pub struct Host {
    child: Child,
    input: Option<ChildStdin>,
    lines: Mutex<Receiver<String>>,
    /// `None` if the standard error cannot be read.
    errors: Option<LastLine>,
    timeout: Duration,
}

impl Host {
    /// Starts the process, which loads the library and creates an instance.
    pub fn start(program: &HostProgram, unit: &Unit, timeout: Duration) -> Result<Self, HostError> {
        let started = Command::new(&program.program)
            .args(&program.arguments)
            .arg(unit.library())
            .arg(&unit.description().guid)
            .arg(format!("file://{}", unit.resources().display()))
            .args(unit.description().exchange.map(|shape| shape.to_string()))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn();
        let named = || program.program.to_string_lossy().into_owned();
        let mut child = started.map_err(|reason| HostError::Start { program: named(), reason })?;
        let (sender, lines) = mpsc::channel();
        if let Some(output) = child.stdout.take() {
            thread::spawn(move || {
                let lines = BufReader::new(output).lines().map_while(Result::ok);
                lines.map(|line| sender.send(line)).take_while(Result::is_ok).count()
            });
        }
        let errors = child.stderr.take().map(LastLine::read);
        let input = child.stdin.take();
        let mut host = Self { child, input, lines: Mutex::new(lines), errors, timeout };
        host.answer("instantiate")?;
        Ok(host)
    }

    /// Sends a request and waits for the answer: numbers and texts, both empty for requests that only act.
    ///
    /// # Errors
    /// [`HostError`] if the unit fails, the process ends, or no answer comes in time.
    pub fn ask(&mut self, request: &Request) -> Result<Values, HostError> {
        let question = request.word();
        let line = serde_json::to_string(request).map_err(|error| failed(question, error.to_string()))?;
        let sent = self.input.as_mut().map(|input| input.write_all(format!("{line}\n").as_bytes()));
        if !matches!(sent, Some(Ok(()))) {
            return Err(self.crashed(question));
        }
        self.answer(question)
    }

    fn answer(&mut self, question: &str) -> Result<Values, HostError> {
        let received = match self.lines.get_mut() {
            Ok(lines) => lines.recv_timeout(self.timeout),
            Err(_) => Err(RecvTimeoutError::Disconnected),
        };
        let line = match received {
            Ok(line) => line,
            Err(RecvTimeoutError::Disconnected) => return Err(self.crashed(question)),
            Err(RecvTimeoutError::Timeout) => {
                self.kill();
                let timeout_s = self.timeout.as_secs_f64();
                return Err(HostError::Timeout { question: question.to_owned(), timeout_s, said: self.last_words() });
            }
        };
        match serde_json::from_str(&line) {
            Ok(HostAnswer::Done) => Ok(Values::default()),
            Ok(HostAnswer::Values(values)) => Ok(values),
            Ok(HostAnswer::Failed { reason }) => Err(failed(question, reason)),
            Err(_) => Err(failed(question, format!("its process answers `{}`", shown(&line)))),
        }
    }

    /// The error for a process that has ended or is about to end.
    fn crashed(&mut self, question: &str) -> HostError {
        let mut waited = Duration::ZERO;
        let status = loop {
            match self.child.try_wait() {
                Ok(None) if waited < ENDING => thread::sleep(ENDING_POLL),
                Ok(status) => break status,
                Err(_) => break None,
            }
            waited += ENDING_POLL;
        };
        HostError::Crashed {
            question: question.to_owned(),
            how: status.map_or_else(|| "no status".to_owned(), ended),
            said: self.last_words(),
        }
    }

    /// The last line that the process wrote, as the end of an error message; empty if it wrote nothing.
    fn last_words(&mut self) -> String {
        let line = self.errors.as_mut().map(|errors| errors.at_end(ENDING)).unwrap_or_default();
        if line.is_empty() { line } else { format!(", after it wrote `{line}`") }
    }

    fn kill(&mut self) {
        // The process may have ended already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Drop for Host {
    fn drop(&mut self) {
        // The process ends by itself when its input is closed, unless the unit hangs.
        self.input = None;
        self.kill();
    }
}

fn failed(question: &str, reason: String) -> HostError {
    HostError::Failed { question: question.to_owned(), reason }
}

#[cfg(unix)]
fn ended(status: ExitStatus) -> String {
    use std::os::unix::process::ExitStatusExt;
    match (status.code(), status.signal()) {
        (Some(code), _) => format!("exit code {code}"),
        (None, Some(signal)) => format!("signal {signal}"),
        (None, None) => "no status".to_owned(),
    }
}

#[cfg(not(unix))]
fn ended(status: ExitStatus) -> String {
    status.code().map_or_else(|| "no status".to_owned(), |code| format!("exit code {code}"))
}

/// Maximum length of a line of the process that an error shows \[characters\].
const SHOWN_CHARACTERS: usize = 120;

/// Reads the standard error of a process to its end, in a thread, and keeps the last line that is not blank.
#[derive(Debug)]
pub(crate) struct LastLine {
    line: Arc<Mutex<String>>,
    /// Disconnected once the thread has read everything.
    open: Mutex<Receiver<()>>,
}

impl LastLine {
    pub(crate) fn read(errors: impl Read + Send + 'static) -> Self {
        let line = Arc::new(Mutex::new(String::new()));
        let (reading, open) = mpsc::channel();
        let last = Arc::clone(&line);
        thread::spawn(move || {
            // This sender is dropped when the thread ends.
            let _reading: mpsc::Sender<()> = reading;
            // Units in other languages may write encodings other than UTF-8.
            for line in BufReader::new(errors).split(b'\n').map_while(Result::ok) {
                let line = String::from_utf8_lossy(&line);
                if !line.trim().is_empty()
                    && let Ok(mut last) = last.lock()
                {
                    *last = shown(line.trim_end());
                }
            }
        });
        Self { line, open: Mutex::new(open) }
    }

    /// Returns the last line of a process that has ended, or nothing if it wrote none.
    ///
    /// Waits until everything is read, but at most `timeout`: a child of the ended process may keep the standard error open.
    pub(crate) fn at_end(&mut self, timeout: Duration) -> String {
        if let Ok(open) = self.open.get_mut() {
            // The channel carries no messages: it only disconnects.
            let (Ok(()) | Err(RecvTimeoutError::Timeout | RecvTimeoutError::Disconnected)) = open.recv_timeout(timeout);
        }
        self.line.lock().map(|line| line.clone()).unwrap_or_default()
    }
}

/// The beginning of a line of the process, as an error shows it.
pub(crate) fn shown(line: &str) -> String {
    line.chars().take(SHOWN_CHARACTERS).flat_map(char::escape_debug).collect()
}
