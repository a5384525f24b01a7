//! Runs a scenario from start to end.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::Ordering;

use interplay::run_outputs::{OutputError, RunOutputs};
use interplay_presentation::animation::{AnimationFormat, encoded};
use interplay_presentation::figures::{FrameLog, RecordedRun};
use interplay_presentation::record::{OpenRecording, Recorder, Sink};
use interplay_simulation::run::{add_counterfactuals, run_unless};
use interplay_simulation::watch::Watcher;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::errors::{RunError, refused, unfinished};
use crate::frames;
use crate::scenario::PyScenario;
use crate::threads::{interruptible, on_all_cores};

/// A finished run: its report, and all its ticks.
#[pyclass(name = "RecordedRun", module = "interplay._native", frozen)]
pub struct PyRecordedRun(Arc<RecordedRun>);

fn unwritten(error: impl std::fmt::Display) -> PyErr {
    RunError::new_err(error.to_string())
}

/// Runs a scenario and its counterfactuals, and writes a recording and the requested outputs: paths by the flags of the command.
#[pyfunction]
#[pyo3(signature = (scenario, record=None, outputs=None, is_cancelled=None))]
pub fn run(
    py: Python<'_>,
    scenario: &PyScenario,
    record: Option<PathBuf>,
    outputs: Option<BTreeMap<String, String>>,
    is_cancelled: Option<Py<PyAny>>,
) -> PyResult<PyRecordedRun> {
    refuse_external(scenario)?;
    let mut asked = RunOutputs::default();
    for (flag, path) in outputs.into_iter().flatten() {
        asked.ask_for(&flag, &path).map_err(bad)?;
    }
    let registry = crate::scenario::registry()?;
    if let Some(reason) = asked.refused(record.as_deref(), None, registry, &scenario.source, &[]) {
        return Err(bad(reason));
    }
    if let Some((flag, lacked)) = asked.without_subject(&scenario.scenario) {
        return Err(bad(format!("`{flag}` needs {lacked}, and `{}` has none", scenario.source)));
    }
    let (name, stated) = (scenario.name.clone(), Arc::clone(&scenario.scenario));
    let command = vec!["interplay".to_owned(), "run".to_owned(), scenario.source.clone()];
    interruptible(py, is_cancelled.as_ref(), |ended| {
        let frame_log = FrameLog::default();
        let mut watchers: Vec<Box<dyn Watcher>> = vec![Box::new(frame_log.clone())];
        let recording = record.map(|path| Recorder::begin(&stated, &name, &Sink::File(path)).map(OpenRecording::new));
        let recording = recording.transpose().map_err(unwritten)?;
        watchers.extend(recording.clone().map(|recording| Box::new(recording) as Box<dyn Watcher>));
        let mut begun = asked.begin(&stated, &command[2]).map_err(without_output)?;
        watchers.extend(begun.watchers());
        let is_ended = || ended.load(Ordering::Relaxed);
        let mut report = run_unless(&is_ended, &name, &stated, watchers).map_err(unfinished)?;
        if !stated.counterfactuals.is_empty() {
            on_all_cores(|| add_counterfactuals(&is_ended, &name, &stated, &mut report))?.map_err(unfinished)?;
        }
        recording.map_or(Ok(()), |recording| recording.close(&report)).map_err(unwritten)?;
        let scenario = (*stated).clone();
        let frames = frame_log.frames();
        let recorded = RecordedRun { label: String::new(), command, scenario, frames, report, shown_until_s: None };
        on_all_cores(|| begun.finish(&recorded, |_| ()))?.map_err(without_output)?;
        Ok(PyRecordedRun(Arc::new(recorded)))
    })
}

/// The exception of an output that is not where it should be.
fn without_output(error: OutputError) -> PyErr {
    match error {
        OutputError::Refused(refusal) => refused(*refusal),
        other => unwritten(other),
    }
}

fn bad(error: impl std::fmt::Display) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// A vehicle that waits for inputs from outside gets none in a whole run.
fn refuse_external(scenario: &PyScenario) -> PyResult<()> {
    let external = scenario.scenario.awaiting_inputs();
    let message = |name: &str| {
        format!("`{name}` is driven from outside: step an `interplay.Simulation`, or give it a planner with `planner=`")
    };
    external.map_or(Ok(()), |vehicle| Err(PyValueError::new_err(message(&vehicle.name))))
}

#[pymethods]
impl PyRecordedRun {
    /// The report, the document of `interplay run --json`.
    fn report(&self) -> PyResult<String> {
        serde_json::to_string(&self.0.report).map_err(unwritten)
    }

    /// The scenario, as a value that can be run again.
    fn scenario(&self) -> PyScenario {
        PyScenario::of(self.0.scenario.clone(), &self.0.report.scenario, &self.0.command[2])
    }

    /// The summary of `interplay run`.
    fn summary(&self) -> String {
        interplay_presentation::report::summary(&self.0.scenario.title, &self.0.report)
    }

    /// All ticks as arrays by name.
    fn frames<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        frames::arrays(py, &self.0.scenario, &self.0.frames)
    }

    /// The moving picture, as the bytes of a file: `gif`, `webp` or `png`.
    fn animation<'py>(&self, py: Python<'py>, format: &str) -> PyResult<Bound<'py, PyBytes>> {
        let format = match format {
            "gif" => AnimationFormat::Gif,
            "webp" => AnimationFormat::WebP,
            "png" => AnimationFormat::Filmstrip,
            word => return Err(PyValueError::new_err(format!("format `{word}`; choose from gif, webp, png"))),
        };
        let recorded = Arc::clone(&self.0);
        let bytes = py.detach(move || on_all_cores(|| encoded(&recorded, format)))?.map_err(unwritten)?;
        Ok(PyBytes::new(py, &bytes))
    }
}
