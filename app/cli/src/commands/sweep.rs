//! `interplay sweep`

use std::num::{NonZeroU32, NonZeroU64, NonZeroUsize};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use clap::{Args, Subcommand, ValueEnum};
use interplay_presentation::record::record_sweep_run;
use interplay_scenarios::{LoadError, Registry, Scenario, SweepPlan, embedded_plans};
use interplay_sweep::{Shard, ShardError, SweepError, SweepOptions, SweepOutcome, SweepRow, check, merge, sweep};
use rayon::ThreadPool;

use crate::commands::compare::after_sweep;
use crate::flag_values::plan_flags::PlanFlags;
use crate::flag_values::values;
use crate::output::error::ExitStatus;
use crate::output::progress::{CheckProgress, Progress};
use crate::output::{gave_up, print_error, print_load_error, printed};
use crate::process::limits::pool;

/// Run a plan of many runs, a row each: scenarios, times drivers, times values that vary, times planners.
#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true)]
#[command(
    after_help = "A sweep that was stopped goes on where it was, and a bigger one reuses the rows of a smaller one.\n\n\
    Examples:\n  \
    interplay sweep                                        (a small one, well below a minute)\n  \
    interplay sweep my-plan.toml --out results --keep failures\n  \
    interplay sweep --scenario intersection/nice --planner negotiation --planner idm --starts 20\n  \
    interplay sweep my-plan.toml --out results --shard 3/8\n  \
    interplay sweep merge results"
)]
pub(crate) struct Sweep {
    #[command(subcommand)]
    action: Option<Action>,

    #[arg(value_name = "PLAN", help = plan_help(), default_value = DEFAULT_PLAN)]
    #[arg(conflicts_with_all = ["scenario", "planner", "arms", "counterfactuals", "style", "vary", "sets", "starts"])]
    plan: String,

    #[command(flatten)]
    flags: PlanFlags,

    /// Where rows, journals, recordings and trajectories go [default: sweeps/NAME of the plan]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Make only a part of the runs: the I-th of N. In a Slurm array, each task makes its own part without being told
    #[arg(long, value_name = "I/N")]
    shard: Option<Shard>,

    /// Make one of N parts: the one that the task of a scheduler stands for (Slurm, Kubernetes or HyperQueue)
    #[arg(long, value_name = "N", value_parser = values::count::<NonZeroU32>, allow_negative_numbers = true, conflicts_with = "shard")]
    shards: Option<NonZeroU32>,

    /// What is kept of runs besides their rows; may be repeated
    #[arg(long, value_name = "WHAT", value_enum)]
    keep: Vec<Keep>,

    /// Check the plan with all that it draws, say how many runs it stands for, and run none
    #[arg(long)]
    dry_run: bool,

    /// How many run at a time [default: one for each core]
    #[arg(long, value_name = "N", value_parser = values::count::<NonZeroUsize>, allow_negative_numbers = true)]
    jobs: Option<NonZeroUsize>,
}

/// Something else to do than to run.
#[derive(Debug, Subcommand)]
enum Action {
    /// Merge the rows of all shards into one file, runs.parquet, sorted by key
    Merge {
        /// The folder of the shards
        #[arg(value_name = "DIR")]
        folder: PathBuf,
        /// Where the rows go [default: runs.parquet in the folder]
        #[arg(long, value_name = "FILE")]
        to: Option<PathBuf>,
        /// Leave out wall times, so that equal runs give equal files
        #[arg(long)]
        no_timings: bool,
    },
}

/// What is kept of runs besides their rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Keep {
    /// Nothing
    None,
    /// Recordings of runs in which the ego touched something or did not reach its goal
    Failures,
    /// What every vehicle did at every tick, a Parquet file a run; runs that were made before are not made again for it
    Trajectories,
}

/// The plan that is run without another.
const DEFAULT_PLAN: &str = "quick";

