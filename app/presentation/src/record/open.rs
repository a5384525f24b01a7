//! A recording that stays open after its run, for what is known only when other runs have been judged.

use std::sync::{Arc, Mutex, PoisonError};

use interplay_simulation::frame::Frame;
use interplay_simulation::report::Report;
use interplay_simulation::watch::{WatchError, Watcher};

use super::{RecordError, Recorder};

/// A watcher that records, and keeps the recording when the run is over; its clones share the recording. Dropped without
/// being closed, it leaves no file.
#[derive(Clone)]
pub struct OpenRecording(Arc<Mutex<Option<Recorder>>>);

impl OpenRecording {
    /// Keeps this recording open.
    pub fn new(recorder: Recorder) -> OpenRecording {
        OpenRecording(Arc::new(Mutex::new(Some(recorder))))
    }

    /// Adds what became of the counterfactuals and ends the recording: only now a file appears at its place.
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
        Ok(recorder.as_mut().map_or(Ok(()), |recorder| recorder.tick(frame))?)
    }

    fn finish(self: Box<Self>) -> Result<(), WatchError> {
        Ok(())
    }
}
