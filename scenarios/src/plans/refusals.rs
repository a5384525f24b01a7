//! Collects the faults of the runs of a plan, each fault once.

use std::collections::BTreeMap;

use super::assignment::Assignment;
use super::plan::{Indices, OtherValue, SweepPlan, SweepPoint};
use crate::text::error::{Fault, LoadError};

/// The most values of a list that are checked as extremes; every value that is run is also checked.
const MAX_LISTED: usize = 100;

/// The faults of some runs of a plan. Each fault is stored once, with its first run and the number of runs that have it.
///
/// Faults of several runs count as the same if their texts are equal except for numbers.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RunRefusals(BTreeMap<FaultKey, Count>);

/// The place of a fault in the plan, as line and column, and its words without numbers.
type FaultKey = (Option<(usize, usize)>, String);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Count {
    first_run: u64,
    runs: u64,
}

impl RunRefusals {
    /// Whether there are no faults.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Combines the faults of two disjoint sets of runs.
    #[must_use]
    pub fn and(mut self, other: RunRefusals) -> RunRefusals {
        for (key, count) in other.0 {
            let own = self.0.entry(key).or_insert(Count { first_run: count.first_run, runs: 0 });
            *own = Count { first_run: own.first_run.min(count.first_run), runs: own.runs + count.runs };
        }
        self
    }
}

impl SweepPlan {
    /// Checks a run.
    ///
    /// # Errors
    /// Its faults.
    pub fn check(&self, point: &SweepPoint) -> Result<(), RunRefusals> {
        let outcome = self.assembled(&point.place, &self.assignments(&point.place, None));
        let count = Count { first_run: point.index, runs: 1 };
        let keyed = |faults: Vec<Fault>| faults.iter().map(|fault| (self.key_of(fault), count)).collect();
        outcome.map(|_| ()).map_err(|faults| RunRefusals(keyed(faults)))
    }

    /// The error for the faults of runs of the plan, each located in the plan, with its first run.
    pub fn refusal(&self, refusals: &RunRefusals) -> LoadError {
        let mut found = Vec::new();
        for (key, count) in &refusals.0 {
            let place = self.point(count.first_run).place;
            let faults = self.assembled(&place, &self.assignments(&place, None)).err().unwrap_or_default();
            let Some(fault) = faults.iter().find(|fault| self.key_of(fault) == *key) else { continue };
            let blamed = self.blamed(&place, &faults, fault);
            found.push(if count.runs > 1 {
                blamed.ending(&format!("; {} runs have this error", count.runs))
            } else {
                blamed
            });
        }
        LoadError::of_plan(&self.name, found)
    }

    /// The faults of the plan's arms, of the extreme values, and of the number of samples. The check
    /// stops at the first combination of scenario, style and planner with a fault.
    ///
    /// Faults caused by a value that differs from run to run, or by the change of the starts, that show in the first run are left to
    /// the check of all runs, which counts those that have it.
    pub(super) fn check_extremes(&self) -> Vec<Fault> {
        for scenario in 0..self.scenarios.len() {
            for style in 0..self.styles.len() {
                for planner in 0..self.planner_count(scenario) as usize {
                    let faults = self.extremes_of(&Indices { scenario, style, planner, cell: 0, draw: 0 });
                    if !faults.is_empty() {
                        return faults;
                    }
                }
            }
        }
        Vec::new()
    }

    /// The same for one combination, each fault once.
    fn extremes_of(&self, place: &Indices) -> Vec<Fault> {
        match self.assembled(place, &self.assignments(place, None)) {
            Err(faults) => {
                return faults.iter().filter_map(|fault| self.blamed_on_what_is_fixed(place, &faults, fault)).collect();
            }
            Ok(scenario) => {
                if let Some(fault) = self.equal_samples(place, None, &scenario) {
                    return vec![fault];
                }
            }
        }
        let mut found: BTreeMap<FaultKey, Fault> = BTreeMap::new();
        for (index, factor) in self.factors(place.style).enumerate() {
            for value in factor.extremes(MAX_LISTED) {
                let instead = OtherValue { factor: index, value };
                let mut refused = |blamed: Fault, message: &str| {
                    found.entry((blamed.line_and_column(), without_numbers(message))).or_insert(blamed);
                };
                match self.assembled(place, &self.assignments(place, Some(&instead))) {
                    Ok(scenario) => {
                        let value = Assignment::varied(&factor.path, instead.value.clone());
                        if let Some(fault) = self.equal_samples(place, Some(&value), &scenario) {
                            refused(fault, "");
                        }
                    }
                    Err(faults) => {
                        for fault in &faults {
                            refused(self.blamed_on_value(place, &instead, fault), fault.message());
                        }
                    }
                }
            }
        }
        found.into_values().collect()
    }

    fn key_of(&self, fault: &Fault) -> FaultKey {
        let is_in_plan = fault.file() == Some(&self.name);
        (fault.line_and_column().filter(|_| is_in_plan), without_numbers(fault.message()))
    }
}

fn without_numbers(message: &str) -> String {
    let is_number = |word: &&str| word.trim_matches(|letter| "`(),;:".contains(letter)).parse::<f64>().is_ok();
    message.split(' ').filter(|word| !is_number(word)).collect::<Vec<_>>().join(" ")
}
