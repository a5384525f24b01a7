//! HTTP requests, one connection each, with a deadline and a maximum length.

use std::io::{self, ErrorKind, Read, Write};
use std::net::{TcpStream, ToSocketAddrs};
use std::time::{Duration, Instant};

use crate::plants::boptest::boptest_error::BoptestError;

/// The longest answer \[bytes\]: the results of a year in steps of 30 s take about a tenth.
const MAX_ANSWER_BYTES: usize = 512 * 1024 * 1024;

/// A server, with a time-out.
#[derive(Clone, Debug)]
pub struct Server {
    /// Host and port.
    pub authority: String,
    /// Prefix of every path, without a trailing slash.
    pub prefix: String,
    /// Time-out of a request.
    pub timeout: Duration,
}

/// The status and the body of an answer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Answer {
    /// The status of HTTP.
    pub status: u16,
    pub body: Vec<u8>,
    /// Whether the head stated the length of the body, and the body has that length.
    is_whole: bool,
}

impl Server {
    /// Sends a request and waits for its answer. `body` is JSON.
    ///
    /// # Errors
    /// [`BoptestError`] if no HTTP answer arrives in time.
    pub fn request(&self, method: &str, path: &str, body: Option<&str>) -> Result<Answer, BoptestError> {
        let request = format!("{method} {path}");
        let deadline = Instant::now() + self.timeout;
        let mut stream = self.connect()?;
        let body = body.unwrap_or_default();
        // Version 1.0 prevents the server from sending its answer in chunks.
        let head = format!(
            "{method} {}{path} HTTP/1.0\r\nHost: {}\r\nContent-Type: application/json\r\nAccept: application/json\r\n\
             Content-Length: {}\r\nConnection: close\r\n\r\n",
            self.prefix,
            self.authority,
            body.len()
        );
        let failed = |reason| self.broken(&request, reason);
        stream.write_all(format!("{head}{body}").as_bytes()).map_err(failed)?;
        let received = receive(&mut stream, deadline).map_err(failed)?;
        if received.len() > MAX_ANSWER_BYTES {
            return Err(BoptestError::TooLong { request, limit: MAX_ANSWER_BYTES });
        }
        parse(&received).map_err(|reason| BoptestError::Invalid { request, reason: reason.to_owned() })
    }

    fn connect(&self) -> Result<TcpStream, BoptestError> {
        let failed = |reason| BoptestError::Connect { url: format!("http://{}", self.authority), reason };
        let mut last = io::Error::new(ErrorKind::NotFound, "the host has no address");
        for found in self.authority.to_socket_addrs().map_err(failed)? {
            match TcpStream::connect_timeout(&found, self.timeout) {
                Ok(stream) => {
                    stream.set_nodelay(true).map_err(failed)?;
                    stream.set_write_timeout(Some(self.timeout)).map_err(failed)?;
                    return Ok(stream);
                }
                Err(error) => last = error,
            }
        }
        Err(failed(last))
    }

    fn broken(&self, request: &str, reason: io::Error) -> BoptestError {
        let request = request.to_owned();
        match reason.kind() {
            ErrorKind::TimedOut | ErrorKind::WouldBlock => {
                BoptestError::Timeout { request, timeout_s: self.timeout.as_secs_f64() }
            }
            _ => BoptestError::Broken { request, reason },
        }
    }
}

/// Everything until the stated length or until the server closes the connection, or one byte more than allowed.
fn receive(stream: &mut TcpStream, deadline: Instant) -> io::Result<Vec<u8>> {
    let mut received = Vec::new();
    let mut buffer = [0; 64 * 1024];
    while received.len() <= MAX_ANSWER_BYTES {
        let left = deadline.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return Err(ErrorKind::TimedOut.into());
        }
        stream.set_read_timeout(Some(left))?;
        match stream.read(&mut buffer) {
            Ok(0) => break,
            Ok(count) => {
                received.extend_from_slice(&buffer[..count]);
                // A server may keep the connection open although the request says not to.
                if parse(&received).is_ok_and(|answer| answer.is_whole) {
                    break;
                }
            }
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
    Ok(received)
}

/// Status and body of a server's answer, or what is wrong with it.
fn parse(received: &[u8]) -> Result<Answer, &'static str> {
    let end = received.windows(4).position(|bytes| bytes == b"\r\n\r\n").ok_or("it is not an HTTP answer")?;
    let head = std::str::from_utf8(&received[..end]).map_err(|_| "its head is not text")?;
    let mut lines = head.lines();
    let status = lines.next().and_then(|line| {
        let (version, rest) = line.split_once(' ')?;
        let status = rest.get(..3)?.parse().ok()?;
        version.starts_with("HTTP/1.").then_some(status)
    });
    let status = status.ok_or("it is not an HTTP answer")?;
    let body = received[end + 4..].to_vec();
    let lengths = lines.filter_map(|line| line.split_once(':'));
    let mut lengths = lengths.filter(|(name, _)| name.eq_ignore_ascii_case("content-length"));
    let stated = lengths.next();
    let is_whole = stated.is_some();
    if let Some((_, length)) = stated {
        let length: usize = length.trim().parse().map_err(|_| "its length is not a number")?;
        if body.len() != length {
            return Err("it ends before its stated length, or goes on after it");
        }
    }
    Ok(Answer { status, body, is_whole })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn valid_answers_are_accepted() {
        let answer = |text: &str| parse(text.as_bytes()).map(|answer| (answer.status, answer.body));
        assert_eq!(answer("HTTP/1.0 200 OK\r\n\r\n{}"), Ok((200, b"{}".to_vec())));
        assert_eq!(answer("HTTP/1.1 404\r\ncontent-length: 2\r\n\r\n{}"), Ok((404, b"{}".to_vec())));
    }

    #[test]
    fn an_answer_that_is_not_http_is_refused() {
        for (text, said) in [
            ("", "not an HTTP answer"),
            ("hello\r\n\r\n", "not an HTTP answer"),
            ("SMTP/1.0 200 OK\r\n\r\n", "not an HTTP answer"),
            ("HTTP/1.0 2\r\n\r\n", "not an HTTP answer"),
            ("HTTP/1.0 200 OK\r\nContent-Length: 3\r\n\r\n{}", "stated length"),
            ("HTTP/1.0 200 OK\r\nContent-Length: 1\r\n\r\n{}", "stated length"),
            ("HTTP/1.0 200 OK\r\nContent-Length: x\r\n\r\n{}", "not a number"),
        ] {
            let error = parse(text.as_bytes()).expect_err(text);
            assert!(error.contains(said), "{text:?}: {error}");
        }
    }
}
