//! Lines of text over TCP, each with a deadline and a maximum length.

use std::io::{self, ErrorKind, Read, Write};
use std::net::{TcpStream, ToSocketAddrs};
use std::time::{Duration, Instant};

use super::error::PlantError;

/// A TCP connection that carries lines of text.
#[derive(Debug)]
pub struct Lines {
    stream: TcpStream,
    /// Bytes received after the last line.
    received: Vec<u8>,
    timeout: Duration,
    limit: usize,
}

impl Lines {
    /// Connects to the first of the addresses that accepts within the time-out.
    ///
    /// # Errors
    /// [`PlantError::Connect`].
    pub fn connect(address: &str, timeout: Duration, limit: usize) -> Result<Self, PlantError> {
        let failed = |reason| PlantError::Connect { address: address.to_owned(), reason };
        let mut last = io::Error::new(ErrorKind::NotFound, "the host has no address");
        for found in address.to_socket_addrs().map_err(failed)? {
            match TcpStream::connect_timeout(&found, timeout) {
                Ok(stream) => {
                    stream.set_nodelay(true).map_err(failed)?;
                    stream.set_write_timeout(Some(timeout)).map_err(failed)?;
                    return Ok(Self { stream, received: Vec::new(), timeout, limit });
                }
                Err(error) => last = error,
            }
        }
        Err(failed(last))
    }

    /// Sends a line, and returns the next received one. `question` names the question in errors.
    ///
    /// # Errors
    /// [`PlantError`] if the line cannot be sent, or if no line of permitted length arrives in time.
    pub fn ask(&mut self, question: &str, line: &str) -> Result<String, PlantError> {
        self.send(line).map_err(|reason| self.broken(question, reason))?;
        let deadline = Instant::now() + self.timeout;
        loop {
            if let Some(end) = self.received.iter().position(|byte| *byte == b'\n') {
                let line: Vec<u8> = self.received.drain(..=end).collect();
                return Ok(String::from_utf8_lossy(&line).trim().to_owned());
            }
            if self.received.len() > self.limit {
                return Err(PlantError::TooLong { question: question.to_owned(), limit: self.limit });
            }
            self.receive(deadline).map_err(|reason| self.broken(question, reason))?;
        }
    }

    /// Sends a line without waiting for an answer.
    ///
    /// # Errors
    /// The error of the operating system.
    pub fn send(&mut self, line: &str) -> io::Result<()> {
        self.stream.write_all(format!("{line}\n").as_bytes())
    }

    /// Receives at least one byte before the deadline.
    fn receive(&mut self, deadline: Instant) -> io::Result<()> {
        let left = deadline.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return Err(ErrorKind::TimedOut.into());
        }
        self.stream.set_read_timeout(Some(left))?;
        let mut buffer = [0; 4096];
        match self.stream.read(&mut buffer) {
            Ok(0) => Err(ErrorKind::UnexpectedEof.into()),
            Ok(count) => {
                self.received.extend_from_slice(&buffer[..count]);
                Ok(())
            }
            Err(error) if error.kind() == ErrorKind::Interrupted => Ok(()),
            Err(error) => Err(error),
        }
    }

    fn broken(&self, question: &str, reason: io::Error) -> PlantError {
        let question = question.to_owned();
        match reason.kind() {
            // A socket that times out returns one of these errors, depending on the system.
            ErrorKind::TimedOut | ErrorKind::WouldBlock => {
                PlantError::Timeout { question, timeout_s: self.timeout.as_secs_f64() }
            }
            ErrorKind::UnexpectedEof
            | ErrorKind::ConnectionReset
            | ErrorKind::ConnectionAborted
            | ErrorKind::BrokenPipe => PlantError::Closed { question },
            _ => PlantError::Broken { question, reason },
        }
    }
}
