//! An entry: what a planner scored on which starts, with all that repeats it.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use interplay_scenarios::{ENCOUNTER_VERSION, Encounter, EncounterSplit, Registry};
use interplay_sweep::{RunKey, Shard, program_version};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::error::BenchError;
use crate::people::PEOPLE;
use crate::planner::{InputRow, PlannerSpec, Wheel};
use crate::score::StartScore;
use crate::start::{Outcome, Start};

/// Which starts of a split.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Selection {
    /// The split: `dev`, `test` or `sealed`.
    pub split: String,
    /// Only this encounter.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub encounter: Option<String>,
    /// Only these numbers of each encounter, the first and the last.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub starts: Option<[u32; 2]>,
    /// Only this shard, such as `3/8`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shard: Option<String>,
}

impl Selection {
    /// The selected starts, encounter by encounter.
    ///
    /// # Errors
    /// [`BenchError::Selection`] if a word is unknown, or nothing is selected.
    pub fn encounters(&self) -> Result<Vec<Encounter>, BenchError> {
        let split: EncounterSplit = self.split.parse().map_err(BenchError::Selection)?;
        if let Some(word) = self.encounter.as_deref().filter(|word| Encounter::kinds().all(|kind| kind != *word)) {
            let known = Encounter::kinds().collect::<Vec<_>>().join(", ");
            return Err(BenchError::Selection(format!("`{word}` is not an encounter; the encounters are {known}")));
        }
        let shard: Shard = match &self.shard {
            Some(text) => {
                text.parse().map_err(|error: interplay_sweep::ShardError| BenchError::Selection(error.to_string()))?
            }
            None => Shard::WHOLE,
        };
        let is_selected = |start: &Encounter| {
            self.encounter.as_deref().is_none_or(|word| word == start.kind())
                && self.starts.is_none_or(|[first, last]| (first..=last).contains(&start.number()))
                && shard.holds(RunKey::of_parts(&[&start.to_string()]))
        };
        let selected: Vec<Encounter> = Encounter::all(split).filter(is_selected).collect();
        if selected.is_empty() {
            let most = split.starts() - 1;
            return Err(BenchError::Selection(format!("{} has the starts 0 to {most}", self.split)));
        }
        Ok(selected)
    }

    /// Whether it is a whole split.
    pub fn is_whole(&self) -> bool {
        self.encounter.is_none() && self.starts.is_none() && self.shard.is_none()
    }
}

/// What a planner did on one start.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EntryRun {
    /// The start.
    pub id: String,
    /// The score with its parts.
    pub score: StartScore,
    /// When the ego reached its goal \[s\].
    pub completed_s: Option<f64>,
    /// When the reference driver does alone \[s\].
    pub alone_s: f64,
    /// The largest delay of another that the ego caused \[s\].
    pub delay_s: f64,
    /// The largest braking of another that the ego caused \[m/s\].
    pub braking_mps: f64,
    /// What made the score 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub failure: Option<String>,
    /// Digest of all states.
    pub digest: String,
    /// Inputs that another program gave; none for kinds of this program.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inputs: Option<Vec<InputRow>>,
    /// Plans of another program that failed, in words.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub failed_plans: Vec<String>,
    /// Wall time of the plans; no part of the score and of the seal \[s\].
    pub planning_s: f64,
}

/// An entry of the benchmark.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BenchEntry {
    /// The name of the planner on the board.
    pub name: String,
    /// The set with its minor version.
    pub set: String,
    /// Digest that pins people, set and formula.
    pub people: String,
    /// The program's version and a digest of its sources.
    pub program: String,
    /// What drove.
    pub planner: PlannerSpec,
    /// The starts.
    pub selection: Selection,
    /// Mean of the means over encounters and families.
    pub score: f64,
    /// Wall time of all plans \[s\].
    pub planning_s: f64,
    /// The runs, in the order of the set.
    pub runs: Vec<EntryRun>,
    /// SHA-256 over everything but wall times.
    pub seal: String,
}

impl EntryRun {
    pub(crate) fn new(start: &Start, outcome: Outcome) -> EntryRun {
        let Outcome { score, ego, delay_s, braking_mps, digest, wheel } = outcome;
        let record = wheel.map(Wheel::into_record);
        EntryRun {
            id: start.id().to_owned(),
            score,
            completed_s: ego.completed_s,
            alone_s: start.alone_s(),
            delay_s,
            braking_mps,
            failure: ego.failure,
            digest,
            failed_plans: record.as_ref().map(|(_, failures)| failures.clone()).unwrap_or_default(),
            inputs: record.map(|(inputs, _)| inputs),
            planning_s: ego.planning_s,
        }
    }

