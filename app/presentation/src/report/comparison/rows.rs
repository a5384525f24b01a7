//! Tables of comparisons.

use interplay_sweep::compare::{
    BuildingDifference, BuildingFigures, Estimate, Figure, GroupFigures, NamedFigure, PairedDifference, PlannerFigures,
    Quantiles, Share, Split, VersionGroup,
};

/// A table: the words of its header, and its rows.
pub(super) type TextRows = (Vec<String>, Vec<Vec<String>>);

/// A column of a table: its title, and the text of a cell.
type RowColumn<T> = (&'static str, fn(&T) -> String);

/// A column of a metric: its title, and the text of a cell.
type MetricColumn<T> = (String, Box<dyn Fn(&T) -> String>);

/// The columns of vehicles, some of which combine several figures.
const TRAFFIC: [RowColumn<PlannerFigures>; 14] = [
    ("planner", |one| one.planner.clone()),
    ("runs", |one| runs(one)),
    ("success % (95 %)", |one| with_interval(one.figures.share("success"))),
    ("as in the file % (95 %)", |one| with_interval(one.figures.share("order_kept"))),
    ("time s (95 %)", |one| one.figures.mean("completed_s").map_or_else(no_value, |time| estimate(time, 2))),
    ("first %", |one| percent(share(one, "first"))),
    ("yields %: ego, others", |one| both(share(one, "yields"), share(one, "others_yield"))),
    ("stuck", |one| one.figures.count("deadlocks").to_string()),
    ("contacts: ego (by ego), any", |one| {
        let [ego, by_ego, any] = ["contacts", "contacts_by_ego", "touched"].map(|key| one.figures.count(key));
        format!("{ego} ({by_ego}), {any}")
    }),
    ("brakes hard %: ego (95 %), others", |one| hard_braking(one)),
    ("off road %", |one| percent(share(one, "off_road"))),
    ("gap m: least, 5 %, median", |one| gap(one)),
    ("time to collision s: 5 %, median", |one| time_to_collision(one)),
    ("plan ms: median, 99 %", |one| plan_times(one)),
];

/// The columns that the first look shows, with those of [`BRIEF_METRIC`].
const BRIEF: [&str; 6] = ["planner", "runs", "success % (95 %)", "time s (95 %)", "first %", "yields %: ego, others"];
/// The metric that the first look shows.
const BRIEF_METRIC: &str = "contacts_at_fault";
/// The first columns of differences are success, the later ones the time; the first look shows these.
const BRIEF_DIFFERENCES: [usize; 7] = [0, 1, 2, 3, 6, 7, 8];

/// The columns of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShownFigures {
    /// Success, which vehicle goes first, time, and contacts at fault.
    First,
    /// All of them.
    All,
}

/// The figures that these columns contain, or that only the JSON output has.
const COVERED: [&str; 18] = [
    "success",
    "order_kept",
    "completed_s",
    "first",
    "yields",
    "others_yield",
    "deadlocks",
    "contacts",
    "contacts_by_ego",
    "touched",
    "hard_braking",
    "others_hard_braking",
    "off_road",
    "gap_m",
    "time_to_collision_s",
    "plans_failed",
    "plan_median_ms",
    "plan_p99_ms",
];

fn building_columns<'a>() -> [RowColumn<(&'a PlannerFigures, &'a BuildingFigures)>; 6] {
    [
        ("planner", |(planner, _)| planner.planner.clone()),
        ("runs", |(planner, _)| runs(planner)),
        ("heat kWh (95 %)", |(_, building)| estimate(&building.energy_kwh, 2)),
        ("electricity kWh (95 %)", |(_, building)| {
            building.electricity_kwh.as_ref().map_or_else(no_value, |electricity| estimate(electricity, 2))
        }),
        ("bill (95 %)", |(_, building)| bill(building)),
        ("discomfort K·h (95 %)", |(_, building)| estimate(&building.discomfort_k_h, 3)),
    ]
}

