//! Figures of comparisons as rows of words.

use interplay_sweep::compare::{
    BuildingDifference, BuildingFigures, Estimate, GroupFigures, PairedDifference, PlannerFigures, Quantiles, Share,
    Split, VersionGroup,
};

/// A table: the words of its header, and its rows.
pub(super) type TextRows = (Vec<String>, Vec<Vec<String>>);

/// A column of a table: what it is called, and what it says of one.
type RowColumn<T> = (&'static str, fn(&T) -> String);

/// The columns of what vehicles did.
const TRAFFIC: [RowColumn<PlannerFigures>; 14] = [
    ("planner", |one| one.planner.clone()),
    ("runs", |one| runs(one)),
    ("success % (95 %)", |one| with_interval(&one.success)),
    ("as in the file % (95 %)", |one| with_interval(&one.order_kept)),
    ("time s (95 %)", |one| one.completed_s.as_ref().map_or_else(nothing, |time| estimate(time, 2))),
    ("first %", |one| percent(one.first.share())),
    ("yields %: ego, others", |one| both(one.yields.share(), one.others_yield.share())),
    ("stuck", |one| one.deadlocks.to_string()),
    ("contacts: ego (by ego), any", |one| format!("{} ({}), {}", one.contacts, one.contacts_by_ego, one.touched)),
    ("brakes hard %: ego (95 %), others", |one| hard_braking(one)),
    ("off road %", |one| if one.off_road.of == 0 { nothing() } else { percent(one.off_road.share()) }),
    ("gap m: least, 5 %, median", |one| gap(one)),
    ("time to collision s: 5 %, median", |one| time_to_collision(one)),
    ("plan ms: median, 99 %", |one| plan_times(one)),
];

/// The columns of what became of buildings.
fn building_columns<'a>() -> [RowColumn<(&'a PlannerFigures, &'a BuildingFigures)>; 6] {
    [
        ("planner", |(planner, _)| planner.planner.clone()),
        ("runs", |(planner, _)| runs(planner)),
        ("heat kWh (95 %)", |(_, building)| estimate(&building.energy_kwh, 2)),
        ("electricity kWh (95 %)", |(_, building)| {
            building.electricity_kwh.as_ref().map_or_else(nothing, |electricity| estimate(electricity, 2))
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
        ("sooner / later", |(_, one)| split(&one.time)),
        ("p (Holm)", |(_, one)| probability(&one.time)),
        ("later by s (95 %), median", |(_, one)| delay(one)),
        ("brakes hard: only the baseline / only this", |(_, one)| split(&one.hard_braking)),
        ("p (Holm)", |(_, one)| probability(&one.hard_braking)),
    ]
}

/// The columns of differences of buildings.
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

/// Tables of the figures of some planners: of vehicles, and of buildings, where there are any.
pub(super) fn figures(group: &GroupFigures) -> Vec<TextRows> {
    let planners: Vec<&PlannerFigures> = group.planners.iter().collect();
    let buildings: Vec<(&PlannerFigures, &BuildingFigures)> =
        planners.iter().filter_map(|planner| Some((*planner, planner.building.as_ref()?))).collect();
    let traffic = table(&TRAFFIC, planners.into_iter().filter(|_| group.has_vehicles));
    [traffic, table(&building_columns(), buildings.iter())].into_iter().filter(|(_, rows)| !rows.is_empty()).collect()
}

/// Tables of differences, each with the name of what is different: of vehicles, and of buildings, where there are any.
pub(super) fn differences(all: &[(String, &PairedDifference)], has_vehicles: bool) -> Vec<TextRows> {
    let named: Vec<(&str, &PairedDifference)> = all.iter().map(|(name, one)| (name.as_str(), *one)).collect();
    let buildings: Vec<(&str, &BuildingDifference)> =
        named.iter().filter_map(|(name, one)| Some((*name, one.building.as_ref()?))).collect();
    let traffic = table(&difference_columns(), named.iter().filter(|_| has_vehicles));
    [traffic, table(&building_difference_columns(), buildings.iter())]
        .into_iter()
        .filter(|(_, rows)| !rows.is_empty())
        .collect()
}

/// The differences of a group from the baseline.
pub(super) fn versus(group: &GroupFigures) -> Vec<TextRows> {
    let differing = group.planners.iter().filter_map(|planner| {
        Some((planner.planner.clone(), planner.versus_baseline.as_ref().filter(|versus| versus.pairs > 0)?))
    });
    differences(&differing.collect::<Vec<_>>(), group.has_vehicles)
}

/// A table without the columns that say nothing in any row.
fn table<'a, T: 'a>(columns: &[RowColumn<T>], of: impl Iterator<Item = &'a T>) -> TextRows {
    let all: Vec<&T> = of.collect();
    let cells: Vec<(&str, Vec<String>)> =
        columns.iter().map(|(title, cell)| (*title, all.iter().map(|one| cell(one)).collect())).collect();
    let told: Vec<(&str, Vec<String>)> =
        cells.into_iter().filter(|(_, cells)| cells.iter().any(|cell| cell != NOTHING)).collect();
    let rows = (0..all.len()).map(|row| told.iter().map(|(_, cells)| cells[row].clone()).collect()).collect();
    (told.iter().map(|(title, _)| (*title).to_owned()).collect(), rows)
}

fn runs(planner: &PlannerFigures) -> String {
    match planner.unfinished {
        0 => planner.runs.to_string(),
        unfinished => format!("{} (+{unfinished} unfinished)", planner.runs),
    }
}

fn gap(planner: &PlannerFigures) -> String {
    let gap = planner.gap_m;
    gap.map_or_else(nothing, |Quantiles { least, p05, median }| format!("{least:.3}, {p05:.3}, {median:.3}"))
}

fn time_to_collision(planner: &PlannerFigures) -> String {
    planner.time_to_collision_s.map_or_else(nothing, |time| format!("{:.2}, {:.2}", time.p05, time.median))
}

fn plan_times(planner: &PlannerFigures) -> String {
    let times = planner.plan_median_ms.zip(planner.plan_p99_ms);
    times.map_or_else(nothing, |(median, tail)| format!("{median:.1}, {tail:.1}"))
}

fn hard_braking(planner: &PlannerFigures) -> String {
    match planner.hard_braking.of {
        0 => nothing(),
        _ => format!("{}, {}", with_interval(&planner.hard_braking), percent(planner.others_hard_braking.share())),
    }
}

fn bill(building: &BuildingFigures) -> String {
    let currency = building.currency.as_deref().unwrap_or_default().replace(char::is_control, " ");
    building.bill.as_ref().map_or_else(nothing, |bill| format!("{} {currency}", estimate(bill, 2)))
}

fn delay(difference: &PairedDifference) -> String {
    let delay = difference.delay_s.zip(difference.delay_interval_s).zip(difference.delay_median_s);
    delay.map_or_else(nothing, |((mean, interval), median)| format!("{mean:+.2} ({}), {median:+.2}", span(interval, 2)))
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

/// A difference with its sign.
fn signed(difference: Option<&Estimate>, decimals: usize) -> String {
    difference.map_or_else(nothing, |one| format!("{:+.decimals$} ({})", one.mean, span(one.interval, decimals)))
}

/// Two shares side by side; nothing if neither is known.
fn both(one: Option<f64>, other: Option<f64>) -> String {
    if one.or(other).is_none() { nothing() } else { format!("{}, {}", percent(one), percent(other)) }
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
