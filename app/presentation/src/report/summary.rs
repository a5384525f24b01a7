//! A run in a few lines.

use std::fmt::Write;

use interplay_common::spelling::counted;
use interplay_simulation::measure::Wait;
use interplay_simulation::report::{BeliefReport, CounterfactualReport, PlansReport, Report, VehicleReport};

use super::building;
use super::columns::{Align, write_table, written};
use super::crowd::{Crowd, is_in};

/// The report as text: goals, passing order, smallest gap, planning times, expectations.
pub fn summary(title: &str, report: &Report) -> String {
    written(|text| write_summary(text, title, report))
}

fn write_summary(text: &mut String, title: &str, report: &Report) -> std::fmt::Result {
    // A building is simulated so fast that the factor says nothing.
    let factor = Some(report.simulated_s / report.wall_s.max(1e-9)).filter(|_| !report.vehicles.is_empty());
    let factor = factor.map_or_else(String::new, |factor| format!(" ({} times real time)", factor_in_words(factor)));
    let simulated = match &report.building {
        Some(building) if report.vehicles.is_empty() => counted(building.iterations.len(), "day"),
        _ => format!("{:?} s", to_milliseconds(report.simulated_s)),
    };
    writeln!(text, "{title}  [{}]", report.scenario)?;
    writeln!(text, "  {simulated} simulated in {:.2} s{factor}", report.wall_s)?;
    if !report.vehicles.is_empty() {
        write_driving(text, report)?;
    }
    if let Some(building) = &report.building {
        building::write(text, building)?;
    }
    write_expectations(text, report)?;
    write_counterfactuals(text, &report.counterfactuals)
}

/// A factor as a whole number, or below one with a digit that tells it from 0: `19`, `0.3`, `2.0e-3`.
fn factor_in_words(factor: f64) -> String {
    match factor {
        _ if factor >= 0.95 => format!("{factor:.0}"),
        _ if factor >= 0.05 => format!("{factor:.1}"),
        _ => format!("{factor:.1e}"),
    }
}

/// Rounds a time to milliseconds, since the steps of full-size roads are not round numbers \[s\].
fn to_milliseconds(time_s: f64) -> f64 {
    (1e3 * time_s).round() / 1e3
}

fn write_driving(text: &mut String, report: &Report) -> std::fmt::Result {
    let (crowds, alone) = Crowd::split(&report.vehicles);
    for crowd in &crowds {
        writeln!(text, "  {}", crowd.sentence())?;
    }
    for vehicle in &alone {
        if let Some(time_s) = vehicle.completed_s {
            writeln!(text, "  {} reached its goal at {:?} s", vehicle.name, to_milliseconds(time_s))?;
        }
    }
    if let Some(order) = order_in_words(report, &crowds) {
        writeln!(text, "  order at the end: {order}")?;
    }
    match report.min_gap_m() {
        Some(gap) => writeln!(text, "  smallest gap of the ego: {gap:.3} m")?,
        None => writeln!(text, "  the ego is the only vehicle")?,
    }
    for vehicle in &report.vehicles {
        for belief in &vehicle.beliefs {
            writeln!(text, "  {} takes {}", vehicle.name, belief_in_words(belief))?;
        }
    }
    for collision in &report.collisions {
        let [a, b] = &collision.between;
        write!(text, "  COLLISION of {a} and {b} at {:.2} s ({:.2} Ns)", collision.time_s, collision.impulse_ns)?;
        writeln!(text, "{}", collision.fault.as_ref().map_or_else(String::new, |fault| format!(": {}", fault.why)))?;
    }
    for broken in &report.broken_rules {
        writeln!(text, "  RULE BROKEN at {:.2} s: {} {}", broken.time_s, broken.vehicle, broken.words())?;
    }
    for vehicle in alone.iter().filter(|vehicle| !vehicle.standing.is_empty()) {
        let waits: Vec<String> = vehicle.standing.iter().map(Wait::sentence).collect();
        writeln!(text, "  {} {}", vehicle.name, waits.join(", "))?;
    }
    for deadlock in &report.deadlocks {
        writeln!(text, "  DEADLOCK at {:.2} s: {}", deadlock.time_s, deadlock.sentence())?;
    }
    write_vehicles(text, &crowds, &alone)
}

