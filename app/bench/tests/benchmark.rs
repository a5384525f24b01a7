//! Entries repeat bit for bit, whatever drives; what was changed in one is found; a program that fails costs its score and nothing else.

use interplay_bench::{BenchEntry, BenchError, PlannerSpec, Selection, board, run_entry, verify, with_checks};
use interplay_scenarios::Registry;

/// A program that keeps its speed and steers straight on, as long as it is alive.
const STEADY: &str = "sh -c 'while read -r line; do echo \"{\\\"input\\\": [0.0, 0.0]}\"; done'";

fn registry() -> Registry {
    with_checks(Registry::standard()).expect("free words")
}

fn kind(kind: &str) -> (String, PlannerSpec) {
    (kind.to_owned(), PlannerSpec::Kind { kind: kind.to_owned(), settings: Vec::new() })
}

fn command(command: &str) -> (String, PlannerSpec) {
    ("other".to_owned(), PlannerSpec::Command { command: command.to_owned() })
}

fn selection(encounter: &str, starts: [u32; 2]) -> Selection {
    Selection { split: "dev".to_owned(), encounter: Some(encounter.to_owned()), starts: Some(starts), shard: None }
}

fn entries(planners: &[(String, PlannerSpec)], selection: &Selection, threads: usize) -> Vec<BenchEntry> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    pool.install(|| run_entry(&registry(), planners, selection, &|| ())).expect("runs")
}

/// All but wall times.
fn repeatable(entry: &BenchEntry) -> BenchEntry {
    let mut entry = entry.clone();
    entry.planning_s = 0.0;
    entry.runs.iter_mut().for_each(|run| run.planning_s = 0.0);
    entry
}

fn refusal(entry: &BenchEntry) -> String {
    match verify(&registry(), entry, 1, &|| ()) {
        Err(BenchError::Refused(reason)) => reason,
        other => panic!("{other:?}"),
    }
}

#[test]
fn an_entry_has_the_same_bits_with_any_number_of_threads_and_holds() {
    let (planners, selection) = ([kind("pusher"), kind("waiter")], selection("crossing-equal", [2, 3]));
    let [one, two] = [1, 2].map(|threads| entries(&planners, &selection, threads));
    for (one, two) in one.iter().zip(&two) {
        assert_eq!(repeatable(one), repeatable(two));
        let verified = verify(&registry(), one, 1, &|| ()).expect("it holds");
        assert_eq!((verified.runs, verified.repeated), (2, 2));
    }
    assert_ne!(one[0].runs[0].digest, one[1].runs[0].digest, "planners drive differently");
    let page = board(&one).expect("a board");
    assert!(page.contains("| pusher |") && page.contains("crossing-equal"), "{page}");
}

#[test]
fn what_was_changed_in_an_entry_is_found() {
    let entry = entries(&[kind("constant-velocity")], &selection("t-fast", [2, 3]), 1).remove(0);
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("entry.json");
    entry.write(&path).expect("written");
    assert_eq!(BenchEntry::read(&path).expect("read"), entry);

    let text = std::fs::read_to_string(&path).expect("read");
    let digest = entry.runs[1].digest.clone();
    let last = if digest.ends_with('0') { "1" } else { "0" };
    let changed = format!("{}{last}", &digest[..digest.len() - 1]);
    std::fs::write(&path, text.replace(&digest, &changed)).expect("written");
    assert!(refusal(&BenchEntry::read(&path).expect("read")).contains("sealed"));

    let mut left_out = entry.clone();
    let run = left_out.runs.remove(0);
    assert!(refusal(&left_out).contains(&format!("{} was left out", run.id)));
    let other_version = BenchEntry { set: "EN1.7".to_owned(), ..entry.clone() };
    assert!(refusal(&other_version).contains("EN1.7"));
    let better = BenchEntry { score: entry.score + 1.0, ..entry };
    assert!(refusal(&better).contains("its runs give"));
}

/// The program that drove is not needed to verify its entry.
#[cfg(unix)]
#[test]
fn inputs_of_another_program_are_replayed_to_the_same_bits() {
    let mut entry = entries(&[command(STEADY)], &selection("crossing-equal", [0, 1]), 2).remove(0);
    assert!(entry.runs.iter().all(|run| run.failed_plans.is_empty()), "{:?}", entry.runs[0].failed_plans);
    entry.planner = PlannerSpec::Command { command: "no-such-program".to_owned() };
    // The seal contains the command; only that is checked before runs are repeated.
    assert!(refusal(&entry).contains("sealed"));
    let original = entries(&[command(STEADY)], &selection("crossing-equal", [0, 1]), 1).remove(0);
    assert_eq!(verify(&registry(), &original, 1, &|| ()).expect("it holds").repeated, 2);
}

/// Not a number, an end without an answer, and a text that is not an answer: the ego brakes, and the run goes on.
#[cfg(unix)]
#[test]
fn a_program_that_fails_brakes_and_does_not_end_the_benchmark() {
    let not_a_number = STEADY.replace("0.0, 0.0", "NaN, 0.0");
    for program in [not_a_number.as_str(), "true", "sh -c 'while read -r line; do echo hello; done'"] {
        let entry = entries(&[command(program)], &selection("crossing-equal", [0, 0]), 1).remove(0);
        let run = &entry.runs[0];
        assert!(run.failed_plans.len() > 3 && run.score.score == 0.0, "{program}: {run:?}");
        assert_eq!(run.inputs.as_ref().map(|inputs| inputs[0][1] < -3_000_000), Some(true), "{program}");
    }
}

#[test]
fn a_selection_that_does_not_exist_is_refused() {
    for wrong in [
        Selection { split: "train".to_owned(), encounter: None, starts: None, shard: None },
        selection("moon", [0, 1]),
        selection("zipper", [40, 50]),
    ] {
        assert!(matches!(wrong.encounters(), Err(BenchError::Selection(_))), "{wrong:?}");
    }
}
