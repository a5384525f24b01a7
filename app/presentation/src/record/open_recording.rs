//! Recordings that stay open after their run, until other runs have been judged; and recordings of runs of a sweep.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use interplay_scenarios::Scenario;
use interplay_simulation::frame::Frame;
use interplay_simulation::report::Report;
use interplay_simulation::run::run;
use interplay_simulation::watch::{WatchError, Watcher};
use interplay_sweep::SweepRow;
use rerun::RecordingStreamError;
use thiserror::Error;

use super::{Recorder, Sink};

/// A watcher that records and stays open after the run; its clones share the recording. Dropped without
/// [`OpenRecording::close`], it leaves no file.
#[derive(Clone)]
pub struct OpenRecording(Arc<Mutex<Option<Recorder>>>);

impl OpenRecording {
    /// Keeps this recording open.
    pub fn new(recorder: Recorder) -> OpenRecording {
        OpenRecording(Arc::new(Mutex::new(Some(recorder))))
    }

    /// Adds the outcomes of the counterfactuals, finishes the recording and writes its file.
    ///
    /// # Errors
    /// As [`Recorder::finish`].
    pub fn close(self, report: &Report) -> Result<(), RecordError> {
        let recorder = self.0.lock().unwrap_or_else(PoisonError::into_inner).take();
        let Some(recorder) = recorder else { return Ok(()) };
        if !report.counterfactuals.is_empty() {
            recorder.describe(&report.counterfactuals)?;
        }
        recorder.finish()
    }
}

impl Watcher for OpenRecording {
    fn tick(&mut self, frame: &Frame) -> Result<(), WatchError> {
        let mut recorder = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        Ok(recorder.as_mut().map_or(Ok(()), |recorder| recorder.log_frame(frame))?)
    }

    fn finish(self: Box<Self>) -> Result<(), WatchError> {
        Ok(())
    }
}

/// Repeats a run of a sweep and records it as `recordings/KEY.rrd` in a folder. A run without a result is not recorded.
///
/// # Errors
/// The error as a text.
pub fn record_sweep_run(folder: &Path, row: &SweepRow, scenario: &Scenario) -> Result<(), String> {
    if row.error.is_some() {
        return Ok(());
    }
    let path = folder.join("recordings").join(format!("{}.rrd", row.key));
    let recorder = Recorder::begin(scenario, &row.scenario, &Sink::File(path)).map_err(|error| error.to_string())?;
    let recording = OpenRecording::new(recorder);
    let report = run(&row.scenario, scenario, vec![Box::new(recording.clone())]).map_err(|error| error.to_string())?;
    recording.close(&report).map_err(|error| error.to_string())
}

/// Why a recording failed. No incomplete file is left behind.
#[derive(Debug, Error)]
pub enum RecordError {
    /// The file cannot be written.
    #[error("cannot write the recording {}: {reason}; name another file with --record, or do without (--no-record)", path.display())]
    Unwritable { path: PathBuf, reason: io::Error },
    /// No viewer listens at the address.
    #[error(
        "no Rerun viewer listens on {address} ({reason}); start one first (`rerun`), or record into a file instead of --connect"
    )]
    NoViewer {
        /// Address at which a viewer was expected.
        address: String,
        reason: io::Error,
    },
    /// Rerun cannot parse its own default address.
    #[error(transparent)]
    Address(#[from] ViewerAddressError),
    /// Rerun refused data or lost the viewer.
    #[error("the recording broke off: {0}")]
    Broken(Box<dyn std::error::Error + Send + Sync>),
}

impl RecordError {
    pub(super) fn unwritable(path: &Path) -> impl Fn(io::Error) -> RecordError {
        move |reason| RecordError::Unwritable { path: path.to_owned(), reason }
    }
}

impl From<RecordingStreamError> for RecordError {
    fn from(error: RecordingStreamError) -> Self {
        RecordError::Broken(Box::new(error))
    }
}

/// A text that is not the address of a viewer.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
#[error("not the address of a viewer; write it like {}", rerun::DEFAULT_CONNECT_URL)]
pub struct ViewerAddressError;