/// The order at the end of the vehicles that are listed by name; `None` if there are crowds and at most one such vehicle.
fn order_in_words(report: &Report, crowds: &[Crowd<'_>]) -> Option<String> {
    let is_named = |name: &&str| report.vehicle(name).is_none_or(|vehicle| !is_in(crowds, vehicle));
    let named: Vec<&str> = report.order_of_driven().into_iter().filter(is_named).collect();
    (crowds.is_empty() || named.len() > 1).then(|| named.join(", "))
}

/// The belief of a driver about another one: the likely kinds of driver, and the one that it plans for.
fn belief_in_words(belief: &BeliefReport) -> String {
    let BeliefReport { about, taken_for, may_be, .. } = belief;
    let (percent, since_s) = (100.0 * belief.may_be_probability, to_milliseconds(belief.since_s));
    match may_be.as_slice() {
        [only] if only == taken_for => format!("{about} for {only} since {since_s:?} s ({percent:.0} %)"),
        several => {
            let names = several.join(" or ");
            format!("{about} for {names} ({percent:.0} %), and plans for {taken_for} since {since_s:?} s")
        }
    }
}

fn write_expectations(text: &mut String, report: &Report) -> std::fmt::Result {
    if report.expectations.is_empty() {
        return writeln!(text, "  no expectations stated");
    }
    for expectation in &report.expectations {
        let mark = if expectation.passed { "ok  " } else { "FAIL" };
        writeln!(text, "  {mark} {expectation}")?;
    }
    let failed = report.expectations.iter().filter(|expectation| !expectation.passed).count();
    match failed {
        0 => writeln!(text, "  PASSED: {} held", all_of(report.expectations.len(), "expectation")),
        _ => writeln!(text, "  FAILED: {failed} of {}", counted(report.expectations.len(), "expectation")),
    }
}

fn write_counterfactuals(text: &mut String, counterfactuals: &[CounterfactualReport]) -> std::fmt::Result {
    if counterfactuals.is_empty() {
        return Ok(());
    }
    writeln!(text, "  counterfactuals, with something changed:")?;
    for one in counterfactuals {
        let mark = if one.passed { "ok  " } else { "FAIL" };
        let order = if one.order.is_empty() { String::new() } else { format!(" (order: {})", one.order.join(", ")) };
        writeln!(text, "  {mark} {}{order}", one.name)?;
        one.failed().try_for_each(|failed| writeln!(text, "         {failed}"))?;
    }
    match counterfactuals.iter().filter(|one| !one.passed).count() {
        0 => writeln!(text, "  PASSED: {} did as claimed", all_of(counterfactuals.len(), "counterfactual")),
        failed => writeln!(text, "  FAILED: {failed} of {}", counted(counterfactuals.len(), "counterfactual")),
    }
}

fn all_of(count: usize, what: &str) -> String {
    if count == 1 { format!("the {what}") } else { format!("all {count} {what}s") }
}

/// Remarks about failed and slow plans.
fn remarks(plans: &PlansReport) -> String {
    let failed = (plans.failed > 0).then(|| format!("{} FAILED", plans.failed));
    let slow = plans.over_budget.filter(|count| *count > 0).map(|count| format!("{count} over budget"));
    failed.into_iter().chain(slow).collect::<Vec<_>>().join(", ")
}

fn write_vehicles(text: &mut String, crowds: &[Crowd<'_>], alone: &[&VehicleReport]) -> std::fmt::Result {
    use Align::{Left, Right};
    let header = [
        ("vehicle", Left),
        ("driver", Left),
        ("speed m/s", Right),
        ("|a| m/s²", Right),
        ("plans", Right),
        ("median ms", Right),
        ("p99 ms", Right),
        ("", Left),
    ];
    let row = |vehicle: &VehicleReport| {
        let plans = &vehicle.plans;
        vec![
            vehicle.name.clone(),
            vehicle.driver.clone(),
            vehicle.speed_range_mps().map(|speed_mps| format!("{speed_mps:.2}")).join("-"),
            vehicle.metrics.number("mean_abs_acceleration").map_or_else(String::new, |mean| format!("{mean:.2}")),
            plans.count.to_string(),
            format!("{:.2}", plans.median_ms),
            format!("{:.2}", plans.p99_ms),
            remarks(plans),
        ]
    };
    let driven = alone.iter().filter(|vehicle| !vehicle.is_obstacle);
    write_table(text, &header, driven.map(|vehicle| row(vehicle)).chain(crowds.iter().map(crowd_row)))
}

/// The row of a crowd: ranges over its vehicles, sums of plans, and the slowest median of planning times.
fn crowd_row(crowd: &Crowd<'_>) -> Vec<String> {
    let came = || crowd.vehicles.iter().filter(|vehicle| vehicle.travel.has_come());
    let [least, most] = came().fold([f64::INFINITY, 0.0_f64], |[least, most], vehicle| {
        let [low, high] = vehicle.speed_range_mps();
        [least.min(low), most.max(high)]
    });
    let mean = came().filter_map(|vehicle| vehicle.metrics.number("mean_abs_acceleration")).sum::<f64>();
    let worst = |of: fn(&PlansReport) -> f64| came().map(|vehicle| of(&vehicle.plans)).fold(0.0, f64::max);
    let total = |of: fn(&PlansReport) -> usize| came().map(|vehicle| of(&vehicle.plans)).sum::<usize>();
    let mut drivers: Vec<&str> = crowd.vehicles.iter().map(|vehicle| vehicle.driver.as_str()).collect();
    drivers.sort_unstable();
    drivers.dedup();
    let failed = total(|plans| plans.failed);
    vec![
        format!("{} ({})", crowd.name, crowd.vehicles.len()),
        drivers.join(", "),
        format!("{:.2}-{most:.2}", least.min(most)),
        format!("{:.2}", mean / came().count().max(1) as f64),
        total(|plans| plans.count).to_string(),
        format!("{:.2}", worst(|plans| plans.median_ms)),
        format!("{:.2}", worst(|plans| plans.p99_ms)),
        if failed > 0 { format!("{failed} FAILED") } else { String::new() },
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_slower_than_real_time_is_not_said_to_take_0_times_it() {
        assert_eq!([19.4, 1.2, 0.97, 0.3, 0.06].map(factor_in_words), ["19", "1", "1", "0.3", "0.1"]);
        assert_eq!(factor_in_words(0.002), "2.0e-3");
    }

    #[test]
    fn a_reported_belief_names_all_likely_kinds_and_the_predicted_one() {
        let mut belief = BeliefReport {
            about: "merger".to_owned(),
            taken_for: "nice".to_owned(),
            probability: 0.6,
            may_be: vec!["nice", "normal"],
            may_be_probability: 0.95,
            since_s: 1.2,
            safety_weight: 33.2,
            safety_weight_interval: [0.2, 100.0],
            entropy: 0.8,
        };
        assert_eq!(belief_in_words(&belief), "merger for nice or normal (95 %), and plans for nice since 1.2 s");
        (belief.may_be, belief.may_be_probability) = (vec!["nice"], 0.91);
        assert_eq!(belief_in_words(&belief), "merger for nice since 1.2 s (91 %)");
    }
}
