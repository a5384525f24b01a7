//! Client of a BOPTEST server, over HTTP.

use std::fmt::Debug;
use std::time::Duration;

use serde_json::{Map, Value, json};

use super::http::Server;
use crate::plants::boptest::boptest_error::BoptestError;
use crate::plants::error::TEMPERATURES_C;

/// Maximum length of a server's message in an error \[characters\].
const MAX_SHOWN_CHARACTERS: usize = 300;

/// A test at a server.
#[derive(Debug)]
pub struct Test {
    server: Server,
    /// `/` and the identifier of the test; empty if the server has only one case.
    suffix: String,
}

impl Test {
    /// Begins a test: of the named case, or of the server's only one.
    ///
    /// # Errors
    /// [`BoptestError`] if the server does not answer as agreed.
    pub fn select(url: &str, case: Option<&str>, timeout: Duration) -> Result<Self, BoptestError> {
        let rest = url.strip_prefix("http://").unwrap_or(url);
        let (authority, path) = rest.split_once('/').unwrap_or((rest, ""));
        let port = if authority.rsplit(']').next().is_some_and(|end| end.contains(':')) { "" } else { ":80" };
        let prefix = if path.is_empty() { String::new() } else { format!("/{}", path.trim_end_matches('/')) };
        let server = Server { authority: format!("{authority}{port}"), prefix, timeout };
        let mut test = Self { server, suffix: String::new() };
        if let Some(case) = case {
            let path = format!("/testcases/{case}/select");
            let answer = test.call("POST", &path, Some(&json!({})))?;
            let identifier = answer.get("testid").and_then(Value::as_str);
            let plain = |text: &&str| !text.is_empty() && text.chars().all(|c| c.is_ascii_alphanumeric() || c == '-');
            let identifier = identifier.filter(plain).ok_or_else(|| BoptestError::Invalid {
                request: format!("POST {path}"),
                reason: "it has no `testid`".to_owned(),
            })?;
            test.suffix = format!("/{identifier}");
        }
        Ok(test)
    }

    /// The payload of an answer: the value of `payload`, or the whole answer.
    fn call(&self, method: &str, path: &str, body: Option<&Value>) -> Result<Value, BoptestError> {
        let request = || format!("{method} {path}");
        let answer = self.server.request(method, path, body.map(Value::to_string).as_deref())?;
        let parsed: Option<Value> = serde_json::from_slice(&answer.body).ok();
        let stated = parsed.as_ref().and_then(|value| value.get("status")).and_then(Value::as_u64);
        let status = stated.and_then(|status| u16::try_from(status).ok()).unwrap_or(answer.status);
        if answer.status != 200 || status != 200 {
            let message = parsed.as_ref().and_then(|value| value.get("message")).map(Value::to_string);
            let message = message.unwrap_or_else(|| String::from_utf8_lossy(&answer.body).into_owned());
            let status = if answer.status == 200 { status } else { answer.status };
            return Err(BoptestError::Refused { request: request(), status, message: shown(&message) });
        }
        match parsed {
            Some(Value::Object(mut object)) => match object.remove("payload") {
                Some(payload) => Ok(payload),
                None => Ok(Value::Object(object)),
            },
            Some(value) => Ok(value),
            None => Err(BoptestError::Invalid { request: request(), reason: "it is not JSON".to_owned() }),
        }
    }
}

impl Bench for Test {
    fn ask(&mut self, method: &str, name: &str, body: Option<&Value>) -> Result<Signals, BoptestError> {
        let path = format!("/{name}{}", self.suffix);
        match self.call(method, &path, body)? {
            Value::Object(signals) => Ok(signals),
            other => Err(BoptestError::Invalid {
                request: format!("{method} {path}"),
                reason: format!("it is {}; wanted is an object", shown(&other.to_string())),
            }),
        }
    }

