//! Figures of comparisons as rows of words.

use interplay_sweep::compare::{GroupFigures, PairedDifference, PlannerFigures, Quantiles, Share, Split, VersionGroup};

/// The columns of figures.
pub(super) const FIGURES: [&str; 11] = [
    "planner",
    "runs",
    "success % (95 %)",
    "time s (95 %)",
    "first %",
    "yields %",
    "stuck",
    "contacts (by ego)",
    "gap m: least, 5 %, median",
    "time to collision s: 5 %, median",
    "plan ms: median, 99 %",
];

/// The columns of differences from the baseline.
pub(super) const DIFFERENCES: [&str; 9] = [
    "planner",
    "pairs",
    "success: wins / losses",
    "p (Holm)",
    "place: ahead / behind",
    "p (Holm)",
    "sooner / later",
    "p (Holm)",
    "later by s (95 %), median",
];

/// What there is nothing to say of.
const NOTHING: &str = "-";
/// Probabilities below this are written as powers of ten.
const LEAST_PROBABILITY: f64 = 1e-3;

/// The words for a group.
pub(super) fn heading(group: &GroupFigures) -> String {
    match (&group.family, &group.style) {
        (Some(family), Some(style)) => format!("{family}, {style}"),
        (Some(family), None) => family.clone(),
        (None, Some(style)) => format!("all, {style}"),
        (None, None) => "all".to_owned(),
    }
}

/// The figures of a planner.
pub(super) fn figures(planner: &PlannerFigures) -> Vec<String> {
    let unfinished =
        if planner.unfinished > 0 { format!(" (+{} unfinished)", planner.unfinished) } else { String::new() };
    let time = planner.completed_s.map(|time| format!("{:.2} ({})", time.mean, span(time.interval, 2)));
    let times = |median: Option<f64>, tail: Option<f64>| Some(format!("{:.1}, {:.1}", median?, tail?));
    vec![
        planner.planner.clone(),
        format!("{}{unfinished}", planner.runs),
        with_interval(&planner.success),
        time.unwrap_or_else(nothing),
        percent(planner.first.share()),
        percent(planner.yields.share()),
        planner.deadlocks.to_string(),
        format!("{} ({})", planner.contacts, planner.contacts_by_ego),
        planner
            .gap_m
            .map_or_else(nothing, |Quantiles { least, p05, median }| format!("{least:.3}, {p05:.3}, {median:.3}")),
        planner.time_to_collision_s.map_or_else(nothing, |time| format!("{:.2}, {:.2}", time.p05, time.median)),
        times(planner.plan_median_ms, planner.plan_p99_ms).unwrap_or_else(nothing),
    ]
}

/// The difference of a planner from the baseline.
pub(super) fn difference(name: &str, difference: &PairedDifference) -> Vec<String> {
    let delay = difference.delay_s.zip(difference.delay_interval_s).zip(difference.delay_median_s);
    let delay = delay.map(|((mean, interval), median)| format!("{mean:+.2} ({}), {median:+.2}", span(interval, 2)));
    let PairedDifference { success, place, time, .. } = difference;
    vec![
        name.to_owned(),
        difference.pairs.to_string(),
        format!("{} / {}", success.wins, success.losses),
        probability(success),
        format!("{} / {}", place.wins, place.losses),
        probability(place),
        format!("{} / {}", time.wins, time.losses),
        probability(time),
        delay.unwrap_or_else(nothing),
    ]
}

/// The name of a group of two versions.
pub(super) fn version_name(group: &VersionGroup) -> String {
    format!("{}, {}: {}", group.family, group.style, group.planner)
}

fn nothing() -> String {
    NOTHING.to_owned()
}

fn with_interval(share: &Share) -> String {
    share.share().map_or_else(nothing, |value| {
        format!("{} ({})", percent(Some(value)), span(share.interval.map(|bound| 100.0 * bound), 0))
    })
}

fn percent(share: Option<f64>) -> String {
    share.map_or_else(nothing, |share| format!("{:.0}", 100.0 * share))
}

fn span([low, high]: [f64; 2], decimals: usize) -> String {
    format!("{low:.decimals$} to {high:.decimals$}")
}

/// A corrected probability, with a star where it is below 5 %.
fn probability(split: &Split) -> String {
    if split.wins + split.losses == 0 {
        return nothing();
    }
    let star = if split.p_holm < 0.05 { " *" } else { "" };
    match split.p_holm {
        0.0 => format!("< 1e-300{star}"),
        small if small < LEAST_PROBABILITY => format!("{small:.0e}{star}"),
        other => format!("{other:.3}{star}"),
    }
}
