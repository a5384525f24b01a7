//! Collects the faults of the runs of a plan, each fault once.

use std::collections::{BTreeMap, BTreeSet};

use super::assignment::Assignment;
use super::plan::{Indices, OtherValue, SweepPlan, SweepPoint};
use crate::model::scenario::Scenario;
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

impl SweepPlan {
    /// The scenario of a run.
    ///
    /// # Errors
    /// Its faults, located in the plan.
    pub fn scenario(&self, point: &SweepPoint) -> Result<Scenario, LoadError> {
        let assignments = self.assignments(&point.place, None);
        self.assembled(&point.place, &assignments).map_err(|faults| {
            let blamed = faults.iter().map(|fault| self.blamed(&point.place, &faults, fault)).collect();
            LoadError::of_plan(&self.name, blamed)
        })
    }

    /// A fault of a run, located at the change that causes it, with the run in which it shows. `faults` are all of the run.
    pub(super) fn blamed(&self, place: &Indices, faults: &[Fault], fault: &Fault) -> Fault {
        let assignments = self.assignments(place, None);
        let culprit = self.culprit(place, &assignments, faults, fault);
        self.located(fault, place, &assignments, culprit, Some(place.cell * self.samples + place.draw))
    }

    /// The same, unless the change differs from run to run; a path that does not exist is wrong in all runs.
    pub(super) fn blamed_on_what_is_fixed(&self, place: &Indices, faults: &[Fault], fault: &Fault) -> Option<Fault> {
        let assignments = self.assignments(place, None);
        let culprit = self.culprit(place, &assignments, faults, fault);
        let is_laid = self.laid(place, &assignments).is_ok();
        let differs = |one: &Assignment<'_>| {
            (one.is_varied && is_laid && one.has_known_path(self.registry.complete())) || self.is_jitter(one)
        };
        (!culprit.is_some_and(|index| differs(&assignments[index])))
            .then(|| self.located(fault, place, &assignments, culprit, None))
    }

    /// Whether a change is the plan's own random change of the starts.
    fn is_jitter(&self, assignment: &Assignment<'_>) -> bool {
        self.jitter_place.as_ref().is_some_and(|jitter| assignment.is_written_at(jitter))
    }

    /// A fault of a run that is sound as written, but not for another value of one of its factors.
    pub(super) fn blamed_on_value(&self, place: &Indices, instead: &OtherValue, fault: &Fault) -> Fault {
        let assignments = self.assignments(place, Some(instead));
        let culprit =
            assignments.len().checked_sub(self.factors(place.style).count()).map(|fixed| fixed + instead.factor);
        self.located(fault, place, &assignments, culprit, None)
    }

    /// A change without which the scenario of the run is sound; or else without which it only has the other faults; or else the
    /// first with which it has the fault.
    ///
    /// Of several candidates it is one that varies, if any does, since its other values are sound; of these the one where the fault is
    /// located, or else the last, since all before it are sound without it. The value of the first run may replace a value that
    /// varies: a plan whose first run has a fault is not run at all.
    fn culprit(
        &self,
        place: &Indices,
        assignments: &[Assignment<'_>],
        faults: &[Fault],
        fault: &Fault,
    ) -> Option<usize> {
        let first = self.assignments(&Indices { cell: 0, draw: 0, ..*place }, None);
        let without = |index: usize| {
            let others = || assignments.iter().enumerate().filter(move |(other, _)| *other != index);
            let left = messages(self.assembled(place, others().map(|(_, one)| one)));
            if left.is_empty() || !assignments[index].is_varied {
                return left;
            }
            let of_first = assignments.iter().zip(&first).enumerate();
            let of_first = of_first.map(|(other, (own, first))| if other == index { first } else { own });
            let left_with_first = messages(self.assembled(place, of_first));
            if left_with_first.is_empty() { left_with_first } else { left }
        };
        let all: BTreeSet<&str> = faults.iter().map(Fault::message).collect();
        let left: Vec<BTreeSet<String>> = (0..assignments.len()).map(without).collect();
        let has_others_only = |left: &BTreeSet<String>| {
            !left.contains(fault.message()) && left.iter().all(|message| all.contains(message.as_str()))
        };
        let begins = || {
            (0..assignments.len())
                .find(|index| messages(self.assembled(place, &assignments[..=*index])).contains(fault.message()))
        };
        let chosen = |is_cause: &dyn Fn(&BTreeSet<String>) -> bool| {
            let is_there = |index: usize| fault.place().is_some_and(|place| assignments[index].is_written_at(place));
            let causes = (0..left.len()).filter(|index| is_cause(&left[*index]));
            causes.max_by_key(|index| (assignments[*index].is_varied, is_there(*index), *index))
        };
        chosen(&BTreeSet::is_empty).or_else(|| chosen(&has_others_only)).or_else(begins)
    }

    /// A fault at the culprit, unless its place is already within the culprit's text.
    fn located(
        &self,
        fault: &Fault,
        place: &Indices,
        assignments: &[Assignment<'_>],
        culprit: Option<usize>,
        sample: Option<u64>,
    ) -> Fault {
        let scenario = &self.scenarios[place.scenario].named.name;
        let (style, planner) = (&self.styles[place.style].name, &self.planner(place).name);
        let run = format!("in the runs of `{scenario}` with the style `{style}` and the planner `{planner}`");
        let Some(culprit) = culprit.map(|index| &assignments[index]) else { return fault.clone().within(&run) };
        let is_there = fault.place().is_some_and(|place| culprit.is_written_at(place));
        let fault = if is_there { fault.clone() } else { fault.clone().moved_to(culprit.place()) };
        let is_jitter = self.is_jitter(culprit);
        if !culprit.is_varied && !is_jitter {
            return fault.within(&run);
        }
        let varied = assignments.iter().filter(|one| one.is_varied).map(Assignment::written);
        let sample = sample.map(|sample| format!("sample {sample}"));
        let seed = is_jitter.then(|| format!("`seed = {}`", self.seed + place.draw));
        let values: Vec<String> = varied.chain(seed).chain(sample).collect();
        fault.within(&format!("{run}, with {}", values.join(", ")))
    }
}

fn messages(outcome: Result<Scenario, Vec<Fault>>) -> BTreeSet<String> {
    outcome.err().into_iter().flatten().map(|fault| fault.message().to_owned()).collect()
}
