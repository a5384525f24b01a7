//! Figures of every planner, by family and style.

use std::collections::{BTreeMap, HashMap};
use std::path::Path;
use std::sync::Arc;

use rayon::prelude::*;
use serde::Serialize;

use super::pairs::{PairedDifference, correct};
use super::records::{Conditions, Records, RunRecord};
use crate::error::SweepError;
use crate::statistics::{mean_interval, quantile, wilson_interval};

/// What the rows of a folder say of the planners.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Comparison {
    /// How many rows there are.
    pub runs: usize,
    /// How many of them have no result.
    pub unfinished: usize,
    /// The versions of the program that made them.
    pub versions: Vec<String>,
    /// The planner that the others are compared with.
    pub baseline: String,
    /// The groups: each family or scenario with each style, then all of them with each style, then all.
    pub groups: Vec<GroupFigures>,
}

/// The planners under some conditions.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct GroupFigures {
    /// The family or scenario; none for all.
    pub family: Option<String>,
    /// The drivers of the other vehicles; none for all.
    pub style: Option<String>,
    /// Each planner.
    pub planners: Vec<PlannerFigures>,
}

/// What a planner did.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PlannerFigures {
    /// Its name.
    pub planner: String,
    /// How many runs have a result.
    pub runs: usize,
    /// How many have none.
    pub unfinished: usize,
    /// Runs in which the ego did its task and touched nobody.
    pub success: Share,
    /// Time to the goal \[s\], of runs that succeeded.
    pub completed_s: Option<Estimate>,
    /// Runs in which the ego had the first place.
    pub first: Share,
    /// Runs in which another went before the ego in a conflict zone.
    pub yields: Share,
    /// Runs in which the ego never did its task, though nobody touched anybody.
    pub deadlocks: usize,
    /// Runs in which the ego touched somebody.
    pub contacts: usize,
    /// Those of them in which it moved towards the other at least as fast as the other towards it.
    pub contacts_by_ego: usize,
    /// Smallest distance of the ego to another \[m\].
    pub gap_m: Option<Quantiles>,
    /// Shortest time to collision \[s\].
    pub time_to_collision_s: Option<Quantiles>,
    /// Plans that failed.
    pub plans_failed: u64,
    /// Median over the runs of the median time of a plan \[ms\]; not reproducible.
    pub plan_median_ms: Option<f64>,
    /// Median over the runs of the 99th percentile of the times of plans \[ms\]; not reproducible.
    pub plan_p99_ms: Option<f64>,
    /// What is different from the baseline under the same conditions; none for the baseline itself.
    pub versus_baseline: Option<PairedDifference>,
}

/// A share with Wilson's interval at 95 %.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Share {
    /// How many.
    pub count: usize,
    /// Of how many.
    pub of: usize,
    /// Lower and upper bound.
    pub interval: [f64; 2],
}

/// A mean with its bootstrap interval at 95 %.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Estimate {
    /// The mean.
    pub mean: f64,
    /// Lower and upper bound.
    pub interval: [f64; 2],
    /// Of how many numbers.
    pub of: usize,
}

/// Quantiles of a measure over runs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Quantiles {
    /// The smallest.
    pub least: f64,
    /// At 5 %.
    pub p05: f64,
    /// The median.
    pub median: f64,
}

/// What rows are grouped by besides the style.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GroupBy {
    /// The family of the scenario.
    #[default]
    Family,
    /// The scenario itself.
    Scenario,
}

impl Share {
    fn of(records: &[&RunRecord], is: impl Fn(&RunRecord) -> bool) -> Share {
        let (count, of) = (records.iter().filter(|record| is(record)).count(), records.len());
        Share { count, of, interval: wilson_interval(count, of) }
    }

    /// The share itself; none of none.
    pub fn share(&self) -> Option<f64> {
        (self.of > 0).then(|| self.count as f64 / self.of as f64)
    }
}

impl Quantiles {
    fn of(mut numbers: Vec<f64>) -> Option<Quantiles> {
        numbers.sort_by(f64::total_cmp);
        let at = |share| quantile(&numbers, share);
        Some(Quantiles { least: at(0.0)?, p05: at(0.05)?, median: at(0.5)? })
    }
}

