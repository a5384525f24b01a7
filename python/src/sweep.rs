//! Many runs from a plan.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use interplay_presentation::record::record_sweep_run;
use interplay_scenarios::{Scenario, SweepPlan};
use interplay_sweep::{Shard, SweepOptions, SweepRow};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::errors::{RunError, refused};
use crate::scenario::registry;
use crate::threads::interruptible;

/// Largest number of threads of a sweep.
const MAX_JOBS: usize = 1024;

/// Runs a plan into a folder, on all cores. Returns the path of the table of rows, the number of runs that were made,
/// and the number of runs without a result. `text` is a plan as JSON; without it, `source` is a name or a path.
#[pyfunction]
#[pyo3(signature = (source, folder, text=None, jobs=None, samples=None, keep_failures=false))]
pub fn sweep(
    py: Python<'_>,
    source: &str,
    folder: PathBuf,
    text: Option<&str>,
    jobs: Option<usize>,
    samples: Option<u64>,
    keep_failures: bool,
) -> PyResult<(PathBuf, u64, usize)> {
    let registry = registry()?;
    let plan = match text {
        None => py.detach(|| registry.sweep_plan(source, samples)).map_err(refused)?,
        Some(json) => {
            let table: toml::Table =
                serde_json::from_str(json).map_err(|error| PyValueError::new_err(error.to_string()))?;
            let text = toml::to_string(&table).map_err(|error| PyValueError::new_err(error.to_string()))?;
            py.detach(|| registry.sweep_plan_from_text(source, &text, Path::new(""))).map_err(refused)?
        }
    };
    let jobs = jobs.unwrap_or(0);
    if jobs > MAX_JOBS {
        return Err(PyValueError::new_err(format!("`jobs` is at most {MAX_JOBS}, and not {jobs}")));
    }
    interruptible(py, None, |ended| made(&plan, &folder, jobs, keep_failures, ended))
}

/// Makes the runs of a plan, until it is cancelled.
fn made(
    plan: &SweepPlan,
    folder: &Path,
    jobs: usize,
    keep_failures: bool,
    ended: &AtomicBool,
) -> PyResult<(PathBuf, u64, usize)> {
    let record = |row: &SweepRow, scenario: &Scenario| record_sweep_run(folder, row, scenario);
    let options = SweepOptions {
        folder,
        shard: Shard::WHOLE,
        keep: keep_failures.then_some(&record),
        trajectories: false,
        checked: &|| (),
        begin: &|_, _| (),
        advance: &|| (),
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(jobs).build();
    let pool = pool.map_err(|error| RunError::new_err(error.to_string()))?;
    let outcome = pool.install(|| interplay_sweep::sweep_unless(&|| ended.load(Ordering::Relaxed), plan, &options));
    let outcome = outcome.map_err(|error| match error {
        interplay_sweep::SweepError::Refused(error) => refused(*error),
        error if error.is_bad_input() => PyValueError::new_err(error.to_string()),
        error => RunError::new_err(error.to_string()),
    })?;
    Ok((outcome.table, outcome.made, outcome.unfinished))
}
