//! Figures of every planner, by family and style.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::path::Path;
use std::sync::Arc;

use interplay_scenarios::{RegisteredMetrics, first_planner};
use rayon::prelude::*;
use serde::{Serialize, Serializer};

use super::building::BuildingFigures;
use super::compared::{ComparedColumns, FigureColumn, FigureKind};
use super::estimate::{Estimate, Quantiles, Share};
use super::pairs::{PairedDifference, correct};
use super::records::{Conditions, Records, RunRecord};
use crate::error::SweepError;
use crate::sweep::PLAN_FILE;

/// Comparison of the planners from the rows of a folder.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Comparison {
    /// Number of rows.
    pub runs: usize,
    /// Number of rows without a result.
    pub unfinished: usize,
    /// The versions of the program that made them.
    pub versions: Vec<String>,
    /// The planner with which the others are compared.
    pub baseline: String,
    /// The groups: each family or scenario with each style, then all of them with each style, then all.
    pub groups: Vec<GroupFigures>,
}

/// The planners under the same conditions.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct GroupFigures {
    /// The family or scenario; none for all.
    pub family: Option<String>,
    /// The drivers of the other vehicles; none for all.
    pub style: Option<String>,
    /// Whether there are vehicles in any run.
    pub has_vehicles: bool,
    /// Each planner.
    pub planners: Vec<PlannerFigures>,
}

/// The figures of a planner over its runs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PlannerFigures {
    /// Its name.
    pub planner: String,
    /// Number of runs with a result.
    pub runs: usize,
    /// Number of runs without a result.
    pub unfinished: usize,
    /// Its figures by key: shares, counts, means and quantiles over the rows.
    #[serde(flatten)]
    pub figures: Figures,
    /// Results for the building; none without one.
    pub building: Option<BuildingFigures>,
    /// Differences from the baseline under the same conditions; none for the baseline itself.
    pub versus_baseline: Option<PairedDifference>,
}

/// Figures in the order in which they are listed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Figures(pub Vec<NamedFigure>);

/// A figure with its title.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedFigure {
    /// Its key.
    pub key: String,
    /// Its name, in words with the unit.
    pub title: String,
    /// The figure.
    pub figure: Figure,
}

/// An aggregate of the values of many runs; `None` if no run has a value.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Figure {
    /// Share of the runs in which a flag is set, among those where it is known.
    Share(Share),
    /// A number of runs, or a sum of counts.
    Count(u64),
    /// A mean.
    Mean(Option<Estimate>),
    /// Quantiles.
    Quantiles(Option<Quantiles>),
    /// A median.
    Median(Option<f64>),
}

impl Figures {
    /// The figure with this key.
    pub fn get(&self, key: &str) -> Option<&Figure> {
        self.0.iter().find(|named| named.key == key).map(|named| &named.figure)
    }

    /// The figure with this key as a share; `None` if it is not a share.
    pub fn share(&self, key: &str) -> Option<&Share> {
        if let Some(Figure::Share(share)) = self.get(key) { Some(share) } else { None }
    }

    /// The figure with this key as a count; 0 if it is not a count.
    pub fn count(&self, key: &str) -> u64 {
        if let Some(Figure::Count(count)) = self.get(key) { *count } else { 0 }
    }

    /// The figure with this key as a mean; `None` if it is not a mean, or if no run has a value.
    pub fn mean(&self, key: &str) -> Option<&Estimate> {
        if let Some(Figure::Mean(mean)) = self.get(key) { mean.as_ref() } else { None }
    }

    /// The figure with this key as quantiles; `None` if it is not quantiles, or if no run has a value.
    pub fn quantiles(&self, key: &str) -> Option<&Quantiles> {
        if let Some(Figure::Quantiles(quantiles)) = self.get(key) { quantiles.as_ref() } else { None }
    }

    /// The figure with this key as a median; `None` if it is not a median, or if no run has a value.
    pub fn median(&self, key: &str) -> Option<f64> {
        if let Some(Figure::Median(median)) = self.get(key) { *median } else { None }
    }
}

impl Serialize for Figures {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|named| (&named.key, &named.figure)))
    }
}

