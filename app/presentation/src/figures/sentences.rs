//! The outcome of runs in sentences.

use super::recorded_run::RecordedRun;

/// Stands for the time of a goal that is not reached, or that is reached from the start.
const GOAL_NOT_REACHED: &str = "never";

/// The outcome of a run in words: what the scenario shows, and the compared facts.
pub fn outcome(recorded: &RecordedRun) -> String {
    let mut sentences = vec![recorded.scenario.shows.trim_end_matches('.').to_owned()];
    let known = facts(recorded).into_iter().filter(|(_, value)| value != GOAL_NOT_REACHED);
    sentences.extend(known.map(|(what, value)| format!("{what} {value}")));
    let mut text = sentences.remove(0);
    text.push_str(". ");
    text.push_str(&capitalised(&sentences.join("; ")));
    text.push('.');
    text
}

/// The facts of `beside` that differ from those of `recorded`, in words; `None` if `beside` has no label.
pub fn difference(recorded: &RecordedRun, beside: &RecordedRun) -> Option<String> {
    let changed: Vec<String> = facts(recorded)
        .into_iter()
        .zip(facts(beside))
        .filter(|((_, here), (_, there))| here != there)
        .map(|((what, here), (_, there))| format!("{what} {there} instead of {here}"))
        .collect();
    let result = if changed.is_empty() { "nothing that is measured changes".to_owned() } else { changed.join("; ") };
    (!beside.label.is_empty()).then(|| format!("{}: {result}.", capitalised(&beside.label)))
}

/// The facts of a run that are compared, always in the same order.
fn facts(recorded: &RecordedRun) -> Vec<(String, String)> {
    let mut facts = Vec::new();
    let report = &recorded.report;
    if let Some(ego) = report.vehicles.get(recorded.scenario.ego_index()) {
        let goal = ego.completed_s.map_or_else(|| GOAL_NOT_REACHED.to_owned(), |time_s| format!("at {time_s:.1} s"));
        facts.push((format!("{} reaches its goal", ego.name), goal));
        facts.push(("order at the end".to_owned(), report.order.join(", ")));
        let gap = report.min_gap_m().map_or_else(|| "none".to_owned(), |gap_m| format!("{gap_m:.2} m"));
        facts.push(("smallest gap".to_owned(), gap));
        facts.push(("slowest".to_owned(), format!("{:.2} m/s", ego.speed_range_mps()[0])));
        facts.push(("collisions".to_owned(), report.collisions.len().to_string()));
    }
    let days = report.building.as_ref().map(|building| building.iterations.as_slice()).unwrap_or_default();
    if let (Some(first), Some(last)) = (days.first(), days.last()) {
        facts.push(("cost of the first day".to_owned(), format!("{:.0}", first.figures.cost)));
        facts.push(("cost of the last day".to_owned(), format!("{:.1}", last.figures.cost)));
        facts.push(("error on the last day".to_owned(), format!("{:.2} K", last.figures.tracking_rmse_c)));
        let outside: f64 = days[1..].iter().map(|day| day.figures.discomfort_k_h).sum();
        let outside = outside / days[1..].len().max(1) as f64;
        facts.push(("outside the comfort band after the first day".to_owned(), format!("{outside:.2} K·h a day")));
        if let Some(exchange) = &last.exchange {
            facts.push(("rounds of messages on the last day".to_owned(), exchange.rounds.to_string()));
        }
    }
    facts
}

fn capitalised(words: &str) -> String {
    let mut letters = words.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

#[cfg(test)]
mod tests {
    use super::super::RunSpec;
    use super::*;

    #[test]
    fn the_difference_between_two_runs_lists_the_facts_that_differ() {
        let recorded =
            |label: &str, sets: &[&str]| RunSpec::new(label, "lane-change/front-nice", sets).record().expect("a run");
        let (nice, other) =
            (recorded("", &[]), recorded("conservative", &["vehicle.ego.driver.kind=\"conservative\""]));
        let words = outcome(&nice);
        assert!(words.contains(". Ego reaches its goal at "), "{words}");
        let words = difference(&nice, &other).expect("it has a label");
        assert!(words.starts_with("Conservative: ego reaches its goal at "), "{words}");
        assert!(words.contains("order at the end front, ego, rear instead of ego, front, rear"), "{words}");
        assert_eq!(difference(&other, &nice), None, "the other run has no label");
        assert!(difference(&other, &other).expect("a label").contains("nothing that is measured changes"));
    }
}