/// Compares the planners in the rows of a folder or file. Without a `baseline`, they are compared with the first by name.
///
/// # Errors
/// Files that cannot be read or are no table of runs; a baseline that has no row.
pub fn compare(path: &Path, baseline: Option<&str>, by: GroupBy) -> Result<Comparison, SweepError> {
    let Records { all, versions } = Records::read(path)?;
    let mut planners: Vec<&str> = all.iter().map(|record| &*record.planner).collect();
    planners.sort_unstable();
    planners.dedup();
    let baseline = match baseline {
        Some(stated) if planners.contains(&stated) => stated.to_owned(),
        Some(stated) => {
            let known = interplay_building::nearest::suggestion(stated, "there are", &planners);
            return Err(SweepError::Input(format!("no run has the planner `{stated}`; {known}")));
        }
        None => planners.first().copied().unwrap_or_default().to_owned(),
    };
    let groups = grouped(&all, by);
    let mut groups: Vec<GroupFigures> = groups
        .into_par_iter()
        .enumerate()
        .map(|(index, ((family, style), records))| {
            let planners = planner_figures(&records, &baseline, (index as u64) << 16);
            GroupFigures { family: family.map(String::from), style: style.map(String::from), planners }
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

/// The groups, with all of one style after those of one family, and all of all at the end. Groups that say the same twice are
/// left out.
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

fn planner_figures(records: &[&RunRecord], baseline: &str, stream: u64) -> Vec<PlannerFigures> {
    let mut by_planner: BTreeMap<&str, Vec<&RunRecord>> = BTreeMap::new();
    for record in records {
        by_planner.entry(&record.planner).or_default().push(record);
    }
    let base: HashMap<Conditions, &RunRecord> =
        by_planner.get(baseline).into_iter().flatten().map(|record| (record.conditions(), *record)).collect();
    let figures = by_planner.iter().enumerate().map(|(index, (planner, records))| {
        // Two intervals a planner.
        let stream = stream + 2 * index as u64;
        let pairs = || -> Vec<(&RunRecord, &RunRecord)> {
            records.iter().filter_map(|record| Some((*record, *base.get(&record.conditions())?))).collect()
        };
        let versus_baseline = (*planner != baseline).then(|| PairedDifference::of(&pairs(), stream + 1));
        PlannerFigures { versus_baseline, ..figures_of(planner, records, stream) }
    });
    figures.collect()
}

fn figures_of(planner: &str, records: &[&RunRecord], stream: u64) -> PlannerFigures {
    let finished: Vec<&RunRecord> = records.iter().copied().filter(|record| record.is_finished()).collect();
    let count = |is: fn(&RunRecord) -> bool| finished.iter().filter(|record| is(record)).count();
    let numbers =
        |of: fn(&RunRecord) -> Option<f64>| -> Vec<f64> { finished.iter().filter_map(|one| of(one)).collect() };
    let median = |of: fn(&RunRecord) -> Option<f64>| Quantiles::of(numbers(of)).map(|quantiles| quantiles.median);
    let times_s = numbers(|record| record.completed_s.filter(|_| record.success));
    let completed_s =
        mean_interval(&times_s, stream).map(|(mean, interval)| Estimate { mean, interval, of: times_s.len() });
    PlannerFigures {
        planner: planner.to_owned(),
        runs: finished.len(),
        unfinished: records.len() - finished.len(),
        success: Share::of(&finished, |record| record.success),
        completed_s,
        first: Share::of(&finished, |record| record.place == Some(1)),
        yields: Share::of(&finished, |record| record.yields),
        deadlocks: count(|record| record.is_deadlock),
        contacts: count(|record| record.has_contact),
        contacts_by_ego: count(|record| record.has_contact_by_ego),
        gap_m: Quantiles::of(numbers(|record| record.gap_m)),
        time_to_collision_s: Quantiles::of(numbers(|record| record.time_to_collision_s)),
        plans_failed: finished.iter().map(|record| record.plans_failed).sum(),
        plan_median_ms: median(|record| record.plan_median_ms),
        plan_p99_ms: median(|record| record.plan_p99_ms),
        versus_baseline: None,
    }
}