/// The grouping of rows, in addition to the style.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GroupBy {
    /// The family of the scenario.
    #[default]
    Family,
    /// The scenario itself.
    Scenario,
}

/// The index of the time to the goal in the list of compared columns.
const TIME_TO_GOAL: usize = 1;
/// First random stream of the intervals of means of metrics.
const FIRST_STREAM: u64 = 1 << 56;
/// Maximum number of figures of a planner with a random stream of their own.
const MAX_FIGURES: u64 = 1 << 12;

/// The name of the driver that a scenario's file states.
const AS_WRITTEN: &str = "as-written";

/// Compares the planners in the rows of a folder or file. Without a `baseline`, they are compared with the first planner of the plan in
/// the folder, otherwise with `as-written` if that is there, otherwise with the first by name. `registered` metrics are compared, too.
///
/// # Errors
/// If a file cannot be read or is not a table of runs, or if the baseline has no row.
pub fn compare(
    path: &Path,
    baseline: Option<&str>,
    by: GroupBy,
    registered: &RegisteredMetrics,
) -> Result<Comparison, SweepError> {
    let compared = ComparedColumns::new(registered);
    let Records { all, versions } = Records::read(path, compared.columns())?;
    let mut planners: Vec<&str> = all.iter().map(|record| &*record.planner).collect();
    planners.sort_unstable();
    planners.dedup();
    let baseline = match baseline {
        Some(stated) if planners.contains(&stated) => stated.to_owned(),
        Some(stated) => {
            let known = interplay_common::spelling::suggestion(stated, "there are", &planners);
            return Err(SweepError::Input(format!("no run has the planner `{stated}`; {known}")));
        }
        None => {
            let plan = std::fs::read_to_string(path.join(PLAN_FILE)).ok();
            let first = plan.and_then(|plan| first_planner(&plan)).filter(|first| planners.contains(&&**first));
            let written = || planners.contains(&AS_WRITTEN).then(|| AS_WRITTEN.to_owned());
            first.or_else(written).unwrap_or_else(|| planners.first().copied().unwrap_or_default().to_owned())
        }
    };
    let groups = grouped(&all, by);
    let mut groups: Vec<GroupFigures> = groups
        .into_par_iter()
        .enumerate()
        .map(|(index, ((family, style), records))| {
            let planners = planner_figures(&records, &baseline, &compared, (index as u64) << 16);
            let has_vehicles = records.iter().any(|record| record.has_vehicles());
            GroupFigures { family: family.map(String::from), style: style.map(String::from), has_vehicles, planners }
        })
        .collect();
    let figures = groups.iter_mut().flat_map(|group| &mut group.planners);
    let mut differences: Vec<&mut PairedDifference> =
        figures.filter_map(|planner| planner.versus_baseline.as_mut()).collect();
    correct(&mut differences);
    let unfinished = all.iter().filter(|record| !record.is_finished()).count();
    Ok(Comparison { runs: all.len(), unfinished, versions, baseline, groups })
}

/// A group: its family or scenario, and its style; none for all.
type GroupName<'a> = (Option<&'a str>, Option<&'a str>);

/// The groups: after those of each family, one for each style over all families, and one for all rows. Groups with the same rows are
/// listed once.
fn grouped(all: &[RunRecord], by: GroupBy) -> Vec<(GroupName<'_>, Vec<&RunRecord>)> {
    let mut groups: BTreeMap<(u8, GroupName<'_>), Vec<&RunRecord>> = BTreeMap::new();
    let family = |record: &'_ RunRecord| match by {
        GroupBy::Family => Arc::clone(&record.family),
        GroupBy::Scenario => Arc::clone(&record.scenario),
    };
    let [mut families, mut styles] =
        [all.iter().map(family).collect::<Vec<_>>(), all.iter().map(|one| Arc::clone(&one.style)).collect()];
    for names in [&mut families, &mut styles] {
        names.sort_unstable();
        names.dedup();
    }
    for record in all {
        let own: &str = match by {
            GroupBy::Family => &record.family,
            GroupBy::Scenario => &record.scenario,
        };
        let style: &str = &record.style;
        groups.entry((0, (Some(own), Some(style)))).or_default().push(record);
        if families.len() > 1 {
            groups.entry((1, (None, Some(style)))).or_default().push(record);
        }
        if styles.len() > 1 {
            groups.entry((2, (None, None))).or_default().push(record);
        }
    }
    groups.into_iter().map(|((_, name), records)| (name, records)).collect()
}