    /// Only servers of several cases support this: the server can then serve another test.
    fn stop(&mut self) {
        if !self.suffix.is_empty() {
            // The run is over, so the answer does not matter.
            let _ = self.call("PUT", &format!("/stop{}", self.suffix), None);
        }
    }
}

fn shown(text: &str) -> String {
    text.chars().take(MAX_SHOWN_CHARACTERS).flat_map(char::escape_debug).collect()
}

/// Numbers by name.
pub type Signals = Map<String, Value>;

/// A test case that answers the requests of BOPTEST's interface: a server, or an FMU that we run.
pub trait Bench: Debug + Send + Sync {
    /// Sends a request to the test. `name` is the first part of the path, such as `advance`.
    ///
    /// # Errors
    /// [`BoptestError`] if the test does not answer as agreed.
    fn ask(&mut self, method: &str, name: &str, body: Option<&Value>) -> Result<Signals, BoptestError>;

    /// Ends the test.
    fn stop(&mut self) {}
}

/// A finite number among signals.
///
/// # Errors
/// [`BoptestError::Invalid`].
pub fn number(request: &str, signals: &Signals, name: &str) -> Result<f64, BoptestError> {
    let found = signals.get(name).and_then(Value::as_f64).filter(|value| value.is_finite());
    found.ok_or_else(|| BoptestError::Invalid {
        request: request.to_owned(),
        reason: format!("it has no number `{name}`"),
    })
}

/// The key of a signal's unit in the list of measurements.
pub const UNIT: &str = "Unit";
/// Units of temperatures. An FMU in °C is converted.
const TEMPERATURE_UNITS: [&str; 2] = ["K", "degC"];

/// Refuses a measurement that is listed with another unit than one of temperatures, or as without a unit. Lists that say nothing of
/// units are accepted.
///
/// # Errors
/// [`BoptestError::Invalid`].
pub fn check_temperature(measurements: &Signals, name: &str) -> Result<(), BoptestError> {
    let Some(unit) = measurements.get(name).and_then(|known| known.get(UNIT)) else { return Ok(()) };
    let has = match unit.as_str() {
        Some(unit) if TEMPERATURE_UNITS.contains(&unit) => return Ok(()),
        Some(unit) => format!("has the unit `{unit}`"),
        None => "has no unit".to_owned(),
    };
    let reason = format!("`{name}` {has}; the temperature of a zone must be in `K` or `degC`");
    Err(BoptestError::Invalid { request: "GET /measurements".to_owned(), reason })
}

/// 0 °C \[K\].
pub const ZERO_CELSIUS_K: f64 = 273.15;

/// The temperature named `name` in an answer, converted from kelvin to °C.
///
/// # Errors
/// [`BoptestError::Invalid`] for an implausible temperature, which plans and indicators would trust.
pub fn celsius(request: &str, name: &str, kelvin: f64) -> Result<f64, BoptestError> {
    let value_c = kelvin - ZERO_CELSIUS_K;
    if TEMPERATURES_C.contains(&value_c) {
        return Ok(value_c);
    }
    let (from, to) = (TEMPERATURES_C.start(), TEMPERATURES_C.end());
    let reason = format!("`{name}` is {value_c:.2} °C, which is outside of {from} to {to} °C");
    Err(BoptestError::Invalid { request: request.to_owned(), reason })
}

/// A list of finite numbers among signals.
///
/// # Errors
/// [`BoptestError::Invalid`].
pub fn series(request: &str, signals: &Signals, name: &str) -> Result<Vec<f64>, BoptestError> {
    let list = signals.get(name).and_then(Value::as_array);
    let numbers = list.and_then(|list| list.iter().map(Value::as_f64).collect::<Option<Vec<f64>>>());
    numbers.filter(|numbers| numbers.iter().all(|value| value.is_finite())).ok_or_else(|| BoptestError::Invalid {
        request: request.to_owned(),
        reason: format!("it has no list of numbers `{name}`"),
    })
}