fn plan_help() -> String {
    format!("A plan: a file, or one in the binary ({})", embedded_plans().join(", "))
}

impl Sweep {
    pub(crate) fn execute(self, registry: &Registry) -> ExitStatus {
        if let Some(Action::Merge { folder, to, no_timings }) = &self.action {
            return merged(folder, to.as_deref(), !no_timings);
        }
        let shard = match self.shard() {
            Ok(shard) => shard,
            Err(error) => {
                print_error(&error.to_string());
                return ExitStatus::BadInput;
            }
        };
        if let Err(message) = self.flags.check() {
            print_error(&message);
            return ExitStatus::BadInput;
        }
        let plan = match self.plan(registry) {
            Ok(plan) => plan,
            Err(error) => {
                print_load_error(error);
                return ExitStatus::BadInput;
            }
        };
        let folder = self.folder();
        if self.dry_run {
            return match self.check(&plan, shard, &folder) {
                Ok(()) => printed(&counted(&plan)),
                Err(error) => gave_up(error),
            };
        }
        match self.run(&plan, shard, &folder) {
            Ok(outcome) => said(&outcome, shard, &folder, registry),
            Err(error) => gave_up(error),
        }
    }

    fn shard(&self) -> Result<Shard, ShardError> {
        if let Some(shard) = self.shard {
            return Ok(shard);
        }
        let found = Shard::of_scheduler(self.shards.map(Into::into), |name| std::env::var(name).ok())?;
        if let Some(shard) = found {
            print_error(&format!("shard {shard}, as the scheduler says"));
        }
        Ok(found.unwrap_or(Shard::WHOLE))
    }

    fn plan(&self, registry: &Registry) -> Result<SweepPlan, LoadError> {
        match self.flags.text() {
            Some(text) => registry.sweep_plan_from_text("the flags", &text, Path::new("")),
            None => registry.sweep_plan(&self.plan, self.flags.samples.map(NonZeroU64::get)),
        }
    }

    fn folder(&self) -> PathBuf {
        let name = if self.flags.text().is_some() { "flags" } else { &self.plan };
        self.out.clone().unwrap_or_else(|| folder_of_plan("sweeps", name))
    }

    /// Checks every run and makes none.
    fn check(&self, plan: &SweepPlan, shard: Shard, folder: &Path) -> Result<(), SweepError> {
        let checks = CheckProgress::start(plan.run_count());
        let outcome = pool_for(plan, self.jobs)?.install(|| check(plan, shard, folder, &|| checks.advance()));
        checks.clear();
        outcome
    }

    fn run(&self, plan: &SweepPlan, shard: Shard, folder: &Path) -> Result<SweepOutcome, SweepError> {
        make_rows(&pool_for(plan, self.jobs)?, plan, shard, folder, &self.keep)
    }
}

/// Makes the runs of a whole plan that are not in a folder yet, and tells how far it is.
pub(crate) fn make_missing_rows(plan: &SweepPlan, folder: &Path) -> Result<SweepOutcome, SweepError> {
    make_rows(&pool_for(plan, None)?, plan, Shard::WHOLE, folder, &[])
}

/// Where the rows of a plan go by default: into a folder of its name.
pub(crate) fn folder_of_plan(above: &str, name: &str) -> PathBuf {
    let stem = Path::new(name).file_stem().map_or_else(|| name.into(), |stem| stem.to_string_lossy());
    Path::new(above).join(&*stem)
}

/// The threads in which a plan is run.
fn pool_for(plan: &SweepPlan, jobs: Option<NonZeroUsize>) -> Result<ThreadPool, SweepError> {
    let pool = pool(jobs, usize::try_from(plan.run_count()).unwrap_or(usize::MAX));
    pool.map_err(|error| SweepError::Threads(error.to_string()))
}

