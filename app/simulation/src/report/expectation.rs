//! One expectation of a scenario and its outcome.

use std::fmt;

use interplay_scenarios::readable;
use serde::Serialize;
use serde_json::{Value, json};

/// One expectation and its outcome.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Expectation {
    /// The key in the scenario file, with the vehicle where there is one.
    pub what: String,
    /// The expected value.
    pub want: Value,
    /// The actual value.
    pub got: Value,
    /// Whether it held.
    pub passed: bool,
    /// Day or zone of the worst value, if it concerns several.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at: Option<String>,
}

impl Expectation {
    pub(super) fn new(what: impl Into<String>, want: Value, got: Value, passed: bool) -> Self {
        Expectation { what: what.into(), want, got, passed, at: None }
    }

    /// The expected and the actual value, with numbers rounded for a reader.
    pub fn shown(&self) -> [Value; 2] {
        [rounded(&self.want, None), rounded(&self.got, self.want.as_f64())]
    }
}

impl fmt::Display for Expectation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [want, got] = self.shown();
        write!(f, "{}: want {want}, got {got}", self.what)?;
        self.at.as_ref().map_or(Ok(()), |at| write!(f, " ({at})"))
    }
}

/// The value with numbers rounded for a reader. A number that rounding would make equal to the bound keeps its digits.
fn rounded(value: &Value, bound: Option<f64>) -> Value {
    match value {
        Value::Number(number) if number.is_f64() => {
            let exact = number.as_f64().unwrap_or_default();
            let short = readable(exact);
            json!(if bound == Some(short) { exact } else { short })
        }
        Value::Array(items) => items.iter().map(|item| rounded(item, bound)).collect(),
        Value::Object(table) => {
            Value::Object(table.iter().map(|(key, item)| (key.clone(), rounded(item, bound))).collect())
        }
        other => other.clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(want: Value, got: Value) -> String {
        Expectation { what: "gap".to_owned(), want, got, passed: false, at: None }.to_string()
    }

    #[test]
    fn numbers_are_rounded_unless_rounding_hides_the_failure() {
        let gap = json!({ "m": 2.288_119_792_938_232_4, "time_s": 16.601_957_716, "between": ["a", "b"] });
        let shown = said(json!(0.5), gap);
        assert!(shown.contains("2.288,") && shown.contains("16.6"), "{shown}");
        assert!(shown.contains(r#""between":["a","b"]"#), "{shown}");
        assert_eq!(said(json!(0.5), json!(0.499_999_987_654)), "gap: want 0.5, got 0.499999987654");
        assert_eq!(said(json!(3), json!(2)), "gap: want 3, got 2");
    }
}
