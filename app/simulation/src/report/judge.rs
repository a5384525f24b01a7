//! Judges whether a run fulfilled the expectations of its scenario.

use std::collections::BTreeSet;

use interplay_scenarios::{Completes, Expect, ExpectedYield, MetricBound, MetricLimit};
use serde_json::{Map, Value, json};

use super::judge_building::{judge_building, judge_zone};
use super::outcome::{Expectation, Report, VehicleReport};
use crate::measure::{Measured, MetricValue, Passage};
use crate::state::frame::Collision;

/// Contacts that a failed expectation names.
const MOST_CONTACTS: usize = 3;

/// Judges every expectation that the scenario states.
pub(super) fn judge(expect: &Expect, report: &Report) -> Vec<Expectation> {
    let mut judged = Vec::new();
    if let Some(none) = expect.no_collision {
        judged.push(no_collision(none, report));
    }
    let mut add = |what: String, want: Value, got: Value, passed: bool| {
        judged.push(Expectation::new(what, want, got, passed));
    };
    if let Some(pairs) = &expect.collisions {
        let (want, got) = (unordered(pairs.iter()), unordered(report.collisions.iter().map(|one| &one.between)));
        let passed = want == got;
        add("collisions".into(), json!(want), json!(got), passed);
    }
    if let Some(order) = &expect.order {
        let got: Vec<&String> = report.order.iter().filter(|name| order.contains(name)).collect();
        let passed = got.iter().copied().eq(order);
        add("order".into(), json!(order), json!(got), passed);
    }
    let of_all = expect.bounds_of_all();
    let (of_ego, of_all) = of_all.split_at(usize::from(expect.min_gap_m.is_some()));
    judged.extend(of_ego.iter().filter_map(|bound| judge_bound(bound, report)));
    if let Some(most) = expect.plan_failures_at_most {
        let failed: usize = report.vehicles.iter().map(|vehicle| vehicle.plans.failed).sum();
        judged.push(Expectation::new("plan_failures_at_most", json!(most), json!(failed), failed <= most));
    }
    judged.extend(of_all.iter().filter_map(|bound| judge_bound(bound, report)));
    judged.extend(expect.rules_kept.map(|kept| rules_kept(kept, report)));
    for window in &expect.completes {
        judged.push(completes(window, report));
    }
    judged.extend(expect.bounds_of_vehicles().iter().filter_map(|bound| judge_bound(bound, report)));
    judged.extend(expect.yields.iter().map(|expected| yields(expected, report)));
    judged.extend(expect.bounds_of_metrics().iter().filter_map(|bound| judge_bound(bound, report)));
    if let Some(building) = &report.building {
        let first_days = expect.building.unwrap_or_default().after_iterations;
        judged.extend(expect.building.iter().flat_map(|expect| judge_building(expect, building)));
        judged.extend(expect.zones.iter().flat_map(|expect| judge_zone(expect, first_days, building)));
    }
    judged
}

/// Judges whether vehicles touched; a failure says which and when, contacts between vehicles that follow records last.
fn no_collision(wanted: bool, report: &Report) -> Expectation {
    let is_recorded = |name: &String| report.vehicle(name).is_some_and(|vehicle| vehicle.follows_record);
    let of_records = |contact: &&Collision| contact.between.iter().all(is_recorded);
    let (recorded, mut contacts): (Vec<&Collision>, Vec<&Collision>) = report.collisions.iter().partition(of_records);
    contacts.extend(recorded);
    let mut words: Vec<String> = contacts
        .iter()
        .take(MOST_CONTACTS)
        .map(|contact| {
            let [one, other] = &contact.between;
            let what =
                contact.fault.as_ref().map_or_else(|| format!("{one} and {other} touched"), |fault| fault.why.clone());
            let records = if of_records(contact) { ", both of which follow their records" } else { "" };
            format!("{what} at {:.2} s{records}", contact.time_s)
        })
        .collect();
    if contacts.len() > MOST_CONTACTS {
        words.push(format!("and {} more", contacts.len() - MOST_CONTACTS));
    }
    let got = contacts.is_empty();
    let at = (wanted && !got).then(|| words.join("; "));
    Expectation { at, ..Expectation::new("no_collision", json!(wanted), json!(got), wanted == got) }
}

