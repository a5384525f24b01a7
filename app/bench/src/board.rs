//! The board: a page of tables made from entries.

use std::collections::BTreeMap;
use std::fmt::Write;

use interplay_scenarios::{ENCOUNTER_VERSION, Encounter, PartnerFamily};
use interplay_sweep::stratified_mean_interval;

use crate::entry::{BenchEntry, EntryRun, cells, mean_score};
use crate::error::BenchError;

/// All runs of one planner, of one or several entries.
struct Ranked {
    name: String,
    runs: Vec<EntryRun>,
    score: f64,
}

/// The tables of entries as Markdown: the ranks with intervals, the scores by encounter and family, and why starts failed. Entries of one
/// planner, such as shards, count as one.
///
/// # Errors
/// [`BenchError::Refused`] for no entries, entries of several splits or of another version, and planners with different starts.
pub fn board(entries: &[BenchEntry]) -> Result<String, BenchError> {
    let ranked = ranked(entries)?;
    let split = &entries[0].selection.split;
    let starts = ranked[0].runs.len();
    let mut text = format!("### {ENCOUNTER_VERSION} on `{split}`, {starts} starts\n\n");
    ranks(&ranked, &mut text);
    let by_encounter = |run: &EntryRun| run.cell().map(|(encounter, _)| encounter);
    let by_family = |run: &EntryRun| run.cell().map(|(_, family)| family.to_owned());
    let encounters: Vec<String> = Encounter::kinds().map(str::to_owned).collect();
    let families: Vec<String> = PartnerFamily::ALL.iter().map(|family| family.word().to_owned()).collect();
    scores_by("family", &families, by_family, &ranked, &mut text);
    scores_by("encounter", &encounters, by_encounter, &ranked, &mut text);
    unsolved(&ranked, &mut text);
    Ok(text)
}

fn refused<T>(reason: String) -> Result<T, BenchError> {
    Err(BenchError::Refused(reason))
}

/// The planners, the best first.
fn ranked(entries: &[BenchEntry]) -> Result<Vec<Ranked>, BenchError> {
    let Some(first) = entries.first() else { return refused("there are no entries".to_owned()) };
    let mut by_name: BTreeMap<&str, BTreeMap<&str, &EntryRun>> = BTreeMap::new();
    for entry in entries {
        if entry.set != ENCOUNTER_VERSION || entry.people != first.people {
            return refused(format!(
                "{} is of {}, which does not compare with {ENCOUNTER_VERSION}",
                entry.name, entry.set
            ));
        }
        if entry.selection.split != first.selection.split {
            return refused(format!("{} is of `{}`; a board has one split", entry.name, entry.selection.split));
        }
        by_name.entry(&entry.name).or_default().extend(entry.runs.iter().map(|run| (run.id.as_str(), run)));
    }
    let mut ranked: Vec<Ranked> = Vec::new();
    for (name, runs) in by_name {
        let runs: Vec<EntryRun> = runs.into_values().cloned().collect();
        ranked.push(Ranked { name: name.to_owned(), score: mean_score(&runs), runs });
    }
    let ids = |ranked: &Ranked| ranked.runs.iter().map(|run| run.id.clone()).collect::<Vec<_>>();
    if let Some(other) = ranked.iter().find(|other| ids(other) != ids(&ranked[0])) {
        return refused(format!("{} and {} did not drive on the same starts", ranked[0].name, other.name));
    }
    ranked.sort_by(|a, b| b.score.total_cmp(&a.score));
    Ok(ranked)
}

/// Strata are encounters and families where each has at least this number of runs, otherwise encounters: resamples of few differ too little.
const LEAST_RUNS: usize = 5;