/// The columns of differences from the baseline.
fn difference_columns<'a>() -> [RowColumn<(&'a str, &'a PairedDifference)>; 11] {
    [
        ("planner", |(name, _)| (*name).to_owned()),
        ("pairs", |(_, one)| one.pairs.to_string()),
        ("success: wins / losses", |(_, one)| split(&one.success)),
        ("p (Holm)", |(_, one)| probability(&one.success)),
        ("place: ahead / behind", |(_, one)| split(&one.place)),
        ("p (Holm)", |(_, one)| probability(&one.place)),
        ("sooner / later (one alone arrives)", |(_, one)| format!("{} ({})", split(&one.time), one.censored)),
        ("p (Holm)", |(_, one)| probability(&one.time)),
        ("later by s (95 %), median", |(_, one)| delay(one)),
        ("brakes hard: only the baseline / only this", |(_, one)| split(&one.metrics.get("hard_braking"))),
        ("p (Holm)", |(_, one)| probability(&one.metrics.get("hard_braking"))),
    ]
}

fn building_difference_columns<'a>() -> [RowColumn<(&'a str, &'a BuildingDifference)>; 6] {
    [
        ("planner", |(name, _)| (*name).to_owned()),
        ("cheaper / dearer", |(_, one)| split(&one.cheaper)),
        ("p (Holm)", |(_, one)| probability(&one.cheaper)),
        ("electricity more kWh (95 %)", |(_, one)| signed(one.electricity_kwh.as_ref(), 2)),
        ("bill more (95 %)", |(_, one)| signed(one.bill.as_ref(), 2)),
        ("discomfort more K·h (95 %)", |(_, one)| signed(one.discomfort_k_h.as_ref(), 3)),
    ]
}

/// The text of a cell without a value.
const NO_VALUE: &str = "-";
/// Probabilities below this are written as powers of ten.
const LEAST_PROBABILITY: f64 = 1e-3;

pub(super) fn heading(group: &GroupFigures) -> String {
    match (&group.family, &group.style) {
        (Some(family), Some(style)) => format!("{family}, {style}"),
        (Some(family), None) => family.clone(),
        (None, Some(style)) => format!("all, {style}"),
        (None, None) => "all".to_owned(),
    }
}

/// Tables of the figures of planners: of vehicles, and of buildings, if there are any.
pub(super) fn figures(group: &GroupFigures, shown: ShownFigures) -> Vec<TextRows> {
    let planners: Vec<&PlannerFigures> = group.planners.iter().collect();
    let buildings: Vec<(&PlannerFigures, &BuildingFigures)> =
        planners.iter().filter_map(|planner| Some((*planner, planner.building.as_ref()?))).collect();
    let is_brief = shown == ShownFigures::First;
    let is_other =
        |named: &&NamedFigure| !COVERED.contains(&named.key.as_str()) && (!is_brief || named.key == BRIEF_METRIC);
    let others = planners.first().into_iter().flat_map(|planner| planner.figures.0.iter().filter(is_other));
    let metrics = others.map(metric_column).collect();
    let columns: Vec<_> = TRAFFIC.into_iter().filter(|(title, _)| !is_brief || BRIEF.contains(title)).collect();
    let traffic = table(&columns, metrics, planners.into_iter().filter(|_| group.has_vehicles));
    [traffic, table(&building_columns(), Vec::new(), buildings.iter())]
        .into_iter()
        .filter(|(_, rows)| !rows.is_empty())
        .collect()
}