fn make_rows(
    pool: &ThreadPool,
    plan: &SweepPlan,
    shard: Shard,
    folder: &Path,
    kept: &[Keep],
) -> Result<SweepOutcome, SweepError> {
    let checks = CheckProgress::start(plan.run_count());
    let progress: OnceLock<Progress> = OnceLock::new();
    let keep = |row: &SweepRow, scenario: &Scenario| record_sweep_run(folder, row, scenario);
    let options = SweepOptions {
        folder,
        shard,
        keep: kept.contains(&Keep::Failures).then_some(&keep),
        trajectories: kept.contains(&Keep::Trajectories),
        checked: &|| checks.advance(),
        begin: &|to_make, there| {
            checks.clear();
            print_error(&format!("{} to make, {there} made before", runs(to_make)));
            progress.get_or_init(|| Progress::with_time_left(to_make as usize));
        },
        advance: &|| {
            if let Some(progress) = progress.get() {
                progress.advance();
            }
        },
    };
    let outcome = pool.install(|| sweep(plan, &options));
    checks.clear();
    if let Some(progress) = progress.into_inner() {
        progress.clear();
    }
    outcome
}

fn runs(count: u64) -> String {
    if count == 1 { "1 run".to_owned() } else { format!("{count} runs") }
}

fn counted(plan: &SweepPlan) -> String {
    let [scenarios, styles, planners] = plan.names();
    let listed = |what: &str, names: &[&str]| {
        let plural = if names.len() == 1 { "" } else { "s" };
        format!("{} {what}{plural}: {}\n", names.len(), names.join(", "))
    };
    let varied: Vec<String> = plan.inputs().into_iter().map(|(path, _)| path).collect();
    let varied = if varied.is_empty() { String::new() } else { format!("varied: {}\n", varied.join(", ")) };
    let counterfactuals = match plan.counterfactual_count() {
        0 => String::new(),
        count => format!("counterfactuals of the scenarios, besides: {count}\n"),
    };
    format!(
        "{}: {}\n{}{}{}{counterfactuals}{varied}",
        plan.title(),
        runs(plan.run_count()),
        listed("scenario", &scenarios),
        listed("style", &styles),
        listed("planner", &planners)
    )
}

/// Says where the rows are; of a whole plan, also what they tell.
fn said(outcome: &SweepOutcome, shard: Shard, folder: &Path, registry: &Registry) -> ExitStatus {
    let SweepOutcome { table, rows, made, unfinished, damaged } = outcome;
    for (journal, line) in damaged {
        print_error(&format!(
            "{}:{line}: this row was not as it was written; its run was made again",
            journal.display()
        ));
    }
    let told = printed(&format!("{} in {}, {made} of them new\n", runs(*rows as u64), table.display()));
    if *unfinished > 0 {
        print_error(&format!("{} could not be finished: see the column `error`", runs(*unfinished as u64)));
    }
    let compared = if shard == Shard::WHOLE {
        let compared = after_sweep(folder, registry);
        compared.max(printed(&format!("next: interplay compare {} --by scenario\n", folder.display())))
    } else {
        printed(&format!("when all shards are there: interplay sweep merge {}\n", folder.display()))
    };
    if *unfinished > 0 { ExitStatus::Unfinished } else { told.max(compared) }
}

fn merged(folder: &Path, to: Option<&Path>, timings: bool) -> ExitStatus {
    match merge(folder, to, timings) {
        Ok(merged) => {
            let table = merged.table.display();
            let rows = format!("{} of {} in {table}\n", runs(merged.rows as u64), shards(merged.shards));
            let replaced = merged.replaced.map_or_else(String::new, |before| {
                format!("the table that was there, of {}, is replaced\n", runs(before as u64))
            });
            printed(&format!("{rows}{replaced}next: interplay compare {}\n", folder.display()))
        }
        Err(error) => gave_up(error),
    }
}

fn shards(count: u32) -> String {
    if count == 1 { "1 shard".to_owned() } else { format!("{count} shards") }
}