fn planner_figures(
    records: &[&RunRecord],
    baseline: &str,
    compared: &ComparedColumns,
    stream: u64,
) -> Vec<PlannerFigures> {
    let mut by_planner: BTreeMap<&str, Vec<&RunRecord>> = BTreeMap::new();
    for record in records {
        by_planner.entry(&record.planner).or_default().push(record);
    }
    leave_out_those_of_some_scenarios(&mut by_planner);
    let base: HashMap<Conditions, &RunRecord> =
        by_planner.get(baseline).into_iter().flatten().map(|record| (record.conditions(), *record)).collect();
    let figures = by_planner.iter().enumerate().map(|(index, (planner, records))| {
        // Each planner has two intervals.
        let stream = stream + 2 * index as u64;
        let pairs = || -> Vec<(&RunRecord, &RunRecord)> {
            records.iter().filter_map(|record| Some((*record, *base.get(&record.conditions())?))).collect()
        };
        let versus_baseline = (*planner != baseline).then(|| PairedDifference::of(&pairs(), compared, stream + 1));
        PlannerFigures { versus_baseline, ..figures_of(planner, records, compared, stream) }
    });
    figures.collect()
}

/// Leaves out planners that ran only in some of the scenarios, such as counterfactuals of one of them, if others ran in all: their
/// means would be over different encounters.
fn leave_out_those_of_some_scenarios(by_planner: &mut BTreeMap<&str, Vec<&RunRecord>>) {
    let count =
        |records: &[&RunRecord]| records.iter().map(|record| &*record.scenario).collect::<BTreeSet<&str>>().len();
    let counts: BTreeMap<&str, usize> =
        by_planner.iter().map(|(planner, records)| (*planner, count(records))).collect();
    let most = counts.values().copied().max().unwrap_or_default();
    by_planner.retain(|planner, _| counts.get(planner) == Some(&most));
}

fn figures_of(planner: &str, records: &[&RunRecord], compared: &ComparedColumns, stream: u64) -> PlannerFigures {
    let finished: Vec<&RunRecord> = records.iter().copied().filter(|record| record.is_finished()).collect();
    let figures = compared.figures.iter().enumerate().map(|(index, column)| NamedFigure {
        key: column.key.clone(),
        title: column.title.clone(),
        figure: figure(column, &finished, stream_of(index, stream)),
    });
    PlannerFigures {
        planner: planner.to_owned(),
        runs: finished.len(),
        unfinished: records.len() - finished.len(),
        figures: Figures(figures.collect()),
        building: BuildingFigures::of(&finished, stream),
        versus_baseline: None,
    }
}

/// The random stream of a mean's interval: the planner's own for the time to the goal, and one each from [`FIRST_STREAM`] on for others.
fn stream_of(index: usize, stream: u64) -> u64 {
    if index == TIME_TO_GOAL { stream } else { FIRST_STREAM + MAX_FIGURES * stream + index as u64 }
}

/// A figure of several runs; `stream` separates the random draws of intervals.
fn figure(column: &FigureColumn, records: &[&RunRecord], stream: u64) -> Figure {
    let values = column.values(records);
    match column.how {
        FigureKind::Share => Figure::Share(Share::of(&values)),
        FigureKind::Runs => Figure::Count(values.iter().filter(|value| **value != 0.0).count() as u64),
        FigureKind::Sum => Figure::Count(values.iter().sum::<f64>() as u64),
        FigureKind::Mean => Figure::Mean(Estimate::of(&values, stream)),
        FigureKind::Quantiles => Figure::Quantiles(Quantiles::of(values)),
        FigureKind::Median => Figure::Median(Quantiles::of(values).map(|quantiles| quantiles.median)),
    }
}
