//! Figures of every planner, by family and style.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::path::Path;
use std::sync::Arc;

use rayon::prelude::*;
use serde::Serialize;

use super::building::BuildingFigures;
use super::estimate::{Estimate, Quantiles, Share};
use super::pairs::{PairedDifference, correct};
use super::records::{Conditions, Records, RunRecord};
use crate::error::SweepError;

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
    /// Whether there are vehicles in any run.
    pub has_vehicles: bool,
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
    /// Runs in which the ego went before another in a conflict zone.
    pub others_yield: Share,
    /// Runs in which the order is that of the scenario's file and nobody touched anybody, of those whose file states one.
    pub order_kept: Share,
    /// Runs in which the ego never did its task, though nobody touched anybody.
    pub deadlocks: usize,
    /// Runs in which the ego touched somebody.
    pub contacts: usize,
    /// Those of them in which it moved towards the other at least as fast as the other towards it.
    pub contacts_by_ego: usize,
    /// Runs in which anybody touched anybody.
    pub touched: usize,
    /// Runs in which the ego braked hard: with at least 75 % of its strongest braking.
    pub hard_braking: Share,
    /// Runs in which another vehicle did.
    pub others_hard_braking: Share,
    /// Runs in which the ego left the road: by more than 3 % of its width.
    pub off_road: Share,
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
    /// What became of the building; none without one.
    pub building: Option<BuildingFigures>,
    /// What is different from the baseline under the same conditions; none for the baseline itself.
    pub versus_baseline: Option<PairedDifference>,
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

/// The name of the driver that a scenario's file states.
const AS_WRITTEN: &str = "as-written";

/// Compares the planners in the rows of a folder or file. Without a `baseline`, they are compared with `as-written` if that is
/// there, otherwise with the first by name.
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
            let known = interplay_common::spelling::suggestion(stated, "there are", &planners);
            return Err(SweepError::Input(format!("no run has the planner `{stated}`; {known}")));
        }
        None if planners.contains(&AS_WRITTEN) => AS_WRITTEN.to_owned(),
        None => planners.first().copied().unwrap_or_default().to_owned(),
    };
    let groups = grouped(&all, by);
    let mut groups: Vec<GroupFigures> = groups
        .into_par_iter()
        .enumerate()
        .map(|(index, ((family, style), records))| {
            let planners = planner_figures(&records, &baseline, (index as u64) << 16);
            let has_vehicles = records.iter().any(|record| record.has_vehicles);
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
    leave_out_those_of_some_scenarios(&mut by_planner);
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

/// Leaves out planners that were run in some of the scenarios only, such as counterfactuals of one of them, where others were run in
/// all: their means would be those of other encounters.
fn leave_out_those_of_some_scenarios(by_planner: &mut BTreeMap<&str, Vec<&RunRecord>>) {
    let count =
        |records: &[&RunRecord]| records.iter().map(|record| &*record.scenario).collect::<BTreeSet<&str>>().len();
    let counts: BTreeMap<&str, usize> =
        by_planner.iter().map(|(planner, records)| (*planner, count(records))).collect();
    let most = counts.values().copied().max().unwrap_or_default();
    by_planner.retain(|planner, _| counts.get(planner) == Some(&most));
}

fn figures_of(planner: &str, records: &[&RunRecord], stream: u64) -> PlannerFigures {
    let finished: Vec<&RunRecord> = records.iter().copied().filter(|record| record.is_finished()).collect();
    let count = |is: fn(&RunRecord) -> bool| finished.iter().filter(|record| is(record)).count();
    let numbers =
        |of: fn(&RunRecord) -> Option<f64>| -> Vec<f64> { finished.iter().filter_map(|one| of(one)).collect() };
    let median = |of: fn(&RunRecord) -> Option<f64>| Quantiles::of(numbers(of)).map(|quantiles| quantiles.median);
    let times_s = numbers(|record| record.completed_s.filter(|_| record.success));
    PlannerFigures {
        planner: planner.to_owned(),
        runs: finished.len(),
        unfinished: records.len() - finished.len(),
        success: Share::of(&finished, |record| Some(record.success)),
        completed_s: Estimate::of(&times_s, stream),
        first: Share::of(&finished, |record| Some(record.place == Some(1))),
        yields: Share::of(&finished, |record| Some(record.yields)),
        others_yield: Share::of(&finished, |record| record.others_yield),
        order_kept: Share::of(&finished, |record| record.is_order_kept),
        deadlocks: count(|record| record.is_deadlock),
        contacts: count(|record| record.has_contact),
        contacts_by_ego: count(|record| record.has_contact_by_ego),
        touched: count(|record| record.has_any_contact),
        hard_braking: Share::of(&finished, |record| record.brakes_hard),
        others_hard_braking: Share::of(&finished, |record| record.others_brake_hard),
        off_road: Share::of(&finished, |record| record.leaves_road),
        gap_m: Quantiles::of(numbers(|record| record.gap_m)),
        time_to_collision_s: Quantiles::of(numbers(|record| record.time_to_collision_s)),
        plans_failed: finished.iter().map(|record| record.plans_failed).sum(),
        plan_median_ms: median(|record| record.plan_median_ms),
        plan_p99_ms: median(|record| record.plan_p99_ms),
        building: BuildingFigures::of(&finished, stream),
        versus_baseline: None,
    }
}
