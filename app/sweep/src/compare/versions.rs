//! Differences between two sweeps of one plan, made by two versions of the program or of a planner.

use std::collections::{BTreeMap, HashMap};
use std::path::Path;

use interplay_scenarios::RegisteredMetrics;
use rayon::prelude::*;
use serde::Serialize;

use super::compared::ComparedColumns;
use super::pairs::{PairedDifference, correct};
use super::records::{Conditions, Records, RunRecord};
use crate::error::SweepError;

/// Differences of the second folder from the first.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct VersionComparison {
    /// The versions of the program, of the first folder and of the second.
    pub versions: [Vec<String>; 2],
    /// Number of rows without a pair, in the first folder and in the second.
    pub unpaired: [usize; 2],
    /// Number of pairs of runs.
    pub pairs: usize,
    /// Number of pairs that differ in any bit of any state.
    pub changed: usize,
    /// Whether there are vehicles in any run.
    pub has_vehicles: bool,
    /// Each family, style and planner.
    pub groups: Vec<VersionGroup>,
}

/// Runs of one planner under the same conditions.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct VersionGroup {
    /// The family.
    pub family: String,
    /// The drivers of the other vehicles.
    pub style: String,
    /// The planner.
    pub planner: String,
    /// Number of pairs that differ in any bit of any state.
    pub changed: usize,
    /// The second folder relative to the first: wins are those of the second.
    pub difference: PairedDifference,
}

/// Compares the rows of two folders or files: pairs have the same scenario, style, planner, sample and seed. `registered` metrics are compared, too.
///
/// # Errors
/// If a file cannot be read or is not a table of runs, or if no runs form a pair.
pub fn compare_versions(
    first: &Path,
    second: &Path,
    registered: &RegisteredMetrics,
) -> Result<VersionComparison, SweepError> {
    let compared = ComparedColumns::new(registered);
    let read = |path| Records::read(path, compared.columns());
    let [before, after] = [read(first)?, read(second)?];
    type Key<'a> = (Conditions, &'a str);
    let known: HashMap<Key<'_>, &RunRecord> =
        before.all.iter().map(|record| ((record.conditions(), &*record.planner), record)).collect();
    let mut groups: BTreeMap<[&str; 3], Vec<(&RunRecord, &RunRecord)>> = BTreeMap::new();
    let mut pairs = 0;
    for record in &after.all {
        if let Some(other) = known.get(&(record.conditions(), &*record.planner)) {
            pairs += 1;
            groups.entry([&record.family, &record.style, &record.planner]).or_default().push((record, other));
        }
    }
    if pairs == 0 {
        let [one, other] = [first, second].map(|path| path.display());
        return Err(SweepError::Input(format!(
            "no run of `{other}` has a pair in `{one}`: they are of different plans"
        )));
    }
    let groups: Vec<([&str; 3], Vec<_>)> = groups.into_iter().collect();
    let mut groups: Vec<VersionGroup> = groups
        .par_iter()
        .enumerate()
        .map(|(index, ([family, style, planner], pairs))| VersionGroup {
            family: (*family).to_owned(),
            style: (*style).to_owned(),
            planner: (*planner).to_owned(),
            changed: pairs.iter().filter(|(one, other)| one.digest != other.digest).count(),
            difference: PairedDifference::of(pairs, &compared, index as u64),
        })
        .collect();
    let mut differences: Vec<&mut PairedDifference> = groups.iter_mut().map(|group| &mut group.difference).collect();
    correct(&mut differences);
    Ok(VersionComparison {
        versions: [before.versions, after.versions],
        unpaired: [before.all.len() - pairs, after.all.len() - pairs],
        pairs,
        has_vehicles: after.all.iter().any(|record| record.has_vehicles()),
        changed: groups.iter().map(|group| group.changed).sum(),
        groups,
    })
}
