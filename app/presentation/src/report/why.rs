//! The table and the sentences of `interplay why`: what the outcome of a drive depends on.

use std::fmt::Write;

use interplay_simulation::why::{WhyReport, WhyRun};

use super::columns::{Align, write_table, written};
use crate::shell;

/// A line for every run, and below them in words what the order, the times and the expectations depend on; `command` are the
/// words that run the scenario itself.
pub fn why(title: &str, command: &[String], report: &WhyReport) -> String {
    written(|text| write_why(text, title, command, report))
}

fn write_why(text: &mut String, title: &str, command: &[String], report: &WhyReport) -> std::fmt::Result {
    use Align::{Left, Right};
    let from = report.at_s.map(|at_s| format!("; what is changed holds from {at_s} s on")).unwrap_or_default();
    writeln!(text, "{title}  [{}]{from}", report.scenario)?;
    let names = report.runs.iter().take(1).flat_map(|run| &run.vehicles).map(|vehicle| format!("{} s", vehicle.name));
    let names: Vec<String> = names.collect();
    let mut header = vec![("what is changed", Left), ("order", Left)];
    header.extend(names.iter().map(|name| (name.as_str(), Right)));
    header.extend([("gap m", Right), ("expectations", Left)]);
    write_table(text, &header, report.runs.iter().map(row))?;
    writeln!(text, "\n{}", conclusion(report))?;
    if report.at_s.is_some() {
        return Ok(());
    }
    // The most instructive run is the first with another passing order.
    let Some(run) = report.runs.iter().find(|run| run.order_differs).or(report.runs.last()) else { return Ok(()) };
    let set = run.set.iter().flat_map(|set| ["--set", set]);
    writeln!(text, "To see one of these runs: {}", shell::line(command.iter().map(String::as_str).chain(set)))
}

fn row(run: &WhyRun) -> Vec<String> {
    let change = run.change.clone().unwrap_or_else(|| "nothing".to_owned());
    let mut row = vec![change, run.order.join(", ")];
    let time = |time_s: Option<f64>| time_s.map_or_else(|| "-".to_owned(), |time_s| format!("{time_s:.1}"));
    row.extend(run.vehicles.iter().map(|vehicle| time(vehicle.completed_s)));
    row.push(run.min_gap_m.map_or_else(|| "-".to_owned(), |gap_m| format!("{gap_m:.3}")));
    let mut verdict = match run.expectations_hold {
        None => "none stated".to_owned(),
        Some(true) => "hold".to_owned(),
        Some(false) => format!("FAIL: {}", run.failed.join(", ")),
    };
    if run.collisions > 0 {
        verdict += "; COLLISION";
    }
    if run.plan_failures > 0 {
        verdict += &format!("; {} failed {}", run.plan_failures, if run.plan_failures == 1 { "plan" } else { "plans" });
    }
    row.push(verdict);
    row
}

/// What the table shows, in sentences.
fn conclusion(report: &WhyReport) -> String {
    let mut sentences = vec![match report.order_depends_on.as_slice() {
        [] => "The order is the same in all of these runs.".to_owned(),
        factors => format!("The order depends on {}.", grouped(factors, "and")),
    }];
    if !report.order_depends_on.is_empty() && !report.order_does_not_depend_on.is_empty() {
        sentences.push(format!("It does not depend on {}.", grouped(&report.order_does_not_depend_on, "or")));
    }
    if !report.times_depend_on.is_empty() {
        let too = if report.order_depends_on.is_empty() { "" } else { " too" };
        sentences.push(format!("The times of arrival depend on {}{too}.", grouped(&report.times_depend_on, "and")));
    }
    sentences.extend(match report.expectations_depend_on.as_slice() {
        [] => None,
        factors if factors == report.order_depends_on => {
            Some("Whether the expectations hold depends on the same factors as the order.".to_owned())
        }
        factors => Some(format!("Whether the expectations hold depends on {}.", grouped(factors, "and"))),
    });
    sentences.join("\n")
}

/// Factors in a row, those of one vehicle together: "ego's planner and persuasion, and front's style".
fn grouped(factors: &[String], last: &str) -> String {
    let mut groups: Vec<(&str, Vec<&str>)> = Vec::new();
    for factor in factors {
        let (owner, aspect) = factor.split_once("'s ").unwrap_or(("", factor));
        match groups.iter_mut().find(|(known, _)| *known == owner) {
            Some((_, aspects)) => aspects.push(aspect),
            None => groups.push((owner, vec![aspect])),
        }
    }
    let words: Vec<String> =
        groups.iter().map(|(owner, aspects)| format!("{owner}'s {}", joined(aspects, last))).collect();
    words.join(&format!(", {last} "))
}

/// Words in a row: "a, b and c".
fn joined(words: &[&str], last: &str) -> String {
    match words {
        [] => String::new(),
        [only] => (*only).to_owned(),
        [first @ .., end] => format!("{} {last} {end}", first.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_why_table_lists_factors_vehicle_by_vehicle() {
        let grouped =
            |factors: &[&str], last| grouped(&factors.iter().map(|&one| one.to_owned()).collect::<Vec<_>>(), last);
        assert_eq!(grouped(&["front's style"], "and"), "front's style");
        assert_eq!(grouped(&["ego's planner", "ego's persuasion"], "and"), "ego's planner and persuasion");
        let all = ["ego's a", "ego's b", "rear's style", "ego's c"];
        assert_eq!(grouped(&all, "or"), "ego's a, b or c, or rear's style");
    }
}
