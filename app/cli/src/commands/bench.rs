//! `interplay bench`

use std::fs;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

use clap::{Args, Subcommand};
use interplay_bench::{
    BenchEntry, BenchError, PEOPLE, PlannerSpec, Selection, Verified, board, observation, run_entry, verify,
    with_checks,
};
use interplay_scenarios::{ENCOUNTER_VERSION, Encounter, EncounterSplit, Registry};
use interplay_sweep::Shard;

use crate::flag_values::values;
use crate::output::error::ExitStatus;
use crate::output::progress::Progress;
use crate::output::{json, print_error, print_load_error, printed};
use crate::process::limits::pool;

/// Encounters 1: a reproducible benchmark of planning among others that react.
///
/// A start puts the ego before a conflict that only interaction solves. A planner is a kind of driver of this program, or any other program
/// that reads a line of JSON for each plan and answers with one.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    interplay bench list\n  \
    interplay bench run --planner idm --planner conservative --starts 0-3 --out entries\n  \
    interplay bench run --command 'python3 python/rivals/follow.py' --name follow --out entries\n  \
    interplay bench verify entries/follow.json\n  \
    interplay bench board entries")]
pub(crate) struct Bench {
    #[command(subcommand)]
    action: Action,
}

#[derive(Debug, Subcommand)]
enum Action {
    /// List the encounters and splits
    List {
        /// Print the id of every start of a split
        #[arg(long, value_name = "SPLIT")]
        split: Option<EncounterSplit>,
    },
    /// Let planners drive, and write an entry for each
    Run(Drive),
    /// Check an entry: its version, that no run is left out, its scores, and that runs repeat bit for bit
    Verify {
        /// The entry
        #[arg(value_name = "ENTRY")]
        entry: PathBuf,
        /// Repeat only every N-th run
        #[arg(long, value_name = "N", default_value = "1", value_parser = values::count::<NonZeroUsize>)]
        every: NonZeroUsize,
        /// How many run at a time [default: one for each core]
        #[arg(long, value_name = "N", value_parser = values::count::<NonZeroUsize>)]
        jobs: Option<NonZeroUsize>,
    },
    /// Make the tables of all entries in a folder, as Markdown
    Board {
        /// The folder
        #[arg(value_name = "FOLDER")]
        folder: PathBuf,
    },
    /// Print the JSON Schema of what another program is given for each plan
    Schema,
}

/// Lets planners drive.
#[derive(Debug, Args)]
struct Drive {
    /// The split: dev, test or sealed
    #[arg(long, value_name = "SPLIT", default_value = "dev")]
    split: EncounterSplit,
    /// A kind of driver; may be repeated
    #[arg(long = "planner", value_name = "KIND", required_unless_present = "command")]
    planners: Vec<String>,
    /// A setting of the driver, such as headway_s=1.2; may be repeated
    #[arg(long = "setting", value_name = "KEY=VALUE", conflicts_with = "command")]
    settings: Vec<String>,
    /// Another program, such as `python3 rival.py`
    #[arg(long, value_name = "COMMAND", conflicts_with = "planners")]
    command: Option<String>,
    /// The name of the entry [default: the kind, or the command]
    #[arg(long, value_name = "NAME")]
    name: Option<String>,
    /// Only this encounter
    #[arg(long, value_name = "WORD")]
    encounter: Option<String>,
    /// Only these numbers of each encounter, such as 0-3
    #[arg(long, value_name = "A-B", value_parser = numbers)]
    starts: Option<[u32; 2]>,
    /// Only a part: the I-th of N
    #[arg(long, value_name = "I/N")]
    shard: Option<Shard>,
    /// How many run at a time [default: one for each core]
    #[arg(long, value_name = "N", value_parser = values::count::<NonZeroUsize>)]
    jobs: Option<NonZeroUsize>,
    /// Where the entries go, a file each
    #[arg(long, value_name = "FOLDER", default_value = "entries")]
    out: PathBuf,
}

/// Numbers from a first to a last, or one.
fn numbers(text: &str) -> Result<[u32; 2], String> {
    let (first, last) = text.split_once('-').unwrap_or((text, text));
    match (first.parse(), last.parse()) {
        (Ok(first), Ok(last)) if first <= last => Ok([first, last]),
        _ => Err("write two numbers such as 0-3".to_owned()),
    }
}

impl Bench {
    pub(crate) fn execute(self, registry: &Registry) -> ExitStatus {
        let outcome = with_checks(registry).and_then(|registry| match self.action {
            Action::List { split } => Ok(listed(split)),
            Action::Run(run) => run.execute(&registry),
            Action::Verify { entry, every, jobs } => verified(&registry, &entry, every, jobs),
            Action::Board { folder } => board(&read_all(&folder)?),
            Action::Schema => Ok(json("the schema", &observation::schema()).unwrap_or_default()),
        });
        match outcome {
            Ok(text) => printed(&text),
            Err(error) => refused(error),
        }
    }
}