/// The distinct pairs, whichever vehicle is named first.
fn unordered<'a>(pairs: impl Iterator<Item = &'a [String; 2]>) -> BTreeSet<[&'a str; 2]> {
    pairs.map(|[a, b]| if a < b { [a.as_str(), b] } else { [b.as_str(), a] }).collect()
}

/// Judges whether rule-keeping vehicles broke a rule; the actual value names each that did, with the count.
fn rules_kept(wanted: bool, report: &Report) -> Expectation {
    let keepers = report.vehicles.iter().filter(|vehicle| vehicle.keeps_rules);
    let broken: Map<String, Value> = keepers
        .filter_map(|vehicle| {
            let count = vehicle.metrics.number("rules_broken").filter(|count| *count > 0.0)?;
            Some((vehicle.name.clone(), json!(count as u64)))
        })
        .collect();
    let are_kept = broken.is_empty();
    let got = if are_kept { json!(true) } else { json!({ "rules_broken": broken }) };
    Expectation::new("rules_kept", json!(wanted), got, wanted == are_kept)
}

fn completes(window: &Completes, report: &Report) -> Expectation {
    let vehicle = report.vehicle(&window.vehicle);
    let completed = vehicle.and_then(|vehicle| vehicle.completed_s);
    let got = match vehicle {
        Some(vehicle) if !vehicle.has_task => {
            json!("nothing to complete: it starts where it is to go, or follows a record")
        }
        _ => json!(completed),
    };
    let (after, before) = (window.after_s.unwrap_or(0.0), window.before_s.unwrap_or(f64::INFINITY));
    Expectation {
        what: format!("completes.{}", window.vehicle),
        want: wanted_window(window),
        got,
        passed: completed.is_some_and(|time| (after..=before).contains(&time)),
        at: None,
    }
}

/// The stated limits; without one, any time fulfils the expectation.
fn wanted_window(window: &Completes) -> Value {
    let limits = [("after_s", window.after_s), ("before_s", window.before_s)];
    let stated: Map<String, Value> =
        limits.into_iter().filter_map(|(key, limit)| Some((key.to_owned(), json!(limit?)))).collect();
    if stated.is_empty() { json!("any time") } else { Value::Object(stated) }
}

/// Judges whether one vehicle let another go first wherever their routes meet and one of them entered. For a rule-keeping vehicle order
/// alone is not enough: it must have yielded.
fn yields(expected: &ExpectedYield, report: &Report) -> Expectation {
    let ExpectedYield { vehicle, to } = expected;
    let is_theirs = |passage: &&Passage| {
        (&passage.first, &passage.second) == (vehicle, to) || (&passage.first, &passage.second) == (to, vehicle)
    };
    let passages: Vec<&Passage> = report.right_of_way.iter().filter(is_theirs).collect();
    let is_strict = report.vehicle(vehicle).is_some_and(|vehicle| vehicle.keeps_rules);
    let let_go = |passage: &&Passage| {
        let is_after = passage.second_s.is_none_or(|second_s| second_s > passage.first_s);
        passage.first == *to && is_after && (passage.yielded || !is_strict)
    };
    let got = match passages.as_slice() {
        [] => json!("neither entered the conflict zone"),
        [only] => json!(only),
        all => json!(all),
    };
    Expectation {
        what: format!("yields.{vehicle}.to.{to}"),
        want: if is_strict {
            json!({ "first": to, "second": vehicle, "yielded": true })
        } else {
            json!({ "first": to, "second": vehicle })
        },
        got,
        passed: !passages.is_empty() && passages.iter().all(let_go),
        at: None,
    }
}

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