    /// Its cell: encounter and family.
    pub(crate) fn cell(&self) -> Option<(String, &'static str)> {
        let start = Encounter::named(&self.id)?;
        Some((start.kind().to_owned(), start.family().word()))
    }
}

impl BenchEntry {
    fn new(name: &str, planner: &PlannerSpec, selection: &Selection, runs: Vec<EntryRun>) -> BenchEntry {
        let mut entry = BenchEntry {
            name: name.to_owned(),
            set: ENCOUNTER_VERSION.to_owned(),
            people: PEOPLE.trim().to_owned(),
            program: program_version(),
            planner: planner.clone(),
            selection: selection.clone(),
            score: mean_score(&runs),
            planning_s: runs.iter().map(|run| run.planning_s).sum(),
            runs,
            seal: String::new(),
        };
        entry.seal = entry.sealed();
        entry
    }

    /// The seal that the content has.
    pub(crate) fn sealed(&self) -> String {
        let runs = self.runs.iter().map(|run| EntryRun { planning_s: 0.0, ..run.clone() }).collect();
        let content = BenchEntry { planning_s: 0.0, seal: String::new(), runs, ..self.clone() };
        format!("{:x}", Sha256::digest(serde_json::to_vec(&content).unwrap_or_default()))
    }

    /// The entry in a file.
    ///
    /// # Errors
    /// If it cannot be read, or is not an entry.
    pub fn read(path: &Path) -> Result<BenchEntry, BenchError> {
        let text = fs::read_to_string(path).map_err(|reason| BenchError::File { path: path.to_owned(), reason })?;
        let wrong =
            |error: serde_json::Error| BenchError::NotAnEntry { path: path.to_owned(), reason: error.to_string() };
        serde_json::from_str(&text).map_err(wrong)
    }

    /// Writes the entry, a run a line.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), BenchError> {
        let runs: Vec<String> = self.runs.iter().filter_map(|run| serde_json::to_string(run).ok()).collect();
        let head = serde_json::to_string_pretty(&BenchEntry { runs: Vec::new(), ..self.clone() }).unwrap_or_default();
        let text = head.replacen("\"runs\": []", &format!("\"runs\": [\n{}\n]", runs.join(",\n")), 1) + "\n";
        interplay_files::write(path, text.as_bytes())
            .map_err(|reason| BenchError::File { path: path.to_owned(), reason })
    }
}

/// The scores by encounter and family.
pub(crate) fn cells(runs: &[EntryRun]) -> BTreeMap<(String, &'static str), Vec<&EntryRun>> {
    let mut cells: BTreeMap<(String, &'static str), Vec<&EntryRun>> = BTreeMap::new();
    for run in runs {
        if let Some(cell) = run.cell() {
            cells.entry(cell).or_default().push(run);
        }
    }
    cells
}

/// The mean over starts within each encounter and family, then over these equally.
pub(crate) fn mean_score(runs: &[EntryRun]) -> f64 {
    let cells = cells(runs);
    let mean = |runs: &Vec<&EntryRun>| runs.iter().map(|run| run.score.score).sum::<f64>() / runs.len() as f64;
    cells.values().map(mean).sum::<f64>() / cells.len().max(1) as f64
}

/// Lets planners, each with its name, drive on the selected starts, in parallel on the threads of the present pool; `advance` is called after
/// each start.
///
/// # Errors
/// If a run fails for another reason than the planner.
pub fn run_entry(
    registry: &Registry,
    planners: &[(String, PlannerSpec)],
    selection: &Selection,
    advance: &(dyn Fn() + Sync),
) -> Result<Vec<BenchEntry>, BenchError> {
    let encounters = selection.encounters()?;
    let on_start = |encounter: &Encounter| -> Result<Vec<EntryRun>, BenchError> {
        let start = Start::new(registry, *encounter)?;
        let drive = |(_, planner): &(String, PlannerSpec)| Ok(EntryRun::new(&start, start.drive(registry, planner)?));
        let runs = planners.iter().map(drive).collect();
        advance();
        runs
    };
    let by_start: Vec<Vec<EntryRun>> = encounters.par_iter().with_max_len(1).map(on_start).collect::<Result<_, _>>()?;
    let of = |(index, (name, planner)): (usize, &(String, PlannerSpec))| {
        BenchEntry::new(name, planner, selection, by_start.iter().map(|runs| runs[index].clone()).collect())
    };
    Ok(planners.iter().enumerate().map(of).collect())
}