fn refused(error: BenchError) -> ExitStatus {
    let ending = if error.is_bad_input() { ExitStatus::BadInput } else { ExitStatus::Unfinished };
    match error {
        BenchError::Planner(error) => print_load_error(*error),
        other => print_error(&format!("Error: {other}")),
    }
    ending
}

fn listed(split: Option<EncounterSplit>) -> String {
    if let Some(split) = split {
        return Encounter::all(split).map(|start| format!("{start}\n")).collect();
    }
    let mut text = format!("{ENCOUNTER_VERSION}, people {}\n\n", PEOPLE.trim());
    for split in EncounterSplit::ALL {
        let families = split.families().iter().map(|family| family.word()).collect::<Vec<_>>().join(", ");
        text += &format!("{:6} 12 encounters x {:3} starts, others: {families}\n", split.word(), split.starts());
    }
    text + "\n"
        + &Encounter::kinds().collect::<Vec<_>>().join("\n")
        + "\n\nnext: interplay run EN1/dev/zipper/000:people\n"
}

impl Drive {
    fn execute(self, registry: &Registry) -> Result<String, BenchError> {
        let selection = Selection {
            split: self.split.word().to_owned(),
            encounter: self.encounter.clone(),
            starts: self.starts,
            shard: self.shard.map(|shard| shard.to_string()),
        };
        let starts = selection.encounters()?.len();
        let planners = self.named_planners()?;
        let progress = Progress::with_time_left(starts);
        let entries =
            on_threads(self.jobs, starts, || run_entry(registry, &planners, &selection, &|| progress.advance()))?;
        progress.clear();
        let mut text = String::new();
        for entry in &entries {
            let part = self.shard.map(|shard| format!("-{}-of-{}", shard.index, shard.count)).unwrap_or_default();
            let path = self.out.join(format!("{}{part}.json", file_name(&entry.name)));
            entry.write(&path)?;
            let solved = entry.runs.iter().filter(|run| run.score.g > 0.0).count();
            let partial = if selection.is_whole() { "" } else { ", a part of the split" };
            text += &format!(
                "{}: score {:.1}, goal reached without a fault on {solved} of {} starts{partial}; {}\n",
                entry.name,
                entry.score,
                entry.runs.len(),
                path.display()
            );
            for run in entry.runs.iter().filter(|run| !run.failed_plans.is_empty()).take(3) {
                print_error(&format!("{}: {}", run.id, run.failed_plans.join("; ")));
            }
        }
        Ok(text + &format!("next: interplay bench board {}\n", self.out.display()))
    }

    fn named_planners(&self) -> Result<Vec<(String, PlannerSpec)>, BenchError> {
        if let Some(command) = &self.command {
            let name = self.name.clone().unwrap_or_else(|| command.clone());
            return Ok(vec![(name, PlannerSpec::Command { command: command.clone() })]);
        }
        if self.name.is_some() && self.planners.len() > 1 {
            return Err(BenchError::Selection("`--name` names one planner, and there are several".to_owned()));
        }
        let spec = |kind: &String| {
            let name = self.name.clone().unwrap_or_else(|| kind.clone());
            (name, PlannerSpec::Kind { kind: kind.clone(), settings: self.settings.clone() })
        };
        Ok(self.planners.iter().map(spec).collect())
    }
}

/// A name as that of a file.
fn file_name(name: &str) -> String {
    name.chars().map(|letter| if letter.is_ascii_alphanumeric() || letter == '-' { letter } else { '_' }).collect()
}

fn on_threads<T: Send>(
    jobs: Option<NonZeroUsize>,
    runs: usize,
    work: impl FnOnce() -> Result<T, BenchError> + Send,
) -> Result<T, BenchError> {
    pool(jobs, runs).map_err(|error| BenchError::Selection(error.to_string()))?.install(work)
}

fn verified(
    registry: &Registry,
    path: &Path,
    every: NonZeroUsize,
    jobs: Option<NonZeroUsize>,
) -> Result<String, BenchError> {
    let entry = BenchEntry::read(path)?;
    let progress = Progress::with_time_left(entry.runs.len().div_ceil(every.get()));
    let checked = on_threads(jobs, entry.runs.len(), || verify(registry, &entry, every.get(), &|| progress.advance()));
    progress.clear();
    let Verified { runs, repeated } = checked?;
    let note =
        if entry.program == interplay_sweep::program_version() { "" } else { ", by a program with other sources" };
    Ok(format!(
        "{}: score {:.1} holds{note}; {repeated} of {runs} runs repeated bit for bit\n",
        entry.name, entry.score
    ))
}

/// All entries of a folder, by name.
fn read_all(folder: &Path) -> Result<Vec<BenchEntry>, BenchError> {
    let unreadable = |reason| BenchError::File { path: folder.to_owned(), reason };
    let files = fs::read_dir(folder).map_err(unreadable)?;
    let mut paths: Vec<PathBuf> = files.filter_map(|file| Some(file.ok()?.path())).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "json"));
    paths.sort();
    paths.iter().map(|path| BenchEntry::read(path)).collect()
}