/// The mean score with its interval, or that of the paired differences from another planner on the same starts.
fn interval(one: &[EntryRun], other: Option<&[EntryRun]>, stream: u64) -> Option<(f64, [f64; 2])> {
    let is_fine = cells(one).values().all(|runs| runs.len() >= LEAST_RUNS);
    let mut strata: BTreeMap<(String, &str), Vec<f64>> = BTreeMap::new();
    for (index, run) in one.iter().enumerate() {
        let (encounter, family) = run.cell()?;
        let value = run.score.score - other.map_or(0.0, |other| other[index].score.score);
        strata.entry((encounter, if is_fine { family } else { "" })).or_default().push(value);
    }
    // Resamples of a single run all equal it, which is not a narrow interval.
    if strata.values().any(|values| values.len() < 2) {
        return None;
    }
    let strata: Vec<&[f64]> = strata.values().map(Vec::as_slice).collect();
    stratified_mean_interval(&strata, stream)
}

fn ranks(ranked: &[Ranked], text: &mut String) {
    text.push_str(
        "| planner | score | 95 % | less than the best, 95 % | contact at fault | rule broken | off the road | no goal in time | \
         `P`, `C`, `K` where `G = 1` | plans per start [s] |\n|---|--:|---|---|--:|--:|--:|--:|---|--:|\n",
    );
    for (rank, Ranked { name, runs, score }) in ranked.iter().enumerate() {
        let shown = |found: Option<(f64, [f64; 2])>| {
            found.map_or_else(String::new, |(_, [low, high])| format!("{low:.1} to {high:.1}"))
        };
        let paired =
            if rank == 0 { String::new() } else { shown(interval(&ranked[0].runs, Some(runs), 1 + rank as u64)) };
        let share = |word: &str| {
            let failed = runs.iter().filter(|run| run.failure.as_ref().is_some_and(|why| why.starts_with(word)));
            format!("{:.0} %", 100.0 * failed.count() as f64 / runs.len() as f64)
        };
        let solved: Vec<&EntryRun> = runs.iter().filter(|run| run.score.g > 0.0).collect();
        let mean = |value: fn(&EntryRun) -> f64| {
            let count = solved.len().max(1) as f64;
            format!("{:.2}", solved.iter().map(|run| value(run)).sum::<f64>() / count)
        };
        let parts = [mean(|run| run.score.p), mean(|run| run.score.c), mean(|run| run.score.k)].join(", ");
        let planning_s = runs.iter().map(|run| run.planning_s).sum::<f64>() / runs.len() as f64;
        // Writing to a text cannot fail.
        let _ = writeln!(
            text,
            "| {name} | {score:.1} | {} | {paired} | {} | {} | {} | {} | {parts} | {planning_s:.2} |",
            shown(interval(runs, None, 0)),
            share("contact"),
            share("rule"),
            share("off"),
            share("no goal"),
        );
    }
}

/// A table of mean scores by a word of each run.
fn scores_by(
    what: &str,
    words: &[String],
    word_of: impl Fn(&EntryRun) -> Option<String>,
    ranked: &[Ranked],
    text: &mut String,
) {
    let has_runs = |word: &&String| ranked[0].runs.iter().any(|run| word_of(run).as_ref() == Some(word));
    let names: Vec<&str> = ranked.iter().map(|ranked| ranked.name.as_str()).collect();
    let _ = writeln!(text, "\n| {what} | {} |\n|---|{}", names.join(" | "), "--:|".repeat(names.len()));
    for word in words.iter().filter(has_runs) {
        let mean = |ranked: &Ranked| {
            let of_word = ranked.runs.iter().filter(|run| word_of(run).as_ref() == Some(word)).cloned();
            format!("{:.1}", mean_score(&of_word.collect::<Vec<_>>()))
        };
        let _ = writeln!(text, "| {word} | {} |", ranked.iter().map(mean).collect::<Vec<_>>().join(" | "));
    }
}

fn unsolved(ranked: &[Ranked], text: &mut String) {
    let is_solved = |index: usize| ranked.iter().any(|ranked| ranked.runs[index].score.score > 0.0);
    let count = ranked[0].runs.len();
    let unsolved = (0..count).filter(|index| !is_solved(*index)).count();
    let _ = writeln!(text, "\n{unsolved} of {count} starts are solved by none of these planners.");
}