/// Tables of named differences: of vehicles, and of buildings, if there are any.
pub(super) fn differences(
    all: &[(String, &PairedDifference)],
    has_vehicles: bool,
    shown: ShownFigures,
) -> Vec<TextRows> {
    let is_brief = shown == ShownFigures::First;
    let named: Vec<(&str, &PairedDifference)> = all.iter().map(|(name, one)| (name.as_str(), *one)).collect();
    let buildings: Vec<(&str, &BuildingDifference)> =
        named.iter().filter_map(|(name, one)| Some((*name, one.building.as_ref()?))).collect();
    let splits = named.first().into_iter().flat_map(|(_, one)| &one.metrics.0);
    let others = splits.filter(|metric| !is_brief && !COVERED.contains(&metric.key));
    let metrics = others.flat_map(|metric| split_columns(metric.key, &metric.title)).collect();
    let columns = difference_columns().into_iter().enumerate();
    let columns = columns.filter(|(at, _)| !is_brief || BRIEF_DIFFERENCES.contains(at));
    let columns: Vec<_> = columns.map(|(_, column)| column).collect();
    let traffic = table(&columns, metrics, named.iter().filter(|_| has_vehicles));
    [traffic, table(&building_difference_columns(), Vec::new(), buildings.iter())]
        .into_iter()
        .filter(|(_, rows)| !rows.is_empty())
        .collect()
}

/// The differences of a group from the baseline.
pub(super) fn versus(group: &GroupFigures, shown: ShownFigures) -> Vec<TextRows> {
    let differing = group.planners.iter().filter_map(|planner| {
        Some((planner.planner.clone(), planner.versus_baseline.as_ref().filter(|versus| versus.pairs > 0)?))
    });
    differences(&differing.collect::<Vec<_>>(), group.has_vehicles, shown)
}

/// A table without the columns that are empty in all rows.
fn table<'a, T: 'a>(
    columns: &[RowColumn<T>],
    metrics: Vec<MetricColumn<T>>,
    of: impl Iterator<Item = &'a T>,
) -> TextRows {
    let all: Vec<&T> = of.collect();
    let fixed = columns.iter().map(|(title, cell)| ((*title).to_owned(), all.iter().map(|one| cell(one)).collect()));
    let metrics = metrics.into_iter().map(|(title, cell)| (title, all.iter().map(|one| cell(one)).collect()));
    let cells: Vec<(String, Vec<String>)> = fixed.chain(metrics).collect();
    let filled: Vec<(String, Vec<String>)> =
        cells.into_iter().filter(|(_, cells)| cells.iter().any(|cell| cell != NO_VALUE)).collect();
    let rows = (0..all.len()).map(|row| filled.iter().map(|(_, cells)| cells[row].clone()).collect()).collect();
    (filled.into_iter().map(|(title, _)| title).collect(), rows)
}

/// The column of a figure, by its kind.
fn metric_column(named: &NamedFigure) -> MetricColumn<PlannerFigures> {
    let (key, title) = (named.key.clone(), &named.title);
    let title = match named.figure {
        Figure::Share(_) => format!("{title} % (95 %)"),
        Figure::Mean(_) => format!("{title} (95 %)"),
        Figure::Quantiles(_) => format!("{title}: least, 5 %, median"),
        Figure::Count(_) | Figure::Median(_) => title.clone(),
    };
    let cell = move |one: &PlannerFigures| match one.figures.get(&key) {
        Some(Figure::Share(share)) => with_interval(Some(share)),
        Some(Figure::Mean(Some(mean))) => estimate(mean, 3),
        Some(Figure::Quantiles(Some(Quantiles { least, p05, median }))) => {
            format!("{least:.3}, {p05:.3}, {median:.3}")
        }
        Some(Figure::Count(count)) => count.to_string(),
        Some(Figure::Median(Some(median))) => format!("{median:.3}"),
        Some(Figure::Mean(None) | Figure::Quantiles(None) | Figure::Median(None)) | None => no_value(),
    };
    (title, Box::new(cell))
}

/// The columns of wins and losses by a metric.
fn split_columns<'a>(key: &'static str, title: &str) -> [MetricColumn<(&'a str, &'a PairedDifference)>; 2] {
    [
        (format!("{title}: better / worse"), Box::new(move |(_, one)| split(&one.metrics.get(key)))),
        ("p (Holm)".to_owned(), Box::new(move |(_, one)| probability(&one.metrics.get(key)))),
    ]
}

