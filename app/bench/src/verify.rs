//! Whether an entry holds what it claims.

use interplay_scenarios::{ENCOUNTER_VERSION, Encounter, Registry};
use rayon::prelude::*;

use crate::entry::{BenchEntry, EntryRun, mean_score};
use crate::error::BenchError;
use crate::people::PEOPLE;
use crate::planner::PlannerSpec;
use crate::score::StartScore;
use crate::start::Start;

/// What was checked of an entry that holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Verified {
    /// Number of runs of the entry.
    pub runs: usize,
    /// Number of runs that were driven or replayed again.
    pub repeated: usize,
}

/// Checks that an entry is of this version and whole, that its scores follow from their parts, and that runs repeat bit for bit: recorded
/// inputs are replayed; of kinds of this program, every `every`-th run is driven again, beginning with the first.
///
/// # Errors
/// [`BenchError::Refused`] says what does not hold.
pub fn verify(
    registry: &Registry,
    entry: &BenchEntry,
    every: usize,
    advance: &(dyn Fn() + Sync),
) -> Result<Verified, BenchError> {
    check_content(entry)?;
    let again = |run: &&EntryRun| -> Result<(), BenchError> {
        let outcome = repeated(registry, entry, run);
        advance();
        outcome
    };
    let every = every.max(1);
    let selected: Vec<&EntryRun> = entry.runs.iter().step_by(every).collect();
    selected.par_iter().with_max_len(1).map(again).collect::<Result<(), _>>()?;
    Ok(Verified { runs: entry.runs.len(), repeated: selected.len() })
}

fn refused<T>(reason: String) -> Result<T, BenchError> {
    Err(BenchError::Refused(reason))
}

/// What can be checked without a run.
fn check_content(entry: &BenchEntry) -> Result<(), BenchError> {
    if entry.set != ENCOUNTER_VERSION || entry.people != PEOPLE.trim() {
        let [theirs, ours] = [&entry.set, &entry.people].map(String::as_str).map(short);
        return refused(format!(
            "it is of {theirs} with people {ours}, and this program has {ENCOUNTER_VERSION} with people {}; scores of other \
             versions do not compare",
            short(PEOPLE.trim())
        ));
    }
    let expected: Vec<String> = entry.selection.encounters()?.iter().map(Encounter::to_string).collect();
    let found: Vec<&str> = entry.runs.iter().map(|run| run.id.as_str()).collect();
    if let Some(missing) = expected.iter().find(|id| !found.contains(&id.as_str())) {
        return refused(format!("the run of {missing} was left out"));
    }
    if expected != found {
        return refused("its runs are not those of its selection, in order".to_owned());
    }
    for run in &entry.runs {
        let StartScore { g, p, c, k, .. } = run.score;
        if StartScore::of_parts([g, p, c, k]) != run.score {
            return refused(format!("the score of {} does not follow from its parts", run.id));
        }
    }
    if mean_score(&entry.runs) != entry.score {
        return refused(format!("its score is {}, and its runs give {}", entry.score, mean_score(&entry.runs)));
    }
    if entry.seal != entry.sealed() {
        return refused("its content was changed after it was sealed".to_owned());
    }
    Ok(())
}

fn short(digest: &str) -> &str {
    digest.get(..digest.len().min(20)).unwrap_or(digest)
}

/// Drives or replays a run again and compares it.
fn repeated(registry: &Registry, entry: &BenchEntry, run: &EntryRun) -> Result<(), BenchError> {
    let Some(encounter) = Encounter::named(&run.id) else { return refused(format!("no start is called {}", run.id)) };
    let planner = match (&entry.planner, &run.inputs) {
        (_, Some(inputs)) => PlannerSpec::Inputs(inputs.clone()),
        (PlannerSpec::Kind { .. }, None) => entry.planner.clone(),
        _ => return refused(format!("{} has no inputs to replay", run.id)),
    };
    let start = Start::new(registry, encounter)?;
    let again = EntryRun::new(&start, start.drive(registry, &planner)?);
    if again.digest != run.digest {
        return refused(format!("{} has the digest {}, and gives {} here", run.id, run.digest, again.digest));
    }
    if (&again.score, again.delay_s, again.completed_s) != (&run.score, run.delay_s, run.completed_s) {
        return refused(format!("{} has the score {}, and gives {} here", run.id, run.score.score, again.score.score));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::checks::with_checks;
    use crate::entry::{Selection, run_entry};

    /// The seal of a changed entry can be made anew; the change is found when the run is repeated.
    #[test]
    fn a_changed_digit_under_a_new_seal_is_found_by_repeating_the_run() {
        let registry = with_checks(Registry::standard()).expect("free words");
        let planner = PlannerSpec::Kind { kind: "constant-velocity".to_owned(), settings: Vec::new() };
        let encounter = Some("crossing-equal".to_owned());
        let selection = Selection { split: "dev".to_owned(), encounter, starts: Some([1, 1]), shard: None };
        let entries = run_entry(&registry, &[("kept".to_owned(), planner)], &selection, &|| ()).expect("runs");
        let mut entry = entries.into_iter().next().expect("one");
        let digit = if entry.runs[0].digest.starts_with('0') { "1" } else { "0" };
        entry.runs[0].digest.replace_range(..1, digit);
        entry.seal = entry.sealed();
        let error = verify(&registry, &entry, 1, &|| ()).expect_err("it was changed").to_string();
        assert!(error.contains("has the digest"), "{error}");
    }
}
