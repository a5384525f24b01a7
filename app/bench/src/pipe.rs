//! Another program that plans: a line of JSON in, a line out.

use std::io::{BufRead, BufReader, Write};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::Duration;

use interplay_planners::Input;
use serde::Deserialize;

use crate::error::BenchError;
use crate::observation::PlannerObservation;

/// An answer that takes longer is a failed plan \[s\].
const LONGEST_S: u64 = 10;
/// The first answer of a process may take longer, since programs load \[s\].
const LONGEST_FIRST_S: u64 = 60;
/// After this many failures the program is not asked any more on this start.
const MOST_FAILURES: usize = 3;

/// What a program answers: an input, or a plan whose first input is applied.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "snake_case")]
enum Answer {
    /// The acceleration \[m/s²\] and the steering angle \[rad\].
    Input([f64; 2]),
    /// The same for each stage.
    Plan(Vec<[f64; 2]>),
}

/// A program that is started anew after a failure.
#[derive(Debug)]
pub(crate) struct Pipe {
    command: String,
    running: Option<Running>,
    failures: usize,
}

#[derive(Debug)]
struct Running {
    child: Child,
    input: ChildStdin,
    lines: Receiver<String>,
    longest_s: u64,
}

impl Pipe {
    /// Starts a program.
    pub fn start(command: &str) -> Result<Pipe, BenchError> {
        let running = Running::start(command);
        let running = running.map_err(|reason| BenchError::Command { command: command.to_owned(), reason })?;
        Ok(Pipe { command: command.to_owned(), running: Some(running), failures: 0 })
    }

    /// The program's answer to an observation, or why it has none.
    pub fn ask(&mut self, observation: &PlannerObservation) -> Result<Input, String> {
        if self.failures >= MOST_FAILURES {
            return Err("the program has failed too often".to_owned());
        }
        let answered = self.answer(observation);
        if answered.is_err() {
            self.failures += 1;
            // A late answer must not be taken for one to the next line.
            self.running = None;
        }
        answered
    }

    fn answer(&mut self, observation: &PlannerObservation) -> Result<Input, String> {
        let line = serde_json::to_string(observation).map_err(|error| error.to_string())?;
        let running = match &mut self.running {
            Some(running) => running,
            none => none.insert(Running::start(&self.command).map_err(|error| error.to_string())?),
        };
        let answer = running.exchange(&line)?;
        let answer: Answer = serde_json::from_str(&answer).map_err(|error| format!("`{}`: {error}", answer.trim()))?;
        let [acceleration_mps2, steering_rad] = match answer {
            Answer::Input(input) => input,
            Answer::Plan(inputs) => *inputs.first().ok_or("the plan is empty")?,
        };
        let input = Input { acceleration_mps2, steering_rad };
        // Beyond these bounds an input is a mistake, and could not be stored.
        let is_sensible = input.is_finite() && acceleration_mps2.abs() < 1e3 && steering_rad.abs() < 1e3;
        is_sensible.then_some(input).ok_or_else(|| "the input is not a finite number below 1000".to_owned())
    }
}

impl Running {
    fn start(command: &str) -> std::io::Result<Running> {
        let mut child = Command::new("sh")
            .args(["-c", &format!("exec {command}")])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()?;
        let missing = || std::io::Error::other("no pipe");
        let input = child.stdin.take().ok_or_else(missing)?;
        let output = child.stdout.take().ok_or_else(missing)?;
        let (sender, lines) = channel();
        std::thread::spawn(move || {
            for line in BufReader::new(output).lines().map_while(Result::ok) {
                if sender.send(line).is_err() {
                    break;
                }
            }
        });
        Ok(Running { child, input, lines, longest_s: LONGEST_FIRST_S })
    }

    /// Sends a line and waits for the answer.
    fn exchange(&mut self, line: &str) -> Result<String, String> {
        let sent = self.input.write_all(line.as_bytes()).and_then(|()| self.input.write_all(b"\n"));
        sent.and_then(|()| self.input.flush()).map_err(|error| format!("the program has ended: {error}"))?;
        let longest_s = std::mem::replace(&mut self.longest_s, LONGEST_S);
        self.lines.recv_timeout(Duration::from_secs(longest_s)).map_err(|error| match error {
            RecvTimeoutError::Timeout => format!("no answer within {longest_s} s"),
            RecvTimeoutError::Disconnected => "the program has ended".to_owned(),
        })
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