/// A share of the runs of a planner; `None` without runs.
fn share(planner: &PlannerFigures, key: &str) -> Option<f64> {
    planner.figures.share(key).and_then(Share::share)
}

fn runs(planner: &PlannerFigures) -> String {
    match planner.unfinished {
        0 => planner.runs.to_string(),
        unfinished => format!("{} (+{unfinished} unfinished)", planner.runs),
    }
}

fn gap(planner: &PlannerFigures) -> String {
    let gap = planner.figures.quantiles("gap_m");
    gap.map_or_else(no_value, |Quantiles { least, p05, median }| format!("{least:.3}, {p05:.3}, {median:.3}"))
}

fn time_to_collision(planner: &PlannerFigures) -> String {
    let time = planner.figures.quantiles("time_to_collision_s");
    time.map_or_else(no_value, |time| format!("{:.2}, {:.2}", time.p05, time.median))
}

fn plan_times(planner: &PlannerFigures) -> String {
    let times = planner.figures.median("plan_median_ms").zip(planner.figures.median("plan_p99_ms"));
    times.map_or_else(no_value, |(median, tail)| format!("{median:.1}, {tail:.1}"))
}

fn hard_braking(planner: &PlannerFigures) -> String {
    let Some(ego) = planner.figures.share("hard_braking").filter(|share| share.of > 0) else { return no_value() };
    format!("{}, {}", with_interval(Some(ego)), percent(share(planner, "others_hard_braking")))
}

fn bill(building: &BuildingFigures) -> String {
    let currency = building.currency.as_deref().unwrap_or_default().replace(char::is_control, " ");
    building.bill.as_ref().map_or_else(no_value, |bill| format!("{} {currency}", estimate(bill, 2)))
}

fn delay(difference: &PairedDifference) -> String {
    let delay = difference.delay_s.zip(difference.delay_interval_s).zip(difference.delay_median_s);
    delay
        .map_or_else(no_value, |((mean, interval), median)| format!("{mean:+.2} ({}), {median:+.2}", span(interval, 2)))
}

/// The name of a group of two versions.
pub(super) fn version_name(group: &VersionGroup) -> String {
    format!("{}, {}: {}", group.family, group.style, group.planner)
}

fn split(split: &Split) -> String {
    format!("{} / {}", split.wins, split.losses)
}

fn estimate(estimate: &Estimate, decimals: usize) -> String {
    format!("{:.decimals$} ({})", estimate.mean, span(estimate.interval, decimals))
}

fn signed(difference: Option<&Estimate>, decimals: usize) -> String {
    difference.map_or_else(no_value, |one| format!("{:+.decimals$} ({})", one.mean, span(one.interval, decimals)))
}

/// Two shares, separated by a comma; no value if neither is known.
fn both(one: Option<f64>, other: Option<f64>) -> String {
    if one.or(other).is_none() { no_value() } else { format!("{}, {}", percent(one), percent(other)) }
}

fn no_value() -> String {
    NO_VALUE.to_owned()
}

fn with_interval(share: Option<&Share>) -> String {
    let known = share.and_then(|share| Some((share.share()?, share.interval)));
    known.map_or_else(no_value, |(value, interval)| {
        format!("{} ({})", percent(Some(value)), span(interval.map(|bound| 100.0 * bound), 0))
    })
}

fn percent(share: Option<f64>) -> String {
    share.map_or_else(no_value, |share| format!("{:.0}", 100.0 * share))
}

fn span([low, high]: [f64; 2], decimals: usize) -> String {
    format!("{low:.decimals$} to {high:.decimals$}")
}

/// A corrected probability, with a star where it is below 5 %.
fn probability(split: &Split) -> String {
    if split.wins + split.losses == 0 {
        return no_value();
    }
    let star = if split.p_holm < 0.05 { " *" } else { "" };
    match split.p_holm {
        0.0 => format!("< 1e-300{star}"),
        small if small < LEAST_PROBABILITY => format!("{small:.0e}{star}"),
        other => format!("{other:.3}{star}"),
    }
}
