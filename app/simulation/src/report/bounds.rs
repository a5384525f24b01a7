//! Judges bounds on metrics. A failure names the vehicles and the time, if there are any.

use interplay_scenarios::{MetricBound, MetricLimit};
use serde_json::{Value, json};

use super::expectation::Expectation;
use super::outcome::{Report, VehicleReport};
use crate::measure::{Measured, MetricValue};

/// Judges a bound; none if it concerns a vehicle that does not exist.
pub(super) fn judge_bound(bound: &MetricBound<'_>, report: &Report) -> Option<Expectation> {
    let MetricBound { metric, limit, .. } = bound;
    let (got, passed) = match (bound.vehicle, report.metrics.get(metric)) {
        (Some(name), _) => of_vehicle(report.vehicle(name)?, metric, *limit),
        (None, Some((declaration, measured))) => (measured.to_json(declaration), holds(*limit, measured)),
        (None, None) => of_all(report, metric, *limit),
    };
    Some(Expectation::new(bound.what.clone(), limit.to_json(), got, passed))
}

/// Whether a value is within a limit. A missing value satisfies every bound, and is neither true nor false.
fn holds(limit: MetricLimit, measured: &Measured) -> bool {
    let value = measured.value.map(MetricValue::as_number);
    value.map_or(!matches!(limit, MetricLimit::Is(_)), |value| limit.admits(value))
}

fn of_vehicle(vehicle: &VehicleReport, metric: &str, limit: MetricLimit) -> (Value, bool) {
    let Some((_, measured)) = vehicle.metrics.get(metric) else { return unmeasured() };
    let got = match measured.is_peak {
        true => json!({ "peak": measured.value, "time_s": measured.time_s }),
        false => json!(measured.value),
    };
    (got, holds(limit, measured))
}

/// The vehicle with the worst value decides.
fn of_all(report: &Report, metric: &str, limit: MetricLimit) -> (Value, bool) {
    let all = report.vehicles.iter().filter_map(|vehicle| Some((vehicle, vehicle.metrics.get(metric)?)));
    let valued = all.clone().filter_map(|(vehicle, (declaration, measured))| {
        Some((vehicle, declaration, measured, measured.value?.as_number()))
    });
    let worst = valued.max_by(|one, other| limit.excess(one.3).total_cmp(&limit.excess(other.3)));
    match worst {
        None if all.count() == 0 => unmeasured(),
        None => (Value::Null, holds(limit, &Measured::default())),
        Some((_, _, measured, 0.0)) if measured.is_peak => (json!(0.0), holds(limit, measured)),
        Some((vehicle, declaration, measured, _)) => {
            let mut got = json!({ declaration.unit_key(): measured.value, "vehicle": vehicle.name });
            if measured.is_peak {
                got["time_s"] = json!(measured.time_s);
            }
            (got, holds(limit, measured))
        }
    }
}

fn unmeasured() -> (Value, bool) {
    (json!("no such metric"), false)
}
