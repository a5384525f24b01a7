//! Whole runs.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use interplay_presentation::animation::{AnimationFormat, encoded};
use interplay_presentation::figures::{FrameLog, RecordedRun};
use interplay_presentation::record::{OpenRecording, Recorder, Sink};
use interplay_simulation::run::run_with_counterfactuals;
use interplay_simulation::watch::Watcher;
use interplay_sweep::{TableFile, TrajectoryWriter};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::errors::{RunError, unfinished};
use crate::frames;
use crate::scenario::PyScenario;
use crate::threads::on_all_cores;

/// A finished run: its report, and all its ticks.
#[pyclass(name = "RecordedRun", module = "interplay._native", frozen)]
pub struct PyRecordedRun(Arc<RecordedRun>);

fn unwritten(error: impl std::fmt::Display) -> PyErr {
    RunError::new_err(error.to_string())
}

/// Runs a scenario and its counterfactuals, and writes what is asked for.
#[pyfunction]
#[pyo3(signature = (scenario, record=None, animate=None, trajectories=None))]
pub fn run(
    py: Python<'_>,
    scenario: &PyScenario,
    record: Option<PathBuf>,
    animate: Option<String>,
    trajectories: Option<String>,
) -> PyResult<PyRecordedRun> {
    refuse_external(scenario)?;
    for path in record.iter().cloned().chain([&animate, &trajectories].into_iter().flatten().map(PathBuf::from)) {
        refuse_input(scenario, &path)?;
    }
    let animate: Option<interplay_presentation::animation::AnimationFile> =
        animate.map(|path| path.parse().map_err(bad)).transpose()?;
    let trajectories: Option<TableFile> = trajectories.map(|path| path.parse().map_err(bad)).transpose()?;
    if let Some(animate) = &animate {
        animate.check().map_err(unwritten)?;
    }
    let (name, stated) = (scenario.name.clone(), Arc::clone(&scenario.scenario));
    let command = vec!["interplay".to_owned(), "run".to_owned(), scenario.source.clone()];
    py.detach(|| {
        let frame_log = FrameLog::default();
        let mut watchers: Vec<Box<dyn Watcher>> = vec![Box::new(frame_log.clone())];
        let recording = record.map(|path| Recorder::begin(&stated, &name, &Sink::File(path)).map(OpenRecording::new));
        let recording = recording.transpose().map_err(unwritten)?;
        watchers.extend(recording.clone().map(|recording| Box::new(recording) as Box<dyn Watcher>));
        let writer = trajectories.as_ref().map(TrajectoryWriter::begin).transpose().map_err(unwritten)?;
        watchers.extend(writer.map(|writer| Box::new(writer) as Box<dyn Watcher>));
        let report = on_all_cores(|| run_with_counterfactuals(&name, &stated, watchers))?.map_err(unfinished)?;
        recording.map_or(Ok(()), |recording| recording.close(&report)).map_err(unwritten)?;
        let scenario = (*stated).clone();
        let frames = frame_log.frames();
        let recorded = RecordedRun { label: String::new(), command, scenario, frames, report, shown_until_s: None };
        if let Some(file) = animate {
            on_all_cores(|| file.write(&recorded))?.map_err(unwritten)?;
        }
        Ok(PyRecordedRun(Arc::new(recorded)))
    })
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

/// No result takes the place of the scenario.
fn refuse_input(scenario: &PyScenario, path: &Path) -> PyResult<()> {
    let registry = crate::scenario::registry()?;
    let files = interplay_scenarios::files(registry, &scenario.source, &[]);
    let real = |path: &Path| path.canonicalize().ok();
    match files.iter().find(|file| real(file).is_some() && real(file) == real(path)) {
        Some(file) => Err(PyValueError::new_err(format!(
            "`{}` would be overwritten, of which the scenario is made; choose another name",
            file.display()
        ))),
        None => Ok(()),
    }
}

#[pymethods]
impl PyRecordedRun {
    /// The report, the document of `interplay run --json`.
    fn report(&self) -> PyResult<String> {
        serde_json::to_string(&self.0.report).map_err(unwritten)
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
