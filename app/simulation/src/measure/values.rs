//! Values of metrics, and their form in a report.

use interplay_scenarios::{MetricDeclaration, MetricKind};
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};
use serde_json::{Value as Json, json};

/// The value of a metric.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum MetricValue {
    /// True or false.
    Flag(bool),
    /// A whole number.
    Count(u64),
    /// A number.
    Number(f64),
}

/// The result of a metric.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Measured {
    /// The value; none if there is nothing to measure.
    pub value: Option<MetricValue>,
    /// The time at which it was reached; none for metrics without time, and for a peak of 0 \[s\].
    pub time_s: Option<f64>,
    /// The two vehicles that it concerns, in the scenario's order, if it concerns two.
    pub between: Option<[String; 2]>,
    /// Whether it has a time unless it is 0.
    pub is_peak: bool,
}

/// The results of all metrics of a vehicle, or of a run, in the order in which the metrics are listed.
///
/// In a report, each value stands under its key. A value of two vehicles stands with them and with its time; the times of
/// peaks stand together, as `peak_times_s`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MetricValues(pub Vec<(MetricDeclaration, Measured)>);

impl Measured {
    /// A number without time and vehicles.
    pub fn number(value: Option<f64>) -> Self {
        Measured { value: value.map(MetricValue::Number), ..Measured::default() }
    }

    /// A number that concerns two vehicles, at a time \[s\].
    pub fn between(value: f64, between: [String; 2], time_s: f64) -> Self {
        Measured { time_s: Some(time_s), between: Some(between), ..Measured::number(Some(value)) }
    }

    /// The same value in the type of a metric's declaration.
    #[must_use]
    pub(super) fn of_kind(self, kind: MetricKind) -> Self {
        let value = self.value.map(|value| match (kind, value.as_number()) {
            (MetricKind::Flag, number) => MetricValue::Flag(number != 0.0),
            (MetricKind::Count, number) => MetricValue::Count(number as u64),
            (MetricKind::Number, number) => MetricValue::Number(number),
        });
        Measured { value, ..self }
    }

    /// The value in the form of a report.
    pub fn to_json(&self, declaration: &MetricDeclaration) -> Json {
        match (&self.between, self.value) {
            (Some(between), Some(value)) => {
                json!({ declaration.unit_key(): value, "between": between, "time_s": self.time_s })
            }
            (_, value) => json!(value),
        }
    }
}

impl MetricValue {
    /// The number; 0 and 1 for flags.
    pub fn as_number(self) -> f64 {
        match self {
            MetricValue::Flag(flag) => f64::from(flag),
            MetricValue::Count(count) => count as f64,
            MetricValue::Number(number) => number,
        }
    }
}

impl MetricValues {
    /// The result of the metric with this name; `None` if it is not measured.
    pub fn get(&self, name: &str) -> Option<(&MetricDeclaration, &Measured)> {
        self.0.iter().find(|(declaration, _)| declaration.name == name).map(|(declaration, one)| (declaration, one))
    }

    /// The value of a metric as a number, flags as 0 and 1.
    pub fn number(&self, name: &str) -> Option<f64> {
        self.get(name).and_then(|(_, measured)| measured.value).map(MetricValue::as_number)
    }
}

impl Serialize for MetricValues {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        for (declaration, measured) in &self.0 {
            map.serialize_entry(declaration.report_key.unwrap_or(declaration.name), &measured.to_json(declaration))?;
        }
        let peaks = self.0.iter().filter(|(_, measured)| measured.is_peak);
        let short = |declaration: &MetricDeclaration| {
            declaration.quantity().strip_prefix("peak_").unwrap_or(declaration.quantity()).to_owned()
        };
        let times: serde_json::Map<String, Json> =
            peaks.map(|(declaration, measured)| (short(declaration), json!(measured.time_s))).collect();
        if !times.is_empty() {
            map.serialize_entry("peak_times_s", &times)?;
        }
        map.end()
    }
}
