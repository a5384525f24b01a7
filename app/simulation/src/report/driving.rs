//! Judges bounds on gaps, edges, speed limits, comfort and right of way. What fails names the vehicles and the time.

use interplay_scenarios::{Expect, ExpectedComfort, ExpectedYield};
use serde_json::{Value, json};

use super::expectation::Expectation;
use super::outcome::{Report, VehicleReport};
use crate::measure::Passage;

/// Judges the bounds that hold for all vehicles.
pub(super) fn of_all(expect: &Expect, report: &Report) -> Vec<Expectation> {
    let mut judged = Vec::new();
    let mut add = |what: &str, want: f64, got: Value, passed: bool| {
        judged.push(Expectation::new(what, json!(want), got, passed));
    };
    if let Some(least) = expect.gap_at_least_m {
        let gap = &report.smallest_gap;
        add("gap_at_least_m", least, json!(gap), gap.as_ref().is_none_or(|gap| gap.m >= least));
    }
    if let Some(least) = expect.time_to_collision_at_least_s {
        let time = &report.shortest_time_to_collision;
        add("time_to_collision_at_least_s", least, json!(time), time.as_ref().is_none_or(|time| time.s >= least));
    }
    if let Some(most) = expect.off_road_at_most_m {
        let worst = worst(report, |vehicle| (vehicle.off_road_m, vehicle.peak_times_s.off_road));
        let got = worst.map_or(json!(0.0), |(name, m, time_s)| json!({ "m": m, "vehicle": name, "time_s": time_s }));
        add("off_road_at_most_m", most, got, worst.is_none_or(|(_, m, _)| m <= most));
    }
    if let Some(most) = expect.speed_limit_exceeded_by_at_most_mps {
        let excess = |vehicle: &VehicleReport| (vehicle.speeding_mps.unwrap_or(0.0), vehicle.peak_times_s.speeding);
        let worst = worst(report, excess);
        let got =
            worst.map_or(json!(0.0), |(name, mps, time_s)| json!({ "mps": mps, "vehicle": name, "time_s": time_s }));
        add("speed_limit_exceeded_by_at_most_mps", most, got, worst.is_none_or(|(_, mps, _)| mps <= most));
    }
    judged
}

/// The vehicle with the largest value of a quantity, that value and its time; none if it is 0 for all vehicles.
fn worst(report: &Report, quantity: impl Fn(&VehicleReport) -> (f64, Option<f64>)) -> Option<(&str, f64, Option<f64>)> {
    let all = report.vehicles.iter().map(|vehicle| {
        let (value, time_s) = quantity(vehicle);
        (vehicle.name.as_str(), value, time_s)
    });
    all.filter(|(_, value, _)| *value > 0.0).max_by(|a, b| a.1.total_cmp(&b.1))
}

/// Judges the bounds on the comfort of one vehicle.
pub(super) fn comfort(bounds: &ExpectedComfort, report: &Report) -> Vec<Expectation> {
    let Some(vehicle) = report.vehicle(&bounds.vehicle) else { return Vec::new() };
    let times = &vehicle.peak_times_s;
    let peaks = [
        (vehicle.peak_acceleration_mps2, times.acceleration),
        (vehicle.peak_braking_mps2, times.braking),
        (vehicle.peak_jerk_mps3, times.jerk),
        (vehicle.peak_lateral_acceleration_mps2, times.lateral_acceleration),
    ];
    let stated = bounds.bounds().into_iter().zip(peaks).filter_map(|((key, most), peak)| Some((key, most?, peak)));
    stated
        .map(|(key, most, (peak, time_s))| Expectation {
            what: format!("comfort.{}.{key}", bounds.vehicle),
            want: json!(most),
            got: json!({ "peak": peak, "time_s": time_s }),
            passed: peak <= most,
            at: None,
        })
        .collect()
}

/// Judges whether one vehicle let another go first wherever their ways meet and one of them came.
pub(super) fn yields(expected: &ExpectedYield, report: &Report) -> Expectation {
    let ExpectedYield { vehicle, to } = expected;
    let is_theirs = |passage: &&Passage| {
        (&passage.first, &passage.second) == (vehicle, to) || (&passage.first, &passage.second) == (to, vehicle)
    };
    let passages: Vec<&Passage> = report.right_of_way.iter().filter(is_theirs).collect();
    let let_go =
        |passage: &&Passage| passage.first == *to && passage.second_s.is_none_or(|second_s| second_s > passage.first_s);
    let got = match passages.as_slice() {
        [] => json!("neither entered the conflict zone"),
        [only] => json!(only),
        all => json!(all),
    };
    Expectation {
        what: format!("yields.{vehicle}.to.{to}"),
        want: json!({ "first": to, "second": vehicle }),
        got,
        passed: !passages.is_empty() && passages.iter().all(let_go),
        at: None,
    }
}
