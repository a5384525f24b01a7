//! The interface of a running BOPTEST test case, on a server or as an FMU.

use std::fmt::Debug;

use serde_json::{Map, Value};

use crate::plants::boptest::boptest_error::BoptestError;
use crate::plants::error::TEMPERATURES_C;

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
